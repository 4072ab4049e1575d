// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/check/held.h"

#include <algorithm>

#include "artus/detail/anatomy/compile/labels/region_labels.h"

namespace artus {
namespace {

bool is_hard(const JointFile& file, const Structure& s) {
  return std::any_of(file.tissues.begin(), file.tissues.end(),
                     [&](const Tissue& t) { return t.name == s.tissue && t.haptic.hard; });
}

/// Whether some of a surface lies in the body and the region of interest.
bool is_in_joint(const JointFile& file, const PreparedSurfaces& surfaces,
                 const PreparedSurface& surface) {
  const auto& roi = file.region_of_interest;
  if (roi && surface.tree.winding_number(roi->centre) > 0.5) return true;
  constexpr std::size_t kSamples = 1000;
  const std::vector<Vec3>& all = surface.mesh.vertices;
  const std::size_t step = all.size() / kSamples + 1;
  for (std::size_t i = 0; i < all.size(); i += step) {
    if (roi && signed_distance(*roi, all[i]) > 0) continue;
    if (surfaces.body.tree.winding_number(all[i]) > 0.5) return true;
  }
  return false;
}

bool is_cut(const JointFile& file, const PreparedSurface& body) {
  if (std::any_of(body.is_cut.begin(), body.is_cut.end(), [](auto cut) { return bool(cut); }))
    return true;
  const auto& roi = file.region_of_interest;
  return roi && std::any_of(body.mesh.vertices.begin(), body.mesh.vertices.end(),
                            [&](const Vec3& p) { return signed_distance(*roi, p) > 0; });
}

}  // namespace

Holders find_holders(const JointFile& file, const PreparedSurfaces& surfaces) {
  Holders holders;
  for (std::size_t i = 0; i < file.structures.size(); ++i) {
    const Structure& s = file.structures[i];
    if (!is_hard(file, s)) continue;
    const bool made = !std::holds_alternative<SurfaceFile>(s.shape);
    const bool there =
        made || (surfaces.structures[i] && is_in_joint(file, surfaces, *surfaces.structures[i]));
    if (there) holders.bones.push_back(s.name);
  }
  holders.cut_faces = is_cut(file, surfaces.body);
  return holders;
}

std::vector<Finding> find_unheld(const JointFile& file, const PreparedSurfaces& surfaces) {
  if (find_holders(file, surfaces).any()) return {};
  return {{Verdict::refused, "unheld", file.body.name, file.body.line, explain_unheld()}};
}

}  // namespace artus
