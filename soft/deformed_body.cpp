// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/deformed_body.h"

#include <algorithm>
#include <array>
#include <limits>

#include <Eigen/SVD>

namespace artus {
namespace {

constexpr int kMostSteps = 60;
constexpr int kNewtonSteps = 8;      // then smaller ones
constexpr double kExact = 1e-7;      // m
constexpr double kSure = 3e-5;       // m, an error of which one Newton step leaves next to nothing
constexpr double kLayerStep = 1e-3;  // m
constexpr double kStill = 1e-9;      // m; what moves less has not moved: its bytes stay
constexpr double kFarTolerance = 20e-6;  // m
constexpr int kReach = 2;                // lattice steps, of points beside the cage: the skin's rim

std::size_t interface_vertices(const TetMesh& mesh) {
  std::size_t n = 0;
  for (const Interface& interface : mesh.interfaces) {
    for (const std::uint32_t v : interface.vertices) n = std::max<std::size_t>(n, v + 1);
  }
  return n;
}

/// The corners of the cubes of some places, ascending.
std::vector<std::uint32_t> nodes_of_places(const Cage& cage, std::span<const CagePlace> places) {
  std::vector<bool> found(cage.nodes().size(), false);
  for (const CagePlace& place : places) {
    if (place.cell < 0) continue;
    for (const std::uint32_t n : cage.cells()[static_cast<std::size_t>(place.cell)].nodes)
      found[n] = true;
  }
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t n = 0; n < found.size(); ++n) {
    if (found[n]) nodes.push_back(n);
  }
  return nodes;
}

/// u and its gradient in a cube, at `s` of its edges from its lowest corner.
DeformedBody::Motion interpolate(const Vec3& s, const CageCell& cell, double edge,
                                 std::span<const Vec3> u) noexcept {
  const Vec3 t = Vec3::Ones() - s;
  std::array<Vec3, 8> c;
  for (std::size_t a = 0; a < 8; ++a) c[a] = u[cell.nodes[a]];
  const Vec3 low = t.y() * c[0] + s.y() * c[2];  // x = 0 and z = 0
  const Vec3 low_x = t.y() * c[1] + s.y() * c[3];
  const Vec3 high = t.y() * c[4] + s.y() * c[6];
  const Vec3 high_x = t.y() * c[5] + s.y() * c[7];
  const Vec3 near = t.x() * low + s.x() * low_x;
  const Vec3 far = t.x() * high + s.x() * high_x;
  DeformedBody::Motion motion;
  motion.displacement = t.z() * near + s.z() * far;
  Eigen::Matrix3d& g = motion.gradient;
  g.col(0) = t.z() * (low_x - low) + s.z() * (high_x - high);
  g.col(1) = t.z() * (t.x() * (c[2] - c[0]) + s.x() * (c[3] - c[1])) +
             s.z() * (t.x() * (c[6] - c[4]) + s.x() * (c[7] - c[5]));
  g.col(2) = far - near;
  g /= edge;
  return motion;
}

/// The column of a cube through a point: from its low end to its high end as they now lie, m, and
/// how that changes along x and y.
struct Column {
  Vec3 way;
  Vec3 along_x;
  Vec3 along_y;
};

Column column_at(const Vec3& s, const CageCell& cell, double edge,
                 std::span<const Vec3> u) noexcept {
  std::array<Vec3, 4> c;
  for (std::size_t a = 0; a < 4; ++a) c[a] = u[cell.nodes[a + 4]] - u[cell.nodes[a]];
  const Vec3 near = c[0] + s.x() * (c[1] - c[0]);
  const Vec3 far = c[2] + s.x() * (c[3] - c[2]);
  return {Vec3(0, 0, edge) + near + s.y() * (far - near),
          ((1 - s.y()) * (c[1] - c[0]) + s.y() * (c[3] - c[2])) / edge, (far - near) / edge};
}

/// Moves a point on along its column as its layers ask.
void add_layers(const LayerMotion::Shift& shift, const Column& column, double edge,
                DeformedBody::Motion& motion) noexcept {
  motion.displacement += shift.along * column.way;
  motion.gradient += column.way * shift.slope.transpose() / edge;
  motion.gradient.col(0) += shift.along * column.along_x;
  motion.gradient.col(1) += shift.along * column.along_y;
}

}  // namespace

