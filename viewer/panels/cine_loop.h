// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "artus/detail/viewer/joint3d/body_shape.h"
#include "artus/detail/viewer/panels/needle_reading.h"
#include "artus/session/session.h"

namespace artus {

/// The last pictures that the window showed, for a frozen scanner to step through, each with its
/// structures' names and how the tissue gave way.
class CineLoop {
 public:
  static constexpr double kSeconds = 20;                 ///< s that are kept
  static constexpr std::size_t kMaxBytes = 256U << 20U;  ///< larger pictures are kept for less

  /// Of pictures of `joint`, as it was compiled.
  explicit CineLoop(std::shared_ptr<const CompiledJoint> joint) : joint_(std::move(joint)) {}
  /// `time`: s, growing.
  void add(const ImageSnapshot& image, std::vector<PictureLabel> labels, double time);
  [[nodiscard]] std::size_t size() const noexcept { return frames_.size(); }
  /// From the oldest, 0; without its scene, which others need. Requires: i < size().
  [[nodiscard]] const ImageSnapshot& at(std::size_t i) const { return frames_[i].image; }
  [[nodiscard]] const std::vector<PictureLabel>& labels(std::size_t i) const {
    return frames_[i].labels;
  }
  /// The body that it was drawn from. All but the newest are without what was injected: a joint
  /// with liquid in it is too large to be kept for each. Requires: i < size(). Cost: as
  /// DeformedBody, none for the newest.
  [[nodiscard]] BodyState body(std::size_t i) const;
  /// s before the newest, 0 or more. Requires: i < size().
  [[nodiscard]] double age(std::size_t i) const { return frames_.back().time - frames_[i].time; }

 private:
  struct Kept {
    ImageSnapshot image;
    std::vector<PictureLabel> labels;
    std::shared_ptr<const BodyMap> map;  // of joint_; null: rigid
    std::vector<Eigen::Vector3f> nodes;  // m, displaced
    double time;
  };
  static std::size_t bytes_of(const Kept& kept) noexcept;
  std::shared_ptr<const CompiledJoint> joint_;
  std::shared_ptr<const BodyMap> map_;  // the last of joint_
  std::deque<Kept> frames_;
  BodyState newest_;
  std::size_t bytes_ = 0;
};

}  // namespace artus
