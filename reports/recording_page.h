// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "artus/detail/simulation/records.h"

namespace artus {

/// What a page about a recorded session shows, gathered while the session is replayed.
class RecordingPage {
 public:
  /// `rate`: ticks a second.
  RecordingPage(std::string joint, std::string engine, double rate)
      : joint_(std::move(joint)), engine_(std::move(engine)), rate_(rate) {}

  void take(const HapticSnapshot& tick);
  /// After the ticks. The image that is shown is that with the deepest tip.
  void take(const FrameInput& input, const Frame& frame, const Transducer& transducer);

  /// A page of A4's shape (CV_8UC3, blue first): axial force and depth over time, the picture at
  /// the deepest place, numbers.
  [[nodiscard]] cv::Mat draw() const;

 private:
  std::string joint_;
  std::string engine_;
  double rate_;
  std::vector<double> force_;           // N against insertion, one a tick
  std::vector<double> depth_;           // mm
  std::vector<std::int64_t> measured_;  // ns, DeviceSample::time_ns
  std::size_t images_ = 0;
  double deepest_ = -1;  // mm, at picture_
  cv::Mat picture_;
};

}  // namespace artus
