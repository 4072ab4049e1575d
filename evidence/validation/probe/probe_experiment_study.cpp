// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/evidence/validation/probe/probe_experiments.h"
#include "artus/detail/haptics/probe/probe_contact.h"

namespace artus {
namespace {

constexpr double kStiffness = 1000;  // N/m, a soft limb
/// Stiffnesses that a pressing hand is given, N/m: the least and most of the published profiles,
/// softer, and harder.
constexpr std::array<double, 6> kStiffnesses{200, 500, 1000, 3000, 8000, 20000};
/// The published cylinder, and one with a low-friction seal (assumed).
constexpr std::array<double, 2> kDryFrictions{5.2, 0.5};  // N
constexpr std::array<ControlLawKind, 4> kLaws{
    ControlLawKind::admittance_pid, ControlLawKind::admittance_ipc,
    ControlLawKind::backstepping_one_valve, ControlLawKind::backstepping_two_valves};

/// What lies under the probe: layers down to bone, moduli of meshes/tissues.toml.
struct TissueCase {
  const char* name = "";
  std::array<ColumnLayer, 3> layers;  // skin, fat, muscle
};
constexpr std::array<TissueCase, 2> kTissues{
    {{"soft limb", {{{2e-3, 150e3}, {8e-3, 3e3}, {20e-3, 15e3}}}},
     {"over bone", {{{2e-3, 150e3}, {1e-3, 3e3}, {0, 15e3}}}}}};

/// Force of the whole face pressed into the tissue, N.
double tissue_force(const TissueCase& tissue, double indentation) {
  const ProbeFootprint face;
  return compress_column({}, tissue.layers, indentation).pressure * face.length * face.width;
}

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
  double drop_error = 0;                                   // m, at 3 bar
  std::array<double, kStiffnesses.size()> spring_error{};  // share, as render_error
  std::array<double, kTissues.size()> tissue_error{};      // share, rms against the tissue's force
};

ProbeScenario make_scenario(const LawResult& r, double duration,
                            const ProbeExperimentOptions& options) {
  ProbeScenario s;
  s.law = r.law;
  s.plant = options.mock;
  s.plant.cylinder.dry_friction = r.dry_friction;
  s.duration = duration;
  s.seed = options.seed;
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
void measure_load_steps(LawResult& r, const ProbeExperimentOptions& options,
                        std::vector<ProbeRow>& rows) {
  ProbeScenario s = make_scenario(r, 8, options);
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
void measure_push(LawResult& r, const ProbeExperimentOptions& options,
                  std::vector<ProbeRow>& rows) {
  constexpr double kTop = 14;
  constexpr double kRise = 10;
  ProbeScenario s = make_scenario(r, 0.5 + 2 * kRise, options);
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

/// A hand presses 0 to 20 mm deep at 0.5 Hz; the rms of what it feels too much or too little over
/// the rms of what it feels. `ideal`: the wanted force at a displacement into the shell, m.
template <class F>
double measure_pressing(ProbeScenario& s, F ideal) {
  const Hand hand;
  s.load = [hand](double t, const CylinderState& state) {
    constexpr double kRate = std::numbers::pi;
    const double wanted = 0.01 * (1 - std::cos(kRate * t));
    return pushed(hand.force(wanted, 0.01 * kRate * std::sin(kRate * t), state));
  };
  double wrong = 0;
  double all = 0;
  for (const ProbeRow& row : run_probe_scenario(s)) {
    if (row.time < 1) continue;
    const double error = row.force - ideal(row.rest - row.y);
    wrong += error * error;
    all += row.force * row.force;
  }
  return std::sqrt(wrong / all);
}

/// Springs from soft to hard under the pressing hand.
void measure_springs(LawResult& r, const ProbeExperimentOptions& options) {
  for (std::size_t i = 0; i < kStiffnesses.size(); ++i) {
    const double stiffness = kStiffnesses[i];
    ProbeScenario s = make_scenario(r, 5, options);
    s.stiffness = [stiffness](double) {
      return stiffness;
    };
    r.spring_error[i] = measure_pressing(s, [stiffness](double d) { return stiffness * d; });
    if (stiffness == kStiffness) r.render_error = r.spring_error[i];
  }
}

/// Tissue under the pressing hand: the law is asked for the secant stiffness of where the rod is.
void measure_tissues(LawResult& r, const ProbeExperimentOptions& options) {
  for (std::size_t i = 0; i < kTissues.size(); ++i) {
    const TissueCase& tissue = kTissues[i];
    ProbeScenario s = make_scenario(r, 5, options);
    s.stiffness = [&tissue](double y) {
      constexpr double kMin = 1e-4;  // m, below which the secant is that of this depth
      const double d = std::max(kMin, -y);
      return tissue_force(tissue, d) / d;
    };
    r.tissue_error[i] =
        measure_pressing(s, [&tissue](double d) { return tissue_force(tissue, std::max(0.0, d)); });
  }
}

/// A hand holds the rod 20 mm in and lets go at 3 s.
void measure_release(LawResult& r, const ProbeExperimentOptions& options,
                     std::vector<ProbeRow>& rows) {
  ProbeScenario s = make_scenario(r, 6, options);
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

void measure_noise(LawResult& r, const ProbeExperimentOptions& options) {
  ProbeScenario s = make_scenario(r, 3, options);
  s.noise = 4;
  s.load = [](double t, const CylinderState&) {
    return pushed(t > 0.5 ? 8 : 0);
  };
  r.noise_travel = measure_window(run_probe_scenario(s), 2, 3).voltage_travel;
}

void measure_lost_sensor(LawResult& r, const ProbeExperimentOptions& options) {
  ProbeScenario s = make_scenario(r, 4, options);
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

void measure_supply_drop(LawResult& r, const ProbeExperimentOptions& options) {
  ProbeScenario s = make_scenario(r, 5, options);
  s.load = [](double t, const CylinderState&) {
    return pushed(t > 0.5 ? 10 : 0);
  };
  s.disturb = [](double t, PneumaticPlant& plant, ProbeSensors&) {
    plant.set_supply(t < 2 ? 4e5 : 3e5);
  };
  r.drop_error = measure_window(run_probe_scenario(s), 4, 5).mean_error;
}

std::string percent(double share) {
  return fixed(100 * share, 1);
}

std::vector<std::string> disturbance_cells(const LawResult& r) {
  return {to_string(r.law),
          fixed(r.dry_friction, 1),
          fixed(r.slope, 0),
          fixed(r.hysteresis, 2),
          percent(r.render_error),
          fixed(1e3 * r.step_error, 2),
          fixed(r.step_settling, 2),
          fixed(1e3 * r.release_overshoot, 2),
          fixed(r.release_settling, 2),
          fixed(r.noise_travel, 1),
          fixed(1e3 * r.lost_excursion, 2) + (r.lost_status != 0 ? " (valve centred)" : ""),
          fixed(1e3 * r.drop_error, 2)};
}

std::vector<std::string> rendering_cells(const LawResult& r) {
  std::vector<std::string> cells{to_string(r.law), fixed(r.dry_friction, 1)};
  for (const double error : r.spring_error) cells.push_back(percent(error));
  for (const double error : r.tissue_error) cells.push_back(percent(error));
  return cells;
}

TextTable make_disturbance_table() {
  return {{"law", "dry friction (N)", "slope of a slow push (N/m)", "hysteresis (N)",
           "rms force error, pressing hand (%)", "error under 10 N (mm)",
           "settling of a 4 N step (s)", "overshoot after release (mm)",
           "settling after release (s)", "voltage travel at 4x noise (V/s)",
           "way after force sensor loss (mm)", "error at 3 bar (mm)"},
          {}};
}

TextTable make_rendering_table() {
  TextTable table{{"law", "dry friction (N)"}, {}};
  for (const double k : kStiffnesses) table.header.push_back(fixed(k, 0) + " N/m (%)");
  for (const TissueCase& t : kTissues) table.header.push_back(std::string(t.name) + " (%)");
  return table;
}

/// The law with the least value among those of one cylinder.
template <class F>
std::string find_best(const std::vector<LawResult>& results, double friction, F value) {
  const LawResult* best = nullptr;
  for (const LawResult& r : results) {
    if (r.dry_friction == friction && (best == nullptr || value(r) < value(*best))) best = &r;
  }
  ARTUS_REQUIRE(best != nullptr, "no law was tried at this friction");
  return std::string(to_string(best->law)) + " (" + percent(value(*best)) + " %)";
}

/// The answer: the truest law for each thing under the probe, by the rms error of the felt force.
TextTable make_answer_table(const std::vector<LawResult>& results) {
  TextTable table{{"under the probe"}, {}};
  for (const double f : kDryFrictions) {
    table.header.push_back("truest law, " + fixed(f, 1) + " N of dry friction (rms force error)");
  }
  const auto add = [&](std::string what, auto value) {
    std::vector<std::string> row{std::move(what)};
    for (const double f : kDryFrictions) row.push_back(find_best(results, f, value));
    table.rows.push_back(std::move(row));
  };
  for (std::size_t i = 0; i < kStiffnesses.size(); ++i) {
    add("spring of " + fixed(kStiffnesses[i], 0) + " N/m",
        [i](const LawResult& r) { return r.spring_error[i]; });
  }
  for (std::size_t i = 0; i < kTissues.size(); ++i) {
    add(kTissues[i].name, [i](const LawResult& r) { return r.tissue_error[i]; });
  }
  return table;
}

/// Both backstepping laws move the rod alike; drawn dashed, the second lets the first be seen.
void add_curve(PlotPanel& panel, ControlLawKind law, PlotSeries series) {
  if (law == ControlLawKind::backstepping_two_valves) series.style = PlotStyle::dashed;
  panel.series.push_back(std::move(series));
}

/// One panel per cylinder, so that the curves of its laws can be told apart.
Plot make_plot(const std::string& title, const std::string& x_label, const std::string& y_label,
               int height) {
  Plot plot{title, {}, 1200, height};
  for (const double friction : kDryFrictions) {
    plot.panels.push_back({x_label, y_label + ", friction " + fixed(friction, 1) + " N", {}});
  }
  return plot;
}

/// What the study collects of every law and cylinder.
struct Study {
  std::vector<LawResult> results;
  TextTable disturbances = make_disturbance_table();
  TextTable rendering = make_rendering_table();
  Plot push =
      make_plot("probe-study: slow push at 1000 N/m", "rod pushed in (mm)", "force (N)", 420);
  Plot release =
      make_plot("probe-study: the hand lets go at 3 s", "time (s)", "position (mm)", 360);
  Plot steps = make_plot("probe-study: load steps 6, 10, 6, 0 N", "time (s)", "position (mm)", 360);
};

/// Runs one law with the cylinder `i` of kDryFrictions.
void study_law(ControlLawKind law, std::size_t i, const ProbeExperimentOptions& options,
               Study& study) {
  LawResult r;
  r.law = law;
  r.dry_friction = kDryFrictions[i];
  const std::string label = to_string(law);
  const auto position = [](const ProbeRow& row) {
    return 1e3 * row.y;
  };
  std::vector<ProbeRow> rows;
  measure_load_steps(r, options, rows);
  add_curve(study.steps.panels[i], law, plot_rows(rows, label, position));
  measure_push(r, options, rows);
  add_curve(study.push.panels[i], law,
            plot_curve(
                rows, label, [](const ProbeRow& row) { return -1e3 * row.y; },
                [](const ProbeRow& row) { return row.force; }));
  measure_release(r, options, rows);
  add_curve(study.release.panels[i], law, plot_rows(rows, label, position));
  measure_springs(r, options);
  measure_tissues(r, options);
  measure_noise(r, options);
  measure_lost_sensor(r, options);
  measure_supply_drop(r, options);
  study.disturbances.rows.push_back(disturbance_cells(r));
  study.rendering.rows.push_back(rendering_cells(r));
  study.results.push_back(r);
}

std::vector<Claim> make_study_claims(const std::vector<LawResult>& results) {
  std::vector<Claim> claims;
  for (const LawResult& r : results) {
    const std::string name = std::string(to_string(r.law)) + ", " + fixed(r.dry_friction, 1, "N: ");
    if (!needs_force_sensor(r.law))
      claims.push_back(claim_near({ClaimKind::input, "C_1 and C_2 are set for it, (3.40)"},
                                  name + "slope of a slow push", r.slope, kStiffness, 0.05, "N/m"));
    claims.push_back(claim_at_most({ClaimKind::fitted, "the bound is artus' own"},
                                   name + "speed after loss of the force sensor", r.lost_speed, 0.2,
                                   "m/s"));
  }
  return claims;
}

}  // namespace

ProbeExperiment run_probe_study(const ProbeExperimentOptions& options) {
  ProbeExperiment e;
  e.name = "probe-study";
  e.title =
      "Which law renders tissue best? Every law that renders a stiffness, with the published dry "
      "friction and with little, under load steps, a slow push, a hand that lets go, four times "
      "the sensor noise, loss of the force sensor, and supply falling from 4 to 3 bar, all at 1000 "
      "N/m; then under a pressing hand, from soft to hard springs and on tissue.";
  Study study;
  for (std::size_t i = 0; i < kDryFrictions.size(); ++i) {
    for (const ControlLawKind law : kLaws) study_law(law, i, options, study);
    study.push.panels[i].series.push_back({"ideal spring", {0, 14}, {0, 14}});
  }
  e.claims = make_study_claims(study.results);
  e.tables = {
      {"Disturbances at 1000 N/m:", std::move(study.disturbances)},
      {"Error of the felt force under a pressing hand, rms over rms:", std::move(study.rendering)},
      {"The answer:", make_answer_table(study.results)}};
  e.plots = {{"probe-study-push.svg", std::move(study.push)},
             {"probe-study-release.svg", std::move(study.release)},
             {"probe-study-steps.svg", std::move(study.steps)}};
  e.assumed = {"a low-friction seal of 0.5 N",
               "the pressing hand, 500 N/m and 5 N s/m, 20 mm at 0.5 Hz",
               "the layers under the probe; their moduli are those of the tissue library",
               "the sizes of all disturbances; 0.2 mm, within which a step has settled",
               "the values that probe-isp lists"};
  return e;
}

}  // namespace artus
