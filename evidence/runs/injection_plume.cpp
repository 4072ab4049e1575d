// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_plume.h"

#include <algorithm>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/haptics/plunger/bevel.h"

namespace artus {
namespace {

constexpr double kPictureTime = 1.0 / 30;  // s
constexpr double kFollowed = 6;            // s

}  // namespace

InjectionPlume::InjectionPlume(const Scene& scene, const InjectionRun& run, double bore)
    : run_(&run), bore_(bore), plume_(run.plunger.liquid) {
  const auto spaces = make_joint_spaces(scene.joint());
  for (const std::string& place : run.places)
    holds_.push_back(spaces && std::any_of(spaces->spaces.begin(), spaces->spaces.end(),
                                           [&](const Space& space) {
                                             return space.name == place &&
                                                    space.law.kind != SpaceKind::open;
                                           }));
}

PlumeSource InjectionPlume::source_at(double time) const {
  const InjectionRow& row = row_of(*run_, time);
  const double opening = bevel_middle(run_->plunger.needle.outer_diameter);
  const Vec3 axis = run_->X_JN.linear().col(2);
  PlumeSource source;
  source.p_J = run_->X_JN.translation() + (row.depth - run_->depth - opening) * axis;
  source.axis_J = axis;
  source.bore = bore_;
  for (std::size_t k = 0; k < holds_.size() && k < row.volumes.size(); ++k)
    if (holds_[k]) source.given += row.volumes[k];
  return source;
}

std::span<const DriftingPoint> InjectionPlume::at(const Scene& body, double time) {
  time_ = std::max(time_, time - kFollowed);
  for (; time_ + kPictureTime <= time; time_ += kPictureTime)
    plume_.step(body, source_at(time_ + kPictureTime), Vec3::UnitZ(), kPictureTime);
  return plume_.points();
}

void InjectionPlume::show(Renderer& renderer, const Scene& body, double time) {
  renderer.set_drifting_points(at(body, time));
  renderer.set_settling({Vec3::UnitZ(), plume_.fallen()});
}

}  // namespace artus
