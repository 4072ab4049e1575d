// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/syringe_course.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

constexpr double kFlows = 1e-9;    // m^3/s above which liquid flows
constexpr double kDose = 1e-8;     // m^3
constexpr double kPause = 2;       // s
constexpr double kSuction = -5e3;  // Pa
constexpr double kAspiration = 2;  // s
constexpr double kPressed = 0.2;   // N below which nobody presses

}  // namespace

SyringeCourse::SyringeCourse(std::size_t max_doses) {
  doses_.reserve(max_doses);
}

RegionId SyringeCourse::place_of(const SyringeTick& tick) const noexcept {
  RegionId place = tick.region;
  double most = 0;
  for (const SyringeTick::Held& now : tick.held) {
    double before = 0;
    for (const SyringeTick::Held& was : last_.held)
      if (was.volume > 0 && was.region == now.region) before = was.volume;
    if (now.volume - before <= most) continue;
    most = now.volume - before;
    place = now.region;
  }
  return place;
}

void SyringeCourse::give(const SyringeTick& tick, double volume) noexcept {
  sum_.given += volume;
  const RegionId place = place_of(tick);
  const bool anew =
      doses_.empty() || doses_.back().volume >= kDose || doses_.back().region != place;
  if (anew && doses_.size() < doses_.capacity()) doses_.push_back({0, place, tick.tip});
  if (doses_.empty()) return;
  doses_.back().volume += volume;
  doses_.back().tip = tick.tip;
  doses_.back().time = tick.time;
}

void SyringeCourse::add(const SyringeTick& tick) noexcept {
  if (!started_) {
    started_ = true;
    last_ = tick;
    return;
  }
  const bool flows = tick.flow > kFlows;
  if (flows && !flows_) {
    flow_began_ = tick.tip;
    if (sum_.flowing > 0 && tick.time - flow_ended_ >= kPause) {
      if (sum_.pauses == 0) sum_.test_dose = sum_.given;
      ++sum_.pauses;
    }
  }
  if (!flows && flows_) flow_ended_ = tick.time;
  flows_ = flows;
  if (flows) {
    sum_.flowing += tick.time - last_.time;
    sum_.tip_drift = std::max(sum_.tip_drift, (tick.tip - flow_began_).norm());
  }
  const bool sucks = tick.pressure < kSuction;
  if (sucks && !sucks_) {
    suction_began_ = tick.time;
    counted_ = false;
  }
  sucks_ = sucks;
  if (sucks && !counted_ && tick.time - suction_began_ >= kAspiration) {
    counted_ = true;
    if (sum_.given < kDose) sum_.aspirated_first = true;
    ++sum_.aspirations;
  }
  if (tick.given > last_.given) give(tick, tick.given - last_.given);
  if (tick.flow > sum_.peak_flow) sum_.peak_flow_time = tick.time;
  if (tick.pressure > sum_.peak_pressure) sum_.peak_pressure_time = tick.time;
  sum_.peak_flow = std::max(sum_.peak_flow, tick.flow);
  sum_.peak_thumb = std::max(sum_.peak_thumb, tick.thumb);
  sum_.peak_pressure = std::max(sum_.peak_pressure, tick.pressure);
  const bool busy = flows || sucks || std::abs(tick.thumb) > kPressed;
  if (busy) sum_.busy += tick.time - last_.time;
  sum_.used = sum_.used || busy;
  last_ = tick;
}

}  // namespace artus
