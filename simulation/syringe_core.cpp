// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/syringe_core.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/detail/soft/liquid/lens.h"

namespace artus {
namespace {

JointSpaces spaces_of(const CompiledJoint& joint) {
  auto spaces = make_joint_spaces(joint);
  ARTUS_REQUIRE(spaces.has_value(), "the joint's spaces must be valid");
  return std::move(*spaces);
}

PlungerParams plunger_params(const SessionParams& params) {
  auto made = make_plunger_params(params.syringe, needle_length_of(params));
  ARTUS_REQUIRE(made.has_value(), "the parameters must be valid");
  return std::move(*made);
}

}  // namespace

SyringeCore::SyringeCore(const CompiledJoint& joint, const SessionParams& params)
    : SyringeCore(spaces_of(joint), params) {}

SyringeCore::SyringeCore(JointSpaces spaces, const SessionParams& params)
    : bevel_(0),
      places_(make_bevel_places(spaces)),
      lifted_(places_.kinds.size(), 0.0),
      plunger_(plunger_params(params), std::move(spaces.spaces), 1 / params.haptic_rate),
      guard_(params.guard, {"thumb", kMaxForce, 0, Vec3::Zero(), 0, 0, 0}, 1 / params.haptic_rate),
      dt_(1 / params.haptic_rate) {
  bevel_ = bevel_length(plunger_.params().needle.outer_diameter);
}

void SyringeCore::reset() noexcept {
  plunger_.reset();
  engaged_ = false;
  n_sites_ = 0;
  told_ = given_ = 0;
}

void SyringeCore::rest() noexcept {
  engaged_ = false;
  describe(0, TickStatus::kStale);
  out_.flow = 0;
}

/// Whether the device's plunger went farther since its last sample than a thumb can push it.
bool SyringeCore::jumps(const DeviceSample& device) noexcept {
  constexpr double kLongest = 0.1;  // s without a sample
  // Of a slow device the plunger may be older than its newest pose.
  const std::int64_t least = device.hold_ms > 0 ? hold_of(device) : 0;
  const double elapsed = 1e-9 * static_cast<double>(std::max(least, device.time_ns - last_time_));
  const double travelled = std::abs(device.plunger_travel - last_travel_);
  const bool jumped = engaged_ && travelled > kMaxSpeed * std::clamp(elapsed, dt_, kLongest);
  last_time_ = device.time_ns;
  last_travel_ = device.plunger_travel;
  return jumped;
}

/// Wherever the device's plunger is when it comes, and after a jump, it begins without a force.
/// False: it jumped.
bool SyringeCore::follow_travel(const DeviceSample& device, PlungerInput& input) noexcept {
  const bool jumped = jumps(device);
  if (jumped) {
    engaged_ = false;
    told_ = kToldFor;
  }
  if (!engaged_) zero_ = device.plunger_travel - plunger_.state().travel;
  input.position = device.plunger_travel - zero_;
  input.stiffness = kCoupling;
  return !jumped;
}

/// By how much what is in a space has lifted its roof off the floor where the bevel is.
void SyringeCore::find_lifted(const NeedleContact& contact) noexcept {
  std::fill(lifted_.begin(), lifted_.end(), 0.0);
  if (!contact.inserted()) return;
  const NeedleTick& tick = contact.tick();
  const Vec3 p = tick.tip - bevel_ / 2 * tick.axis;
  for (std::size_t k = 0; k < n_sites_; ++k) {
    const InjectedSite& site = sites_[k];
    if (site.cavity == 0 || !(site.volume > 0)) continue;
    const double away = (p - Vec3(site.p_J[0], site.p_J[1], site.p_J[2])).norm();
    lifted_[space_of_site_[k]] = lens_height(site.volume, away);
  }
}

void SyringeCore::step(const DeviceSample& device, const NeedleContact& contact) noexcept {
  PlungerInput input;
  find_lifted(contact);
  input.tip = tip_ = bevel_shares(contact, bevel_, places_, lifted_);
  input.depth = contact.tick().depth;
  const double before = plunger_.state().content;
  told_ = std::max(0.0, told_ - dt_);
  bool felt = device.plunger != PlungerSign::none;
  if (device.plunger == PlungerSign::travel) {
    felt = follow_travel(device, input);
  } else if (device.plunger == PlungerSign::force) {
    input.force = device.plunger_force;
  }
  engaged_ = device.plunger == PlungerSign::travel;
  const PlungerState& state = plunger_.step(input);
  given_ += std::max(0.0, before - state.content);
  note_sites(input, contact);
  describe(felt ? state.force : 0, felt ? TickStatus::kOk : TickStatus::kStale);
}

void SyringeCore::note_sites(const PlungerInput& input, const NeedleContact& contact) noexcept {
  const auto states = plunger_.states();
  for (std::size_t k = 0; k < n_sites_; ++k) sites_[k].volume = states[space_of_site_[k]].volume;
  for (const TipShare& share : input.tip) {
    const SpaceKind kind = plunger_.spaces()[share.space].law.kind;
    const bool shown = kind == SpaceKind::cavity || kind == SpaceKind::split;
    if (!(share.share > 0) || !shown || !(states[share.space].volume > 0)) continue;
    const auto known = space_of_site_.begin() + static_cast<std::ptrdiff_t>(n_sites_);
    if (n_sites_ == kMaxSites || std::find(space_of_site_.begin(), known, share.space) != known)
      continue;
    const auto& of_region = places_.of_region;
    const auto region = std::find(of_region.begin(), of_region.end(), share.space);
    const auto first = static_cast<std::uint32_t>(region - of_region.begin());
    InjectedSite& site = sites_[n_sites_];
    const NeedleTick& tick = contact.tick();
    const Vec3 p = tick.tip - bevel_ / 2 * tick.axis;
    for (Eigen::Index i = 0; i < 3; ++i) site.p_J[i] = p[i];
    site.volume = states[share.space].volume;
    site.region = of_region[contact.region()] == share.space ? contact.region() : first;
    site.cavity = kind == SpaceKind::cavity ? 1 : 0;
    space_of_site_[n_sites_++] = share.space;
  }
}

void SyringeCore::describe(double thumb, std::uint32_t faults) noexcept {
  const PlungerState& state = plunger_.state();
  std::uint32_t ignored = 0;
  const Wrench felt = guard_.apply({Vec3(0, 0, thumb), Vec3::Zero()}, faults, ignored);
  out_.thumb_force = felt.force.z();
  on_needle_ = plunger_.params().unbalanced * out_.thumb_force;
  out_.pressure = state.pressure;
  out_.tip_pressure = state.tip_pressure;
  out_.flow = state.flow;
  out_.travel = state.travel;
  out_.drawn = state.drawn;
  out_.given = given_;
  out_.status = state.status | (told_ > 0 ? PlungerStatus::kJumped : 0U);
}

}  // namespace artus
