// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/plunger/plunger.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "artus/core/noise.h"
#include "artus/haptics/plunger/bevel.h"
#include "artus/haptics/plunger/space_pressure.h"

namespace artus {
namespace {

constexpr double kVacuum = -90e3;           // Pa, below which a liquid is not drawn
constexpr double kAfterTear = 0.2;          // of the pressure; assumed
constexpr double kClogFactor = 100;         // on the needle's resistance; assumed
constexpr double kClogTime = 0.2;           // s in which it clogs; assumed
constexpr double kWidestClogged = 0.22e-3;  // m of bore; 27 G and thinner
constexpr double kFilmRate = 1e3;  // 1/s at which a thinning liquid runs in a film; assumed
constexpr double kStill = 1e-12;   // m^3/s

double fade(const SpaceLaw& law, double dt) noexcept {
  return law.relaxation > 0 ? std::exp(-dt / law.relaxation) : 0;
}

/// What lies around the places: takes what they lose.
Space surroundings() {
  Space space;
  space.name = "surroundings";
  space.like = "surroundings";
  return space;
}

}  // namespace

Plunger::Plunger(const PlungerParams& params, std::vector<Space> spaces, double dt)
    : params_(params),
      dt_(dt),
      area_(params.syringe.area()),
      softness_(params.syringe.softness()),
      bevel_share_(
          std::min(0.5, bevel_length(params.needle.outer_diameter) / params.needle.length)),
      own_(params.needle, params.liquid.viscosity, params.liquid.density, params.entry_loss),
      spaces_(std::move(spaces)) {
  ARTUS_REQUIRE(dt > 0 && dt <= 0.01, "the period must be above 0 and at most 0.01 s");
  ARTUS_REQUIRE(!spaces_.empty(), "there must be a space");
  ARTUS_REQUIRE(softness_ > 0 && area_ > 0, "a barrel has an area and gives way");
  const auto air = std::find_if(spaces_.begin(), spaces_.end(),
                                [](const Space& space) { return space.like == kOutsideSpace; });
  outside_ = static_cast<std::uint32_t>(air - spaces_.begin());
  spaces_.push_back(surroundings());
  states_.resize(spaces_.size());
  const auto around = static_cast<std::uint32_t>(spaces_.size() - 1);
  for (std::uint32_t k = 0; k < spaces_.size(); ++k) {
    const Space& space = spaces_[k];
    fading_.push_back(fade(space.law, dt));
    contents_.push_back(-1);
    if (!space.liquid.empty()) {
      const auto liquid = find_liquid(params_.liquids, space.liquid);
      ARTUS_REQUIRE(liquid.has_value(), "there must be a liquid for each space's contents");
      contents_.back() = static_cast<std::int32_t>(others_.size());
      others_.emplace_back(params_.needle, liquid->viscosity, liquid->density, params_.entry_loss);
    }
    const auto to = std::find_if(spaces_.begin(), spaces_.end(),
                                 [&](const Space& other) { return other.name == space.leaks_to; });
    if (!space.leaks_to.empty() && to != spaces_.end())
      leaks_.push_back({k, static_cast<std::uint32_t>(to - spaces_.begin()), space.leak_opening,
                        space.leak_resistance, false});
    if (space.law.kind == SpaceKind::cavity) {
      leaks_.push_back({k, around, 0, params_.lost_resistance, true});
    }
  }
  reset();
}

void Plunger::reset() noexcept {
  std::fill(states_.begin(), states_.end(), SpaceState{});
  state_ = {};
  state_.content = params_.syringe.filled;
  way_ = 0;
  clear_needle();
}

void Plunger::clear_needle() noexcept {
  clogging_ = 0;
  rest_time_ = 0;
  // Exponentially distributed, from a counter: the next needle has another time.
  const double u = 0x1p-53 * static_cast<double>(mix_bits(params_.seed++) >> 11U);
  clog_after_ = -params_.clog_time * std::log(1 - u);
}

double Plunger::pressure(std::size_t space) const noexcept {
  const SpaceState& s = states_[space];
  const double p = pressure_of(spaces_[space].law, s.volume - s.drawn) + s.relaxing;
  return s.ruptured ? kAfterTear * p : p;
}

/// What needs no pressure opens at once. Of the rest the place that gives way most easily; another
/// one in a later tick, when the pressure inside the bevel is still enough for it.
void Plunger::open_places(const PlungerInput& input, double pressure) noexcept {
  const auto open = [&input](SpaceState& s) {
    s.open = true;
    s.open_depth = input.depth;
    s.idle = 0;
  };
  SpaceState* easiest = nullptr;
  double most = 0;
  for (const TipShare& tip : input.tip) {
    if (!(tip.share > 0)) continue;
    SpaceState& s = states_[tip.space];
    const SpaceLaw& law = spaces_[tip.space].law;
    const bool left = std::abs(input.depth - s.open_depth) > params_.reopen_distance;
    s.idle += dt_;
    if (s.open && (left || s.idle > params_.reopen_time)) s.open = false;
    if (s.open || law.kind == SpaceKind::solid) continue;
    const double over = pressure - opening_of(law, s.volume - s.drawn) - s.relaxing;
    if (!(law.opening > 0)) {
      open(s);
    } else if (over > most) {
      most = over;
      easiest = &s;
    }
  }
  if (easiest != nullptr) open(*easiest);
}

/// What a place gives back: what was put in, otherwise its own contents; null: nothing.
const NeedleFlow* Plunger::flow_in(const TipShare& tip) const noexcept {
  const SpaceState& s = states_[tip.space];
  if (s.volume > 0) return &own_;
  const auto contents = contents_[tip.space];
  if (contents < 0 || s.drawn >= spaces_[tip.space].law.contents) return nullptr;
  return &others_[static_cast<std::size_t>(contents)];
}

/// A place meets what is half a tick later.
Plunger::Branch Plunger::branch(const TipShare& tip, bool out) const noexcept {
  const SpaceState& s = states_[tip.space];
  if (!s.open || !(tip.share > 0)) return {};
  const SpaceLaw& law = spaces_[tip.space].law;
  // What has parted tissue stays there.
  if (!out && (law.kind == SpaceKind::split || flow_in(tip) == nullptr)) return {};
  const double volume = s.volume - s.drawn;
  const double slope = std::max(0.0, slope_of(law, volume) * (1 + law.relaxing));
  const double near = bevel_share_ * own_.resistance() + law.resistance +
                      film_resistance(law, volume, params_.liquid.viscosity.at(kFilmRate));
  return {true, pressure(tip.space), near / tip.share + dt_ * slope / 2};
}

/// The bore ends in both branches; one against whose pressure nothing flows takes no part.
Plunger::Parting Plunger::part(const PlungerInput& input, const Drive& drive,
                               bool out) const noexcept {
  const double way = out ? 1 : -1;
  std::array<Branch, 2> branches{branch(input.tip[0], out), branch(input.tip[1], out)};
  for (Branch& b : branches) b.open = b.open && way * (drive.pressure - b.pressure) > 0;
  const std::size_t first = branches[0].open ? 0 : 1;
  Parting parting;
  parting.pressure = drive.pressure;
  if (!branches[first].open) return parting;
  const NeedleFlow& bore = out ? own_ : *flow_in(input.tip[first]);
  const double in_bevel = bevel_share_ * own_.resistance();
  const double clogged = clogging_ * (kClogFactor - 1) * own_.resistance();
  for (;;) {
    double conductance = 0;
    double drawn = 0;
    for (const Branch& b : branches) {
      if (!b.open) continue;
      conductance += 1 / b.resistance;
      drawn += b.pressure / b.resistance;
    }
    const double behind = drawn / conductance;
    const double extra = std::max(0.0, 1 / conductance - in_bevel) + clogged + dt_ * drive.slope;
    const double q = bore.flow(drive.pressure - behind, extra);
    parting.pressure = behind + q / conductance;
    bool all = true;
    for (std::size_t k = 0; k < 2; ++k) {
      const Branch& b = branches[k];
      parting.flows[k] = b.open ? (parting.pressure - b.pressure) / b.resistance : 0;
      all = all && way * parting.flows[k] >= 0;
    }
    if (all) return parting;
    for (std::size_t k = 0; k < 2; ++k)
      if (way * parting.flows[k] < 0) branches[k].open = false;
  }
}

Plunger::Parting Plunger::flow_out(const PlungerInput& input, const Drive& drive) const noexcept {
  Parting parting = part(input, drive, true);
  if (parting.flows[0] == 0 && parting.flows[1] == 0) parting = part(input, drive, false);
  return parting;
}

/// The gliding stopper: the thumb's spring beside the barrel's. Without a spring the pressure is
/// what the thumb's force leaves.
Plunger::Drive Plunger::gliding(double thumb, double stiffness, int way) const noexcept {
  const double net = thumb - way * params_.syringe.glide;
  const double soft = stiffness * softness_ / area_;  // m^2
  return {(net + soft * state_.pressure) / (area_ + soft), stiffness / (area_ * (area_ + soft))};
}

/// False when the stopper would not go its way: then it sticks, and nothing has changed.
bool Plunger::glide(const PlungerInput& input, double thumb) noexcept {
  const Drive drive = gliding(thumb, input.stiffness, way_);
  const Parting parting = flow_out(input, drive);
  const double out = (parting.flows[0] + parting.flows[1]) * dt_;
  double next = drive.pressure - drive.slope * out;
  double dx = (softness_ * (next - state_.pressure) + out) / area_;
  if (dx * way_ <= 0) return false;
  const double in_end = params_.syringe.filled / area_;
  const double out_end = in_end - params_.syringe.volume / area_;
  const double x = std::clamp(state_.travel + dx, out_end, in_end);
  if (x != state_.travel + dx) {
    dx = x - state_.travel;
    next = state_.pressure + (area_ * dx - out) / softness_;
    way_ = 0;
  }
  state_.travel = x;
  state_.pressure = next;
  take_flows(input, parting);
  return true;
}

void Plunger::rest(const PlungerInput& input) noexcept {
  way_ = 0;
  const Parting parting = flow_out(input, {state_.pressure, 0.5 / softness_});
  state_.pressure -= (parting.flows[0] + parting.flows[1]) * dt_ / softness_;
  take_flows(input, parting);
}

void Plunger::change_volume(std::size_t space, double by) noexcept {
  SpaceState& s = states_[space];
  const SpaceLaw& law = spaces_[space].law;
  if (law.relaxing > 0) {
    const double slope = slope_of(law, s.volume - s.drawn);
    s.relaxing += law.relaxing * slope * by;
  }
  s.volume += by;
  if (s.volume >= law.rupture) s.ruptured = true;
}

/// What was put in comes out first, then the place's own.
void Plunger::take_out(std::size_t space, double volume) noexcept {
  SpaceState& s = states_[space];
  const double own = std::max(0.0, volume - s.volume);
  change_volume(space, own - volume);
  s.drawn += own;
  state_.drawn += own;
}

void Plunger::take_flows(const PlungerInput& input, const Parting& parting) noexcept {
  const std::array<double, 2>& flows = parting.flows;
  state_.flow = flows[0] + flows[1];
  state_.bevel_pressure = state_.flow == 0 ? state_.pressure : parting.pressure;
  for (std::size_t k = 0; k < 2; ++k) {
    const double volume = flows[k] * dt_;
    const std::size_t space = input.tip[k].space;
    if (volume > 0)
      change_volume(space, volume);
    else if (volume < 0)
      take_out(space, -volume);
    if (std::abs(flows[k]) > kStill) states_[space].idle = 0;
    state_.content -= volume;
  }
}

void Plunger::leak(const PlungerInput& input) noexcept {
  const auto pass = [&](const Leak& leak) {
    const SpaceState& from = states_[leak.from];
    if (leak.by_rupture && !from.ruptured) return;
    const double dp = pressure(leak.from) - pressure(leak.to) - leak.opening;
    if (!(dp > 0) || !(from.volume > 0)) return;
    const double slope = std::max(0.0, slope_of(spaces_[leak.from].law, from.volume)) +
                         std::max(0.0, slope_of(spaces_[leak.to].law, states_[leak.to].volume));
    const double volume = std::min(dp / (leak.resistance + 0.5 * dt_ * slope) * dt_, from.volume);
    change_volume(leak.from, -volume);
    change_volume(leak.to, volume);
  };
  for (const Leak& l : leaks_) pass(l);
  const auto around = static_cast<std::uint32_t>(spaces_.size() - 1);
  for (const TipShare& tip : input.tip)
    if (tip.share > 0 && spaces_[tip.space].law.kind == SpaceKind::cavity)
      pass({tip.space, around, params_.grip, params_.track_resistance, false});
  for (std::size_t k = 0; k < states_.size(); ++k) states_[k].relaxing *= fading_[k];
}

/// Grains settle in a thin bore while nothing moves.
void Plunger::clog() noexcept {
  const bool may = params_.liquid.solids > 0 && params_.needle.diameter <= kWidestClogged;
  const bool settled = may && rest_time_ > clog_after_;
  if (clogging_ > 0 || settled) clogging_ = std::min(1.0, clogging_ + dt_ / kClogTime);
}

void Plunger::describe(const PlungerInput& input, double thumb) noexcept {
  const double in_end = params_.syringe.filled / area_;
  const double out_end = in_end - params_.syringe.volume / area_;
  std::uint32_t& status = state_.status;
  if (way_ != 0) status |= PlungerStatus::kMoving;
  if (std::abs(state_.flow) > kStill) status |= PlungerStatus::kFlowing;
  if (state_.travel >= in_end) status |= PlungerStatus::kEmpty;
  if (state_.travel <= out_end && params_.syringe.volume > params_.syringe.filled)
    status |= PlungerStatus::kDrawnOut;
  if (clogging_ > 0) status |= PlungerStatus::kClogged;
  if (state_.drawn > params_.syringe.dead_space) status |= PlungerStatus::kFlash;
  state_.tip_pressure = 0;
  bool any_open = false;
  for (const TipShare& tip : input.tip) {
    if (!(tip.share > 0)) continue;
    // Tissue that has not parted presses on nothing.
    const bool parted = states_[tip.space].open || states_[tip.space].volume > 0 ||
                        spaces_[tip.space].law.kind != SpaceKind::split;
    const double p = parted ? pressure(tip.space) : 0;
    state_.tip_pressure += tip.share * p;
    any_open = any_open || states_[tip.space].open;
    if (states_[tip.space].ruptured) status |= PlungerStatus::kRuptured;
    if (p > spaces_[tip.space].law.stop) status |= PlungerStatus::kTense;
    if (tip.space == outside_) status |= PlungerStatus::kOutside;
  }
  if (!any_open) status |= PlungerStatus::kClosed;
  state_.force = thumb - input.stiffness * state_.travel;
  state_.on_needle = params_.unbalanced * state_.force;
}

const PlungerState& Plunger::step(const PlungerInput& input) noexcept {
  PlungerInput in = input;
  state_.status = 0;
  if (!std::isfinite(in.force) || !std::isfinite(in.position) || !std::isfinite(in.stiffness) ||
      !(in.stiffness >= 0) || !std::isfinite(in.depth)) {
    in.force = in.position = in.stiffness = in.depth = 0;
    state_.status |= PlungerStatus::kNotFinite;
  }
  const double least = area_ * kVacuum - params_.syringe.glide;
  const double spring = in.stiffness * state_.travel;
  const double wish = in.force + in.stiffness * in.position - spring;
  const double now = std::clamp(wish, std::max(least, -params_.most_force), params_.most_force);
  if (now != wish) state_.status |= PlungerStatus::kLimited;
  const double net = now - area_ * state_.pressure;
  const double age = std::log10(std::max(1.0, rest_time_));
  const double hold = params_.syringe.break_loose * (1 + params_.syringe.ageing * age);
  const double in_end = params_.syringe.filled / area_;
  const double out_end = in_end - params_.syringe.volume / area_;
  if (way_ == 0 && net > hold && state_.travel < in_end) way_ = 1;
  if (way_ == 0 && -net > hold && state_.travel > out_end) way_ = -1;
  open_places(in, state_.bevel_pressure);
  if (way_ == 0 || !glide(in, now)) rest(in);
  leak(in);
  rest_time_ = way_ == 0 ? rest_time_ + dt_ : 0;
  clog();
  describe(in, now + spring);
  return state_;
}

}  // namespace artus
