// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/plunger.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "artus/detail/core/noise.h"
#include "artus/detail/haptics/plunger/bevel.h"
#include "artus/detail/haptics/plunger/space_pressure.h"

namespace artus {
namespace {

constexpr double kAfterTear = 0.2;  // of the walls' tension; assumed
constexpr double kAround = 1e3;  // Pa that parts what lies around a torn place; assumed, as of fat
constexpr double kClogFactor = 100;         // on the needle's resistance; assumed
constexpr double kClogTime = 0.2;           // s in which it clogs; assumed
constexpr double kWidestClogged = 0.22e-3;  // m of bore; 27 G and thinner
constexpr double kMaxFall = 0.25;  // of the bevel's resistance, by which a place may fall in a tick
constexpr double kFilmRate = 1e3;  // 1/s at which a thinning liquid runs in a film; assumed

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

/// Whether a place parts and is full of something that runs out of it again: a deposit's slurry.
/// Other tissue keeps what has parted it.
bool is_washed(const Space& space) noexcept {
  return space.law.kind == SpaceKind::split && !space.liquid.empty();
}

/// Pa that push out of what is washed: its walls spring back from where they were parted by `more`
/// m^3, and are sucked together where more was drawn than put in. assumed: in this course
double springs_back(double pressure, double more, double contents) noexcept {
  return pressure * more / std::max(more + contents, 1e-3 * contents);
}

}  // namespace

Plunger::Plunger(const PlungerParams& params, std::vector<Space> spaces, double dt)
    : params_(params),
      dt_(dt),
      area_(params.syringe.area()),
      in_end_(params.syringe.filled / area_),
      out_end_(in_end_ - params.syringe.volume / area_),
      bevel_share_(
          std::min(0.5, bevel_length(params.needle.outer_diameter) / params.needle.length)),
      own_(params.needle, params.liquid.viscosity, params.liquid.density, params.entry_loss),
      spaces_(std::move(spaces)) {
  ARTUS_REQUIRE(dt > 0 && dt <= 0.01, "the period must be above 0 and at most 0.01 s");
  ARTUS_REQUIRE(!spaces_.empty(), "there must be a space");
  ARTUS_REQUIRE(params.syringe.softness() > 0 && area_ > 0, "a barrel has an area and gives way");
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
      // What leaks lies under what pressed on the place, and has to part it.
      leaks_.push_back({k, around, space.law.rest + kAround, params_.lost_resistance, true});
    }
  }
  reset();
}

void Plunger::reset() noexcept {
  std::fill(states_.begin(), states_.end(), SpaceState{});
  state_ = {};
  flows_ = {};
  state_.content = params_.syringe.filled;
  direction_ = 0;
  started_ = false;
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
  // A tear takes the tension of the walls, not what presses on them from outside.
  const double rest = spaces_[space].law.rest;
  return s.ruptured ? rest + kAfterTear * (p - rest) : p;
}

/// Pa/m^3 by which the pressure rises with what is put in, as long as nothing relaxes; a split's
/// falls.
double Plunger::rise(std::size_t space) const noexcept {
  const SpaceState& s = states_[space];
  const SpaceLaw& law = spaces_[space].law;
  const double slope = slope_of(law, s.volume - s.drawn) * (1 + law.relaxing);
  return s.ruptured ? kAfterTear * slope : slope;
}

void Plunger::open(const TipShare& tip, double depth) noexcept {
  SpaceState& s = states_[tip.space];
  s.open = true;
  s.open_depth = depth;
  s.idle = 0;
}

/// Closes what the tip has left; what needs no pressure opens at once.
void Plunger::meet_places(const PlungerInput& input) noexcept {
  for (const TipShare& tip : input.tip) {
    if (!(tip.share > 0)) continue;
    SpaceState& s = states_[tip.space];
    const SpaceLaw& law = spaces_[tip.space].law;
    const bool left = std::abs(input.depth - s.open_depth) > params_.reopen_distance;
    s.idle += dt_;
    if (s.open && (left || s.idle > params_.reopen_time)) s.open = false;
    if (!s.open && law.kind != SpaceKind::solid && !(law.opening > 0)) open(tip, input.depth);
  }
}

/// Of what is shut the place that gives way most easily. Another one opens later, when the pressure
/// inside the bevel is still enough for it.
Plunger::Shut Plunger::easiest(const PlungerInput& input, double pressure) const noexcept {
  Shut shut;
  for (const TipShare& tip : input.tip) {
    const SpaceState& s = states_[tip.space];
    const SpaceLaw& law = spaces_[tip.space].law;
    if (!(tip.share > 0) || s.open || law.kind == SpaceKind::solid) continue;
    const double over = pressure - opening_of(law, s.volume - s.drawn) - s.relaxing;
    if (shut.tip == nullptr || over > shut.over) shut = {&tip, over};
  }
  return shut;
}

/// What a place gives back: what was put in, otherwise its own contents; null: nothing.
const NeedleFlow* Plunger::flow_in(const TipShare& tip) const noexcept {
  const SpaceState& s = states_[tip.space];
  if (s.volume > 0) return &own_;
  const auto contents = contents_[tip.space];
  if (contents < 0 || s.drawn >= spaces_[tip.space].law.contents) return nullptr;
  return &others_[static_cast<std::size_t>(contents)];
}

