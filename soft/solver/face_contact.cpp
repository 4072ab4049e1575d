// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/face_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

using Index = Eigen::Index;

constexpr int kMaxSweeps = 120;
constexpr double kSettled = 1e-7;  // N, a sweep that changes less ends the search
/// Skin farther before the face than a step can bring it takes no part in that step, m.
constexpr double kInReach = 3e-3;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

FaceContact::FaceContact(std::shared_ptr<const SoftModel> model, SkinPatch skin,
                         const ProbeFace& face, std::span<const std::uint32_t> root)
    : model_(std::move(model)), skin_(std::move(skin)), face_(face) {
  ARTUS_REQUIRE(face.length > 0 && face.width > 0 && face.points_x > 0 && face.points_y > 0,
                "a face without size");
  root_of_unknown_.assign(model_->n_unknowns(), -1);
  for (std::size_t k = 0; k < root.size(); ++k)
    root_of_unknown_[root[k]] = static_cast<std::int32_t>(k);
  skin_places_.reserve(skin_.vertices.size());
  for (const Vec3& v : skin_.vertices) skin_places_.push_back(model_->cage().locate(v, 2));
  const auto n = static_cast<std::size_t>(face.points_x * face.points_y);
  forces_.assign(n, Vec3::Zero());
  at_rest_.assign(n, Vec3::Zero());
  gaps_.assign(n, kInfinity);
}

Vec3 FaceContact::piece_P(std::uint32_t piece) const noexcept {
  const auto n = static_cast<std::uint32_t>(face_.points_x);
  return {face_.length * ((piece % n + 0.5) / face_.points_x - 0.5),
          face_.width * ((piece / n + 0.5) / face_.points_y - 0.5), 0};
}

/// Looks for the pieces of the face that a triangle covers; keeps the nearest skin of each.
void FaceContact::raster(std::size_t triangle, const std::vector<Vec3>& skin_P,
                         std::vector<ContactPoint>& nearest) const {
  const auto& [ia, ib, ic] = skin_.triangles[triangle];
  const Vec3& a = skin_P[ia];
  const Vec3& b = skin_P[ib];
  const Vec3& c = skin_P[ic];
  const double area = (b - a).cross(c - a).z();
  if (!(area < 0)) return;  // turned away from the face
  const auto first = [](double low, double size, int n) {
    return std::max(0, static_cast<int>(std::ceil((low / size + 0.5) * n - 0.5 - 1e-9)));
  };
  const auto last = [](double high, double size, int n) {
    return std::min(n - 1, static_cast<int>(std::floor((high / size + 0.5) * n - 0.5 + 1e-9)));
  };
  const Vec3 low = a.cwiseMin(b).cwiseMin(c).cwiseMax(-1).cwiseMin(1);
  const Vec3 high = a.cwiseMax(b).cwiseMax(c).cwiseMax(-1).cwiseMin(1);
  const int x_end = last(high.x(), face_.length, face_.points_x);
  const int y_end = last(high.y(), face_.width, face_.points_y);
  for (int j = first(low.y(), face_.width, face_.points_y); j <= y_end; ++j) {
    for (int i = first(low.x(), face_.length, face_.points_x); i <= x_end; ++i) {
      const auto piece = static_cast<std::uint32_t>(i + face_.points_x * j);
      const Vec3 p = piece_P(piece);
      if (face_.round && std::hypot(p.x() / face_.length, p.y() / face_.width) > 0.5) continue;
      const auto turn = [&p](const Vec3& s, const Vec3& t) {
        return (s.x() - p.x()) * (t.y() - p.y()) - (s.y() - p.y()) * (t.x() - p.x());
      };
      const Vec3 w = Vec3(turn(b, c), turn(c, a), turn(a, b)) / area;
      if (w.minCoeff() < -1e-9) continue;
      const double z = w.x() * a.z() + w.y() * b.z() + w.z() * c.z();
      if (z >= nearest[piece].gap) continue;
      nearest[piece].gap = z;
      nearest[piece].p_rest =
          w.x() * skin_.vertices[ia] + w.y() * skin_.vertices[ib] + w.z() * skin_.vertices[ic];
      if (!lifts_.empty())
        nearest[piece].lift = w.x() * lifts_[ia] + w.y() * lifts_[ib] + w.z() * lifts_[ic];
    }
  }
}

std::vector<ContactPoint> FaceContact::cast(std::span<const Vec3> u) const {
  std::vector<Vec3> skin_P;
  skin_P.reserve(skin_.vertices.size());
  const Pose X_PC = X_CP_.inverse();
  for (std::size_t v = 0; v < skin_.vertices.size(); ++v) {
    Vec3 now = skin_.vertices[v] + model_->displacement_at(skin_places_[v], u);
    if (!lifts_.empty()) now += lifts_[v];
    skin_P.push_back(X_PC * now);
  }
  std::vector<ContactPoint> nearest(forces_.size());
  for (std::uint32_t piece = 0; piece < nearest.size(); ++piece) {
    nearest[piece].piece = piece;
    nearest[piece].gap = kInfinity;
  }
  for (std::size_t t = 0; t < skin_.triangles.size(); ++t) raster(t, skin_P, nearest);
  return nearest;
}

