// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "artus/session/hand_device.h"

namespace artus {

/// Keys of the needle in time: straight motion between them, for demonstrations, screenshots and
/// tests. Pure: the sample is a function of the time alone.
class ScriptedDevice final : public InputDevice {
 public:
  struct Key {
    double time = 0;  ///< s after the first read
    HandTarget hand;
  };
  /// Requires: at least one key, times ascending.
  explicit ScriptedDevice(std::vector<Key> keys);

  [[nodiscard]] ARTUS_REALTIME DeviceSample read(std::int64_t now_ns) noexcept override;
  ARTUS_REALTIME void write(const DeviceFeedback& feedback) noexcept override;
  [[nodiscard]] std::string_view name() const noexcept override { return "simulated hand"; }
  [[nodiscard]] HandTarget at(double time) const noexcept;

 private:
  std::vector<Key> keys_;
  std::int64_t start_ns_ = 0;
  std::uint64_t number_ = 0;
};

/// The keys of an injection along a line: from before the skin to the target at `speed`, a rest of
/// a second, and back. The probe stays at X_WP.
[[nodiscard]] std::vector<ScriptedDevice::Key> make_injection(const Vec3& entry_W,
                                                              const Vec3& target_W,
                                                              const Pose& X_WP, double speed);

}  // namespace artus