/// A place meets what is half a step later: its pressure by what flows in it, the gap of its film
/// by what flowed into it until now.
Plunger::Branch Plunger::branch(const PlungerInput& input, std::size_t which, double step,
                                bool out) const noexcept {
  const TipShare& tip = input.tip[which];
  const SpaceState& s = states_[tip.space];
  if (!s.open || !(tip.share > 0)) return {};
  const SpaceLaw& law = spaces_[tip.space].law;
  const bool stays = law.kind == SpaceKind::split && !is_washed(spaces_[tip.space]);
  if (!out && (stays || flow_in(tip) == nullptr)) return {};
  const double volume = s.volume - s.drawn;
  const double near = bevel_share_ * own_.resistance() + law.resistance +
                      film_resistance(law, volume + step / 2 * flows_[which],
                                      params_.liquid.viscosity.at(kFilmRate));
  // Never so much that the bore would seem to help.
  const double min = -kMaxFall * bevel_share_ * own_.resistance();
  if (!out && is_washed(spaces_[tip.space]))
    return {true, springs_back(pressure(tip.space), volume, law.contents), near / tip.share};
  return {true, pressure(tip.space), near / tip.share + std::max(min, step * rise(tip.space) / 2)};
}

/// The bore ends in both branches; one against whose pressure nothing flows takes no part.
Plunger::BevelFlow Plunger::part(const PlungerInput& input, const Drive& drive,
                                 bool out) const noexcept {
  const double direction = out ? 1 : -1;
  std::array<Branch, 2> branches{branch(input, 0, drive.step, out),
                                 branch(input, 1, drive.step, out)};
  for (Branch& b : branches) b.open = b.open && direction * (drive.pressure - b.pressure) > 0;
  const std::size_t first = branches[0].open ? 0 : 1;
  BevelFlow bevel_flow;
  bevel_flow.pressure = drive.pressure;
  if (!branches[first].open) return bevel_flow;
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
    const double extra =
        std::max(-kMaxFall * in_bevel, 1 / conductance - in_bevel) + clogged + drive.lag;
    const double q = bore.flow(drive.pressure - behind, extra);
    bevel_flow.pressure = behind + q / conductance;
    bool all = true;
    for (std::size_t k = 0; k < 2; ++k) {
      const Branch& b = branches[k];
      bevel_flow.flows[k] = b.open ? (bevel_flow.pressure - b.pressure) / b.resistance : 0;
      all = all && direction * bevel_flow.flows[k] >= 0;
    }
    if (all) return bevel_flow;
    for (std::size_t k = 0; k < 2; ++k)
      if (direction * bevel_flow.flows[k] < 0) branches[k].open = false;
  }
}

Plunger::BevelFlow Plunger::flow_out(const PlungerInput& input, const Drive& drive) const noexcept {
  BevelFlow bevel_flow = part(input, drive, true);
  if (bevel_flow.flows[0] == 0 && bevel_flow.flows[1] == 0) bevel_flow = part(input, drive, false);
  return bevel_flow;
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

/// What was put in comes out first, then the place's own; what is washed comes out mixed.
void Plunger::take_out(std::size_t space, double volume) noexcept {
  SpaceState& s = states_[space];
  double own = std::max(0.0, volume - s.volume);
  if (is_washed(spaces_[space])) {
    const double left = std::max(0.0, spaces_[space].law.contents - s.drawn);
    own = std::max(own, volume * left / std::max(left + s.volume, volume));
  }
  change_volume(space, own - volume);
  s.drawn += own;
  state_.drawn += own;
}

/// False when nothing did.
bool Plunger::leak(const PlungerInput& input, double step) noexcept {
  bool any = false;
  const auto pass = [&](const Leak& leak) {
    const SpaceState& from = states_[leak.from];
    if (leak.by_rupture && !from.ruptured) return;
    const double dp = pressure(leak.from) - pressure(leak.to) - leak.opening;
    if (!(dp > 0) || !(from.volume > 0)) return;
    const double slope = std::max(0.0, rise(leak.from)) + std::max(0.0, rise(leak.to));
    const double volume = std::min(dp / (leak.resistance + 0.5 * step * slope) * step, from.volume);
    any = true;
    change_volume(leak.from, -volume);
    change_volume(leak.to, volume);
  };
  for (const Leak& l : leaks_) pass(l);
  const auto around = static_cast<std::uint32_t>(spaces_.size() - 1);
  for (const TipShare& tip : input.tip)
    if (tip.share > 0 && spaces_[tip.space].law.kind == SpaceKind::cavity)
      pass({tip.space, around, params_.grip, params_.track_resistance, false});
  return any;
}

/// Grains settle in a thin bore while nothing moves.
void Plunger::clog() noexcept {
  const bool may = params_.liquid.solids > 0 && params_.needle.diameter <= kWidestClogged;
  const bool settled = may && rest_time_ > clog_after_;
  if (clogging_ > 0 || settled) clogging_ = std::min(1.0, clogging_ + dt_ / kClogTime);
}

}  // namespace artus
