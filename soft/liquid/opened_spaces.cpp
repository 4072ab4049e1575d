// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/opened_spaces.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "artus/detail/core/check.h"

namespace artus {

std::vector<std::uint32_t> order_by_plan(const CompiledJoint& joint, const JointSpaces& spaces) {
  const auto is_cavity = [&](std::uint32_t space) {
    return spaces.spaces[space].law.kind == SpaceKind::cavity;
  };
  std::vector<std::uint32_t> order;
  const auto add = [&](std::uint32_t space) {
    if (std::find(order.begin(), order.end(), space) == order.end()) order.push_back(space);
  };
  for (const PlannedInjection& injection : joint.injections) {
    double nearest = std::numeric_limits<double>::infinity();
    std::optional<std::uint32_t> meant;
    for (const Interface& f : joint.mesh.interfaces)
      for (const RegionId region : {f.front, f.back}) {
        const std::uint32_t space = spaces.of_region[region];
        if (!is_cavity(space)) continue;
        const double away = (joint.mesh.vertices[f.vertices[0]] - injection.target).squaredNorm();
        if (away >= nearest) continue;
        nearest = away;
        meant = space;
      }
    if (meant) add(*meant);
  }
  for (std::uint32_t space = 0; space < spaces.spaces.size(); ++space)
    if (is_cavity(space)) add(space);
  return order;
}

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
    for (const std::uint32_t space : order_by_plan(*joint_, spaces_)) {
      if (stop_) return;
      const std::vector<RegionId> regions = regions_of(space);
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
