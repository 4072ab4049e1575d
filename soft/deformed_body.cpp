// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/deformed_body.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

#include <Eigen/SVD>

#include "artus/soft/kernels.h"

namespace artus {
namespace {

constexpr int kMostSteps = 60;
constexpr int kNewtonSteps = 8;  // then smaller ones
constexpr double kExact = 1e-7;  // m
constexpr double kSure = 3e-5;   // m, an error of which one Newton step leaves next to nothing
constexpr double kStill = 1e-9;  // m; what moves less has not moved: its bytes stay
constexpr double kFarTolerance = 20e-6;  // m
constexpr int kReach = 2;                // lattice steps, of points beside the cage: the skin's rim

std::size_t interface_vertices(const TetMesh& mesh) {
  std::size_t n = 0;
  for (const Interface& interface : mesh.interfaces) {
    for (const std::uint32_t v : interface.vertices) n = std::max<std::size_t>(n, v + 1);
  }
  return n;
}

/// The corners of some cubes, ascending.
std::vector<std::uint32_t> nodes_of(const Cage& cage, std::span<const CubeVertices> cubes) {
  std::vector<bool> found(cage.nodes().size(), false);
  for (const CubeVertices& cube : cubes) {
    for (const std::uint32_t n : cage.cells()[cube.cell].nodes) found[n] = true;
  }
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t n = 0; n < found.size(); ++n) {
    if (found[n]) nodes.push_back(n);
  }
  return nodes;
}

/// Which share of a cube's edges lies before a point, from its weights.
Vec3 share_of(const CagePlace& place) noexcept {
  Vec3 share = Vec3::Zero();
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t k = 0; k < 3; ++k) {
      if ((a >> k & 1U) != 0) share[static_cast<Eigen::Index>(k)] += place.weights[a];
    }
  }
  return share;
}

/// Vertices of the interfaces, each once.
std::vector<std::uint32_t> vertices_of(const TetMesh& mesh) {
  std::vector<std::uint32_t> vertices;
  for (const Interface& i : mesh.interfaces)
    vertices.insert(vertices.end(), i.vertices.begin(), i.vertices.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

/// Fills `moving`, `shares` and `cubes`: near cubes, far ones, no cube.
void sort_into_cubes(const TetMesh& mesh, const Cage& cage, BodyMap& map) {
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  std::int32_t largest = 0;
  for (const CageCell& cell : cage.cells()) {
    least = std::min(least, cell.span);
    largest = std::max(largest, cell.span);
  }
  struct Placed {
    int zone = 2;  // 0: near; 1: far; 2: in no cube
    CagePlace place;
    std::uint32_t vertex = 0;
  };
  const Pose X_CJ = map.X_JC.inverse();
  std::vector<Placed> all;
  for (const std::uint32_t v : vertices_of(mesh)) {
    Placed placed{2, cage.locate(X_CJ * mesh.vertices[v], kReach), v};
    if (placed.place.cell >= 0) {
      const std::int32_t span = cage.cells()[static_cast<std::size_t>(placed.place.cell)].span;
      placed.zone = least == largest || span < largest ? 0 : 1;
    }
    all.push_back(placed);
  }
  std::sort(all.begin(), all.end(), [](const Placed& a, const Placed& b) {
    return std::tie(a.zone, a.place.cell, a.vertex) < std::tie(b.zone, b.place.cell, b.vertex);
  });
  for (const Placed& placed : all) {
    const auto k = static_cast<std::uint32_t>(map.moving.size());
    map.moving.push_back(placed.vertex);
    map.shares.push_back(share_of(placed.place));
    if (placed.zone == 2) continue;
    const auto cell = static_cast<std::uint32_t>(placed.place.cell);
    if (map.cubes.empty() || map.cubes.back().cell != cell) map.cubes.push_back({cell, k, k});
    map.cubes.back().end = k + 1;
    if (placed.zone == 0) {
      map.n_near = k + 1;
      map.n_near_cubes = map.cubes.size();
    }
  }
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

}  // namespace

std::shared_ptr<const BodyMap> make_body_map(const CompiledJoint& joint, const Pose& X_JC,
                                             std::shared_ptr<const SoftModel> model) {
  auto map = std::make_shared<BodyMap>();
  map->X_JC = X_JC;
  const Cage& cage = model->cage();
  sort_into_cubes(joint.mesh, cage, *map);
  map->far_nodes = nodes_of(cage, std::span(map->cubes).subspan(map->n_near_cubes));
  map->n_vertices = interface_vertices(joint.mesh);
  map->model = std::move(model);
  return map;
}

namespace {

/// Terms of the displacement in a cube, frame J: 1, x, y, xy, z, xz, yz, xyz of the share of its
/// edges.
CubeTerms terms_of(const CageCell& cell, std::span<const Vec3> u, const Eigen::Matrix3d& R) {
  std::array<Vec3, 8> c;
  for (std::size_t a = 0; a < 8; ++a) c[a] = R * u[cell.nodes[a]];
  for (std::size_t axis = 1; axis < 8; axis *= 2) {
    for (std::size_t a = 0; a < 8; ++a) {
      if ((a & axis) != 0) c[a] -= c[a - axis];
    }
  }
  CubeTerms terms;
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t k = 0; k < 3; ++k) terms.of[a][k] = c[a][static_cast<Eigen::Index>(k)];
  }
  return terms;
}

}  // namespace

