// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/cine_loop.h"

#include <utility>

namespace artus {

std::size_t CineLoop::bytes_of(const Kept& kept) noexcept {
  return kept.image.grey.size() + kept.image.motion.size() +
         kept.nodes.size() * sizeof(Eigen::Vector3f);
}

void CineLoop::add(const ImageSnapshot& image, std::vector<PictureLabel> labels, double time) {
  Kept kept{image, std::move(labels), nullptr, {}, time};
  newest_ = image.body ? state_of(*image.body) : BodyState{};
  kept.image.body = nullptr;
  if (newest_.tissue && newest_.joint == joint_) map_ = newest_.tissue->shared_map();
  if (newest_.tissue && map_ && map_->model == newest_.tissue->map().model) {
    kept.map = map_;
    for (const Vec3& u : newest_.tissue->node_displacements())
      kept.nodes.push_back(u.cast<float>());
  }
  bytes_ += bytes_of(kept);
  frames_.push_back(std::move(kept));
  while (frames_.size() > 1 && (time - frames_.front().time > kSeconds || bytes_ > kMaxBytes)) {
    bytes_ -= bytes_of(frames_.front());
    frames_.pop_front();
  }
}

BodyState CineLoop::body(std::size_t i) const {
  if (i + 1 == frames_.size() && newest_.joint) return newest_;
  const Kept& kept = frames_[i];
  if (!kept.map) return {joint_, nullptr};
  std::vector<Vec3> nodes;
  for (const Eigen::Vector3f& u : kept.nodes) nodes.push_back(u.cast<double>());
  return {joint_, std::make_shared<const DeformedBody>(joint_, kept.map, nodes, ContactForce{})};
}

}  // namespace artus
