// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/body_pose.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/calib3d.hpp>

#include <Eigen/Cholesky>

namespace artus::kit {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// A marker with its corners on the body and in the plane z = 1, times the focal length: lengths
/// are pixels without the lens' bend.
struct Pair {
  const Marker* marker = nullptr;
  std::array<Eigen::Vector2d, 4> seen;
};

std::vector<Pair> pairs_of(const MarkerBody& body, const std::vector<SeenMarker>& seen,
                           const Lens& lens) {
  std::vector<Pair> pairs;
  for (const SeenMarker& one : seen)
    for (const Marker& marker : body.markers) {
      if (marker.id != one.id) continue;
      Pair pair{&marker, {}};
      for (std::size_t i = 0; i < 4; ++i) pair.seen[i] = lens.fx * lens.looks_at(one.corners[i]);
      pairs.push_back(pair);
    }
  return pairs;
}

/// A turn by a small vector, then a shift, from the left.
Pose moved(const Pose& X, const Vector6& step) {
  Pose out = X;
  const Vec3 turn = step.head<3>();
  const double angle = turn.norm();
  if (angle > 0) out.linear() = Eigen::AngleAxisd(angle, turn / angle) * X.linear();
  out.translation() += step.tail<3>();
  return out;
}

/// Sums of one evaluation: normal equations and the squared misses by marker, pixels^2. What is off
/// by more than kStray counts linearly (Huber), as corners beside a finger are.
struct Fit {
  Matrix6 normal = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  std::vector<double> missed;
  double total = 0;  // by Huber
  bool in_front = true;
};
constexpr double kStray = 0.3;  // pixels

Fit evaluate(const std::vector<Pair>& pairs, double f, const Pose& X_CB) {
  Fit fit;
  for (const Pair& pair : pairs) {
    double missed = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 arm = X_CB.linear() * pair.marker->corners[i];
      const Vec3 p = arm + X_CB.translation();
      if (!(p.z() > 1e-3)) {
        fit.in_front = false;
        return fit;
      }
      const Eigen::Vector2d r = f * p.head<2>() / p.z() - pair.seen[i];
      Eigen::Matrix<double, 2, 3> by_point;
      by_point << f / p.z(), 0, -f * p.x() / (p.z() * p.z()), 0, f / p.z(),
          -f * p.y() / (p.z() * p.z());
      Eigen::Matrix<double, 2, 6> by_step;
      Eigen::Matrix3d turn;
      turn << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
      by_step << by_point * turn, by_point;
      const double off = r.norm();
      const double weight = off <= kStray ? 1 : kStray / off;
      fit.normal += weight * by_step.transpose() * by_step;
      fit.gradient += weight * by_step.transpose() * r;
      fit.total += off <= kStray ? off * off : 2 * kStray * off - kStray * kStray;
      missed += off * off;
    }
    fit.missed.push_back(missed);
  }
  return fit;
}

struct Settled {
  Pose X_CB;
  Fit fit;
  double rms = 0;
};

std::optional<Settled> settle(const std::vector<Pair>& pairs, double f, Pose X_CB) {
  constexpr int kMostSteps = 25;
  double damping = 1e-4;
  Fit fit = evaluate(pairs, f, X_CB);
  if (!fit.in_front || pairs.empty()) return std::nullopt;
  for (int k = 0; k < kMostSteps; ++k) {
    Matrix6 damped = fit.normal;
    damped.diagonal() *= 1 + damping;
    const Vector6 step = -damped.ldlt().solve(fit.gradient);
    if (!step.allFinite()) return std::nullopt;
    const Pose next = moved(X_CB, step);
    Fit there = evaluate(pairs, f, next);
    if (!there.in_front || there.total > fit.total) {
      damping *= 10;
      if (damping > 1e6) break;
      continue;
    }
    const bool still = fit.total - there.total < 1e-9 * fit.total + 1e-12;
    X_CB = next;
    fit = std::move(there);
    damping = std::max(damping / 10, 1e-9);
    if (still) break;
  }
  const auto n = static_cast<double>(4 * pairs.size());
  double missed = 0;
  for (const double of_marker : fit.missed) missed += of_marker;
  return Settled{X_CB, fit, std::sqrt(missed / n)};
}

