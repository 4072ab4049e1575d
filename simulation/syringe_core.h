// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/haptics/guard.h"
#include "artus/detail/haptics/plunger/bevel.h"
#include "artus/simulation/input_device.h"
#include "artus/simulation/session_params.h"

namespace artus {

/// A place that liquid went into, where it did so first. Plain bytes.
struct InjectedSite {
  double p_J[3] = {};        ///< m, the middle of the bevel then  NOLINT(*-avoid-c-arrays)
  double volume = 0;         ///< m^3 in it
  std::uint32_t region = 0;  ///< RegionId
  std::uint32_t cavity = 0;  ///< 1: a space that opens; 0: tissue that parts
};
/// Places that are told of; what goes into more is not drawn.
inline constexpr std::size_t kMaxSites = 4;

/// The syringe of a session: the plunger as a device moves it, with the tip where the needle's
/// contact says, and what thumb and needle feel of it. A pure function of its inputs.
class SyringeCore {
 public:
  /// N/m of the spring between a device's plunger and the stopper. Source: the softness of 1e-11
  /// m^3/Pa that a device at 1 kHz can render on a barrel of 5 ml.
  static constexpr double kCoupling = 1300;
  /// N that a thumb is ever pushed with; assumed: a strong push.
  static constexpr double kMaxForce = 40;
  /// m/s of a device's plunger; what is faster is no thumb's motion. Assumed: a thumb < 0.5 m/s.
  static constexpr double kMaxSpeed = 1;
  /// s for which a jump of the plunger is told after it.
  static constexpr double kToldFor = 0.5;

  /// Requires: valid params.
  SyringeCore(const CompiledJoint& joint, const SessionParams& params);

  /// One period.
  ARTUS_REALTIME void step(const DeviceSample& device, const NeedleContact& contact) noexcept;
  /// One period in which time stands still for the syringe, and the thumb feels nothing.
  ARTUS_REALTIME void rest() noexcept;
  /// A new syringe, and a body that nothing was put into.
  ARTUS_REALTIME void reset() noexcept;

  [[nodiscard]] const PlungerFeedback& feedback() const noexcept { return out_; }
  /// N along the needle, of the thumb's force: what of it the fingers do not carry.
  [[nodiscard]] double on_needle() const noexcept { return on_needle_; }
  [[nodiscard]] const Plunger& plunger() const noexcept { return plunger_; }
  /// In which places the opening of the bevel was in the last step.
  [[nodiscard]] const std::array<TipShare, 2>& tip() const noexcept { return tip_; }
  /// In the order in which something came to them.
  [[nodiscard]] std::span<const InjectedSite> sites() const noexcept {
    return {sites_.data(), n_sites_};
  }

 private:
  SyringeCore(JointSpaces spaces, const SessionParams& params);
  void describe(double thumb, std::uint32_t faults) noexcept;
  [[nodiscard]] bool jumps(const DeviceSample& device) noexcept;
  [[nodiscard]] bool follow_travel(const DeviceSample& device, PlungerInput& input) noexcept;
  void find_lifted(const NeedleContact& contact) noexcept;
  void note_sites(const PlungerInput& input, const NeedleContact& contact) noexcept;

  double bevel_;  // m
  BevelPlaces places_;
  std::vector<double> lifted_;  // (n_spaces) m of roof, off the bevel
  std::array<TipShare, 2> tip_{};
  Plunger plunger_;
  OutputGuard guard_;
  double zero_ = 0;  // m of the device's travel where the plunger's is 0
  bool engaged_ = false;
  double dt_;                   // s
  double last_travel_ = 0;      // m of the device's, when it last said
  std::int64_t last_time_ = 0;  // ns of the sample that said it
  double told_ = 0;             // s for which a jump is still told
  double given_ = 0;            // m^3 that left the needle forward
  double on_needle_ = 0;
  std::array<InjectedSite, kMaxSites> sites_;
  std::array<std::uint32_t, kMaxSites> space_of_site_{};
  std::size_t n_sites_ = 0;
  PlungerFeedback out_;
};

}  // namespace artus
