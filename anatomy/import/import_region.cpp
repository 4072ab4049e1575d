// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "artus/detail/anatomy/import/imported_joint.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kNear = 15 * kMillimetre;   // of bones that make a joint
constexpr double kWhole = 90 * kMillimetre;  // a body of this half diagonal is meshed whole
constexpr double kLeast = 60 * kMillimetre;  // a ball's radius: hands and probe around a joint
constexpr double kMost = 130 * kMillimetre;
constexpr double kBehindSkin = 30 * kMillimetre;
constexpr std::size_t kSamples = 1500;
constexpr std::size_t kSkinSamples = 20000;

/// Evenly chosen vertices of a surface: millimetres apart, which is enough to say where a joint is.
std::vector<Vec3> samples_of_surface(const SurfaceMesh& mesh, std::size_t n) {
  std::vector<Vec3> samples;
  const std::size_t step = mesh.vertices.size() / n + 1;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step) samples.push_back(mesh.vertices[i]);
  return samples;
}

double distance_to(const std::vector<Vec3>& samples, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& q : samples) least = std::min(least, (p - q).squaredNorm());
  return std::sqrt(least);
}

/// Where two surfaces are nearest.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  Vec3 centre = Vec3::Zero();
};

Nearest nearest_of(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  constexpr double kAround = 3 * kMillimetre;
  std::vector<double> distances;
  Nearest nearest;
  for (const Vec3& p : a) {
    distances.push_back(distance_to(b, p));
    nearest.distance = std::min(nearest.distance, distances.back());
  }
  double n = 0;
  for (std::size_t k = 0; k < distances.size(); ++k) {
    if (distances[k] > nearest.distance + kAround) continue;
    nearest.centre += a[k];
    ++n;
  }
  if (n > 0) nearest.centre /= n;
  return nearest;
}

/// Whether the boxes of two sets of points are farther apart than bones of a joint are.
bool are_far(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  Eigen::AlignedBox3d of_a, of_b;
  for (const Vec3& p : a) of_a.extend(p);
  for (const Vec3& p : b) of_b.extend(p);
  return of_a.exteriorDistance(of_b) > kNear;
}

/// The two bones that make the joint: of the near ones those whose smaller is largest.
std::optional<std::pair<std::size_t, std::size_t>> find_bones(
    const ImportedJoint& joint, const std::vector<std::vector<Vec3>>& samples) {
  std::optional<std::pair<std::size_t, std::size_t>> best;
  double most = 0;
  const auto& all = joint.structures;
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      if (all[a].tissue != "bone" || all[b].tissue != "bone") continue;
      const double smaller = std::min(signed_volume(all[a].mesh), signed_volume(all[b].mesh));
      if (smaller <= most) continue;
      if (are_far(samples[a], samples[b])) continue;
      if (nearest_of(samples[a], samples[b]).distance > kNear) continue;
      most = smaller;
      best = {a, b};
    }
  return best;
}

Result<std::pair<std::size_t, std::size_t>> find_named(const ImportedJoint& joint,
                                                       const std::vector<std::string>& between) {
  const auto names = item_names(joint.structures);
  const auto a = find_name(names, between[0], "structure", "--between");
  ARTUS_TRY(a);
  const auto b = find_name(names, between[1], "structure", "--between");
  ARTUS_TRY(b);
  return std::pair{*a, *b};
}

void leave_out_far(ImportedJoint& joint) {
  std::vector<ImportedStructure> kept;
  for (ImportedStructure& s : joint.structures) {
    // As deep in the region as gives it a facet there.
    const double reach = joint.region->radius - 2 * kMillimetre;
    const bool is_near =
        std::any_of(s.mesh.vertices.begin(), s.mesh.vertices.end(),
                    [&](const Vec3& p) { return (p - joint.region->centre).norm() < reach; });
    if (is_near) {
      kept.push_back(std::move(s));
      continue;
    }
    s.by = "all of it lies outside of the region of interest";
    s.mesh = {};
    joint.left_out.push_back(std::move(s));
  }
  joint.structures = std::move(kept);
}

}  // namespace

Result<void> choose_region(ImportedJoint& joint, const std::vector<std::string>& between) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : joint.body.vertices) box.extend(p);
  if (between.size() != 2 && (box.isEmpty() || box.diagonal().norm() / 2 <= kWhole)) return {};
  std::vector<std::vector<Vec3>> samples;
  for (const ImportedStructure& s : joint.structures)
    samples.push_back(samples_of_surface(s.mesh, kSamples));
  std::optional<std::pair<std::size_t, std::size_t>> pair;
  if (between.size() == 2) {
    const auto named = find_named(joint, between);
    ARTUS_TRY(named);
    pair = *named;
  } else {
    pair = find_bones(joint, samples);
  }
  if (!pair) {
    joint.notes.push_back(
        "no two bones are near each other, so that no region of interest is "
        "chosen: all of the body is meshed");
    return {};
  }
  const auto& [a, b] = *pair;
  ImportedRegion region;
  region.centre = nearest_of(samples[a], samples[b]).centre;
  const double to_skin = distance_to(samples_of_surface(joint.body, kSkinSamples), region.centre);
  region.radius = std::clamp(to_skin + kBehindSkin, kLeast, kMost);
  region.by = "the ball around where '" + joint.structures[a].name + "' and '" +
              joint.structures[b].name + "' are nearest";
  joint.assumed.push_back("region of interest: " + region.by);
  joint.region = region;
  leave_out_far(joint);
  return {};
}

}  // namespace artus
