// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "artus/detail/core/units.h"
#include "artus/detail/evidence/runs/probe_in_plane.h"

namespace artus {
namespace {

constexpr double kLongest = 0.075;    // m from the skin to the tip
constexpr int kFacePoints = 11;       // at which it is looked how the face lies
constexpr double kTouches = 3e-3;     // m that gel fills between face and skin
constexpr double kBesideTip = 10e-3;  // m to either side of the tip that should be seen
constexpr double kHalfSeen = 0.9;     // of half a face, within which the tip lies
constexpr double kOwnView = 0.25;     // what the joint's own way of looking is worth
constexpr double kAside = 0.25;       // of the face, by which it is also tried beside the tip

bool ends_sight(const Scene& scene, const TissueInterval& s) {
  return s.region == kBeyond || scene.joint().tissue_of(s.region).haptic.hard;
}

/// m from the face to the skin below it, less than 0 where that is higher; kLongest: none is there,
/// or one looks from within the body.
double gap_below(const Scene& scene, const Vec3& face, const Vec3& look) {
  const Vec3 start = face - kLongest * look;
  if (scene.region_at(start) != kOutside) return kLongest;
  for (const TissueInterval& s : tissue_intervals(scene, {start, face + kLongest * look}))
    if (s.region != kOutside) return s.region >= kFirstRegion ? s.entry - kLongest : kLongest;
  return kLongest;
}

/// The share of `n` points across the picture, `half` m to either side of `middle`, for which
/// `holds`.
template <class F>
double share_of(int n, double middle, double half, F holds) {
  int count = 0;
  for (int k = 0; k < n; ++k) count += holds(middle + half * (2.0 * k / (n - 1) - 1)) ? 1 : 0;
  return static_cast<double>(count) / n;
}

/// Moved out until nothing of the skin is behind the face.
Pose resting(const Scene& scene, const Pose& X_JP, double width) {
  const Vec3 look = X_JP.linear().col(2);
  double highest = kLongest;
  for (int k = 0; k < kFacePoints; ++k) {
    const double x = width / 2 * (2.0 * k / (kFacePoints - 1) - 1);
    highest = std::min(highest, gap_below(scene, X_JP * Vec3(x, 0, 0), look));
  }
  Pose out = X_JP;
  if (highest < kLongest) out.translation() += highest * look;
  return out;
}

/// How well it sees the tip; none: not at all.
std::optional<double> merit_of(const Scene& scene, const Pose& X_JP, const Pose& X_JN,
                               double width) {
  const Vec3 tip = X_JP.inverse() * X_JN.translation();
  if (!(tip.z() > 0) || std::abs(tip.x()) > kHalfSeen * width / 2) return std::nullopt;
  const Vec3 look = X_JP.linear().col(2);
  const auto touches = [&](double x) {
    return std::abs(gap_below(scene, X_JP * Vec3(x, 0, 0), look)) < kTouches;
  };
  if (!touches(tip.x())) return std::nullopt;
  const auto sees = [&](double x) {
    if (std::abs(x) > width / 2 || !touches(x)) return false;
    const auto path = tissue_intervals(scene, {X_JP * Vec3(x, 0, 0), X_JP * Vec3(x, 0, tip.z())});
    return std::none_of(path.begin(), path.end(),
                        [&](const TissueInterval& s) { return ends_sight(scene, s); });
  };
  if (!sees(tip.x())) return std::nullopt;
  const double contact = share_of(kFacePoints, 0, width / 2, touches);
  const double clear = share_of(kFacePoints, tip.x(), kBesideTip, sees);
  const double across = look.cross(X_JN.linear().col(2)).norm();
  return 2 * contact + clear - 0.5 * tip.z() / kLongest + 0.2 * across;
}

}  // namespace

namespace {

/// The same view with its left and right as the joint's own probe has them, as every other picture.
Pose faced_as(const Pose& own, const Pose& X_JP) {
  if (own.linear().col(0).dot(X_JP.linear().col(0)) >= 0) return X_JP;
  return X_JP * Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ());
}

}  // namespace

FoundView find_view_of(const Scene& scene, const Pose& X_JN, double width, ViewSearch search) {
  constexpr std::array kTilts{50.0, 65.0, 35.0, 80.0};
  constexpr std::array kAsides{0.0, -kAside, kAside};
  const bool fine = search == ViewSearch::fine;
  const int turns = fine ? 24 : 12;
  const Vec3 axis = X_JN.linear().col(2);
  const Vec3& tip = X_JN.translation();
  FoundView best{probe_in_plane(scene, X_JN)};
  const auto own = merit_of(scene, best.X_JP, X_JN, width);
  if (own) best.merit = *own + kOwnView;
  for (const double tilt : std::span(kTilts).first(fine ? kTilts.size() : 1))
    for (int k = 0; k < turns; ++k) {
      const Vec3 about =
          Eigen::AngleAxisd(2 * std::numbers::pi * k / turns, axis) * Vec3(X_JN.linear().col(0));
      const Vec3 look = Eigen::AngleAxisd(tilt * kDegree, about) * axis;
      const double gap = gap_below(scene, tip, look);
      if (!(gap < 0)) continue;
      const Vec3 lateral = about.cross(look);
      for (const double aside : std::span(kAsides).first(fine ? kAsides.size() : 1)) {
        const Vec3 middle = tip + gap * look + aside * width * lateral;
        const Pose there = resting(scene, make_pose(middle, look, lateral), width);
        const auto merit = merit_of(scene, there, X_JN, width);
        if (merit && *merit > best.merit) best = {there, *merit};
      }
    }
  best.X_JP = faced_as(scene.joint().X_JP_default, best.X_JP);
  return best;
}

Pose ride_on_skin(const Scene& body, Pose X_JP, const Transducer& transducer) {
  constexpr double kMost = 30e-3;  // m
  constexpr int kSamples = 21;     // along the face
  double lift = 0;
  for (int k = 0; k < kSamples; ++k) {
    const double along = transducer.width * (static_cast<double>(k) / (kSamples - 1) - 0.5);
    const double r = transducer.radius;
    const Vec3 face =
        r > 0 ? Vec3(r * std::sin(along / r), 0, r * (std::cos(along / r) - 1)) : Vec3(along, 0, 0);
    const Segment down{X_JP * Vec3(face - kMost * Vec3::UnitZ()), X_JP * face};
    const TissueInterval first = tissue_intervals(body, down).front();
    if (first.region == kOutside) lift = std::max(lift, kMost - first.exit);
  }
  X_JP.translation() -= lift * X_JP.linear().col(2);
  return X_JP;
}

}  // namespace artus
