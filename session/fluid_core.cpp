// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/fluid_core.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/core/check.h"
#include "artus/echo/fibre_course.h"

namespace artus {
namespace {

constexpr double kShapeTime = 0.06;  // s that the first shape may take: a flow is seen at once
constexpr double kGrowthTime = 0.3;  // s that a later one may: images need not wait for it
constexpr double kVisible = 1e-9;    // m^3, of a shape's first liquid and least growth
constexpr double kGrowth = 0.01;     // of what is there

/// Whether the region is anywhere in the body; a recording may name one that a gap left empty.
bool is_there(const CompiledJoint& joint, std::uint32_t region) {
  const auto& all = joint.mesh.interfaces;
  return region < joint.regions.size() &&
         std::any_of(all.begin(), all.end(),
                     [&](const Interface& f) { return f.front == region || f.back == region; });
}

std::vector<Injected> injected_of(const CompiledJoint& joint,
                                  const std::vector<InjectedSite>& sites) {
  std::vector<Injected> injected;
  for (const InjectedSite& site : sites)
    if (is_there(joint, site.region))
      injected.push_back({joint.regions[site.region].name, site.volume, site.cavity != 0,
                          Vec3(site.p_J[0], site.p_J[1], site.p_J[2])});
  return injected;
}

}  // namespace

FluidCore::FluidCore(std::shared_ptr<const CompiledJoint> joint, Liquid liquid, double image_rate)
    : joint_(std::move(joint)),
      liquid_(std::move(liquid)),
      images_to_change_(static_cast<std::uint64_t>(std::ceil(kShapeTime * image_rate))) {
  ARTUS_REQUIRE(joint_ != nullptr && image_rate > 0, "a joint and an image rate are needed");
  fibres_ = make_fibre_field(joint_);
}

bool FluidCore::has_changed(std::span<const InjectedSite> sites) const {
  for (std::size_t k = 0; k < sites.size(); ++k) {
    const double before = k < begun_.size() ? begun_[k].volume : 0;
    if (std::abs(sites[k].volume - before) >= std::max(kVisible, kGrowth * before)) return true;
  }
  return false;
}

void FluidCore::start(std::span<const InjectedSite> sites, const DeformedBody* tissue) {
  const double later = kGrowthTime / kShapeTime * static_cast<double>(images_to_change_);
  due_ = images_ + (begun_.empty() ? images_to_change_ : static_cast<std::uint64_t>(later));
  begun_.assign(sites.begin(), sites.end());
  std::shared_ptr<const BodyMap> cage;
  if (tissue != nullptr) cage = tissue->shared_map();
  next_ = std::async(std::launch::async,
                     [joint = joint_, liquid = liquid_, fibres = fibres_, sites = begun_, cage] {
                       Shape shape;
                       shape.joint = std::make_shared<const CompiledJoint>(
                           with_injected(*joint, injected_of(*joint, sites), liquid, fibres));
                       if (cage)
                         shape.map = make_body_map(*shape.joint, cage->X_JC, cage->model);
                       else
                         shape.scene = std::make_shared<const Scene>(shape.joint);
                       return shape;
                     });
}

/// In a cage that was changed meanwhile it lies elsewhere.
void FluidCore::take(const DeformedBody* tissue) {
  shape_ = next_.get();
  placed_ = nullptr;
  if (tissue != nullptr && shape_.map && shape_.map->model != tissue->map().model)
    shape_.map = make_body_map(*shape_.joint, tissue->map().X_JC, tissue->map().model);
}

void FluidCore::place(const std::shared_ptr<const DeformedBody>& tissue) {
  if (!tissue) {
    if (!shape_.scene) shape_.scene = std::make_shared<const Scene>(shape_.joint);
    scene_ = shape_.scene;
    return;
  }
  if (placed_ == tissue) return;
  if (!shape_.map || shape_.map->model != tissue->map().model)
    shape_.map = make_body_map(*shape_.joint, tissue->map().X_JC, tissue->map().model);
  placed_ = tissue;
  scene_ = scenes_.at(std::make_shared<const DeformedBody>(
      shape_.joint, shape_.map, tissue->node_displacements(), tissue->contact()));
}

const std::shared_ptr<const Scene>& FluidCore::step(
    std::span<const InjectedSite> sites, const std::shared_ptr<const DeformedBody>& tissue) {
  ++images_;
  if (next_.valid() && images_ >= due_) take(tissue.get());
  if (sites.empty()) {  // a new syringe, and a body that nothing was put into
    if (next_.valid()) next_.get();
    begun_.clear();
    shape_ = {};
    scene_ = nullptr;
    placed_ = nullptr;
    return scene_;
  }
  if (!next_.valid() && has_changed(sites)) start(sites, tissue.get());
  if (shape_.joint) place(tissue);
  return scene_;
}

}  // namespace artus
