// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_report.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/operators/thumb_dose.h"

namespace artus {
namespace {

constexpr double kKilo = 1e3;           // Pa
constexpr double kBalance = 1e-9;       // ml
constexpr double kInPlace = 95;         // %
constexpr std::size_t kPlotEvery = 10;  // rows

/// Every tenth row is enough for a picture.
std::vector<const InjectionRow*> thinned(const InjectionRun& run) {
  std::vector<const InjectionRow*> rows;
  for (std::size_t i = 0; i < run.rows.size(); i += kPlotEvery) rows.push_back(&run.rows[i]);
  return rows;
}

template <class F>
PlotSeries curve(const std::vector<const InjectionRow*>& rows, std::string label, double start,
                 F value) {
  PlotSeries series;
  series.label = std::move(label);
  for (const InjectionRow* row : rows) {
    if (row->time < start) continue;
    series.x.push_back(row->time - start);
    series.y.push_back(value(*row));
  }
  return series;
}

double thumb_of(const InjectionRow& row) {
  return row.thumb;
}
double barrel_of(const InjectionRow& row) {
  return row.plunger.pressure / kKilo;
}
double tip_of(const InjectionRow& row) {
  return row.plunger.tip_pressure / kKilo;
}
double flow_of(const InjectionRow& row) {
  return row.plunger.flow / kCubicCentimetre;
}

double sum_of(const InjectionRow& row) {
  double sum = 0;
  for (const double v : row.volumes) sum += v;
  return sum / kCubicCentimetre;
}

double start_of_push(const InjectionRun& run) {
  const auto at = std::find_if(run.rows.begin(), run.rows.end(),
                               [](const InjectionRow& row) { return row.phase == "inject"; });
  return at == run.rows.end() ? 0 : at->time;
}

std::string text(double value) {
  return printed("%.9g", value);
}

Result<void> write_trace(const InjectionRun& run, const std::filesystem::path& file) {
  std::string out =
      "time_s,phase,depth_mm,region,axial_n,thumb_n,barrel_kpa,tip_kpa,flow_ml_s,travel_mm,"
      "content_ml,drawn_ml,status";
  for (const std::string& place : run.places) out += "," + place + "_ml";
  out += '\n';
  for (const InjectionRow& row : run.rows) {
    const PlungerState& p = row.plunger;
    out += text(row.time) + ',' + std::string(row.phase) + ',' + text(row.depth / kMillimetre) +
           ',' + run.regions[row.region] + ',' + text(row.axial) + ',' + text(row.thumb);
    for (const double value :
         {p.pressure / kKilo, p.tip_pressure / kKilo, p.flow / kCubicCentimetre,
          p.travel / kMillimetre, p.content / kCubicCentimetre, p.drawn / kCubicCentimetre})
      out += ',' + text(value);
    out += ',' + std::to_string(p.status);
    for (const double v : row.volumes) out += ',' + text(v / kCubicCentimetre);
    out += '\n';
  }
  return write_text(file, out);
}

double share_in_target(const InjectionRun& run) {
  return run.given > 0 ? 100 * run.volumes.front() / run.given : 0;
}

/// m^3 that were in the target at once.
double most_in_target(const InjectionRun& run) {
  double most = 0;
  for (const InjectionRow& row : run.rows) most = std::max(most, row.volumes.front());
  return most;
}

}  // namespace

std::vector<Claim> claims_of(const InjectionRun& run) {
  std::vector<Claim> claims;
  claims.push_back(claim_that({ClaimKind::input, "the target is on the line"},
                              "the tip was in '" + run.target + "'", run.reached));
  claims.push_back(claim_at_most({ClaimKind::input, "the scalars are written to balance"},
                                 "what left the needle is somewhere",
                                 std::abs(run.unbalanced) / kCubicCentimetre, kBalance, "ml"));
  claims.push_back(claim_at_least(ClaimKind::independent, "volume in '" + run.target + "'",
                                  share_in_target(run), kInPlace, "%"));
  claims.push_back(claim_that(ClaimKind::independent, "all was given", run.complete));
  return claims;
}

double mean_flow(const InjectionRun& run) {
  double sum = 0;
  int n = 0;
  for (const InjectionRow& row : run.rows) {
    if (row.phase != "inject" || row.plunger.flow <= ThumbDose::kFlows) continue;
    sum += row.plunger.flow;
    ++n;
  }
  return n > 0 ? sum / n : 0;
}

std::vector<std::string> notes_of(const InjectionRun& run) {
  constexpr double kKept = 0.8;  // of the rate; slower is another injection than was asked for
  constexpr double kRises = 1;   // s in which the flow of a syringe rises
  std::vector<std::string> notes;
  const double flow = mean_flow(run);
  const bool slow = run.given > 0 && flow < kKept * run.spec.rate;
  if (slow && run.spec.volume < kRises * run.spec.rate)
    notes.push_back(printed("%.3g ml are out before the flow comes to %.3g ml/s",
                            run.spec.volume / kCubicCentimetre, run.spec.rate / kCubicCentimetre));
  else if (slow)
    notes.push_back(
        printed("the rate was not kept: %.3g of %.3g ml/s, with up to %.0f N on a "
                "plunger of %.0f mm2; a smaller barrel or a wider needle gives more",
                flow / kCubicCentimetre, run.spec.rate / kCubicCentimetre, run.highest_force,
                run.plunger.syringe.area() / (kMillimetre * kMillimetre)));
  if (run.given > 0 && !run.complete)
    notes.push_back(printed("not all was given: %.3g of %.3g ml", run.given / kCubicCentimetre,
                            run.spec.volume / kCubicCentimetre));
  return notes;
}

nlohmann::json summarize(const InjectionRun& run) {
  auto places = nlohmann::json::object();
  for (std::size_t k = 0; k < run.places.size(); ++k)
    places[run.places[k]] = run.volumes[k] / kCubicCentimetre;
  auto patient = nlohmann::json::array();
  for (const PatientLine& line : run.patient)
    patient.push_back({{"time_s", line.time}, {"text", line.text}});
  const double misplaced = run.given - run.volumes.front();
  const auto claims = claims_of(run);
  return {{"injection", run.spec.name},
          {"deforms", run.gave_way},
          {"target", run.target},
          {"target_kind", run.target_like},
          {"liquid", run.plunger.liquid.name},
          {"meant_ml", run.spec.volume / kCubicCentimetre},
          {"rate_ml_s", run.spec.rate / kCubicCentimetre},
          {"flow_ml_s", mean_flow(run) / kCubicCentimetre},
          {"notes", notes_of(run)},
          {"needle_mm", run.plunger.needle.length / kMillimetre},
          {"given_ml", run.given / kCubicCentimetre},
          {"drawn_ml", run.drawn / kCubicCentimetre},
          {"in_target_percent", share_in_target(run)},
          {"most_in_target_ml", most_in_target(run) / kCubicCentimetre},
          {"target_holds_ml", run.holds / kCubicCentimetre},
          {"misplaced_ml", misplaced / kCubicCentimetre},
          {"volumes_ml", places},
          {"unbalanced_ml", run.unbalanced / kCubicCentimetre},
          {"highest_tip_kpa", run.highest_pressure / kKilo},
          {"highest_thumb_n", run.highest_force},
          {"tip_walk_mm", run.tip_walk / kMillimetre},
          {"complete", run.complete},
          {"status", run.status},
          {"patient", patient},
          {"verdict", verdict(claims)}};
}

Plot plot_of(const InjectionRun& run) {
  const auto rows = thinned(run);
  Plot plot;
  plot.title = run.spec.name + ": " + run.plunger.liquid.name + " into " + run.target;
  plot.panels.push_back({"", "thumb, N", {curve(rows, "thumb", 0, thumb_of)}});
  plot.panels.push_back(
      {"", "pressure, kPa", {curve(rows, "barrel", 0, barrel_of), curve(rows, "tip", 0, tip_of)}});
  plot.panels.push_back({"", "flow, ml/s", {curve(rows, "out of the needle", 0, flow_of)}});
  PlotPanel volumes{"time, s", "volume, ml", {}};
  for (std::size_t k = 0; k < run.places.size(); ++k)
    volumes.series.push_back(curve(rows, run.places[k], 0, [k](const InjectionRow& row) {
      return row.volumes[k] / kCubicCentimetre;
    }));
  plot.panels.push_back(std::move(volumes));
  return plot;
}

Plot plot_of(std::span<const InjectionRun> runs) {
  Plot plot;
  plot.title = "The same thumb in different places";
  plot.panels = {{"", "thumb, N", {}},
                 {"", "barrel, kPa", {}},
                 {"", "flow, ml/s", {}},
                 {"time since the push began, s", "volume given, ml", {}}};
  for (const InjectionRun& run : runs) {
    const auto rows = thinned(run);
    const double start = start_of_push(run);
    plot.panels[0].series.push_back(curve(rows, run.target, start, thumb_of));
    plot.panels[1].series.push_back(curve(rows, run.target, start, barrel_of));
    plot.panels[2].series.push_back(curve(rows, run.target, start, flow_of));
    plot.panels[3].series.push_back(curve(rows, run.target, start, sum_of));
  }
  return plot;
}

Result<void> write_injection(const InjectionRun& run, const std::filesystem::path& folder) {
  ARTUS_TRY(make_folder(folder));
  ARTUS_TRY(write_trace(run, folder / "trace.csv"));
  return write_plot(folder / "injection.svg", plot_of(run));
}

}  // namespace artus
