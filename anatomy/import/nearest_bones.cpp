// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/nearest_bones.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/known_names.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kNear = 15 * kMillimetre;  // of bones that make a joint
constexpr std::size_t kSamples = 1500;

using Pair = std::pair<std::size_t, std::size_t>;

/// Of the near bones those whose smaller is largest.
std::optional<Pair> find_largest(const ImportedJoint& joint,
                                 const std::vector<SurfaceSamples>& samples) {
  std::optional<Pair> best;
  double most = 0;
  const auto& all = joint.structures;
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      if (all[a].tissue != "bone" || all[b].tissue != "bone") continue;
      const double smaller = std::min(signed_volume(all[a].mesh), signed_volume(all[b].mesh));
      if (smaller <= most) continue;
      if (are_apart(samples[a], samples[b], kNear)) continue;
      if (nearest_of(samples[a], samples[b]).distance > kNear) continue;
      most = smaller;
      best = {a, b};
    }
  return best;
}

}  // namespace

SurfaceSamples sample_surface(const SurfaceMesh& mesh, std::size_t n) {
  SurfaceSamples samples;
  const std::size_t step = mesh.vertices.size() / n + 1;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step) samples.push_back(mesh.vertices[i]);
  return samples;
}

std::vector<SurfaceSamples> sample_structures(const ImportedJoint& joint) {
  std::vector<SurfaceSamples> samples;
  for (const ImportedStructure& s : joint.structures)
    samples.push_back(sample_surface(s.mesh, kSamples));
  return samples;
}

double distance_to(const SurfaceSamples& samples, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& q : samples) least = std::min(least, (p - q).squaredNorm());
  return std::sqrt(least);
}

Nearest nearest_of(const SurfaceSamples& a, const SurfaceSamples& b) {
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

bool are_apart(const SurfaceSamples& a, const SurfaceSamples& b, double reach) {
  Eigen::AlignedBox3d of_a, of_b;
  for (const Vec3& p : a) of_a.extend(p);
  for (const Vec3& p : b) of_b.extend(p);
  return of_a.exteriorDistance(of_b) > reach;
}

Result<std::optional<Pair>> find_joint_bones(const ImportedJoint& joint,
                                             const std::vector<std::string>& between,
                                             const std::vector<SurfaceSamples>& samples) {
  if (between.size() != 2) return find_largest(joint, samples);
  const auto names = item_names(joint.structures);
  const auto a = find_name(names, between[0], "structure", "--between");
  ARTUS_TRY(a);
  const auto b = find_name(names, between[1], "structure", "--between");
  ARTUS_TRY(b);
  return std::optional(Pair{*a, *b});
}

}  // namespace artus
