// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

#include "artus/simulation/input_device.h"

namespace artus {

/// Samples of an earlier session, one a tick, with the times of now.
class RecordedDevice final : public InputDevice {
 public:
  explicit RecordedDevice(std::vector<DeviceSample> samples) : samples_(std::move(samples)) {}
  [[nodiscard]] ARTUS_REALTIME DeviceSample read(std::int64_t now_ns) noexcept override;
  ARTUS_REALTIME void write(const DeviceFeedback& feedback) noexcept override;
  [[nodiscard]] std::string_view name() const noexcept override { return "recorded file"; }
  [[nodiscard]] bool finished() const noexcept { return next_ >= samples_.size(); }

 private:
  std::vector<DeviceSample> samples_;
  std::atomic<std::size_t> next_{0};
};

}  // namespace artus
