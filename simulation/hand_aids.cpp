// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/hand_aids.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace artus {

HandAid::HandAid(const CompiledJoint& joint, const HandAids& aids, double period)
    : aids_(aids), max_step_(kSlew * period), keep_out_(joint.regions.size(), 0) {
  const Vec3 direction = aids.target - aids.entry;
  if (direction.norm() > 0) direction_ = direction.normalized();
  std::istringstream names(aids.keep_out);
  for (std::string name; std::getline(names, name);)
    for (std::size_t r = kFirstRegion; r < joint.regions.size(); ++r)
      if (joint.regions[r].name == name) keep_out_[r] = 1;
}

Vec3 HandAid::step(const NeedleContact& contact, const Vec3& tip, bool runs) noexcept {
  const Vec3 change = wanted(contact, tip) - force_;
  const double size = change.norm();
  if (!runs || !std::isfinite(size))
    force_.setZero();
  else
    force_ += size > max_step_ ? Vec3(max_step_ / size * change) : change;
  return force_;
}

/// What both ask for here, N.
Vec3 HandAid::wanted(const NeedleContact& contact, const Vec3& tip) noexcept {
  const bool inside = contact.inserted();
  const RegionId region = contact.region();
  const bool within = inside && region < keep_out_.size() && keep_out_[region] != 0;
  const double depth = contact.tick().depth;
  if (within && !within_) entered_ = depth;
  within_ = within;
  Vec3 force = Vec3::Zero();
  if (!inside) return force;
  if (aids_.guide > 0) {
    const Vec3 from = tip - aids_.entry;
    const Vec3 across = from - from.dot(direction_) * direction_;
    const double share = std::clamp(depth / kBegins, 0.0, 1.0);
    const double pull = share * aids_.guide * across.norm();
    if (pull > 0) force -= std::min(pull, kMaxForce) * across.normalized();
  }
  if (within && aids_.wall > 0)
    force -= std::clamp(aids_.wall * (depth - entered_), 0.0, kMaxForce) * contact.tick().axis;
  return force;
}

}  // namespace artus
