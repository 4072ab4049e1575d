// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>

#include "artus/detail/haptics/probe/skin_contact.h"
#include "artus/detail/simulation/hand_aids.h"
#include "artus/detail/simulation/records.h"
#include "artus/haptics/needle_renderer.h"

namespace artus {

/// The haptic half of a session as a pure function of its inputs: no clock, no thread. What runs
/// live is what a replay runs.
class HapticCore {
 public:
  /// Requires: valid params, a scene.
  HapticCore(std::shared_ptr<const Scene> scene, const SessionParams& params);

  /// What the tissue answers the hands with from the next tick on.
  ARTUS_REALTIME void take(const TissuePacket& packet) noexcept {
    probe_.take(packet.probe);
    needle_.take(packet.needle);
  }

  /// One period. Errors: none; the status says what was wrong, and then the force is zero.
  ARTUS_REALTIME const HapticSnapshot& step(const TickInput& input) noexcept;

  /// For who replays: volumes and places, between two ticks.
  [[nodiscard]] const SyringeCore& syringe() const noexcept { return syringe_; }
  /// The same: contact and laws.
  [[nodiscard]] const NeedleModel& needle() const noexcept { return needle_.model(); }
  /// J given to the needle's hand since the start.
  [[nodiscard]] double energy_to_hand() const noexcept { return needle_.energy_to_hand(); }
  [[nodiscard]] const HapticSnapshot& last() const noexcept { return out_; }

 private:
  void take(const TickInput& input) noexcept;
  [[nodiscard]] bool feel_needle(const DeviceSample& device, std::uint32_t command) noexcept;
  void step_probe(bool felt, const std::optional<Pose>& X_WP) noexcept;
  [[nodiscard]] double step_syringe(bool runs) noexcept;
  void command_needle(const Vec3& more_J) noexcept;
  void describe() noexcept;

  std::shared_ptr<const Scene> scene_;
  NeedleRenderer needle_;
  TwoPhaseGesture gesture_;
  SkinContact probe_;
  PassivityObserver probe_account_;
  OutputGuard probe_guard_;
  SyringeCore syringe_;
  HandAid aid_;
  DeviceLimits limits_;
  std::uint32_t rests_ = 0;  // why the needle feels nothing in this tick
  HapticSnapshot out_;
};

}  // namespace artus
