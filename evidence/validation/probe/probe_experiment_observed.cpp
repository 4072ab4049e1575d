// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/probe/probe_experiment_observed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "artus/detail/evidence/validation/probe/probe_experiments.h"

namespace artus {
namespace {

constexpr double kObservedEnd = PublishedTimes::kEnd;
constexpr double kPeak = PublishedTimes::kPeak;
constexpr double kPlateau = PublishedTimes::kPlateau;
constexpr double kSettle = 1.0;          // s after the load that count as its peak
constexpr double kStepWindow = 0.5;      // s after a step in which chattering is counted
constexpr double kChatter = 4;           // turns; an overshoot and its return are 2 to 3
constexpr double kAbout = 1.2;           // "about" a value: up to a fifth more
constexpr double kAboutZero = 0.5;       // mm
constexpr double kPneumaticShare = 0.1;  // of a published K_pneu

/// `published_value` as a bound or a value that `artus` may not exceed by more than to `limit`.
ProbeObservation observe_at_most(std::string what, std::string published, double published_value,
                                 double artus, double limit, std::string unit) {
  ProbeObservation o;
  o.what = std::move(what);
  o.published = std::move(published);
  o.artus = artus;
  o.unit = std::move(unit);
  o.reproduced = artus <= limit;
  o.difference = fixed(artus - published_value, 3) + " " + o.unit;
  return o;
}

ProbeObservation observe_range(std::string what, double low, double high, double artus_low,
                               double artus_high, const std::string& unit) {
  ProbeObservation o;
  o.what = std::move(what);
  o.published = fixed(low, 2) + " to " + fixed(high, 2) + " " + unit;
  o.artus = artus_high;
  o.unit = unit + " at most, " + fixed(artus_low, 2) + " at least";
  o.difference = fixed(artus_low - low, 2) + " at the low end, " + fixed(artus_high - high, 2) +
                 " at the high end";
  return o;
}

/// From the load until the error stays below 1 mm for good, or the end; s.
double settling_time(const std::vector<ProbeRow>& rows, double load_time, double until) {
  double last = load_time;
  for (const ProbeRow& row : rows) {
    if (row.time >= load_time && row.time < until && std::abs(row.error()) > 1e-3) last = row.time;
  }
  return last - load_time;
}

double position_at(const std::vector<ProbeRow>& rows, double time) {
  const auto row =
      std::find_if(rows.begin(), rows.end(), [time](const ProbeRow& r) { return r.time >= time; });
  return row == rows.end() ? rows.back().y : row->y;
}

/// The admittance laws are told the force through a filter that was set by the first of them.
ClaimBasis basis_of(std::size_t law) {
  if (law > 0) return ClaimKind::independent;
  return {ClaimKind::fitted, "the force filter of 2 Hz was chosen so that PID does not ring"};
}

void observe_isp_errors(const std::vector<ProbeTrace>& traces, std::vector<ProbeObservation>& out) {
  const auto laws = published_laws();
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const bool backstepping = i == 2;
    const auto& rows = traces[i].rows;
    const std::string label = traces[i].label;
    const double load_time = laws[i].load_time;
    const ProbeWindow moving = measure_window(rows, load_time + kSettle, kPeak);
    const ProbeWindow steady = measure_window(rows, kObservedEnd - 2, kObservedEnd);
    const double limit = backstepping ? 5 : 3;
    out.push_back(observe_at_most(label + ": largest error in the transition",
                                  "about " + fixed(limit, 0) + " mm at most", limit,
                                  1e3 * moving.largest_error, kAbout * limit, "mm"));
    out.back().basis = basis_of(i);
    out.push_back(observe_at_most(label + ": error in steady state", "about 0 mm", 0,
                                  1e3 * steady.mean_error, kAboutZero, "mm"));
    out.back().basis = basis_of(i);
  }
}

/// The rows that are not within half a second of one of the stiffness steps.
std::vector<ProbeRow> between_steps(const std::vector<ProbeRow>& rows, double load_time) {
  std::vector<ProbeRow> kept;
  for (const ProbeRow& row : rows) {
    const double place = std::max(0.0, row.time - load_time);
    const bool at_step = place >= kPlateau && place < 3 * kPlateau + kStepWindow &&
                         std::fmod(place, kPlateau) < kStepWindow;
    if (!at_step) kept.push_back(row);
  }
  return kept;
}

void observe_voltages(const std::vector<ProbeTrace>& traces, bool steps,
                      std::vector<ProbeObservation>& out) {
  const auto laws = published_laws();
  double smoothest = 1e9;
  std::string label;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const double start = laws[i].load_time + kSettle;
    const auto rows = steps ? between_steps(traces[i].rows, laws[i].load_time) : traces[i].rows;
    const ProbeWindow w = measure_window(rows, start, kObservedEnd);
    ProbeObservation o = observe_range(
        traces[i].label + ": control voltage after the first peak" + (steps ? ", off steps" : ""),
        4.4, 5.3, w.lowest_voltage, w.highest_voltage, "V");
    o.reproduced = w.lowest_voltage >= 4.4 && w.highest_voltage <= 5.3;
    o.basis = basis_of(i);
    out.push_back(std::move(o));
    const double travel = measure_window(traces[i].rows, start, kObservedEnd).voltage_travel;
    if (travel < smoothest) {
      smoothest = travel;
      label = traces[i].label;
    }
  }
  ProbeObservation o;
  o.what = "law with the smoothest voltage (least travel): " + label;
  o.published = "ipc";
  o.artus = smoothest;
  o.unit = "V/s of travel";
  o.difference = label == "ipc" ? "none" : "another law";
  o.reproduced = label == "ipc";
  o.basis = basis_of(0);
  out.push_back(std::move(o));
}