/// The two poses that a square has by itself.
std::vector<Pose> poses_of_square(const Pair& pair, double f) {
  const double h = pair.marker->side / 2;
  const std::vector<cv::Point3d> square{{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
  std::vector<cv::Point2d> seen;
  for (const auto& p : pair.seen) seen.emplace_back(p.x() / f, p.y() / f);
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> shifts;
  cv::solvePnPGeneric(square, seen, cv::Matx33d::eye(), cv::noArray(), turns, shifts, false,
                      cv::SOLVEPNP_IPPE_SQUARE);
  const Pose X_MB = pose_of_marker(*pair.marker).inverse();
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Vec3 turn(turns[i].at<double>(0), turns[i].at<double>(1), turns[i].at<double>(2));
    const double angle = turn.norm();
    Pose X_CM = Pose::Identity();
    if (angle > 0) X_CM.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
    X_CM.translation() =
        Vec3(shifts[i].at<double>(0), shifts[i].at<double>(1), shifts[i].at<double>(2));
    if (X_CM.matrix().allFinite()) poses.push_back(X_CM * X_MB);
  }
  return poses;
}

double angle_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

/// Are all faces of the markers turned to the camera?
bool faces_camera(const std::vector<Pair>& pairs, const Pose& X_CB) {
  return std::all_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    const Vec3 centre = X_CB * pair.marker->centre();
    return (X_CB.linear() * pair.marker->normal()).dot(centre) < 0;
  });
}

/// What one bad marker may cost a pose at most while poses are chosen among, pixels^2.
double capped_cost(const Fit& fit) {
  constexpr double kMost = 4 * 16.0;
  double sum = 0;
  for (const double missed : fit.missed) sum += std::min(missed, kMost);
  return sum;
}

struct Choice {
  Settled best;
  double ratio = std::numeric_limits<double>::infinity();
};

/// The best of all starts, and how much worse the next that is another pose is.
std::optional<Choice> choose(const std::vector<Pair>& pairs, double f, const Pose* before) {
  std::vector<Pose> starts;
  if (before != nullptr) starts.push_back(*before);
  for (const Pair& pair : pairs)
    for (const Pose& pose : poses_of_square(pair, f)) starts.push_back(pose);
  std::vector<Settled> ends;
  for (const Pose& start : starts) {
    const auto end = settle(pairs, f, start);
    if (end && faces_camera(pairs, end->X_CB)) ends.push_back(*end);
  }
  if (ends.empty()) return std::nullopt;
  std::sort(ends.begin(), ends.end(), [](const Settled& a, const Settled& b) {
    return capped_cost(a.fit) < capped_cost(b.fit);
  });
  Choice choice{ends.front()};
  const auto floored = [&](const Settled& s) {
    return std::sqrt(capped_cost(s.fit) / static_cast<double>(4 * pairs.size()) + 0.05 * 0.05);
  };
  for (const Settled& end : ends) {
    if (angle_between(end.X_CB, ends.front().X_CB) < kSamePose) continue;
    choice.ratio = floored(end) / floored(ends.front());
    if (choice.ratio < kSureRatio && before != nullptr &&
        angle_between(end.X_CB, *before) < angle_between(ends.front().X_CB, *before))
      choice.best = end;
    break;
  }
  return choice;
}

}  // namespace

Eigen::Matrix3d BodyPose::covariance_at(const Vec3& p_B) const {
  const Vec3 arm = X_CB.linear() * p_B;
  Eigen::Matrix<double, 3, 6> by_step;
  by_step << 0, arm.z(), -arm.y(), 1, 0, 0, -arm.z(), 0, arm.x(), 0, 1, 0, arm.y(), -arm.x(), 0, 0,
      0, 1;
  return by_step * covariance * by_step.transpose();
}

std::optional<Pose> refine_pose(const MarkerBody& body, const std::vector<SeenMarker>& seen,
                                const Lens& lens, const Pose& start, double& rms) {
  const auto end = settle(pairs_of(body, seen, lens), lens.fx, start);
  if (!end) return std::nullopt;
  rms = end->rms;
  return end->X_CB;
}

std::optional<BodyPose> find_pose(const MarkerBody& body, const std::vector<SeenMarker>& seen,
                                  const Lens& lens, const Pose* before) {
  constexpr double kNear = 0.35;  // rad from the pose before that settles a doubt
  std::vector<Pair> pairs = pairs_of(body, seen, lens);
  BodyPose out;
  while (pairs.size() >= 2) {
    const auto choice = choose(pairs, lens.fx, before);
    if (!choice) return std::nullopt;
    const auto& missed = choice->best.fit.missed;
    const auto worst = std::max_element(missed.begin(), missed.end());
    if (*worst > 4 * kFarMarker * kFarMarker) {
      pairs.erase(pairs.begin() + (worst - missed.begin()));
      ++out.n_dropped;
      continue;
    }
    const bool near = before != nullptr && angle_between(choice->best.X_CB, *before) < kNear;
    if (choice->ratio < kSureRatio && !near) return std::nullopt;
    const auto n = static_cast<double>(8 * pairs.size());
    const double noise = std::max(kCornerNoise * kCornerNoise, choice->best.fit.total / (n - 6));
    out.X_CB = choice->best.X_CB;
    out.covariance = noise * choice->best.fit.normal.inverse();
    out.rms = choice->best.rms;
    out.n_markers = static_cast<int>(pairs.size());
    out.ratio = choice->ratio;
    return out;
  }
  return std::nullopt;
}

}  // namespace artus::kit
