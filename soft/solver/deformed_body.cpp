// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/deformed_body.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include <Eigen/SVD>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr int kMaxSteps = 60;
constexpr int kNewtonSteps = 8;      // then smaller ones
constexpr int kLayerSteps = 40;      // the same in cubes of several tissues
constexpr double kLayerStep = 1e-3;  // m
constexpr double kExact = 1e-7;      // m
constexpr double kSure = 3e-5;       // m, an error of which one Newton step leaves next to nothing
constexpr double kStill = 1e-9;      // m; what moves less has not moved: its bytes stay
constexpr double kFar = 20e-6;       // m, tolerance in the coarsest cubes
constexpr double kAside = 80e-6;     // m, the same beside what pictures show; see docs
constexpr double kLookedAt = 9e-3;   // m from the plane of the picture
constexpr std::int32_t kGroup = 2;   // coarsest cubes along a group's edge
constexpr int kReach = 2;            // lattice steps, of points beside the cage: the skin's rim

std::size_t interface_vertices(const TetMesh& mesh) {
  std::size_t n = 0;
  for (const Interface& interface : mesh.interfaces) {
    for (const std::uint32_t v : interface.vertices) n = std::max<std::size_t>(n, v + 1);
  }
  return n;
}

/// Where a point hangs; one that liquid lifted off the body, as the skin below it.
CagePlace place_in(const SoftModel& model, const Vec3& p_C) noexcept {
  return model.cage().locate(model.skin().below(p_C).p_C, kReach);
}

/// How far a cube's nodes may move before its vertices do: pictures are of the plane y = 0.
double tolerance_of(const Cage& cage, const CageCell& cell, bool coarsest) noexcept {
  const double low = cage.low_corner(cell).y();
  if (std::max(low, -low - cage.edge(cell)) > kLookedAt) return kAside;
  return coarsest ? kFar : 0;
}

/// The points of the map that a group's vertices hang on.
std::vector<std::uint32_t> points_of(std::span<const MapPlace> places) {
  std::vector<std::uint32_t> points;
  for (const MapPlace& place : places)
    points.insert(points.end(), place.points.begin(), place.points.end());
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
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

bool has_surfaces_of(const TetMesh& mesh, const TetMesh& other) {
  return mesh.vertices.size() == other.vertices.size() &&
         std::equal(mesh.interfaces.begin(), mesh.interfaces.end(), other.interfaces.begin(),
                    other.interfaces.end(), [](const Interface& a, const Interface& b) {
                      return a.vertices == b.vertices && a.front == b.front && a.back == b.back;
                    });
}

/// The map of a shape in the groups of another's; null where they do not do.
std::shared_ptr<const BodyMap> map_in_groups(const TetMesh& mesh, const MappedJoint& first) {
  const std::vector<Vec3>& before = first.joint->mesh.vertices;
  if (!has_surfaces_of(mesh, first.joint->mesh)) return nullptr;
  const std::vector<std::uint32_t>& group_of = first.map->group_of;
  for (std::size_t v = 0; v < group_of.size(); ++v)
    if (group_of[v] == first.map->groups.size() && mesh.vertices[v] != before[v]) return nullptr;
  auto map = std::make_shared<BodyMap>(*first.map);
  map->first = first;
  const Cage& cage = map->model->cage();
  const Pose X_CJ = map->X_JC.inverse();
  for (VertexGroup& group : map->groups) {
    for (std::size_t k = 0; k < group.vertices.size(); ++k) {
      const std::uint32_t v = group.vertices[k];
      if (mesh.vertices[v] == before[v]) continue;
      const CagePlace place = place_in(*map->model, X_CJ * mesh.vertices[v]);
      if (place.cell < 0) return nullptr;
      group.rest[k] = mesh.vertices[v];
      group.places[k] = map->model->layers().place(cage, place);
    }
    group.points = points_of(group.places);
  }
  return map;
}

/// Puts the vertices that hang on the same points beside each other.
void sort_by_points(VertexGroup& group) {
  std::vector<std::pair<MapPlace, std::uint32_t>> all;
  for (std::size_t k = 0; k < group.vertices.size(); ++k)
    all.emplace_back(group.places[k], group.vertices[k]);
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.points, a.second) < std::tie(b.first.points, b.second);
  });
  for (std::size_t k = 0; k < all.size(); ++k)
    std::tie(group.places[k], group.vertices[k]) = all[k];
}

}  // namespace