void observe_isp_motion(const std::vector<ProbeTrace>& traces, std::vector<ProbeObservation>& out) {
  const auto laws = published_laws();
  std::array<double, 3> settling{};
  double min_return = 1e9;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const auto& rows = traces[i].rows;
    settling[i] = settling_time(rows, laws[i].load_time, kPeak);
    min_return = std::min(min_return, position_at(rows, kObservedEnd - 1) -
                                          position_at(rows, laws[i].load_time + kSettle));
  }
  ProbeObservation faster;
  faster.what = "backstepping takes longer than PID and IPC to come within 1 mm of x_c";
  faster.published = "PID and IPC react faster";
  faster.artus = settling[2];
  faster.unit = "s (pid " + fixed(settling[0], 2) + " s, ipc " + fixed(settling[1], 2) + " s)";
  faster.reproduced = settling[2] > std::max(settling[0], settling[1]);
  faster.difference = fixed(settling[2] - std::max(settling[0], settling[1]), 2) +
                      " s after the slower of them; published without figures";
  faster.basis = basis_of(0);
  out.push_back(std::move(faster));

  ProbeObservation outward;
  outward.what = "the rod comes out again as the stiffness rises (least of the laws)";
  outward.published = "yes, all laws";
  outward.artus = 1e3 * min_return;
  outward.unit = "mm";
  outward.difference = "none published in figures";
  outward.reproduced = min_return > 0;
  out.push_back(std::move(outward));
}

void observe_pneumatic(const std::vector<ProbeTrace>& traces, double low, double high,
                       std::vector<ProbeObservation>& out) {
  const ProbeWindow w = measure_window(traces[2].rows, published_laws()[2].load_time, kObservedEnd);
  const auto add = [&](const char* end, double published, double artus, ClaimBasis basis) {
    ProbeObservation o;
    o.what = traces[2].label + ": " + end + " K_pneu";
    o.published = fixed(published, 0, "N/m");
    o.artus = artus;
    o.unit = "N/m";
    o.difference = fixed(artus - published, 0, "N/m");
    o.reproduced = std::abs(artus - published) <= kPneumaticShare * published;
    o.basis = std::move(basis);
    out.push_back(std::move(o));
  };
  add("lowest", low, w.lowest_pneumatic,
      {ClaimKind::fitted, "4 bar of supply were read as absolute by the 2100 N/m at rest"});
  add("highest", high, w.highest_pneumatic, ClaimKind::independent);
}

/// How often the voltage turns by more than 0.2 V within half a second of a step, mean of the
/// steps.
double turns_at_steps(const std::vector<ProbeRow>& rows, double load_time) {
  constexpr double kSwing = 0.2;  // V
  std::size_t turns = 0;
  for (int i = 1; i < 4; ++i) {
    const double t = load_time + i * kPlateau;
    double extreme = 0;
    int direction = 0;
    bool first = true;
    for (const ProbeRow& row : rows) {
      if (row.time < t || row.time >= t + kStepWindow) continue;
      if (first) extreme = row.u_P;
      first = false;
      if (direction * (row.u_P - extreme) > 0) {
        extreme = row.u_P;
      } else if (std::abs(row.u_P - extreme) > kSwing) {
        if (direction != 0) ++turns;
        direction = row.u_P > extreme ? 1 : -1;
        extreme = row.u_P;
      }
    }
  }
  return static_cast<double>(turns) / 3;
}

