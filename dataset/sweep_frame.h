// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include <nlohmann/json.hpp>

#include "artus/dataset/pose_list.h"
#include "artus/dataset/sweep.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"

namespace artus {

/// A frame of a sweep before it is a file: its line of truth and its pictures by their keys there
/// ("image", "labels", "shadow_mask", and "needle_mask" with a needle).
struct SweepFrame {
  nlohmann::json truth;
  std::vector<std::pair<std::string, cv::Mat>> pictures;
};

/// Draws poses one by one; a frame depends on its pose alone.
class SweepDrawer {
 public:
  SweepDrawer(std::shared_ptr<const Scene> scene, const SweepOptions& options);
  /// The pictures look into the drawer until the next call.
  [[nodiscard]] SweepFrame draw(std::size_t index, const ListedPose& pose);

 private:
  std::shared_ptr<const Scene> scene_;
  NeedleShape needle_;
  Renderer renderer_;
  LabelRenderer truth_;
};

/// What was asked for, apart from the poses: joint, transducer, settings, needle.
[[nodiscard]] nlohmann::json describe_sweep(const CompiledJoint& joint,
                                            const SweepOptions& options);
/// A number of a list of poses, 16 hex digits.
[[nodiscard]] std::string digest_of(const std::vector<ListedPose>& poses);

}  // namespace artus