std::shared_ptr<const BodyMap> make_body_map(const CompiledJoint& joint, const Pose& X_JC,
                                             std::shared_ptr<const SoftModel> model) {
  auto map = std::make_shared<BodyMap>();
  map->X_JC = X_JC;
  const Cage& cage = model->cage();
  const Pose X_CJ = X_JC.inverse();
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  std::int32_t largest = 0;
  for (const CageCell& cell : cage.cells()) {
    least = std::min(least, cell.span);
    largest = std::max(largest, cell.span);
  }
  std::vector<bool> used(interface_vertices(joint.mesh), false);
  for (const Interface& i : joint.mesh.interfaces) {
    for (const std::uint32_t v : i.vertices) used[v] = true;
  }
  using Key = std::array<std::int32_t, 4>;  // a group's place, and its tolerance in nm
  std::map<Key, VertexGroup> groups;
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    const CagePlace place = used[v] ? place_in(*model, X_CJ * joint.mesh.vertices[v]) : CagePlace{};
    if (place.cell < 0) continue;
    const CageCell& cell = cage.cells()[static_cast<std::size_t>(place.cell)];
    const double tolerance = tolerance_of(cage, cell, least < largest && cell.span == largest);
    const std::int32_t side = kGroup * largest;
    VertexGroup& group =
        groups[{cell.corner[0] / side, cell.corner[1] / side, cell.corner[2] / side,
                static_cast<std::int32_t>(1e9 * tolerance)}];
    group.tolerance = tolerance;
    group.vertices.push_back(v);
    group.places.push_back(model->layers().place(cage, place));
  }
  map->group_of.assign(used.size(), static_cast<std::uint32_t>(groups.size()));
  for (auto& [key, group] : groups) {
    group.points = points_of(group.places);
    sort_by_points(group);
    for (const std::uint32_t v : group.vertices) {
      map->group_of[v] = static_cast<std::uint32_t>(map->groups.size());
      group.rest.push_back(joint.mesh.vertices[v]);
    }
    map->groups.push_back(std::move(group));
  }
  map->model = std::move(model);
  return map;
}

MappedJoint indexed(const MappedJoint& mapped) {
  return mapped.map->first.map ? mapped.map->first : mapped;
}

std::shared_ptr<const BodyMap> make_body_map(const CompiledJoint& shape,
                                             std::span<const MappedJoint> others) {
  ARTUS_REQUIRE(!others.empty(), "another shape is needed");
  for (const MappedJoint& other : others)
    if (auto map = map_in_groups(shape.mesh, indexed(other))) return map;
  return make_body_map(shape, others.front().map->X_JC, others.front().map->model);
}

void DeformedBody::carry(const DeformedBody* before) {
  const bool follows = before != nullptr && before->map_ == map_;
  const Eigen::Matrix3d R = map_->X_JC.linear();
  std::vector<Vec3> moved;  // of all points, frame J
  moved.reserve(u_.size());
  for (const Vec3& u : u_) moved.emplace_back(R * u);
  groups_.reserve(map_->groups.size());
  for (const VertexGroup& group : map_->groups) {
    const double limit = group.tolerance * group.tolerance;
    if (follows) {
      const auto& old = before->groups_[groups_.size()];
      bool stays = true;
      for (std::size_t k = 0; stays && k < group.points.size(); ++k)
        stays = (u_[group.points[k]] - old->points[k]).squaredNorm() <= limit;
      if (stays) {
        groups_.push_back(old);
        continue;
      }
    }
    auto now = std::make_shared<Moved>();
    now->points.reserve(group.points.size());
    for (const std::uint32_t p : group.points) now->points.push_back(u_[p]);
    now->vertices.reserve(group.vertices.size());
    for (std::size_t k = 0; k < group.vertices.size(); ++k) {
      const MapPlace& place = group.places[k];
      Vec3 offset = Vec3::Zero();
      for (std::size_t a = 0; a < 8; ++a)
        offset += static_cast<double>(place.weights[a]) * moved[place.points[a]];
      const Vec3& rest = group.rest[k];
      now->vertices.push_back(offset.squaredNorm() > kStill * kStill ? Vec3(rest + offset) : rest);
    }
    groups_.push_back(std::move(now));
  }
}

