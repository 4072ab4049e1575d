// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/tip_calibration.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/devices/kit/body.h"

namespace artus::kit {
namespace {

struct Solution {
  Vec3 tip;
  Vec3 pivot;
  double condition = 0;
};

Solution solve(const std::vector<Pose>& poses) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  for (const Pose& X : poses) {
    Eigen::Matrix<double, 3, 6> row;
    row << X.linear(), -Eigen::Matrix3d::Identity();
    normal += row.transpose() * row;
    right -= row.transpose() * X.translation();
  }
  const Eigen::JacobiSVD<Eigen::Matrix<double, 6, 6>> svd(
      normal, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix<double, 6, 1> found = svd.solve(right);
  const auto& s = svd.singularValues();
  return {found.head<3>(), found.tail<3>(), std::sqrt(s[0] / std::max(s[5], 1e-300))};
}

double percentile_95(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(0.95 * static_cast<double>(values.size() - 1))];
}

/// Poses leaning to one side of their mean direction, and to the other.
std::array<std::vector<Pose>, 2> halves_of(const std::vector<Pose>& poses) {
  Vec3 mean = Vec3::Zero();
  for (const Pose& X : poses) mean += X.linear().col(2);
  mean /= static_cast<double>(poses.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Pose& X : poses)
    spread += (X.linear().col(2) - mean) * (X.linear().col(2) - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const Vec3 side = solver.eigenvectors().col(2);
  std::array<std::vector<Pose>, 2> halves;
  for (const Pose& X : poses) halves[side.dot(X.linear().col(2) - mean) > 0 ? 1 : 0].push_back(X);
  return halves;
}

double bootstrap_deviation(const std::vector<Pose>& poses) {
  constexpr int kDraws = 40;
  constexpr std::size_t kBlock = 8;  // neighbours in time are not independent
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::size_t> any(0, poses.size() - 1);
  std::vector<Vec3> tips;
  Vec3 mean = Vec3::Zero();
  for (int k = 0; k < kDraws; ++k) {
    std::vector<Pose> drawn;
    while (drawn.size() < poses.size()) {
      const std::size_t from = any(random);
      for (std::size_t i = 0; i < kBlock; ++i) drawn.push_back(poses[(from + i) % poses.size()]);
    }
    tips.push_back(solve(drawn).tip);
    mean += tips.back() / kDraws;
  }
  double sum = 0;
  for (const Vec3& tip : tips) sum += (tip - mean).squaredNorm() / (kDraws - 1);
  return std::sqrt(sum);
}

Vec3 mean_tip(const std::vector<Pose>& poses, const Vec3& tip_B) {
  Vec3 mean = Vec3::Zero();
  for (const Pose& X : poses) mean += X * tip_B / static_cast<double>(poses.size());
  return mean;
}

}  // namespace

Result<TipFit> fit_tip(const std::vector<Pose>& X_SB) {
  constexpr std::size_t kFewest = 60;
  constexpr double kMostCondition = 12;
  if (X_SB.size() < kFewest)
    return fail(ErrorCode::invalid,
                printed("the syringe was seen in %zu pictures only, %zu are needed: keep its "
                        "markers to the camera and go on for longer",
                        X_SB.size(), kFewest),
                "pivot");
  const Solution all = solve(X_SB);
  if (!(all.condition < kMostCondition))
    return fail(ErrorCode::invalid,
                printed("the cone is too narrow (condition %.0f, at most %.0f): keep the tip in "
                        "the pit and lean the syringe by 25 degrees and more to all sides",
                        all.condition, kMostCondition),
                "pivot");
  TipFit fit{all.tip, all.pivot, all.condition, 0, 0};
  std::vector<double> off;
  for (const Pose& X : X_SB) off.push_back((X * all.tip - all.pivot).norm());
  fit.scatter = percentile_95(off);
  const auto halves = halves_of(X_SB);
  double gap = 0;
  if (halves[0].size() >= 10 && halves[1].size() >= 10)
    gap = (solve(halves[0]).tip - solve(halves[1]).tip).norm();
  fit.error = std::max({2 * bootstrap_deviation(X_SB), gap, fit.scatter});
  return fit;
}

Result<TipFit> with_divots(const TipFit& fit, const std::array<std::vector<Pose>, 2>& X_SB) {
  constexpr std::size_t kFewest = 10;
  constexpr double kFarthest = 5e-3;  // m
  if (X_SB[0].size() < kFewest || X_SB[1].size() < kFewest)
    return fail(ErrorCode::invalid, "each pit must be touched for ten pictures and more", "pivot");
  const Vec3 first = mean_tip(X_SB[0], fit.tip_B);
  const Vec3 second = mean_tip(X_SB[1], fit.tip_B);
  const double off = std::abs((second - first).norm() - kDivotsApart);
  if (off > kFarthest)
    return fail(ErrorCode::invalid,
                printed("two pits 60 mm apart seem to be %.1f mm apart: touch one and then the "
                        "other; and check the ruler of the prints",
                        (second - first).norm() / kMillimetre),
                "pivot");
  TipFit out = fit;
  out.error = std::max(out.error, off);
  return out;
}

Result<Vec3> fit_axis(const std::vector<Pose>& X_SB, const Vec3& nominal_B) {
  constexpr double kLeast = 30 * kDegree;
  double rolled = 0;
  for (const Pose& X : X_SB)
    rolled =
        std::max(rolled, Eigen::AngleAxisd(X_SB.front().linear().transpose() * X.linear()).angle());
  if (X_SB.size() < 20 || rolled < kLeast)
    return fail(ErrorCode::invalid,
                "roll the syringe about its needle by 45 degrees to both sides, without tilting it",
                "pivot");
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Pose& X : X_SB) {
    Eigen::Matrix<double, 3, 6> row;
    row << X.linear(), -Eigen::Matrix3d::Identity();
    normal += row.transpose() * row;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(normal);
  const Vec3 axis = solver.eigenvectors().col(0).head<3>().normalized();
  return axis.dot(nominal_B) < 0 ? Vec3(-axis) : axis;
}

Pose needle_on_syringe(const Vec3& tip_B, const Vec3& axis_B) {
  return make_pose(tip_B, axis_B, Vec3::UnitX());
}

Result<FaceFit> fit_face(const std::array<std::vector<Vec3>, 3>& touches_B, const Pose& nominal,
                         double tip_error) {
  constexpr std::size_t kFewest = 6;
  constexpr double kFarthest = 4e-3;  // m
  std::array<Vec3, 3> at;
  std::vector<double> off;
  for (std::size_t k = 0; k < 3; ++k) {
    if (touches_B[k].size() < kFewest)
      return fail(ErrorCode::invalid, "touch each of the three marks six times and more", "face");
    at[k] = Vec3::Zero();
    for (const Vec3& p : touches_B[k]) at[k] += p / static_cast<double>(touches_B[k].size());
    for (const Vec3& p : touches_B[k]) off.push_back((p - at[k]).norm());
  }
  const Vec3 along = at[2] - at[0];
  const double length_off = std::abs(along.norm() - 2 * kTouchSpan);
  if (length_off > kFarthest)
    return fail(ErrorCode::invalid,
                printed("the marks at the ends are 46 mm apart and seem to be %.1f mm apart: touch "
                        "the left end, the middle, the right end",
                        along.norm() / kMillimetre),
                "face");
  const Vec3 x = along.normalized();
  const Vec3 middle = (at[0] + at[1] + at[2]) / 3;
  const Vec3 z = nominal.linear().col(2) - x * x.dot(nominal.linear().col(2));
  const double bent = (at[1] - (at[0] + at[2]) / 2).norm();
  FaceFit fit;
  fit.X_BP = make_pose(middle, z, x);
  const double touches = std::sqrt(static_cast<double>(off.size()));
  fit.error = std::max({tip_error, length_off, bent / 2, percentile_95(off) * 3 / touches});
  return fit;
}

}  // namespace artus::kit
