// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <deque>

#include "artus/session/session.h"

namespace artus {

/// The last pictures that the window showed, for a frozen scanner to step through.
class CineLoop {
 public:
  static constexpr double kSeconds = 20;                  ///< s that are kept
  static constexpr std::size_t kMostBytes = 256U << 20U;  ///< larger pictures are kept for less

  /// `time`: s, growing.
  void add(const ImageSnapshot& image, double time);
  [[nodiscard]] std::size_t size() const noexcept { return frames_.size(); }
  /// From the oldest, 0. Requires: i < size().
  [[nodiscard]] const ImageSnapshot& at(std::size_t i) const { return frames_[i].image; }
  /// s before the newest, 0 or more. Requires: i < size().
  [[nodiscard]] double age(std::size_t i) const { return frames_.back().time - frames_[i].time; }

 private:
  struct Kept {
    ImageSnapshot image;
    double time;
  };
  std::deque<Kept> frames_;
  std::size_t bytes_ = 0;
};

}  // namespace artus
