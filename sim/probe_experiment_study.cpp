// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "sim/probe_experiment_list.h"

namespace artus {
namespace {

constexpr double kStiffness = 1000;  // N/m, a soft limb
/// The published cylinder, and one with a low-friction seal (assumed).
constexpr std::array<double, 2> kDryFrictions{5.2, 0.5};  // N
constexpr std::array<ControlLawKind, 4> kLaws{
    ControlLawKind::admittance_pid, ControlLawKind::admittance_ipc,
    ControlLawKind::backstepping_one_valve, ControlLawKind::backstepping_two_valves};

/// The results of one law; the study's row.
struct LawResult {
  ControlLawKind law{};
  double dry_friction = 0;       // N, of the cylinder
  double step_settling = 0;      // s
  double step_error = 0;         // m
  double slope = 0;              // N/m, loading
  double hysteresis = 0;         // N, between loading and unloading at half way
  double render_error = 0;       // share, rms force error of a pressing hand
  double release_overshoot = 0;  // m beyond x_0
  double release_settling = 0;   // s
  double noise_travel = 0;       // V/s at four times the noise
  double lost_speed = 0;         // m/s, fastest after that
  double lost_excursion = 0;     // m the rod moves after the force sensor is lost
  std::uint32_t lost_status = 0;
  double drop_error = 0;  // m, at 3 bar
};

ProbeScenario make_scenario(const LawResult& r, double duration, std::uint64_t seed) {
  ProbeScenario s;
  s.law = r.law;
  s.plant.cylinder.dry_friction = r.dry_friction;
  s.duration = duration;
  s.seed = seed;
  s.target = [](double) {
    ProbeTarget target;
    target.stiffness = kStiffness;
    return target;
  };
  return s;
}

/// A hand on the rod's head: a spring and damper to where it wants to be; it can only push.
/// Stiffness and damping assumed: order of a relaxed grip.
struct Hand {
  double stiffness = 500;  // N/m
  double damping = 5;      // N s/m
  [[nodiscard]] double force(double wanted, double wanted_speed,
                             const CylinderState& s) const noexcept {
    return std::max(0.0, stiffness * (wanted + s.y) + damping * (wanted_speed + s.v));
  }
};

RodLoad pushed(double force) {
  RodLoad load;
  load.force = force;
  return load;
}

/// 6 N, 10 N, 6 N, 0 N in steps: settling of the last 10 N step and its error.
void measure_load_steps(LawResult& r, std::uint64_t seed, std::vector<ProbeRow>& rows) {
  ProbeScenario s = make_scenario(r, 8, seed);
  s.load = [](double t, const CylinderState&) {
    return pushed(t < 1 ? 0 : t < 3 ? 6 : t < 5 ? 10 : t < 7 ? 6 : 0);
  };
  rows = run_probe_scenario(s);
  const double end = measure_window(rows, 4.8, 5).mean_error;
  double final_y = 0;
  for (const ProbeRow& row : rows) {
    if (row.time < 5) final_y = row.y;
  }
  double last = 3;
  for (const ProbeRow& row : rows) {
    if (row.time >= 3 && row.time < 5 && std::abs(row.y - final_y) > 0.2e-3) last = row.time;
  }
  r.step_settling = last - 3;
  r.step_error = end;
}

/// A quasi-static push to 14 N and back: slope while loading, width of the loop.
void measure_push(LawResult& r, std::uint64_t seed, std::vector<ProbeRow>& rows) {
  constexpr double kTop = 14;
  constexpr double kRise = 10;
  ProbeScenario s = make_scenario(r, 0.5 + 2 * kRise, seed);
  s.load = [](double t, const CylinderState&) {
    const double u = std::max(0.0, t - 0.5);
    return pushed(kTop * (u < kRise ? u / kRise : std::max(0.0, 2 - u / kRise)));
  };
  rows = run_probe_scenario(s);
  double n = 0;
  double x_mean = 0;
  double f_mean = 0;
  for (const bool second : {false, true}) {
    double xx = 0;
    double xf = 0;
    for (const ProbeRow& row : rows) {
      if (row.time > 0.5 + kRise || row.force < 7) continue;
      if (second) {
        xx += (row.y - x_mean) * (row.y - x_mean);
        xf += (row.y - x_mean) * (row.force - f_mean);
      } else {
        n += 1;
        x_mean += (row.y - x_mean) / n;
        f_mean += (row.force - f_mean) / n;
      }
    }
    if (second) r.slope = -xf / xx;
  }
  // The force at which the rod is half way, going in and coming out.
  const double deepest =
      std::min_element(rows.begin(), rows.end(), [](const ProbeRow& a, const ProbeRow& b) {
        return a.y < b.y;
      })->y;
  double in = 0;
  double out = 0;
  for (const ProbeRow& row : rows) {
    if (row.time <= 0.5 + kRise && row.y > deepest / 2) in = row.force;
    if (row.time > 0.5 + kRise && row.y < deepest / 2) out = row.force;
  }
  r.hysteresis = in - out;
}

/// A hand presses 0 to 20 mm deep at 0.5 Hz: rms of F - K (x_0 - y) over the rms of F.
void measure_rendering(LawResult& r, std::uint64_t seed) {
  ProbeScenario s = make_scenario(r, 7, seed);
  const Hand hand;
  s.load = [hand](double t, const CylinderState& state) {
    constexpr double kRate = 3.14159265358979;
    const double wanted = 0.01 * (1 - std::cos(kRate * t));
    return pushed(hand.force(wanted, 0.01 * kRate * std::sin(kRate * t), state));
  };
  double wrong = 0;
  double all = 0;
  for (const ProbeRow& row : run_probe_scenario(s)) {
    if (row.time < 1) continue;
    const double error = row.force - kStiffness * (row.rest - row.y);
    wrong += error * error;
    all += row.force * row.force;
  }
  r.render_error = std::sqrt(wrong / all);
}

/// A hand holds the rod 20 mm in and lets go at 3 s.
void measure_release(LawResult& r, std::uint64_t seed, std::vector<ProbeRow>& rows) {
  ProbeScenario s = make_scenario(r, 6, seed);
  const Hand hand;
  s.load = [hand](double t, const CylinderState& state) {
    return pushed(t < 3 ? hand.force(0.03 * std::min(1.0, t), t < 1 ? 0.03 : 0, state) : 0);
  };
  rows = run_probe_scenario(s);
  double last = 3;
  const double end = rows.back().y;
  for (const ProbeRow& row : rows) {
    if (row.time < 3) continue;
    r.release_overshoot = std::max(r.release_overshoot, row.y - row.rest);
    if (std::abs(row.y - end) > 0.2e-3) last = row.time;
  }
  r.release_settling = last - 3;
}

void measure_noise(LawResult& r, std::uint64_t seed) {
  ProbeScenario s = make_scenario(r, 3, seed);
  s.noise = 4;
  s.load = [](double t, const CylinderState&) {
    return pushed(t > 0.5 ? 8 : 0);
  };
  r.noise_travel = measure_window(run_probe_scenario(s), 2, 3).voltage_travel;
}

void measure_lost_sensor(LawResult& r, std::uint64_t seed) {
  ProbeScenario s = make_scenario(r, 4, seed);
  s.load = [](double t, const CylinderState&) {
    return pushed(t > 0.5 ? 8 : 0);
  };
  s.disturb = [](double t, PneumaticPlant&, ProbeSensors& sensors) {
    if (t >= 2) sensors.set_fault(ProbeSensor::force, SensorFault::lost);
  };
  double before = 0;
  for (const ProbeRow& row : run_probe_scenario(s)) {
    if (row.time < 2) {
      before = row.y;
    } else {
      r.lost_excursion = std::max(r.lost_excursion, std::abs(row.y - before));
      r.lost_speed = std::max(r.lost_speed, std::abs(row.v));
      r.lost_status |= row.status & ControlStatus::kFaults;
    }
  }
}

void measure_supply_drop(LawResult& r, std::uint64_t seed) {
  ProbeScenario s = make_scenario(r, 5, seed);
  s.load = [](double t, const CylinderState&) {
    return pushed(t > 0.5 ? 10 : 0);
  };
  s.disturb = [](double t, PneumaticPlant& plant, ProbeSensors&) {
    plant.set_supply(t < 2 ? 4e5 : 3e5);
  };
  r.drop_error = measure_window(run_probe_scenario(s), 4, 5).mean_error;
}

PlotSeries push_curve(const std::vector<ProbeRow>& rows, const std::string& label) {
  PlotSeries series;
  series.label = label;
  for (const ProbeRow& row : rows) {
    series.x.push_back(-1e3 * row.y);
    series.y.push_back(row.force);
  }
  return series;
}

std::vector<std::string> make_cells(const LawResult& r) {
  return {to_string(r.law),
          fixed(r.dry_friction, 1),
          fixed(r.slope, 0),
          fixed(r.hysteresis, 2),
          fixed(100 * r.render_error, 1),
          fixed(1e3 * r.step_error, 2),
          fixed(r.step_settling, 2),
          fixed(1e3 * r.release_overshoot, 2),
          fixed(r.release_settling, 2),
          fixed(r.noise_travel, 1),
          fixed(1e3 * r.lost_excursion, 2) + (r.lost_status != 0 ? " (valve centred)" : ""),
          fixed(1e3 * r.drop_error, 2)};
}

}  // namespace

ProbeExperiment run_probe_study(std::uint64_t seed) {
  ProbeExperiment e;
  e.name = "probe-study";
  e.title =
      "Which law renders tissue best? Every law that renders a stiffness, at 1000 N/m, with the "
      "published dry friction and with little, under load "
      "steps, a slow push, a pressing hand, a hand that lets go, four times the sensor noise, loss "
      "of the force sensor, and supply falling from 4 to 3 bar.";
  e.table.header = {"law",
                    "dry friction (N)",
                    "slope of a slow push (N/m)",
                    "hysteresis (N)",
                    "rms force error, pressing hand (%)",
                    "error under 10 N (mm)",
                    "settling of a 4 N step (s)",
                    "overshoot after release (mm)",
                    "settling after release (s)",
                    "voltage travel at 4x noise (V/s)",
                    "way after force sensor loss (mm)",
                    "error at 3 bar (mm)"};
  Plot push{
      "probe-study: slow push at 1000 N/m", {{"rod pushed in (mm)", "force (N)", {}}}, 1200, 600};
  Plot release{
      "probe-study: the hand lets go at 3 s", {{"time (s)", "position (mm)", {}}}, 1200, 420};
  Plot steps{
      "probe-study: load steps 6, 10, 6, 0 N", {{"time (s)", "position (mm)", {}}}, 1200, 420};
  const auto position = [](const ProbeRow& row) {
    return 1e3 * row.y;
  };
  for (const double friction : kDryFrictions) {
    for (const ControlLawKind law : kLaws) {
      LawResult r;
      r.law = law;
      r.dry_friction = friction;
      const std::string label = std::string(to_string(law)) + ", " + fixed(friction, 1) + " N";
      std::vector<ProbeRow> rows;
      measure_load_steps(r, seed, rows);
      steps.panels[0].series.push_back(plot_probe_rows(rows, label, position));
      measure_push(r, seed, rows);
      push.panels[0].series.push_back(push_curve(rows, label));
      measure_release(r, seed, rows);
      release.panels[0].series.push_back(plot_probe_rows(rows, label, position));
      measure_rendering(r, seed);
      measure_noise(r, seed);
      measure_lost_sensor(r, seed);
      measure_supply_drop(r, seed);
      e.table.rows.push_back(make_cells(r));
      if (!needs_force_sensor(law)) {
        e.claims.push_back(
            claim_near(label + ": slope of a slow push", r.slope, kStiffness, 0.05, "N/m"));
      }
      e.claims.push_back(claim_at_most(label + ": speed after loss of the force sensor",
                                       r.lost_speed, 0.2, "m/s"));
    }
  }
  PlotSeries ideal{"ideal spring", {0, 14}, {0, 14}};
  push.panels[0].series.push_back(ideal);
  e.plots = {{"probe-study-push.png", push},
             {"probe-study-release.png", release},
             {"probe-study-steps.png", steps}};
  return e;
}

}  // namespace artus
