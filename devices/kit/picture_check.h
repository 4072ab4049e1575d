// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include <opencv2/core.hpp>

namespace artus::kit {

/// Turns pictures round that a camera mirrors, in which few markers are found, and those for
/// others.
class MirrorCheck {
 public:
  /// The picture to look at. Cost: until it is known, a search or two a picture; then a flip or
  /// nothing.
  [[nodiscard]] cv::Mat right(const cv::Mat& grey);
  [[nodiscard]] bool is_mirrored() const noexcept { return mirrored_; }

 private:
  bool settled_ = false;
  bool mirrored_ = false;
  int empty_ = 0;
};

/// A camera that hangs repeats its last picture, which no sensor gives twice: no pose may be made
/// of it.
class FrozenCheck {
 public:
  /// Takes a picture; true from its third repetition in a row on.
  [[nodiscard]] bool is(const cv::Mat& grey);

 private:
  cv::Mat last_;
  int same_ = 0;
};

/// What of the checks is to be told to people, each once: empty, or a line.
class PictureNotes {
 public:
  [[nodiscard]] std::string take(bool is_mirrored, bool is_frozen);

 private:
  bool mirrored_ = false;
  bool frozen_ = false;
};

}  // namespace artus::kit