/// Mean error in the last second of each plateau, m.
double plateau_error(const std::vector<ProbeRow>& rows, double load_time) {
  double sum = 0;
  for (int i = 1; i <= 4; ++i) {
    const double t = load_time + i * kPlateau;
    sum += measure_window(rows, t - 1, t).mean_error;
  }
  return sum / 4;
}

void observe_ssp_errors(const std::vector<ProbeTrace>& traces, std::vector<ProbeObservation>& out) {
  const auto laws = published_laws();
  std::array<double, 3> error{};
  for (std::size_t i = 0; i < laws.size(); ++i) {
    error[i] = plateau_error(traces[i].rows, laws[i].load_time);
  }
  ProbeObservation larger;
  larger.what = "backstepping's steady-state error over that of PID and IPC";
  larger.published = "about 10 % larger";
  const double others = (error[0] + error[1]) / 2;
  larger.artus = 100 * (error[2] / others - 1);
  larger.unit = "% larger (" + fixed(1e3 * error[2], 2) + " mm against pid " +
                fixed(1e3 * error[0], 2) + ", ipc " + fixed(1e3 * error[1], 2) + " mm)";
  larger.reproduced = larger.artus > 0 && larger.artus < 30;
  larger.difference = fixed(larger.artus - 10, 0) + " percentage points";
  larger.basis = basis_of(0);
  out.push_back(std::move(larger));
}

void observe_chatter(const std::vector<ProbeTrace>& traces, std::vector<ProbeObservation>& out) {
  const auto laws = published_laws();
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const double turns = turns_at_steps(traces[i].rows, laws[i].load_time);
    const bool should = i != 2;
    ProbeObservation o;
    o.what = traces[i].label + ": turns of the voltage by more than 0.2 V after a step";
    o.published = should ? "chatters" : "does not chatter";
    o.artus = turns;
    o.unit = "turns in 0.5 s";
    o.reproduced = should == (turns > kChatter);
    o.difference =
        "published without figures; called chatter above " + fixed(kChatter, 0) + " turns";
    o.basis = basis_of(i);
    out.push_back(std::move(o));
  }
}

}  // namespace

void find_causes(const std::vector<ProbeRerun>& reruns, std::vector<ProbeObservation>& base) {
  for (std::size_t i = 0; i < base.size(); ++i) {
    if (base[i].reproduced) continue;
    std::string with;
    for (const ProbeRerun& rerun : reruns) {
      const ProbeObservation& o = rerun.observations[i];
      if (!o.reproduced) continue;
      with += (with.empty() ? "reproduced with " : "; with ") + rerun.what + ": " +
              fixed(o.artus, 2) + " " + o.unit;
    }
    if (reruns.empty())
      base[i].cause = "not looked for";
    else
      base[i].cause = with.empty() ? "none of the other values reproduces it" : with;
  }
}

std::vector<Claim> claim_observations(const std::vector<ProbeObservation>& observations) {
  std::vector<Claim> claims;
  for (const ProbeObservation& o : observations)
    claims.push_back({o.what, o.artus, "published: " + o.published, o.reproduced, o.basis});
  return claims;
}

std::array<PublishedLaw, 3> published_laws() {
  return {{{ControlLawKind::admittance_pid, "pid", 10, 500, 1000, {500, 1000, 500, 800}},
           {ControlLawKind::admittance_ipc, "ipc", 10, 500, 1000, {500, 1000, 500, 800}},
           {ControlLawKind::backstepping_one_valve,
            "backstepping",
            8.5,
            800,
            3000,
            {800, 3000, 800, 2000}}}};
}

std::vector<ProbeObservation> observe_isp(const std::vector<ProbeTrace>& traces) {
  std::vector<ProbeObservation> out;
  observe_isp_errors(traces, out);
  observe_isp_motion(traces, out);
  observe_voltages(traces, false, out);
  observe_pneumatic(traces, 2100, 3300, out);
  return out;
}

std::vector<ProbeObservation> observe_ssp(const std::vector<ProbeTrace>& traces) {
  std::vector<ProbeObservation> out;
  observe_ssp_errors(traces, out);
  observe_chatter(traces, out);
  observe_voltages(traces, true, out);
  observe_pneumatic(traces, 2100, 2450, out);
  return out;
}

}  // namespace artus