void FaceContact::set_lifts(std::vector<Vec3> lifts) {
  ARTUS_REQUIRE(lifts.empty() || lifts.size() == skin_.vertices.size(), "a lift for each vertex");
  lifts_ = std::move(lifts);
}

void FaceContact::prepare(std::span<const Vec3> u, const Pose& X_CP, const Pose& X_CP_before) {
  X_CP_ = X_CP;
  const Pose X_PC = X_CP.inverse();
  const Pose X_PC_before = X_CP_before.inverse();
  points_.clear();
  outside_ = false;
  for (ContactPoint& point : cast(u)) {
    gaps_[point.piece] = point.gap;
    if (!(point.gap < kInReach)) {
      forces_[point.piece].setZero();
      continue;
    }
    point.place = model_->cage().locate(point.p_rest, 2);
    bool reached = point.place.cell >= 0;
    for (const UnknownShare& s : model_->shares_of(point.place)) {
      const std::int32_t root = root_of_unknown_[s.unknown];
      reached = reached && root >= 0;
      if (reached) point.shares.push_back({static_cast<std::uint32_t>(root), s.weight});
    }
    if (!reached || point.shares.empty()) {
      outside_ = outside_ || point.gap < 0;
      forces_[point.piece].setZero();
      continue;
    }
    const Vec3 now = point.p_rest + point.lift + model_->displacement_at(point.place, u);
    point.gap = (X_PC * now).z();
    const Vec3 before = X_PC_before * now;
    point.start = {before.x(), before.y()};
    points_.push_back(std::move(point));
  }
}

void FaceContact::condense(const Eigen::MatrixXf& root_inverse) {
  // The nodes that carry the points, each once.
  std::vector<std::uint32_t> nodes;
  for (const ContactPoint& point : points_) {
    for (const UnknownShare& s : point.shares) nodes.push_back(s.unknown);
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto m = static_cast<Index>(nodes.size());
  std::vector<Index> place(static_cast<std::size_t>(root_inverse.rows() / 3), 0);
  Eigen::MatrixXf by_node(3 * m, 3 * m);
  for (Index a = 0; a < m; ++a) {
    place[nodes[static_cast<std::size_t>(a)]] = a;
    for (Index b = 0; b < m; ++b)
      by_node.block<3, 3>(3 * b, 3 * a) =
          root_inverse.block<3, 3>(3 * static_cast<Index>(nodes[static_cast<std::size_t>(b)]),
                                   3 * static_cast<Index>(nodes[static_cast<std::size_t>(a)]));
  }
  const auto n = static_cast<Index>(points_.size());
  const Eigen::Matrix3f R = X_CP_.linear().cast<float>();
  Eigen::Matrix<float, Eigen::Dynamic, 3> moved(3 * m, 3);  // all nodes by a point's unit forces
  compliance_.resize(3 * n, 3 * n);
  for (Index j = 0; j < n; ++j) {
    moved.setZero();
    for (const UnknownShare& s : points_[static_cast<std::size_t>(j)].shares)
      moved.noalias() += static_cast<float>(s.weight) * by_node.middleCols<3>(3 * place[s.unknown]);
    for (Index i = j; i < n; ++i) {
      Eigen::Matrix3f block = Eigen::Matrix3f::Zero();
      for (const UnknownShare& s : points_[static_cast<std::size_t>(i)].shares)
        block += static_cast<float>(s.weight) * moved.middleRows<3>(3 * place[s.unknown]);
      const Eigen::Matrix3d turned = (R.transpose() * block * R).cast<double>();
      compliance_.block<3, 3>(3 * i, 3 * j) = turned;
      compliance_.block<3, 3>(3 * j, 3 * i) = turned.transpose();
    }
  }
}

void FaceContact::add_forces(Eigen::VectorXd& on_unknowns) const {
  for (const ContactPoint& point : points_)
    model_->add_force(point.place, X_CP_.linear() * forces_[point.piece], on_unknowns);
}

Eigen::VectorXd FaceContact::forces_of(const std::vector<Vec3>& by_piece) const {
  Eigen::VectorXd out(3 * static_cast<Index>(points_.size()));
  for (std::size_t i = 0; i < points_.size(); ++i)
    out.segment<3>(3 * static_cast<Index>(i)) = by_piece[points_[i].piece];
  return out;
}

/// Changes `force` (3 n_points, where the search starts) to what holds the points before the face
/// when they go the share `alpha` of their displacement.
void FaceContact::balance(const Eigen::VectorXd& step_root, std::span<const Vec3> u, double alpha,
                          Eigen::VectorXd& force) const {
  const auto n = static_cast<Index>(points_.size());
  const Eigen::Matrix3d R = X_CP_.linear();
  const Pose X_PC = X_CP_.inverse();
  Eigen::VectorXd free(3 * n);  // gap and slip without a change of force
  for (Index i = 0; i < n; ++i) {
    const ContactPoint& point = points_[static_cast<std::size_t>(i)];
    Vec3 step = Vec3::Zero();
    for (const UnknownShare& s : point.shares)
      step += s.weight * step_root.segment<3>(3 * static_cast<Index>(s.unknown));
    const Vec3 now = X_PC * (point.p_rest + point.lift + model_->displacement_at(point.place, u));
    free.segment<3>(3 * i) = now + alpha * (R.transpose() * step);
    free[3 * i] -= point.start[0];
    free[3 * i + 1] -= point.start[1];
  }
  Eigen::VectorXd moved = compliance_ * (force - forces_of(forces_));
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    double change = 0;
    for (Index k = 3 * n; k-- > 0;) {
      const double diagonal = alpha * compliance_(k, k);
      double next = force[k] - (free[k] + alpha * moved[k]) / diagonal;
      const double normal = force[k - k % 3 + 2];
      next = k % 3 == 2 ? std::max(0.0, next)
                        : std::clamp(next, -face_.friction * normal, face_.friction * normal);
      const double by = next - force[k];
      if (by == 0) continue;
      force[k] = next;
      moved += by * compliance_.col(k);
      change = std::max(change, std::abs(by));
    }
    if (change < kSettled) break;
  }
}

