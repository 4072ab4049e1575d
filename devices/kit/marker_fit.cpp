// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/marker_fit.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus::kit {
namespace {

/// One picture with a body's markers.
struct Picture {
  std::vector<SeenMarker> seen;
  Pose X_CB;
};

const SeenMarker* find(const std::vector<SeenMarker>& seen, int id) {
  const auto one =
      std::find_if(seen.begin(), seen.end(), [id](const SeenMarker& s) { return s.id == id; });
  return one == seen.end() ? nullptr : &*one;
}

/// A step of Gauss and Newton for one marker's place on the body over all pictures.
void improve(Marker& marker, const std::vector<Picture>& pictures, const Lens& lens) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Identity() * 1e-6;
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  const Vec3 centre = marker.centre();
  for (const Picture& picture : pictures) {
    const SeenMarker* seen = find(picture.seen, marker.id);
    if (seen == nullptr) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 arm = marker.corners[i] - centre;
      const Vec3 p = picture.X_CB * marker.corners[i];
      const double f = lens.fx;
      const Eigen::Vector2d r = f * (p.head<2>() / p.z() - lens.looks_at(seen->corners[i]));
      Eigen::Matrix<double, 2, 3> by_point;
      by_point << f / p.z(), 0, -f * p.x() / (p.z() * p.z()), 0, f / p.z(),
          -f * p.y() / (p.z() * p.z());
      Eigen::Matrix3d turn;
      turn << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
      Eigen::Matrix<double, 2, 6> by_step;
      by_step << by_point * picture.X_CB.linear() * turn, by_point * picture.X_CB.linear();
      const double weight = std::min(1.0, 0.5 / std::max(r.norm(), 1e-9));
      normal += weight * by_step.transpose() * by_step;
      gradient += weight * by_step.transpose() * r;
    }
  }
  const Eigen::Matrix<double, 6, 1> step = -normal.ldlt().solve(gradient);
  if (!step.allFinite()) return;
  const double angle = step.head<3>().norm();
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  if (angle > 0) turned = Eigen::AngleAxisd(angle, Vec3(step.head<3>()) / angle).toRotationMatrix();
  for (Vec3& corner : marker.corners) corner = centre + turned * (corner - centre) + step.tail<3>();
}

/// Turns and shifts the body so that its corners are where the drawing has them in the mean.
void hold_to(const MarkerBody& drawn, MarkerBody& body) {
  Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(4 * body.markers.size()));
  Eigen::Matrix3Xd to(3, from.cols());
  Eigen::Index at = 0;
  for (std::size_t m = 0; m < body.markers.size(); ++m)
    for (std::size_t i = 0; i < 4; ++i, ++at) {
      from.col(at) = body.markers[m].corners[i];
      to.col(at) = drawn.markers[m].corners[i];
    }
  const Eigen::Matrix4d back = Eigen::umeyama(from, to, false);
  Pose X;
  X.matrix() = back;
  for (Marker& marker : body.markers)
    for (Vec3& corner : marker.corners) corner = X * corner;
}

/// Poses of all pictures by the body as it is; the rms over them, pixels.
double settle_poses(const MarkerBody& body, std::vector<Picture>& pictures, const Lens& lens) {
  double sum = 0;
  for (Picture& picture : pictures) {
    double rms = 0;
    if (const auto pose = refine_pose(body, picture.seen, lens, picture.X_CB, rms))
      picture.X_CB = *pose;
    sum += rms * rms;
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(pictures.size(), 1)));
}

}  // namespace

Result<MarkerFit> fit_markers(const MarkerBody& drawn,
                              const std::vector<std::vector<SeenMarker>>& pictures,
                              const Lens& lens) {
  constexpr std::size_t kFewest = 40;
  constexpr int kFewestOfOne = 10;
  constexpr int kRounds = 40;
  constexpr double kFarthest = 5e-3;  // m
  std::vector<Picture> used;
  for (const auto& seen : pictures) {
    Picture picture;
    for (const SeenMarker& one : seen)
      for (const Marker& marker : drawn.markers)
        if (marker.id == one.id) picture.seen.push_back(one);
    if (picture.seen.size() < 3) continue;
    MarkerBody tolerant = drawn;
    double rms = 0;
    const auto rough = find_pose(tolerant, picture.seen, lens, nullptr);
    if (!rough) continue;
    const auto pose = refine_pose(drawn, picture.seen, lens, rough->X_CB, rms);
    if (!pose) continue;
    picture.X_CB = *pose;
    used.push_back(std::move(picture));
  }
  if (used.size() < kFewest)
    return fail(ErrorCode::invalid,
                printed("the %s was seen with three markers in %zu pictures only, %zu are needed: "
                        "turn it slowly before the camera for half a minute",
                        drawn.name.c_str(), used.size(), kFewest),
                "markers");
  for (const Marker& marker : drawn.markers) {
    const auto n = std::count_if(used.begin(), used.end(), [&](const Picture& p) {
      return find(p.seen, marker.id) != nullptr;
    });
    if (n < kFewestOfOne)
      return fail(ErrorCode::invalid,
                  printed("marker %d of the %s was hardly seen: turn it to the camera", marker.id,
                          drawn.name.c_str()),
                  "markers");
  }
  MarkerFit fit{drawn, 0, 0, 0};
  fit.before = settle_poses(fit.body, used, lens);
  for (int round = 0; round < kRounds; ++round) {
    for (Marker& marker : fit.body.markers) improve(marker, used, lens);
    hold_to(drawn, fit.body);
    fit.after = settle_poses(fit.body, used, lens);
  }
  for (std::size_t m = 0; m < drawn.markers.size(); ++m)
    fit.moved =
        std::max(fit.moved, (fit.body.markers[m].centre() - drawn.markers[m].centre()).norm());
  if (fit.moved > kFarthest)
    return fail(ErrorCode::invalid,
                printed("a marker of the %s is %.1f mm from where it belongs: are all numbers in "
                        "their places?",
                        drawn.name.c_str(), fit.moved / kMillimetre),
                "markers");
  return fit;
}

}  // namespace artus::kit