DeformedBody::DeformedBody(std::shared_ptr<const CompiledJoint> joint,
                           std::shared_ptr<const BodyMap> map,
                           std::span<const Vec3> node_displacements, const ContactForce& contact_J,
                           const DeformedBody* before)
    : joint_(std::move(joint)),
      map_(std::move(map)),
      u_(move_map(map_->model->cage(), map_->model->layers(), node_displacements)),
      X_CJ_(map_->X_JC.inverse()),
      contact_(contact_J) {
  carry(before);
}

std::vector<Vec3> DeformedBody::vertices() const {
  const auto& rest = joint_->mesh.vertices;
  std::vector<Vec3> all(rest.begin(),
                        rest.begin() + static_cast<std::ptrdiff_t>(map_->group_of.size()));
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const auto& vertices = map_->groups[g].vertices;
    for (std::size_t k = 0; k < vertices.size(); ++k) all[vertices[k]] = groups_[g]->vertices[k];
  }
  return all;
}

std::shared_ptr<const DeformedBody> DeformedBody::come_from(const DeformedBody& other,
                                                            double part) const {
  ARTUS_REQUIRE(
      map_->model == other.map_->model && map_->group_of.size() == other.map_->group_of.size(),
      "shapes of one body in one cage");
  const std::vector<Vec3> from = other.vertices();
  auto body = std::make_shared<DeformedBody>(*this);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    auto moved = std::make_shared<Moved>(*groups_[g]);
    const auto& numbers = map_->groups[g].vertices;
    for (std::size_t k = 0; k < numbers.size(); ++k)
      moved->vertices[k] = (1 - part) * from[numbers[k]] + part * moved->vertices[k];
    body->groups_[g] = std::move(moved);
  }
  return body;
}

CompiledJoint DeformedBody::moved_joint() const {
  CompiledJoint moved = *joint_;
  const std::vector<Vec3> interfaces = vertices();
  std::copy(interfaces.begin(), interfaces.end(), moved.mesh.vertices.begin());
  for (std::size_t v = interfaces.size(); v < moved.mesh.vertices.size(); ++v)
    moved.mesh.vertices[v] += displacement(moved.mesh.vertices[v]);
  return moved;
}

DeformedBody::PlacedMotion DeformedBody::motion_in_cage(const Vec3& p_C) const noexcept {
  const Cage& cage = map_->model->cage();
  const SkinHeight::Below there = map_->model->skin().below(p_C);
  std::int32_t number = cage.cell_around(there.p_C);
  if (number < 0) number = cage.locate(there.p_C, kReach).cell;
  if (number < 0) return {};
  const CageCell& cell = cage.cells()[static_cast<std::size_t>(number)];
  const double edge = cage.edge(cell);
  const Vec3 s = ((there.p_C - cage.low_corner(cell)) / edge).cwiseMax(0).cwiseMin(1);
  LayerMap::Around four;
  PlacedMotion placed{map_->model->layers().around(number, s, four)
                          ? between_columns(four, s.z(), edge)
                          : interpolate(s, cell, edge, u_),
                      number};
  Eigen::Matrix3d& gradient = placed.motion.gradient;
  if (there.lowered) {
    gradient.col(0) += there.slope[0] * gradient.col(2);
    gradient.col(1) += there.slope[1] * gradient.col(2);
    gradient.col(2).setZero();
    placed.cell = -1;
  }
  gradient.diagonal().array() += 1;
  return placed;
}

