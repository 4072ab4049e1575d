// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/record/recorded_device.h"

namespace artus {

DeviceSample RecordedDevice::read(std::int64_t now_ns) noexcept {
  const std::size_t i = next_.load(std::memory_order_relaxed);
  if (i >= samples_.size()) {
    DeviceSample gone = samples_.empty() ? DeviceSample{} : samples_.back();
    gone.state = PeerState::lost;
    return gone;
  }
  next_.store(i + 1, std::memory_order_relaxed);
  DeviceSample sample = samples_[i];
  sample.time_ns = now_ns;
  return sample;
}

void RecordedDevice::write(const DeviceFeedback& /*feedback*/) noexcept {
  // What was felt then is in the recording.
}

}  // namespace artus
