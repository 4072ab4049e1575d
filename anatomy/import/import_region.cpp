// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>

#include "artus/detail/anatomy/import/imported_joint.h"
#include "artus/detail/anatomy/import/nearest_bones.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kWhole = 90 * kMillimetre;  // a body of this half diagonal is meshed whole
constexpr double kLeast = 60 * kMillimetre;  // a ball's radius: hands and probe around a joint
constexpr double kMost = 130 * kMillimetre;
constexpr double kBehindSkin = 30 * kMillimetre;
constexpr std::size_t kSkinSamples = 20000;

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

Result<void> choose_region(ImportedJoint& joint, const ImportOptions& options) {
  const auto& between = options.between;
  if (options.whole) return {};
  Eigen::AlignedBox3d box;
  for (const Vec3& p : joint.body.vertices) box.extend(p);
  if (between.size() != 2 && (box.isEmpty() || box.diagonal().norm() / 2 <= kWhole)) return {};
  const auto samples = sample_structures(joint);
  const auto found = find_joint_bones(joint, between, samples);
  ARTUS_TRY(found);
  const auto& pair = *found;
  if (!pair) {
    joint.notes.push_back(
        "no two bones are near each other, so that no region of interest is "
        "chosen: all of the body is meshed");
    return {};
  }
  const auto& [a, b] = *pair;
  ImportedRegion region;
  region.centre = nearest_of(samples[a], samples[b]).centre;
  const double to_skin = distance_to(sample_surface(joint.body, kSkinSamples), region.centre);
  region.radius = std::clamp(to_skin + kBehindSkin, kLeast, kMost);
  region.by = "the ball around where '" + joint.structures[a].name + "' and '" +
              joint.structures[b].name + "' are nearest";
  joint.assumed.push_back("region of interest: " + region.by);
  joint.region = region;
  leave_out_far(joint);
  return {};
}

}  // namespace artus
