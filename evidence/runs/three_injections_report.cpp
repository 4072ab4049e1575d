// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <numeric>

#include <nlohmann/json.hpp>

#include "artus/dataset/pose_list.h"
#include "artus/detail/core/csv.h"
#include "artus/detail/core/plot.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/runs/three_injections.h"

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

// The probe's rows have the needle's times.
template <class F>
PlotSeries probe_series(const ThreeInjections& run, const char* label, F value) {
  PlotSeries s = plot_rows(run.rows, label, [](const NeedleRow& /*row*/) { return 0.0; });
  for (std::size_t i = 0; i < s.y.size(); ++i) s.y[i] = value(run.probe[i]);
  return s;
}

void add_probe_panels(const ThreeInjections& run, Plot& plot) {
  using Row = const ProbeHandRow&;
  const std::string time = "time (s)";
  const auto probe = [&run](const char* label, auto value) {
    return probe_series(run, label, value);
  };
  plot.panels.push_back({time,
                         "probe: force (N)",
                         {probe("normal", [](Row r) { return r.normal_force; }),
                          probe("edges", [](Row r) { return r.edge_force.norm(); })}});
  plot.panels.push_back({time,
                         "probe: friction, torque",
                         {probe("friction (N)", [](Row r) { return r.friction.norm(); }),
                          probe("torque (N cm)", [](Row r) { return 100 * r.torque.norm(); })}});
  // The distances are of a rigid body's columns.
  const bool has_paths = std::any_of(run.probe.begin(), run.probe.end(),
                                     [](Row r) { return r.indentation != 0 || r.slip != 0; });
  if (!has_paths) return;
  plot.panels.push_back(
      {time,
       "probe: distance (mm)",
       {probe("pressed in", [](Row r) { return r.indentation / kMillimetre; }),
        probe("slid since touching", [](Row r) { return r.slip / kMillimetre; })}});
}

constexpr const char* kProbeHeader =
    ",probe_x_m,probe_y_m,probe_z_m,probe_q_w,probe_q_x,probe_q_y,probe_q_z,probe_normal_n,"
    "probe_edge_x_n,probe_edge_y_n,probe_edge_z_n,probe_friction_x_n,probe_friction_y_n,"
    "probe_friction_z_n,probe_torque_x_nm,probe_torque_y_nm,probe_torque_z_nm,probe_slip_m,"
    "probe_stiffness_n_m,probe_indentation_m,probe_contact_share,probe_energy_to_hand_j,probe_"
    "status";

void append_probe(const ProbeHandRow& row, std::string& line) {
  const Eigen::Quaterniond q(row.X_JP.linear());
  const Vec3 p = row.X_JP.translation();
  for (const double value : {p.x(),
                             p.y(),
                             p.z(),
                             q.w(),
                             q.x(),
                             q.y(),
                             q.z(),
                             row.normal_force,
                             row.edge_force.x(),
                             row.edge_force.y(),
                             row.edge_force.z(),
                             row.friction.x(),
                             row.friction.y(),
                             row.friction.z(),
                             row.torque.x(),
                             row.torque.y(),
                             row.torque.z(),
                             row.slip,
                             row.stiffness,
                             row.indentation,
                             row.contact_share,
                             row.energy_to_hand}) {
    line += ',' + to_csv(value);
  }
  line += ',' + std::to_string(row.status);
}

// So do the syringe's.
template <class F>
PlotSeries syringe_series(const ThreeInjections& run, const char* label, F value) {
  PlotSeries s = plot_rows(run.rows, label, [](const NeedleRow& /*row*/) { return 0.0; });
  for (std::size_t i = 0; i < s.y.size(); ++i) s.y[i] = value(run.syringe[i].plunger);
  return s;
}

void add_syringe_panels(const ThreeInjections& run, Plot& plot) {
  using Felt = const PlungerFeedback&;
  const std::string time = "time (s)";
  plot.panels.push_back(
      {time,
       "thumb (N), given (ml)",
       {syringe_series(run, "thumb (N)", [](Felt f) { return f.thumb_force; }),
        syringe_series(run, "given (ml)", [](Felt f) { return f.given / kCubicCentimetre; })}});
}

constexpr const char* kSyringeHeader =
    ",thumb_n,barrel_pa,tip_pa,flow_m3_s,plunger_m,given_m3,plunger_status";

void append_syringe(const PlungerFeedback& felt, std::string& line) {
  for (const double value :
       {felt.thumb_force, felt.pressure, felt.tip_pressure, felt.flow, felt.travel, felt.given})
    line += ',' + to_csv(value);
  line += ',' + std::to_string(felt.status);
}

