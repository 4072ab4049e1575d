// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/frame_order.h"

#include <bit>
#include <cstdint>
#include <memory>
#include <utility>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/printed.h"

namespace artus {
namespace {

std::uint64_t mix_pose(std::uint64_t hash, const Pose& pose) {
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 4; ++j)
      hash = mix_bits(hash ^ std::bit_cast<std::uint64_t>(pose(i, j)));
  return hash;
}

}  // namespace

std::string digest_of(const std::vector<ListedPose>& poses) {
  std::uint64_t hash = poses.size();
  for (const ListedPose& pose : poses) {
    for (const char c : pose.name) hash = mix_bits(hash ^ static_cast<unsigned char>(c));
    hash = mix_bits(hash ^ std::bit_cast<std::uint64_t>(pose.time.value_or(-1)));
    hash = mix_pose(mix_bits(hash ^ (pose.X_JN ? 1U : 0U)), pose.X_JP);
    if (pose.X_JN) hash = mix_pose(hash, *pose.X_JN);
  }
  return in_hexadecimal(hash);
}

FrameSource source_of(std::vector<ListedPose> poses) {
  FrameSource source;
  source.count = poses.size();
  source.digest = digest_of(poses);
  source.frame =
      [kept = std::make_shared<const std::vector<ListedPose>>(std::move(poses))](std::size_t i) {
        return FrameOrder((*kept)[i]);
      };
  return source;
}

}  // namespace artus
