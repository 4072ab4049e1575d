// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/picture_check.h"

#include <opencv2/core.hpp>

#include "artus/detail/devices/kit/marker_dictionary.h"

namespace artus::kit {

cv::Mat MirrorCheck::right(const cv::Mat& grey) {
  cv::Mat flipped;
  if (mirrored_) {
    cv::flip(grey, flipped, 1);
    return flipped;
  }
  if (settled_) return grey;
  constexpr int kPatience = 30;        // pictures without a marker
  constexpr std::size_t kMarkers = 3;  // that are no accident
  const std::size_t upright = find_markers(grey).size();
  if (upright == 0 && ++empty_ % kPatience != 0) return grey;
  // Some markers pass for others when they are mirrored: the way round that shows more is right.
  cv::flip(grey, flipped, 1);
  const std::size_t turned = find_markers(flipped).size();
  settled_ = upright >= kMarkers && upright > 2 * turned;
  mirrored_ = turned >= kMarkers && turned > 2 * upright;
  return mirrored_ ? flipped : grey;
}

bool FrozenCheck::is(const cv::Mat& grey) {
  constexpr int kSame = 3;  // repetitions in a row
  const bool same = last_.size() == grey.size() && cv::norm(last_, grey, cv::NORM_INF) == 0;
  last_ = grey.clone();
  same_ = same ? same_ + 1 : 0;
  return same_ >= kSame;
}

std::string PictureNotes::take(bool is_mirrored, bool is_frozen) {
  std::string note;
  if (is_mirrored && !mirrored_)
    note = "the camera mirrors its picture; it is turned round here, better switch it off";
  if (is_frozen && !frozen_) note = "the camera repeats one picture: it hangs, or is paused";
  mirrored_ = is_mirrored;
  frozen_ = is_frozen;
  return note;
}

}  // namespace artus::kit
