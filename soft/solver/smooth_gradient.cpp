// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/smooth_gradient.h"

#include <utility>

#include "artus/detail/soft/cage/element.h"

namespace artus {

SmoothGradient::SmoothGradient(std::shared_ptr<const DeformedBody> body) : body_(std::move(body)) {
  const Cage& cage = body_->map().model->cage();
  const Eigen::Matrix3d R = body_->map().X_JC.linear();
  nodes_.assign(cage.nodes().size(), Entries::Zero());
  std::vector<float> cubes(nodes_.size(), 0);
  for (const CageCell& cell : cage.cells()) {
    CellVector u;
    for (std::size_t a = 0; a < 8; ++a)
      u.segment<3>(static_cast<Eigen::Index>(3 * a)) = body_->node_displacements()[cell.nodes[a]];
    const Eigen::Matrix3d F = R * cell_gradient(cage.edge(cell), u) * R.transpose();
    Entries entries = Entries::Zero();
    for (Eigen::Index k = 0; k < 9; ++k) entries[k] = static_cast<float>(F.data()[k]);
    for (const std::uint32_t n : cell.nodes) {
      nodes_[n] += entries;
      cubes[n] += 1;
    }
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_[n] /= cubes[n];
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    const auto masters = cage.masters(n);
    if (masters.empty()) continue;
    nodes_[n].setZero();
    for (const NodeShare& share : masters)
      nodes_[n] += static_cast<float>(share.weight) * nodes_[share.node];
  }
}

Eigen::Matrix3d SmoothGradient::at(const Vec3& rest_C, std::int32_t cell) const noexcept {
  if (cell < 0) return Eigen::Matrix3d::Identity();
  const Cage& cage = body_->map().model->cage();
  const CageCell& cube = cage.cells()[static_cast<std::size_t>(cell)];
  const Eigen::Vector3f s =
      ((rest_C - cage.low_corner(cube)) / cage.edge(cube)).cwiseMax(0).cwiseMin(1).cast<float>();
  const auto along = [&](std::size_t a, std::size_t b, float share) -> Entries {
    return nodes_[cube.nodes[a]] + share * (nodes_[cube.nodes[b]] - nodes_[cube.nodes[a]]);
  };
  const Entries low = along(0, 1, s.x()) + s.y() * (along(2, 3, s.x()) - along(0, 1, s.x()));
  const Entries high = along(4, 5, s.x()) + s.y() * (along(6, 7, s.x()) - along(4, 5, s.x()));
  const Entries entries = low + s.z() * (high - low);
  Eigen::Matrix3d F;
  for (Eigen::Index k = 0; k < 9; ++k) F.data()[k] = static_cast<double>(entries[k]);
  return F;
}

}  // namespace artus
