// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/opened_spaces.h"

#include <utility>

#include "artus/detail/core/check.h"

namespace artus {

OpenedSpaces::OpenedSpaces(std::shared_ptr<const CompiledJoint> joint, bool ahead)
    : joint_(std::move(joint)) {
  ARTUS_REQUIRE(joint_ != nullptr, "a joint");
  auto spaces = make_joint_spaces(*joint_);
  ARTUS_REQUIRE(spaces.has_value(), "the joint's spaces must be valid");
  spaces_ = std::move(*spaces);
  there_.assign(joint_->regions.size(), false);
  for (const Interface& f : joint_->mesh.interfaces) there_[f.front] = there_[f.back] = true;
  entries_ = std::vector<Entry>(spaces_.spaces.size());
  if (!ahead) return;
  ahead_ = std::async(std::launch::async, [this] {
    for (std::size_t k = 0; k < entries_.size() && !stop_; ++k) {
      if (spaces_.spaces[k].law.kind != SpaceKind::cavity) continue;
      const std::vector<RegionId> regions = regions_of(k);
      if (!regions.empty()) static_cast<void>(of(regions.front()));
    }
  });
}

OpenedSpaces::~OpenedSpaces() {
  stop_ = true;
  if (ahead_.valid()) ahead_.wait();
}

std::vector<RegionId> OpenedSpaces::regions_of(std::size_t space) const {
  std::vector<RegionId> regions;
  for (RegionId r = kFirstRegion; r < there_.size(); ++r)
    if (there_[r] && spaces_.of_region[r] == space) regions.push_back(r);
  return regions;
}

const OpenedSpace& OpenedSpaces::of(RegionId region) const {
  ARTUS_REQUIRE(region < there_.size() && there_[region], "a region that has interfaces");
  const std::size_t space = spaces_.of_region[region];
  Entry& entry = entries_[space];
  std::call_once(entry.made, [&] {
    entry.space = std::make_unique<const OpenedSpace>(*joint_, regions_of(space), &stop_);
  });
  return *entry.space;
}

}  // namespace artus
