// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/medium/vessel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "artus/detail/echo/medium/fibre_course.h"

namespace artus {
namespace {

// An artery of a limb at rest: forward, back for a moment, forward again [Jager1985]; the shape is
// assumed, of half sines.
constexpr double kBeat = 72.0 / 60;     // Hz
constexpr double kSystole = 0.25;       // s
constexpr double kBackUntil = 0.42;     // s
constexpr double kBack = 0.25;          // of the peak
constexpr double kForwardUntil = 0.6;   // s
constexpr double kForwardAgain = 0.12;  // of the peak
constexpr double kBreath = 0.25;        // Hz
constexpr double kVenousSpeed = 0.15;   // m/s, mean in the middle. assumed
constexpr double kVenousSwing = 0.5;    // of it, with the breath. assumed

/// A half sine between `begin` and `end`, 0 elsewhere.
double half_sine(double t, double begin, double end) noexcept {
  if (t <= begin || t >= end) return 0;
  return std::sin(std::numbers::pi * (t - begin) / (end - begin));
}

double beat(double time) noexcept {
  const double t = (time * kBeat - std::floor(time * kBeat)) / kBeat;
  return half_sine(t, 0, kSystole) - kBack * half_sine(t, kSystole, kBackUntil) +
         kForwardAgain * half_sine(t, kBackUntil, kForwardUntil);
}

/// Of a round tube, whose surface beside its ends is 2 V / r.
double tube_radius(const CompiledJoint& joint, RegionId region) {
  double volume = 0;
  for (std::size_t i = 0; i < joint.mesh.tetrahedra.size(); ++i)
    if (joint.mesh.regions[i] == region) volume += tet_volume(joint.mesh, i);
  double surface = 0;
  for (const Interface& face : joint.mesh.interfaces) {
    // Where the region of interest cuts it there is no wall.
    if ((face.front != region && face.back != region) || face.front == kBeyond ||
        face.back == kBeyond)
      continue;
    const auto& v = joint.mesh.vertices;
    const Vec3& a = v[face.vertices[0]];
    surface += 0.5 * (v[face.vertices[1]] - a).cross(v[face.vertices[2]] - a).norm();
  }
  return surface > 0 ? 2 * volume / surface : 0;
}

Vec3 middle_of(const CompiledJoint& joint, RegionId region) {
  Vec3 sum = Vec3::Zero();
  double volume = 0;
  for (std::size_t i = 0; i < joint.mesh.tetrahedra.size(); ++i) {
    if (joint.mesh.regions[i] != region) continue;
    const double v = tet_volume(joint.mesh, i);
    for (const std::uint32_t corner : joint.mesh.tetrahedra[i])
      sum += 0.25 * v * joint.mesh.vertices[corner];
    volume += v;
  }
  return volume > 0 ? Vec3(sum / volume) : sum;
}

}  // namespace

Vec3 Vessel::direction(const Vec3& p_J) const noexcept {
  const Vec3 along = course.evaluate(p_J).gradient.row(2);
  const double length = along.norm();
  return length > 0 ? Vec3(towards / length * along) : Vec3::Zero();
}

double Vessel::middle_speed(double time) const noexcept {
  if (is_artery) return kArterialRate * 2 * radius * beat(time);
  return kVenousSpeed * (1 + kVenousSwing * std::sin(2 * std::numbers::pi * kBreath * time));
}

std::optional<Vessel> find_vessel(const CompiledJoint& joint, RegionId region) {
  const std::string& tissue = joint.tissue_of(region).name;
  const bool is_artery = tissue == "artery";
  if (!is_artery && tissue != "vein") return std::nullopt;
  const auto course = fit_fibre_course(joint, region, std::nullopt);
  const double radius = tube_radius(joint, region);
  if (!course || radius <= 0) return std::nullopt;
  Vessel vessel{is_artery, radius, 1, *course};
  const bool runs_up = vessel.direction(middle_of(joint, region)).z() > 0;
  vessel.towards = runs_up == is_artery ? -1 : 1;
  return vessel;
}

}  // namespace artus