// Both hands' poses at the rate of a video.
std::vector<ListedPose> poses_of(const ThreeInjections& run) {
  constexpr double kPoseRate = 50;  // 1/s
  std::vector<ListedPose> poses;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const double time = run.rows[i].time;
    if (time * kPoseRate < static_cast<double>(poses.size())) continue;
    poses.push_back({"", time, run.probe[i].X_JP, run.rows[i].X_JN});
  }
  return poses;
}

nlohmann::json doses_json(const ThreeInjections& run) {
  const TargetDose& dose = run.options.dose;
  auto places = nlohmann::json::object();
  double all = 0;
  for (const GivenTo& to : run.given) {
    places[to.place] = {{"ml", to.volume / kCubicCentimetre}, {"target", to.target}};
    all += to.volume;
  }
  return {{"liquid", dose.syringe.liquid},
          {"gauge", dose.syringe.gauge},
          {"ml_each", dose.volume / kCubicCentimetre},
          {"rate_ml_s", dose.rate / kCubicCentimetre},
          {"asked_ml", run.asked / kCubicCentimetre},
          {"given_ml", all / kCubicCentimetre},
          {"unbalanced_ml", run.unbalanced / kCubicCentimetre},
          {"places", places}};
}

Plot force_plot(const ThreeInjections& run) {
  using Row = const NeedleRow&;
  const std::string time = "time (s)";
  Plot plot;
  plot.title =
      "Three injections: needle's depth, axial forces (positive into the body), lateral, bone; "
      "probe";
  plot.panels = {
      {time,
       "depth (mm)",
       {plot_rows(run.rows, "tip", [](Row r) { return r.depth / kMillimetre; }),
        plot_rows(run.rows, "wall", [](Row r) { return r.wall / kMillimetre; })}},
      {time,
       "force (N)",
       {plot_rows(run.rows, "cutting", [](Row r) { return r.forces.cutting; }),
        plot_rows(run.rows, "attracted", [](Row r) { return r.forces.attracted; }),
        plot_rows(run.rows, "pre-puncture", [](Row r) { return r.forces.prepuncture; })}},
      {time,
       "force (N)",
       {plot_rows(run.rows, "friction", [](Row r) { return r.forces.friction; }),
        plot_rows(run.rows, "clamping", [](Row r) { return r.forces.clamping.norm(); })}},
      {time,
       "force (N)",
       {plot_rows(run.rows, "tap on bone", [](Row r) { return r.forces.hard; })}},
      {time, "alpha (degrees)", {plot_rows(run.rows, "alpha", [](Row r) {
         return r.cone / kDegree;
       })}}};
  if (!run.probe.empty()) add_probe_panels(run, plot);
  if (!run.syringe.empty()) add_syringe_panels(run, plot);
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
                     {"probe_press_force_n", o.probe.press_force},
                     {"needle_length_m", run.needle_length}};
  out["assumed"] = {
      "0.8 s at a target, 1.2 s to re-aim, 1 s between injections",
      "speeds of 12 and 100 mm/s, 20 mm of withdrawal (\"a few centimetres\")",
      "the hand's stiffness, damping, mass, tremor and lag; mass, damping and encoder "
      "step of the device",
      "the probe's force of 3 N, its hand's ways and times, friction of gel and skin",
      "2 % of a layer's force"};
  if (!run.syringe.empty()) out["injected"] = doses_json(run);
  for (const LayerPlateau& p : run.plateaus) {
    out["plateaus"].push_back({{"tissue", p.tissue},
                               {"expected_n", p.expected},
                               {"mean_n", p.mean},
                               {"min_n", p.least},
                               {"max_n", p.most},
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
    if (m.coverage.empty()) continue;
    const double sum = std::accumulate(m.coverage.begin(), m.coverage.end(), 0.0);
    out["moments"].back()["probe_coverage"] = sum / static_cast<double>(m.coverage.size());
  }
  return out;
}

Result<void> write_three_injections(const ThreeInjections& run,
                                    const std::filesystem::path& folder) {
  ARTUS_TRY(make_folder(folder));
  MoreColumns more;
  std::string header;
  if (!run.probe.empty()) header += kProbeHeader;
  if (!run.syringe.empty()) header += kSyringeHeader;
  more.header = header;
  more.append = [&run](std::size_t i, std::string& line) {
    if (!run.probe.empty()) append_probe(run.probe[i], line);
    if (!run.syringe.empty()) append_syringe(run.syringe[i].plunger, line);
  };
  ARTUS_TRY(write_needle_csv(folder / "trace.csv", run.rows, run.region_names, more));
  if (!run.probe.empty()) {
    ARTUS_TRY(write_text(folder / "poses.csv", poses_csv(poses_of(run))));
  }
  return write_plot(folder / "forces.svg", force_plot(run));
}

}  // namespace artus
