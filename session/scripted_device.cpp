// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/scripted_device.h"

#include <algorithm>
#include <utility>

namespace artus {

ScriptedDevice::ScriptedDevice(std::vector<Key> keys) : keys_(std::move(keys)) {
  ARTUS_REQUIRE(!keys_.empty(), "a script needs a key");
  ARTUS_REQUIRE(std::is_sorted(keys_.begin(), keys_.end(),
                               [](const Key& a, const Key& b) { return a.time < b.time; }),
                "the keys' times must ascend");
}

HandTarget ScriptedDevice::at(double time) const noexcept {
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), time,
                                     [](double t, const Key& key) { return t < key.time; });
  if (next == keys_.begin()) return keys_.front().hand;
  const Key& before = *(next - 1);
  HandTarget hand = before.hand;
  if (next == keys_.end()) return hand;
  const double share = (time - before.time) / (next->time - before.time);
  hand.X_WN = blend(before.hand.X_WN, next->hand.X_WN, share);
  hand.X_WP = blend(before.hand.X_WP, next->hand.X_WP, share);
  return hand;
}

DeviceSample ScriptedDevice::read(std::int64_t now_ns) noexcept {
  if (number_ == 0) start_ns_ = now_ns;
  const HandTarget hand = at(1e-9 * static_cast<double>(now_ns - start_ns_));
  DeviceSample sample;
  sample.X_WN = hand.X_WN;
  sample.X_WP = hand.X_WP;
  sample.time_ns = now_ns;
  sample.number = ++number_;
  sample.buttons = hand.buttons;
  sample.state = PeerState::alive;
  sample.has_needle = hand.has_needle;
  sample.has_probe = 1;
  return sample;
}

void ScriptedDevice::write(const DeviceFeedback& /*feedback*/) noexcept {
  // A script goes its way whatever it feels.
}

std::vector<ScriptedDevice::Key> make_injection(const Vec3& entry_W, const Vec3& target_W,
                                                const Pose& X_WP, double speed) {
  ARTUS_REQUIRE(speed > 0 && (target_W - entry_W).norm() > 0, "an injection goes somewhere");
  const Vec3 axis = (target_W - entry_W).normalized();
  constexpr double kBefore = 15e-3;  // m above the skin
  const double way = (target_W - entry_W).norm() + kBefore;
  const auto key = [&](double time, const Vec3& tip) {
    HandTarget hand;
    hand.X_WN = to_plain(make_pose(tip, axis, X_WP.linear().col(1)));
    hand.X_WP = to_plain(X_WP);
    return ScriptedDevice::Key{time, hand};
  };
  const Vec3 above = entry_W - kBefore * axis;
  const double there = 0.5 + way / speed;
  return {key(0, above), key(0.5, above), key(there, target_W), key(there + 1, target_W),
          key(there + 1 + way / speed, above)};
}

}  // namespace artus