std::shared_ptr<const BodyMap> make_body_map(const CompiledJoint& joint, const Pose& X_JC,
                                             std::shared_ptr<const SoftModel> model) {
  auto map = std::make_shared<BodyMap>();
  map->X_JC = X_JC;
  for (const Interface& i : joint.mesh.interfaces)
    map->moving.insert(map->moving.end(), i.vertices.begin(), i.vertices.end());
  std::sort(map->moving.begin(), map->moving.end());
  map->moving.erase(std::unique(map->moving.begin(), map->moving.end()), map->moving.end());
  const Cage& cage = model->cage();
  const Pose X_CJ = X_JC.inverse();
  const auto place_of = [&](std::uint32_t v) {
    return cage.locate(X_CJ * joint.mesh.vertices[v], kReach);
  };
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  std::int32_t largest = 0;
  for (const CageCell& cell : cage.cells()) {
    least = std::min(least, cell.span);
    largest = std::max(largest, cell.span);
  }
  const auto middle =
      std::stable_partition(map->moving.begin(), map->moving.end(), [&](std::uint32_t v) {
        const std::int32_t cell = place_of(v).cell;
        return cell >= 0 &&
               (least == largest || cage.cells()[static_cast<std::size_t>(cell)].span < largest);
      });
  map->n_near = static_cast<std::size_t>(middle - map->moving.begin());
  for (const std::uint32_t v : map->moving) map->places.push_back(place_of(v));
  map->far_nodes = nodes_of_places(cage, std::span(map->places).subspan(map->n_near));
  map->n_vertices = interface_vertices(joint.mesh);
  map->model = std::move(model);
  return map;
}

void DeformedBody::move_vertex(std::size_t k, std::span<const Vec3> u) {
  const CagePlace& place = map_->places[k];
  Vec3 moved = map_->model->displacement_at(place, u);
  if (layers_.layered(place.cell)) {
    const auto& w = place.weights;
    const Vec3 s(w[1] + w[3] + w[5] + w[7], w[2] + w[3] + w[6] + w[7], w[4] + w[5] + w[6] + w[7]);
    const Cage& cage = map_->model->cage();
    const CageCell& cell = cage.cells()[static_cast<std::size_t>(place.cell)];
    moved += layers_.at(place.cell, s).along * column_at(s, cell, cage.edge(cell), u).way;
  }
  if (moved.squaredNorm() > kStill * kStill)
    vertices_[map_->moving[k]] += map_->X_JC.linear() * moved;
}

/// Far vertices whose cube has no node that went on stay as they were.
void DeformedBody::move_far(const DeformedBody* before) {
  if (before != nullptr && before->map_ != map_) before = nullptr;
  std::vector<Vec3> u = u_;
  std::vector<bool> went_on(u.size(), true);
  far_u_.reserve(map_->far_nodes.size());
  for (std::size_t k = 0; k < map_->far_nodes.size(); ++k) {
    const std::uint32_t n = map_->far_nodes[k];
    if (before != nullptr) {
      went_on[n] = (u_[n] - before->far_u_[k]).squaredNorm() > kFarTolerance * kFarTolerance;
      if (!went_on[n]) u[n] = before->far_u_[k];
    }
    far_u_.push_back(u[n]);
  }
  std::vector<bool> still;
  for (const CageCell& cell : map_->model->cage().cells())
    still.push_back(std::none_of(cell.nodes.begin(), cell.nodes.end(),
                                 [&](std::uint32_t n) { return went_on[n]; }));
  for (std::size_t k = map_->n_near; k < map_->moving.size(); ++k) {
    const std::int32_t cell = map_->places[k].cell;
    if (cell < 0) continue;
    const std::uint32_t v = map_->moving[k];
    if (still[static_cast<std::size_t>(cell)]) {
      vertices_[v] = before->vertices_[v];
    } else {
      move_vertex(k, u);
    }
  }
}

