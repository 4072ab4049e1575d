// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "artus/detail/operators/scanning_operator.h"

namespace artus {

/// Where a probe may go to look for something: a rectangle on the skin.
struct LookPlan {
  double half_x = 35e-3;  ///< m, along the face
  double half_y = 35e-3;  ///< m, along the elevation
  double view = 38e-3;    ///< m of the skin that one picture shows
  std::size_t n = 0;      ///< how many are asked for, one after another
};

/// What the eyes get at a glance: which of the structures are in the picture, and where.
struct LookGlance {
  std::vector<std::optional<double>> x;  ///< (n), m from the picture's middle; empty: not in it
  std::size_t asked = 0;                 ///< the one that is asked for now; n: all are found
};

/// One simulated hand with a probe that looks for what it is asked to show: it sweeps its rectangle
/// in lanes, brings what it takes for the thing asked into the picture's middle and waits. It
/// recognises a structure with the chance `OperatorSkill::know` each time that it comes into the
/// picture, else may take another for it, and remembers where it recognised others on the way.
/// Deterministic by seed; knows no clock but the times it is given.
class LookingOperator {
 public:
  LookingOperator(const OperatorSkill& skill, const LookPlan& plan, std::uint64_t seed);

  /// A glance at the picture, 20 times a second.
  void look(double time, const LookGlance& glance);

  /// Where the probe is meant to be: m along x and y from the rectangle's middle.
  [[nodiscard]] double x() const noexcept { return x_; }
  [[nodiscard]] double y() const noexcept { return y_; }
  [[nodiscard]] bool done() const noexcept { return done_; }

 private:
  struct Place {
    double x = 0;
    double y = 0;
  };
  void move_to(const Place& place, double speed) noexcept;
  void sweep() noexcept;
  void notice(double time, const LookGlance& glance);
  void centre(double time, const LookGlance& glance);
  [[nodiscard]] double draw() noexcept;

  OperatorSkill skill_;
  LookPlan plan_;
  std::uint64_t seed_;
  std::uint64_t draws_ = 0;
  double x_ = 0;
  double y_ = 0;
  std::vector<Place> lanes_;  // corners of the sweep
  std::size_t next_ = 0;
  std::vector<char> in_view_;                 // (n) at the last glance
  std::vector<std::optional<Place>> places_;  // (n) where others were recognised
  std::optional<std::size_t> taken_;          // what is being centred
  double taken_time_ = 0;                     // s
  std::size_t asked_ = 0;
  bool done_ = false;
};

}  // namespace artus
