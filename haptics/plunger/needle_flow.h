// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "artus/detail/anatomy/body/liquid.h"
#include "artus/detail/core/check.h"

namespace artus {

/// The inside of a needle.
struct NeedleBore {
  double diameter = 0.413e-3;        ///< m
  double outer_diameter = 0.718e-3;  ///< m
  double length = 0.050;             ///< m
};

/// Regular-wall bore of a gauge, 18, 19, 20, 21, 22, 23, 25 or 27, with this length (m); empty for
/// any other. Source: nominal values, [WikiNeedle].
[[nodiscard]] std::optional<NeedleBore> bore_of_gauge(int gauge, double length);

/// What flows through a needle at a pressure drop: Hagen and Poiseuille's law with the loss at the
/// entry for a Newtonian liquid, a table by Rabinowitsch and Mooney for one that thins. Explicit in
/// both directions; nothing is iterated.
class NeedleFlow {
 public:
  /// Kinetic energy of the jet (2) and the entry (0.2) in units of the mean velocity's dynamic
  /// pressure; assumed: others use 1.5 to 2.3.
  static constexpr double kEntryLoss = 2.2;

  /// Requires: diameter, length, viscosity, density above 0; entry_loss of at least 0.
  NeedleFlow(const NeedleBore& bore, const Viscosity& viscosity, double density,
             double entry_loss = kEntryLoss);

  /// m^3/s at a drop of `dp` (Pa), with `extra` Pa s/m^3 in series; the sign of dp.
  [[nodiscard]] ARTUS_REALTIME double flow(double dp, double extra = 0) const noexcept;
  /// Pa at `flow` m^3/s; its inverse.
  [[nodiscard]] ARTUS_REALTIME double drop(double flow, double extra = 0) const noexcept;
  /// Pa s/m^3: of a Newtonian liquid its own; of another the apparent one at 0.1 ml/s.
  [[nodiscard]] double resistance() const noexcept { return resistance_; }

 private:
  static constexpr std::size_t kPoints = 512;
  void tabulate(const NeedleBore& bore, const Viscosity& viscosity);

  bool newtonian_;
  double resistance_;                   // Pa s/m^3
  double kinetic_;                      // Pa s^2/m^6
  std::array<double, kPoints> flow_{};  // m^3/s, ascending from 0
  std::array<double, kPoints> drop_{};  // Pa
};

}  // namespace artus