void FaceContact::solve(const Eigen::VectorXd& step_root, std::span<const Vec3> u, double alpha,
                        Eigen::VectorXd& load_root) {
  if (points_.empty()) return;
  const Eigen::Matrix3d R = X_CP_.linear();
  const Eigen::VectorXd old = forces_of(forces_);
  Eigen::VectorXd force = old;
  balance(step_root, u, alpha, force);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const ContactPoint& point = points_[i];
    const auto k = 3 * static_cast<Index>(i);
    const Vec3 by = R * (force - old).segment<3>(k);
    for (const UnknownShare& s : point.shares)
      load_root.segment<3>(3 * static_cast<Index>(s.unknown)) += s.weight * by;
    forces_[point.piece] = force.segment<3>(k);
  }
}

void FaceContact::settle(const Eigen::VectorXd& step_root, std::span<const Vec3> u) {
  std::vector<Vec3> found(forces_.size(), Vec3::Zero());
  if (!points_.empty()) {
    Eigen::VectorXd force = forces_of(at_rest_);
    balance(step_root, u, 1, force);
    for (std::size_t i = 0; i < points_.size(); ++i)
      found[points_[i].piece] = force.segment<3>(3 * static_cast<Index>(i));
  }
  at_rest_ = std::move(found);
}

ContactForce FaceContact::force() const {
  return sum(forces_);
}

ContactForce FaceContact::sum(std::span<const Vec3> forces) const {
  ContactForce out;
  out.outside = outside_;
  out.into = X_CP_.linear().col(2);
  out.piece_area = face_.length * face_.width / static_cast<double>(forces.size());
  std::size_t pressing = 0;
  for (std::uint32_t piece = 0; piece < forces.size(); ++piece) {
    const Vec3 on_probe = -(X_CP_.linear() * forces[piece]);
    out.force += on_probe;
    out.torque += (X_CP_.linear() * piece_P(piece)).cross(on_probe);
    if (!(forces[piece].z() > 0)) continue;
    ++pressing;
    out.pieces.push_back({X_CP_ * piece_P(piece), forces[piece].z()});
  }
  out.share = static_cast<double>(pressing) / static_cast<double>(forces.size());
  return out;
}

double FaceContact::stiffness_at_rest() const {
  constexpr double kShare =
      1e-3;  // there are more pieces than nodes below: their matrix is near singular
  std::vector<Index> pressing;
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (at_rest_[points_[i].piece].z() > 0) pressing.push_back(3 * static_cast<Index>(i) + 2);
  if (pressing.empty() || compliance_.rows() != 3 * static_cast<Index>(points_.size())) return 0;
  Eigen::MatrixXd normal = compliance_(pressing, pressing);
  normal.diagonal().array() += kShare * normal.trace() / static_cast<double>(pressing.size());
  const Eigen::VectorXd along = Eigen::VectorXd::Ones(normal.rows());
  return along.dot(normal.llt().solve(along));
}

double FaceContact::pressure_at(std::uint32_t piece) const noexcept {
  return forces_[piece].z() / (face_.length * face_.width) * static_cast<double>(forces_.size());
}

void FaceContact::release() noexcept {
  std::fill(forces_.begin(), forces_.end(), Vec3::Zero());
  std::fill(at_rest_.begin(), at_rest_.end(), Vec3::Zero());
}

}  // namespace artus