DeformedBody::DeformedBody(std::shared_ptr<const CompiledJoint> joint,
                           std::shared_ptr<const BodyMap> map,
                           std::span<const Vec3> node_displacements, const ContactForce& contact_J,
                           const DeformedBody* before)
    : joint_(std::move(joint)),
      map_(std::move(map)),
      u_(node_displacements.begin(), node_displacements.end()),
      layers_(map_->model->cage(), map_->model->layers(), u_),
      X_CJ_(map_->X_JC.inverse()),
      contact_(contact_J) {
  const auto& rest = joint_->mesh.vertices;
  vertices_.assign(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(map_->n_vertices));
  for (std::size_t k = 0; k < map_->n_near; ++k) move_vertex(k, u_);
  move_far(before);
}

CompiledJoint DeformedBody::moved_joint() const {
  CompiledJoint moved = *joint_;
  std::copy(vertices_.begin(), vertices_.end(), moved.mesh.vertices.begin());
  for (std::size_t v = vertices_.size(); v < moved.mesh.vertices.size(); ++v)
    moved.mesh.vertices[v] += displacement(moved.mesh.vertices[v]);
  return moved;
}

DeformedBody::PlacedMotion DeformedBody::motion_in_cage(const Vec3& p_C) const noexcept {
  const Cage& cage = map_->model->cage();
  std::int32_t number = cage.cell_around(p_C);
  if (number < 0) number = cage.locate(p_C, kReach).cell;
  if (number < 0) return {};
  const CageCell& cell = cage.cells()[static_cast<std::size_t>(number)];
  const double edge = cage.edge(cell);
  const Vec3 s = ((p_C - cage.low_corner(cell)) / edge).cwiseMax(0).cwiseMin(1);
  PlacedMotion placed{interpolate(s, cell, edge, u_), number};
  placed.motion.gradient.diagonal().array() += 1;
  if (layers_.layered(number))
    add_layers(layers_.at(number, s), column_at(s, cell, edge, u_), edge, placed.motion);
  return placed;
}

DeformedBody::Motion DeformedBody::in_J(const Motion& motion) const noexcept {
  const Eigen::Matrix3d R = map_->X_JC.linear();
  return {R * motion.displacement, R * motion.gradient * R.transpose()};
}

DeformedBody::Motion DeformedBody::motion(const Vec3& p_rest) const noexcept {
  return in_J(motion_in_cage(X_CJ_ * p_rest).motion);
}

Vec3 DeformedBody::displacement(const Vec3& p_rest) const noexcept {
  return motion(p_rest).displacement;
}

DeformedBody::Rest DeformedBody::to_rest(const Vec3& p, const Vec3& guess) const noexcept {
  const Vec3 p_C = X_CJ_ * p;
  Vec3 rest_C = X_CJ_ * Vec3(p - guess);
  Motion motion;
  bool found = false;
  double way = 1;  // shorter steps where full ones go round in circles
  double before = 1e9;
  for (int k = 0; k < kMostSteps && !found; ++k) {
    const PlacedMotion placed = motion_in_cage(rest_C);
    motion = placed.motion;
    const Vec3 error = p_C - rest_C - motion.displacement;
    const double size = error.norm();
    found = size < kExact;
    if (found) break;
    const bool layered = layers_.layered(placed.cell);
    if (k < (layered ? kMostSteps : kNewtonSteps) && motion.gradient.determinant() > 0.01) {
      Vec3 step = motion.gradient.inverse() * error;
      // From within a thin layer a step that is too long must end in the next.
      if (layered && step.norm() > kLayerStep) step *= kLayerStep / step.norm();
      rest_C += step;
      found = size < kSure && !layered;
      if (found) motion.displacement = p_C - rest_C;
      continue;
    }
    if (size > 0.7 * before) way = std::max(0.1, 0.7 * way);
    before = size;
    rest_C += way * error;
  }
  const Motion moved = in_J(motion);
  return {p - (found ? moved.displacement : Vec3(map_->X_JC.linear() * (p_C - rest_C))), moved,
          found};
}

Eigen::Matrix3d DeformedBody::gradient(const Vec3& p_rest) const noexcept {
  const SoftModel& model = *map_->model;
  const CagePlace place = model.cage().locate(X_CJ_ * p_rest, kReach);
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
