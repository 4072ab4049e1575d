// SPDX-License-Identifier: AGPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "core/text_file.h"
#include "core/units.h"
#include "sim/plot.h"
#include "sim/three_injections.h"

namespace artus {
namespace {

nlohmann::json to_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

nlohmann::json to_json(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return {{"position_m", to_json(Vec3(pose.translation()))},
          {"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}}};
}

template <class F>
PlotSeries series(const ThreeInjections& run, const char* label, F value) {
  PlotSeries s;
  s.label = label;
  s.x.reserve(run.rows.size());
  s.y.reserve(run.rows.size());
  for (const NeedleRow& row : run.rows) {
    s.x.push_back(row.time);
    s.y.push_back(value(row));
  }
  return s;
}

Plot force_plot(const ThreeInjections& run) {
  using Row = const NeedleRow&;
  const std::string time = "time (s)";
  Plot plot;
  plot.title = "Three injections: depth, axial forces (positive into the body), lateral, bone";
  plot.panels = {
      {time,
       "depth (mm)",
       {series(run, "tip", [](Row r) { return r.depth / kMillimetre; }),
        series(run, "wall", [](Row r) { return r.wall / kMillimetre; })}},
      {time,
       "force (N)",
       {series(run, "cutting", [](Row r) { return r.forces.cutting; }),
        series(run, "attracted", [](Row r) { return r.forces.attracted; }),
        series(run, "pre-puncture", [](Row r) { return r.forces.prepuncture; })}},
      {time,
       "force (N)",
       {series(run, "friction", [](Row r) { return r.forces.friction; }),
        series(run, "clamping", [](Row r) { return r.forces.clamping.norm(); })}},
      {time, "force (N)", {series(run, "tap on bone", [](Row r) { return r.forces.hard; })}},
      {time, "alpha (degrees)", {series(run, "alpha", [](Row r) { return r.cone / kDegree; })}}};
  return plot;
}

}  // namespace

nlohmann::json summarize(const ThreeInjections& run) {
  nlohmann::json out = verdict(run.claims);
  const ThreeInjectionsOptions& o = run.options;
  out["settings"] = {{"rate_hz", o.rate_hz},
                     {"seed", o.seed},
                     {"device", o.device},
                     {"slow_speed_m_s", o.slow_speed},
                     {"fast_speed_m_s", o.fast_speed},
                     {"withdrawal_m", o.withdrawal},
                     {"needle_length_m", run.needle_length}};
  for (const LayerPlateau& p : run.plateaus) {
    out["plateaus"].push_back({{"tissue", p.tissue},
                               {"expected_n", p.expected},
                               {"mean_n", p.mean},
                               {"least_n", p.least},
                               {"most_n", p.most},
                               {"rise_m", p.rise},
                               {"rows", p.rows}});
  }
  for (const BoneTouch& t : run.touches) {
    out["bone_touches"].push_back({{"injection", t.pass},
                                   {"time_s", t.time},
                                   {"incoming_speed_m_s", t.incoming_speed},
                                   {"tap_peak_n", t.peak},
                                   {"tap_duration_s", t.duration}});
  }
  for (const NamedMoment& m : run.moments) {
    out["moments"].push_back({{"time_s", m.time},
                              {"label", m.label},
                              {"injection", m.pass},
                              {"needle", to_json(m.X_JN)},
                              {"probe", to_json(m.X_JP)}});
  }
  return out;
}

Result<void> write_three_injections(const ThreeInjections& run,
                                    const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), folder.string());
  const auto csv = write_needle_csv(folder / "trace.csv", run.rows, run.region_names);
  if (!csv) return csv;
  const auto summary = write_text(folder / "summary.json", summarize(run).dump(2) + "\n");
  if (!summary) return summary;
  return write_plot(folder / "forces.png", force_plot(run));
}

}  // namespace artus
