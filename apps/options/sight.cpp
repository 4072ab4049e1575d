// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/sight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

/// The middle of the skin's triangle nearest to `p`, looking into the body.
std::optional<Pose> nearest_stand(const CompiledJoint& joint, const Vec3& p) {
  std::optional<Pose> stand;
  double least = std::numeric_limits<double>::infinity();
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != kOutside && f.back != kOutside) continue;
    const Vec3& a = joint.mesh.vertices[f.vertices[0]];
    const Vec3& b = joint.mesh.vertices[f.vertices[1]];
    const Vec3& c = joint.mesh.vertices[f.vertices[2]];
    const Vec3 centre = (a + b + c) / 3;
    if ((centre - p).norm() >= least) continue;
    least = (centre - p).norm();
    const Vec3 to_front = (b - a).cross(c - a);
    stand = make_pose(centre, f.front == kOutside ? Vec3(-to_front) : to_front, Vec3::UnitX());
  }
  return stand;
}

/// m along the beam from the face to the skin at `p`; negative: the face is inside the body. Empty
/// where the line meets no skin within 50 mm.
std::optional<double> gap_at(const Scene& scene, const Vec3& p, const Vec3& into) {
  constexpr double kReach = 50e-3;  // m
  std::array<Crossing, 64> crossings;
  const QueryCount found =
      scene.find_crossings({p - kReach * into, p + kReach * into}, std::span<Crossing>(crossings));
  std::optional<double> gap;
  for (std::size_t i = 0; i < found.size; ++i) {
    const double here = crossings[i].depth - kReach;
    if (crossings[i].from == kOutside && (!gap || std::abs(here) < std::abs(*gap))) gap = here;
  }
  return gap;
}

}  // namespace

std::vector<std::string> notes_of_stand(const LoadedView& view) {
  constexpr int kPlaces = 5;
  constexpr double kHovers = 0.5 * kMillimetre;  // gel that is put on a probe
  constexpr double kInside = 3 * kMillimetre;    // what unevenness of the skin does not explain
  double least = std::numeric_limits<double>::infinity();
  double deepest = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double x = view.view.transducer.width * (static_cast<double>(i) / (kPlaces - 1) - 0.5);
    const Vec3 p = view.X_JP * Vec3(0.98 * x, 0, 0);
    const auto gap = gap_at(*view.scene, p, view.X_JP.linear().col(2));
    if (!gap) continue;
    least = std::min(least, *gap);
    deepest = std::max(deepest, -*gap);
  }
  std::vector<std::string> notes;
  if (deepest > kInside)
    notes.push_back(
        printed("the probe's face lies up to %.1f mm inside the body as it is: put it on "
                "the skin (--probe), or press it there (--press-mm, --press-n)",
                deepest / kMillimetre));
  if (std::isfinite(least) && least > kHovers)
    notes.push_back(
        printed("the probe's face is %.1f mm or more off the skin: what the picture "
                "shows is seen through gel in that gap",
                least / kMillimetre));
  return notes;
}

Result<void> check_sight(const Frame& frame, const LoadedView& view) {
  if (std::any_of(frame.contact.begin(), frame.contact.end(), [](float c) { return c > 0; }))
    return {};
  const Vec3 probe = view.X_JP.translation();
  const auto stand = nearest_stand(view.joint(), probe);
  if (!stand) return fail(ErrorCode::invalid, "the joint has no skin to stand on", "--probe");
  const Vec3 p = stand->translation() / kMillimetre;
  const Vec3 z = stand->linear().col(2);
  const std::string text = printed(
      "no part of the probe touches skin, so there is no image; the nearest skin is %.1f mm away, "
      "where --probe=%.1f,%.1f,%.1f/%.3f,%.3f,%.3f stands",
      (p - probe / kMillimetre).norm(), p.x(), p.y(), p.z(), z.x(), z.y(), z.z());
  return fail(ErrorCode::invalid, text, "--probe");
}

}  // namespace artus
