// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>
#include <utility>

#include "artus/detail/evidence/validation/probe/probe_experiment_observed.h"
#include "artus/detail/evidence/validation/probe/probe_experiments.h"

namespace artus {
namespace {

constexpr double kMass = 1.0;  // kg laid on the rod
constexpr double kEnd = PublishedTimes::kEnd;
constexpr double kPressureMargin = 0.05;   // share by which the moving rod may compress further
constexpr double kPublishedKMin = 692.14;  // N/m
constexpr double kPublishedKMax = 14155;   // N/m

using MakeTarget = std::function<ProbeTarget(double)> (*)(const PublishedLaw&);
using Observe = std::vector<ProbeObservation> (*)(const std::vector<ProbeTrace>&);
using Change = void (*)(ProbeScenario&);

std::vector<ProbeTrace> run_all(MakeTarget make_target, const ProbeExperimentOptions& options,
                                Change change) {
  std::vector<ProbeTrace> traces;
  for (const PublishedLaw& p : published_laws()) {
    ProbeScenario scenario;
    scenario.law = p.law;
    scenario.duration = kEnd;
    scenario.target = make_target(p);
    scenario.load = lay_mass(kMass, p.load_time);
    scenario.seed = options.seed;
    scenario.plant = options.mock;
    change(scenario);
    traces.push_back({p.label, run_probe_scenario(scenario)});
  }
  return traces;
}

PlotPanel make_panel(std::string y_label, std::vector<PlotSeries> series) {
  return {"time (s)", std::move(y_label), std::move(series)};
}

/// Position, error, voltage and K_pneu of all laws, one file each.
std::vector<NamedPlot> make_plots(const std::string& name, const std::vector<ProbeTrace>& traces,
                                  const std::array<const char*, 4>& figures) {
  std::vector<NamedPlot> plots(4);
  plots[0] = {name + "-position.svg", {name + ": position (" + figures[0] + ")", {}}};
  plots[1] = {name + "-error.svg", {name + ": position error (" + figures[1] + ")", {}}};
  plots[2] = {name + "-voltage.svg", {name + ": control voltage (" + figures[2] + ")", {}}};
  plots[3] = {name + "-k-pneu.svg",
              {name + ": stiffness wanted and K_pneu (" + figures[3] + ")", {}}};
  for (const ProbeTrace& t : traces) {
    const auto& rows = t.rows;
    plots[0].plot.panels.push_back(make_panel(
        t.label + " (mm)",
        {plot_rows(rows, "x_c expected", [](const ProbeRow& r) { return 1e3 * r.expected; }),
         plot_rows(rows, "x_m measured", [](const ProbeRow& r) { return 1e3 * r.y; }),
         plot_rows(rows, "x_0", [](const ProbeRow& r) { return 1e3 * r.rest; })}));
    plots[1].plot.panels.push_back(make_panel(
        t.label + " (mm)",
        {plot_rows(rows, "x_c - x_m", [](const ProbeRow& r) { return 1e3 * r.error(); })}));
    plots[2].plot.panels.push_back(make_panel(
        t.label + " (V)", {plot_rows(rows, "u", [](const ProbeRow& r) { return r.u_P; })}));
    plots[3].plot.panels.push_back(
        make_panel(t.label + " (N/m)",
                   {plot_rows(rows, "K_pneu", [](const ProbeRow& r) { return r.pneumatic; }),
                    plot_rows(rows, "wanted", [](const ProbeRow& r) { return r.stiffness; })}));
  }
  return plots;
}

std::uint32_t faults_of(const std::vector<ProbeRow>& rows) {
  std::uint32_t faults = 0;
  for (const ProbeRow& row : rows) faults |= row.status & ControlStatus::kFaults;
  return faults;
}

/// What must hold in both experiments, whatever was published.
std::vector<Claim> make_claims(const std::vector<ProbeTrace>& traces, const PneumaticParams& mock) {
  std::vector<Claim> claims;
  for (const ProbeTrace& t : traces) {
    claims.push_back(claim_at_most({ClaimKind::input, "the supervisor's limits"},
                                   t.label + ": ticks in fault (status bits seen)",
                                   static_cast<double>(faults_of(t.rows)), 0, ""));
    const ProbeWindow all = measure_window(t.rows, 0, kEnd);
    claims.push_back(claim_at_least({ClaimKind::input, "the valve's exhaust"},
                                    t.label + ": lowest chamber pressure", all.lowest_pressure,
                                    (1 - kPressureMargin) * mock.valve.exhaust, "Pa"));
    claims.push_back(claim_at_most({ClaimKind::input, "the valve's supply"},
                                   t.label + ": highest chamber pressure", all.highest_pressure,
                                   (1 + kPressureMargin) * mock.valve.supply, "Pa"));
    claims.push_back(claim_at_most({ClaimKind::input, "the plant's work is summed apart"},
                                   t.label + ": rod's energy that no work accounts for",
                                   all.energy_error, 1e-6, "J"));
  }
  const double k_min = min_pneumatic_stiffness(mock.cylinder, mock.valve.exhaust);
  claims.push_back(claim_near({ClaimKind::fitted, "the power of ten of the areas was read from it"},
                              "K_min of (3.43)", k_min, kPublishedKMin, 1e-3, "N/m"));
  return claims;
}

void keep(ProbeScenario&) {}

/// A value that had to be chosen, set to another one that the source allows too.
struct Assumption {
  const char* what;
  Change change;
};

constexpr std::array<Assumption, 7> kAssumptions{{
    {"supply 4 bar gauge (5 bar absolute) instead of 4 bar absolute",
     [](ProbeScenario& s) {
       s.plant.valve.supply += s.plant.valve.exhaust;
     }},
    {"no dry friction in any law's cylinder",
     [](ProbeScenario& s) {
       s.plant.cylinder.dry_friction = 0;
     }},
    {"the centred valve leaks a tenth",
     [](ProbeScenario& s) {
       s.plant.valve.centre_opening /= 10;
     }},
    {"the spool takes twice as long",
     [](ProbeScenario& s) {
       s.plant.valve.spool_frequency /= 2;
     }},
    {"the admittance's force is filtered at 10 Hz instead of 2 Hz",
     [](ProbeScenario& s) {
       s.control.force_filter = 10;
     }},
    {"K_3i = 0 instead of 2e4",
     [](ProbeScenario& s) {
       s.control.backstepping.k_3i = 0;
     }},
    {"a tenth of IPC's virtual mass",
     [](ProbeScenario& s) {
       s.control.ipc.mass /= 10;
     }},
}};

/// Runs the test once more for each assumption.
std::vector<ProbeRerun> run_assumptions(MakeTarget make_target, Observe observe,
                                        const ProbeExperimentOptions& options) {
  std::vector<ProbeRerun> reruns;
  for (const Assumption& a : kAssumptions)
    reruns.push_back({a.what, observe(run_all(make_target, options, a.change))});
  return reruns;
}

/// The verdicts that turn with each assumption.
TextTable list_turns(const std::vector<ProbeRerun>& reruns,
                     const std::vector<ProbeObservation>& base) {
  TextTable table{{"other value", "reproduced", "verdicts that turn"}, {}};
  const auto add = [&](const std::string& what, const std::vector<ProbeObservation>& seen) {
    std::size_t reproduced = 0;
    std::string turned;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const ProbeObservation& o = seen[i];
      if (o.reproduced) ++reproduced;
      if (o.reproduced == base[i].reproduced) continue;
      turned += (turned.empty() ? "" : "; ") + o.what + ": " +
                (o.reproduced ? "reproduced" : "refuted") + " with " + fixed(o.artus, 2, o.unit);
    }
    table.rows.push_back({what, std::to_string(reproduced) + " of " + std::to_string(seen.size()),
                          turned.empty() ? "none" : turned});
  };
  add("as described", base);
  for (const ProbeRerun& rerun : reruns) add(rerun.what, rerun.observations);
  return table;
}

TextTable list_observations(const std::vector<ProbeObservation>& observations) {
  TextTable table{
      {"observation", "published", "artus", "difference", "verdict", "with other values", "kind"},
      {}};
  for (const ProbeObservation& o : observations)
    table.rows.push_back({o.what, o.published, fixed(o.artus, 3, o.unit), o.difference,
                          o.reproduced ? "reproduced" : "refuted", o.cause,
                          to_string(o.basis.kind)});
  return table;
}

/// Published figures from which a parameter was read, so that they test nothing.
TextTable list_fitted(const std::vector<ProbeTrace>& traces, const PneumaticParams& mock) {
  const CylinderParams& c = mock.cylinder;
  TextTable table{{"figure", "published", "artus", "difference", "parameter read from it"}, {}};
  const auto add = [&table](const char* what, double published, double artus,
                            const char* parameter) {
    table.rows.push_back({what, fixed(published, 2) + " N/m", fixed(artus, 2) + " N/m",
                          fixed(100 * (artus / published - 1), 2) + " %", parameter});
  };
  add("K_pneu at rest", 2100, traces.front().rows.front().pneumatic,
      "supply: the printed 4 bar taken as absolute; as gauge it would give a quarter more");
  add("K_max of (3.43)", kPublishedKMax, max_pneumatic_stiffness(c, mock.valve.supply, -c.travel),
      "end stops at +-22.2 mm; no verdict depends on them");
  add("K_min of (3.43)", kPublishedKMin, min_pneumatic_stiffness(c, mock.valve.exhaust),
      "the power of ten of the printed areas; their digits are independent");
  return table;
}

std::function<ProbeTarget(double)> isp_target(const PublishedLaw& p) {
  return ramp_stiffness(p.low, p.high, p.load_time, PublishedTimes::kPeak);
}

std::function<ProbeTarget(double)> ssp_target(const PublishedLaw& p) {
  return step_stiffness(p.steps, p.load_time, PublishedTimes::kPlateau);
}

/// One of the two published tests.
struct PublishedTest {
  const char* name;
  const char* title;
  const char* source;
  MakeTarget make_target;
  Observe observe;
  std::array<const char*, 4> figures;
  std::vector<std::string> assumed;
};

ProbeExperiment run_published(const PublishedTest& test, const ProbeExperimentOptions& options) {
  ProbeExperiment e;
  e.name = test.name;
  e.title = test.title;
  e.source = test.source;
  e.traces = run_all(test.make_target, options, keep);
  e.plots = make_plots(e.name, e.traces, test.figures);
  e.observations = test.observe(e.traces);
  std::vector<ProbeRerun> reruns;
  if (options.assumptions) reruns = run_assumptions(test.make_target, test.observe, options);
  find_causes(reruns, e.observations);
  e.tables.emplace_back("What was published and what artus shows:",
                        list_observations(e.observations));
  e.tables.emplace_back("Figures of the source that parameters were read from:",
                        list_fitted(e.traces, options.mock));
  if (options.assumptions)
    e.tables.emplace_back(
        "What the verdicts owe to values that the source does not print, or prints in two ways:",
        list_turns(reruns, e.observations));
  e.claims = claim_observations(e.observations);
  for (Claim& claim : make_claims(e.traces, options.mock)) e.claims.push_back(std::move(claim));
  e.assumed = test.assumed;
  e.assumed.insert(e.assumed.end(),
                   {"the valve's leak at the centre, the spool's lag, the sensors' noise",
                    "the force filter (2 Hz), the velocity filter (150 Hz), K_3i, the damping of "
                    "IPC, the control rate (5 kHz)",
                    "0.3 s in which the hand lays the weight on the rod",
                    "supply of 4 bar absolute; end stops at +-22.2 mm",
                    "what counts as reproduced: \"about\" a value: up to a fifth more; about 0: "
                    "0.5 mm; K_pneu: within a tenth; chatter: more than 4 turns of the voltage by "
                    "0.2 V within 0.5 s"});
  return e;
}

}  // namespace

ProbeExperiment run_probe_isp(const ProbeExperimentOptions& options) {
  return run_published({"probe-isp",
                        "Increasing stiffness under 1 kg: PID and IPC 500 to 1000 N/m, "
                        "backstepping 800 to 3000 N/m, highest at 25 s.",
                        "[Alamilla2020] section 3.3.2, figs. 3-16 to 3-19",
                        isp_target,
                        observe_isp,
                        {"fig. 3-16", "fig. 3-17", "fig. 3-18", "fig. 3-19"},
                        {}},
                       options);
}

ProbeExperiment run_probe_ssp(const ProbeExperimentOptions& options) {
  return run_published({"probe-ssp",
                        "Stiffness steps under 1 kg: PID and IPC 500, 1000, 500, 800 N/m, "
                        "backstepping 800, 3000, 800, 2000 N/m, 5 s each.",
                        "[Alamilla2020] section 3.3.2, figs. 3-20 to 3-24",
                        ssp_target,
                        observe_ssp,
                        {"fig. 3-21", "fig. 3-22", "fig. 3-23", "fig. 3-24"},
                        {"the steps' stiffnesses and lengths: the figure prints no values"}},
                       options);
}

}  // namespace artus
