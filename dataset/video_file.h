// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "artus/core/result.h"

namespace artus {

/// A video that is being written. The file appears under its name only when finish() succeeded, so
/// that a run that was stopped leaves no broken video.
class VideoFile {
 public:
  /// `file` ends in .mp4 or .avi; where the system has no codec for MP4, MJPEG in AVI under the
  /// same stem takes its place. Errors: unsupported (extension, no codec), invalid (empty frame).
  [[nodiscard]] static Result<VideoFile> open(const std::filesystem::path& file,
                                              const cv::Size& size, bool colour, double rate);

  /// Requires: size and colour as given to open().
  void write(const cv::Mat& frame);

  /// Closes and renames; returns the name it has. Errors: unreadable.
  [[nodiscard]] Result<std::filesystem::path> finish();

 private:
  VideoFile() = default;

  cv::VideoWriter writer_;
  std::filesystem::path file_;
  std::filesystem::path part_;
};

}  // namespace artus
