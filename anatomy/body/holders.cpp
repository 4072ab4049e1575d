// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/holders.h"

#include <algorithm>

namespace artus {

Holders find_holders(const CompiledJoint& joint) {
  Holders holders;
  std::vector<bool> there(joint.regions.size(), false);
  for (const RegionId region : joint.mesh.regions) there[region] = true;
  for (std::size_t r = kFirstRegion; r < joint.regions.size(); ++r)
    if (there[r] && joint.tissue_of(static_cast<RegionId>(r)).haptic.hard)
      holders.bones.push_back(joint.regions[r].name);
  holders.cut_faces =
      std::any_of(joint.mesh.interfaces.begin(), joint.mesh.interfaces.end(),
                  [](const Interface& i) { return i.front == kBeyond || i.back == kBeyond; });
  return holders;
}

std::string describe(const Holders& holders) {
  constexpr std::size_t kNamed = 4;
  if (!holders.any()) return explain_unheld();
  std::string text = "the tissue is held by ";
  for (std::size_t i = 0; i < std::min(kNamed, holders.bones.size()); ++i)
    text += (i == 0 ? "bone (" : ", ") + holders.bones[i];
  if (holders.bones.size() > kNamed)
    text += " and " + std::to_string(holders.bones.size() - kNamed) + " more";
  if (!holders.bones.empty()) text += ")";
  if (!holders.bones.empty() && holders.cut_faces) text += " and by ";
  if (holders.cut_faces) text += "the faces where the body is cut";
  return text;
}

std::string explain_unheld() {
  return "nothing holds the tissue: give the body bone, or a [region_of_interest] that cuts it, "
         "whose cut faces are held";
}

}  // namespace artus
