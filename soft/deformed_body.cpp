// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/deformed_body.h"

#include <algorithm>

#include <Eigen/SVD>

namespace artus {
namespace {

constexpr int kMostSteps = 60;
constexpr double kExact = 1e-8;  // m
constexpr double kStill = 1e-9;  // m; what moves less has not moved: its bytes stay

std::size_t interface_vertices(const TetMesh& mesh) {
  std::size_t n = 0;
  for (const Interface& interface : mesh.interfaces) {
    for (const std::uint32_t v : interface.vertices) n = std::max<std::size_t>(n, v + 1);
  }
  return n;
}

}  // namespace

DeformedBody::DeformedBody(std::shared_ptr<const CompiledJoint> joint,
                           std::shared_ptr<const BodyMap> map,
                           std::span<const Vec3> node_displacements, const ContactForce& contact_J)
    : joint_(std::move(joint)),
      map_(std::move(map)),
      u_(node_displacements.begin(), node_displacements.end()),
      contact_(contact_J) {
  const auto& rest = joint_->mesh.vertices;
  vertices_.assign(rest.begin(),
                   rest.begin() + static_cast<std::ptrdiff_t>(interface_vertices(joint_->mesh)));
  const Eigen::Matrix3d R = map_->X_JC.linear();
  for (std::size_t k = 0; k < map_->moving.size(); ++k) {
    const Vec3 u = map_->model->displacement_at(map_->places[k], u_);
    if (u.norm() > kStill) vertices_[map_->moving[k]] += R * u;
  }
}

CompiledJoint DeformedBody::moved_joint() const {
  CompiledJoint moved = *joint_;
  std::copy(vertices_.begin(), vertices_.end(), moved.mesh.vertices.begin());
  for (std::size_t v = vertices_.size(); v < moved.mesh.vertices.size(); ++v)
    moved.mesh.vertices[v] += displacement(moved.mesh.vertices[v]);
  return moved;
}

Vec3 DeformedBody::displacement(const Vec3& p_rest) const noexcept {
  const Vec3 p_C = map_->X_JC.inverse() * p_rest;
  return map_->X_JC.linear() * map_->model->displacement_at(map_->model->cage().locate(p_C, 1), u_);
}

DeformedBody::Rest DeformedBody::to_rest(const Vec3& p, const Vec3& guess) const noexcept {
  Rest rest;
  rest.displacement = guess;
  double way = 1;  // under-relaxed where full steps go round in circles
  double before = 1e9;
  for (int k = 0; k < kMostSteps; ++k) {
    rest.p_rest = p - rest.displacement;
    const Vec3 now = displacement(rest.p_rest);
    const Vec3 error = now - rest.displacement;
    if (error.norm() < kExact) {
      rest.found = true;
      return rest;
    }
    if (error.norm() > 0.7 * before) way = std::max(0.2, 0.7 * way);
    before = error.norm();
    rest.displacement += way * error;
  }
  rest.p_rest = p - rest.displacement;
  return rest;
}

Eigen::Matrix3d DeformedBody::gradient(const Vec3& p_rest) const noexcept {
  const SoftModel& model = *map_->model;
  const CagePlace place = model.cage().locate(map_->X_JC.inverse() * p_rest, 1);
  if (place.cell < 0) return Eigen::Matrix3d::Identity();
  const CageCell& cell = model.cage().cells()[static_cast<std::size_t>(place.cell)];
  CellVector v;
  for (std::size_t a = 0; a < 8; ++a)
    v.segment<3>(static_cast<Eigen::Index>(3 * a)) = u_[cell.nodes[a]];
  const Eigen::Matrix3d R = map_->X_JC.linear();
  return R * cell_gradient(model.cage().edge(cell), v) * R.transpose();
}

Eigen::Matrix3d DeformedBody::rotation(const Vec3& p_rest) const noexcept {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(gradient(p_rest),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

}  // namespace artus
