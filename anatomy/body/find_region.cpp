// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/find_region.h"

#include "artus/detail/core/known_names.h"

namespace artus {

Result<RegionId> find_region(const CompiledJoint& joint, std::string_view name) {
  const auto names = item_names(joint.regions);
  const auto at = find_name(std::span(names).subspan(kFirstRegion), name, "structure");
  ARTUS_TRY(at);
  return static_cast<RegionId>(kFirstRegion + *at);
}

}  // namespace artus