/// u and its gradient between four columns.
DeformedBody::Motion DeformedBody::between_columns(const LayerMap::Around& four, double s_z,
                                                   double edge) const noexcept {
  const LayerMap& map = map_->model->layers();
  const Vec3* const points = &u_[map_->model->cage().nodes().size()];
  std::array<Vec3, 4> c;
  std::array<Vec3, 4> slope;
  for (std::size_t a = 0; a < 4; ++a) {
    const std::uint32_t k = map.below(map.columns()[four.columns[a]], s_z);
    const auto from = static_cast<double>(map.levels()[k]);
    slope[a] = (points[k + 1] - points[k]) / (static_cast<double>(map.levels()[k + 1]) - from);
    c[a] = points[k] + (s_z - from) * slope[a];
  }
  const auto between = [&](const std::array<Vec3, 4>& v) {
    return Vec3((1 - four.y) * ((1 - four.x) * v[0] + four.x * v[1]) +
                four.y * ((1 - four.x) * v[2] + four.x * v[3]));
  };
  Motion motion;
  motion.displacement = between(c);
  Eigen::Matrix3d& g = motion.gradient;
  g.col(0) = ((1 - four.y) * (c[1] - c[0]) + four.y * (c[3] - c[2])) / four.width;
  g.col(1) = ((1 - four.x) * (c[2] - c[0]) + four.x * (c[3] - c[1])) / four.width;
  g.col(2) = between(slope);
  g /= edge;
  return motion;
}

DeformedBody::Piece DeformedBody::piece_around(const Vec3& p_C,
                                               std::int32_t number) const noexcept {
  const SoftModel& model = *map_->model;
  const CageCell& cell = model.cage().cells()[static_cast<std::size_t>(number)];
  const double edge = model.cage().edge(cell);
  const Vec3 low = model.cage().low_corner(cell);
  const Vec3 s = (p_C - low) / edge;
  LayerMap::Around four;
  Piece piece{low, low + Vec3::Constant(edge)};
  if (!model.layers().around(number, s, four)) return piece;
  double below = 0;
  double above = 1;
  for (const std::uint32_t column : four.columns) {
    const std::uint32_t k = model.layers().below(model.layers().columns()[column], s.z());
    below = std::max(below, static_cast<double>(model.layers().levels()[k]));
    above = std::min(above, static_cast<double>(model.layers().levels()[k + 1]));
  }
  piece.high = low + edge * Vec3(four.low.x() + four.width, four.low.y() + four.width, above);
  piece.low = low + edge * Vec3(four.low.x(), four.low.y(), below);
  piece.whole = false;
  return piece;
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
  double offset = 1;  // shorter steps where full ones go round in circles
  double before = 1e9;
  for (int k = 0; k < kMaxSteps && !found; ++k) {
    const PlacedMotion placed = motion_in_cage(rest_C);
    motion = placed.motion;
    const Vec3 error = p_C - rest_C - motion.displacement;
    const double size = error.norm();
    found = size < kExact;
    if (found) break;
    const bool cut = map_->model->layers().cuts(placed.cell);
    if (k < (cut ? kLayerSteps : kNewtonSteps) && motion.gradient.determinant() > 0.02) {
      Vec3 step = motion.gradient.inverse() * error;
      // From within a thin layer a step that is too long must end in the next.
      if (cut && step.norm() > kLayerStep) step *= kLayerStep / step.norm();
      rest_C += step;
      found = size < kSure && !cut;
      if (found) motion.displacement = p_C - rest_C;
      continue;
    }
    if (size > 0.7 * before) offset = std::max(0.1, 0.7 * offset);
    before = size;
    rest_C += offset * error;
  }
  const Motion moved = in_J(motion);
  return {p - (found ? moved.displacement : Vec3(map_->X_JC.linear() * (p_C - rest_C))), moved,
          found};
}

Eigen::Matrix3d DeformedBody::gradient(const Vec3& p_rest) const noexcept {
  const SoftModel& model = *map_->model;
  const CagePlace place = place_in(model, X_CJ_ * p_rest);
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