void DeformedBody::move_cube(const CubeVertices& cube, std::span<const Vec3> u) {
  const CageCell& cell = map_->model->cage().cells()[cube.cell];
  const auto moves = [&](std::uint32_t n) {
    return u[n].squaredNorm() > kStill * kStill;
  };
  if (std::none_of(cell.nodes.begin(), cell.nodes.end(), moves)) return;
  const CubeTerms terms = terms_of(cell, u, map_->X_JC.linear());
  std::array<Lanes, 64> moved;  // NOLINT(cppcoreguidelines-pro-type-member-init): written first
  for (std::uint32_t from = cube.begin; from < cube.end; from += 64) {
    const std::uint32_t n = std::min<std::uint32_t>(64, cube.end - from);
    soft_kernels().carry(terms, map_->shares[from].data(), n, moved.data());
    for (std::uint32_t k = 0; k < n; ++k) {
      const Vec3 by(moved[k][0], moved[k][1], moved[k][2]);
      if (by.squaredNorm() > kStill * kStill) vertices_[map_->moving[from + k]] += by;
    }
  }
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
  for (const CubeVertices& cube : std::span(map_->cubes).subspan(map_->n_near_cubes)) {
    if (!still[cube.cell]) {
      move_cube(cube, u);
      continue;
    }
    for (std::uint32_t k = cube.begin; k < cube.end; ++k)
      vertices_[map_->moving[k]] = before->vertices_[map_->moving[k]];
  }
}

DeformedBody::DeformedBody(std::shared_ptr<const CompiledJoint> joint,
                           std::shared_ptr<const BodyMap> map,
                           std::span<const Vec3> node_displacements, const ContactForce& contact_J,
                           const DeformedBody* before)
    : joint_(std::move(joint)),
      map_(std::move(map)),
      u_(node_displacements.begin(), node_displacements.end()),
      X_CJ_(map_->X_JC.inverse()),
      contact_(contact_J) {
  const auto& rest = joint_->mesh.vertices;
  vertices_.assign(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(map_->n_vertices));
  for (const CubeVertices& cube : std::span(map_->cubes).first(map_->n_near_cubes))
    move_cube(cube, u_);
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
    motion = motion_in_cage(rest_C).motion;
    const Vec3 error = p_C - rest_C - motion.displacement;
    const double size = error.norm();
    found = size < kExact;
    if (found) break;
    if (k < kNewtonSteps && motion.gradient.determinant() > 0.02) {
      rest_C += motion.gradient.inverse() * error;
      found = size < kSure;
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
