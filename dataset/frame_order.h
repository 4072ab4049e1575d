// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "artus/dataset/pose_list.h"
#include "artus/echo/needle_view.h"

namespace artus {

/// What one frame of a sweep shows: poses, and where it departs from the sweep's own settings.
struct FrameOrder : ListedPose {
  FrameOrder() = default;
  explicit FrameOrder(ListedPose pose) : ListedPose(std::move(pose)) {}

  std::size_t patient = 0;            ///< of SweepOptions::patients, from 1; 0: the sweep's joint
  std::size_t transducer = 0;         ///< of SweepOptions::transducers, from 1; 0: the sweep's
  std::optional<NeedleShape> needle;  ///< else the sweep's
  double press = 0;                   ///< m, by which the probe presses along its beam
};

/// A long list of frames, any of which can be had alone.
struct FrameSource {
  std::size_t count = 0;
  std::string digest;  ///< two lists share it only when they are the same
  std::function<FrameOrder(std::size_t)> frame;
};
/// A number of a list of poses, 16 hex digits.
[[nodiscard]] std::string digest_of(const std::vector<ListedPose>& poses);
[[nodiscard]] FrameSource source_of(std::vector<ListedPose> poses);

}  // namespace artus
