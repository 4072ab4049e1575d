// SPDX-License-Identifier: AGPL-3.0-or-later
// A tick of the plunger: the thumb's force runs straight from what it was to what it is, and what
// happens on the way - the stopper breaks loose or comes to rest, a place opens - does so at its
// own instant. So a tick's length hardly matters.
#include <algorithm>
#include <cmath>
#include <limits>

#include "artus/detail/haptics/plunger/plunger.h"
#include "artus/detail/haptics/plunger/space_pressure.h"

namespace artus {
namespace {

constexpr double kVacuum = -90e3;  // Pa, below which a liquid is not drawn
constexpr double kStill = 1e-12;   // m^3/s
constexpr int kMaxEvents = 6;      // in a tick that are met at their instant

/// Of a step in which a number rises from `from` to `to`, where it is 0; 1 when nowhere.
double crossing(double from, double to) noexcept {
  return from < 0 && to > 0 ? from / (from - to) : 1;
}

/// Of a step that would have the mean speed `now`, where the speed has come to 0: it falls from the
/// middle of the last step to the middle of this one.
template <class StopperMotion>
double stopping(const StopperMotion& last, const StopperMotion& now) noexcept {
  if (!(last.speed > now.speed)) return 0;
  const double between = (last.step + now.step) / 2;
  const double at = between * last.speed / (last.speed - now.speed) - last.step / 2;
  return std::clamp(at / now.step, 0.0, 1.0);
}

}  // namespace

/// Where in a step the flow is taken: in the middle, which is exact to the second order, unless the
/// barrel empties within the step; then as late as keeps it from swinging.
double Plunger::instant(double slope, double step) const noexcept {
  return std::max(0.5, 1 - own_.resistance() / (slope * step));
}

/// Pa in the barrel once `volume` m^3 more are squeezed into it.
double Plunger::pressed(double volume) const noexcept {
  const Syringe& syringe = params_.syringe;
  if (syringe.air == 0) return state_.pressure + volume / syringe.compliance;
  return syringe.pressure_of(syringe.squeezed(state_.pressure) + volume);
}

/// m^3 more that it takes at another pressure.
double Plunger::taken(double pressure) const noexcept {
  const Syringe& syringe = params_.syringe;
  if (syringe.air == 0) return syringe.compliance * (pressure - state_.pressure);
  return syringe.squeezed(pressure) - syringe.squeezed(state_.pressure);
}

/// m^3/Pa now.
double Plunger::softness() const noexcept {
  return params_.syringe.softness(state_.pressure);
}

/// Pa in the barrel of a gliding stopper but for what flows: the thumb's spring beside the
/// barrel's. Without a spring the pressure is what the thumb's force leaves.
double Plunger::gliding(double thumb, double stiffness) const noexcept {
  const double net = thumb - direction_ * params_.syringe.glide;
  const double soft = stiffness * softness() / area_;  // m^2
  return (net + soft * state_.pressure) / (area_ + soft);
}

/// The stopper's mean speed in the direction it goes; not above 0: then it sticks, and nothing has
/// changed.
double Plunger::glide(const PlungerInput& input, const Push& push) noexcept {
  const double soft = push.stiffness * softness() / area_;
  const double slope = push.stiffness / (area_ * (area_ + soft));  // Pa/m^3 that is out
  const double at = slope > 0 ? instant(slope, push.step) : 0.5;
  const Drive drive{gliding(push.from + at * (push.to - push.from), push.stiffness),
                    at * slope * push.step, push.step};
  const BevelFlow bevel_flow = flow_out(input, drive);
  const double out = (bevel_flow.flows[0] + bevel_flow.flows[1]) * push.step;
  double next = gliding(push.to, push.stiffness) - slope * out;
  double dx = (taken(next) + out) / area_;
  const double speed = dx * direction_ / push.step;
  if (!(speed > 0)) return speed;
  const double x = std::clamp(state_.travel + dx, out_end_, in_end_);
  if (x != state_.travel + dx) {
    dx = x - state_.travel;
    next = pressed(area_ * dx - out);
    direction_ = 0;
  }
  state_.travel = x;
  state_.pressure = next;
  take_flows(input, bevel_flow, push.step);
  return speed;
}

void Plunger::rest(const PlungerInput& input, double step) noexcept {
  direction_ = 0;
  const double soft = softness();
  const double lag = instant(1 / soft, step) * step / soft;
  const BevelFlow bevel_flow = flow_out(input, {state_.pressure, lag, step});
  state_.pressure = pressed(-(bevel_flow.flows[0] + bevel_flow.flows[1]) * step);
  take_flows(input, bevel_flow, step);
}

void Plunger::move(const PlungerInput& input, const Push& push) noexcept {
  motion_ = {direction_ == 0 ? 0 : glide(input, push), push.step};
  if (!(motion_.speed > 0)) rest(input, push.step);
  meet(input);
}

/// What flows now.
void Plunger::meet(const PlungerInput& input) noexcept {
  const BevelFlow now = flow_out(input, {state_.pressure, 0, 0});
  flows_ = now.flows;
  state_.flow = now.flows[0] + now.flows[1];
  state_.bevel_pressure = state_.flow == 0 ? state_.pressure : now.pressure;
}

/// The direction in which a resting stopper breaks loose under a net force on it (N); 0: it holds.
int Plunger::breaks_loose(double net) const noexcept {
  if (net > hold_ && state_.travel < in_end_) return 1;
  return -net > hold_ && state_.travel > out_end_ ? -1 : 0;
}

/// The stopper has no mass: it jumps to where the barrel carries what the friction no longer does.
void Plunger::break_loose(int direction, double thumb, double stiffness) noexcept {
  direction_ = direction;
  const double pressure = gliding(thumb, stiffness);
  const double dx = taken(pressure) / area_;
  const double x = std::clamp(state_.travel + dx, out_end_, in_end_);
  state_.pressure = pressed(area_ * (x - state_.travel));
  state_.travel = x;
  motion_ = {};
  if (state_.flow == 0) state_.bevel_pressure = state_.pressure;
}

/// One step up to the first thing that happens in it; gives the share of it that is done.
double Plunger::move_to_event(const PlungerInput& input, const Push& push) noexcept {
  const double net = push.from - area_ * state_.pressure;
  if (const int direction = direction_ == 0 ? breaks_loose(net) : 0; direction != 0) {
    break_loose(direction, push.from, push.stiffness);
    return 0;
  }
  const Before before{state_,
                      {states_[input.tip[0].space], states_[input.tip[1].space]},
                      flows_,
                      direction_,
                      motion_};
  const double shut = easiest(input, state_.bevel_pressure).over;
  move(input, push);
  const double pulls = felt(push, before.state.travel) - area_ * state_.pressure;
  const int loose = before.direction == 0 ? breaks_loose(pulls) : 0;
  const bool stops = before.direction != 0 && !(motion_.speed > 0);
  const Shut opens = easiest(input, state_.bevel_pressure);
  const double opening = opens.tip != nullptr ? crossing(shut, opens.over) : 1;
  double first = stops ? stopping(before.motion, motion_) : 1;
  if (loose != 0) first = crossing(loose * net - hold_, loose * pulls - hold_);
  if (!stops && loose == 0 && opening >= 1) return 1;
  const bool parts = opening < first;
  first = std::min(first, opening);
  state_ = before.state;
  for (std::size_t k = 0; k < 2; ++k) states_[input.tip[k].space] = before.spaces[k];
  flows_ = before.flows;
  direction_ = before.direction;
  motion_ = before.motion;
  const Push some = push.part(first);
  if (first > 0) move(input, some);
  if (parts) {
    open(*opens.tip, input.depth);
  } else if (loose != 0) {
    break_loose(loose, felt(some, before.state.travel), push.stiffness);
  } else {
    direction_ = 0;
  }
  return first;
}

/// The thumb's force (N) at the end of a step that began with the stopper at `travel`.
double Plunger::felt(const Push& push, double travel) const noexcept {
  return push.to - push.stiffness * (state_.travel - travel);
}

void Plunger::take_flows(const PlungerInput& input, const BevelFlow& bevel_flow,
                         double step) noexcept {
  const std::array<double, 2>& flows = bevel_flow.flows;
  for (std::size_t k = 0; k < 2; ++k) {
    const double volume = flows[k] * step;
    const std::size_t space = input.tip[k].space;
    if (volume > 0)
      change_volume(space, volume);
    else if (volume < 0)
      take_out(space, -volume);
    if (std::abs(flows[k]) > kStill) states_[space].idle = 0;
    state_.content -= volume;
  }
}

/// A whole tick; gives the thumb's force at its end, N.
double Plunger::run(const PlungerInput& input, Push push) noexcept {
  for (int k = 0;; ++k) {
    if (const Shut shut = easiest(input, state_.bevel_pressure);
        shut.tip != nullptr && shut.over > 0 && (k == 0 || state_.flow == 0))
      open(*shut.tip, input.depth);
    const double travel = state_.travel;
    double share = 1;
    if (k < kMaxEvents)
      share = move_to_event(input, push);
    else
      move(input, push);
    if (share >= 1) return felt(push, travel);
    const double gone = push.stiffness * (state_.travel - travel);
    push.from += share * (push.to - push.from) - gone;
    push.to -= gone;
    push.step *= 1 - share;
  }
}

void Plunger::describe(const PlungerInput& input, double thumb) noexcept {
  std::uint32_t& status = state_.status;
  if (direction_ != 0) status |= PlungerStatus::kMoving;
  if (std::abs(state_.flow) > kStill) status |= PlungerStatus::kFlowing;
  if (state_.travel >= in_end_) status |= PlungerStatus::kEmpty;
  if (state_.travel <= out_end_ && params_.syringe.volume > params_.syringe.filled)
    status |= PlungerStatus::kDrawnOut;
  if (clogging_ > 0) status |= PlungerStatus::kClogged;
  if (state_.drawn > params_.syringe.dead_space) status |= PlungerStatus::kFlash;
  double by_share = 0;
  double lowest = std::numeric_limits<double>::infinity();
  for (const TipShare& tip : input.tip) {
    if (!(tip.share > 0)) continue;
    // Tissue that has not parted presses on nothing.
    const bool parted = states_[tip.space].open || states_[tip.space].volume > 0 ||
                        spaces_[tip.space].law.kind != SpaceKind::split;
    const double p = parted ? pressure(tip.space) : 0;
    by_share += tip.share * p;
    if (states_[tip.space].open) lowest = std::min(lowest, p);
    if (states_[tip.space].ruptured) status |= PlungerStatus::kRuptured;
    if (p > spaces_[tip.space].law.stop) status |= PlungerStatus::kTense;
    if (tip.space == outside_) status |= PlungerStatus::kOutside;
  }
  const bool any_open = std::isfinite(lowest);
  state_.tip_pressure = any_open ? lowest : by_share;
  if (!any_open) status |= PlungerStatus::kClosed;
  state_.force = thumb;
  state_.on_needle = params_.unbalanced * state_.force;
}

const PlungerState& Plunger::step(const PlungerInput& input) noexcept {
  PlungerInput in = input;
  state_.status = 0;
  if (!std::isfinite(in.force) || !std::isfinite(in.position) || !std::isfinite(in.stiffness) ||
      !(in.stiffness >= 0) || !std::isfinite(in.depth)) {
    in.force = in.position = in.stiffness = in.depth = 0;
    state_.status |= PlungerStatus::kNotFinite;
    started_ = false;
  }
  const double min = std::max(area_ * kVacuum - params_.syringe.glide, -params_.max_force);
  const double request = in.force + in.stiffness * (in.position - state_.travel);
  const double now = std::clamp(request, min, params_.max_force);
  const bool limited = now != request;
  if (limited) state_.status |= PlungerStatus::kLimited;
  const double age = std::log10(std::max(1.0, rest_time_));
  hold_ = params_.syringe.break_loose * (1 + params_.syringe.ageing * age);
  meet_places(in);
  // Half before and half after: exact to the second order, too.
  leak(in, dt_ / 2);
  const double thumb =
      run(in, {started_ ? state_.force : now, now, limited ? 0 : in.stiffness, dt_});
  started_ = true;
  if (leak(in, dt_ / 2)) meet(in);
  for (std::size_t k = 0; k < states_.size(); ++k) states_[k].relaxing *= fading_[k];
  rest_time_ = direction_ == 0 ? rest_time_ + dt_ : 0;
  clog();
  describe(in, thumb);
  return state_;
}

}  // namespace artus
