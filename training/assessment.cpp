// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/assessment.h"

#include <nlohmann/json.hpp>

#include "artus/detail/anatomy/body/find_region.h"
#include "artus/detail/training/session_meter.h"

namespace artus {

Result<Goals> make_goals(const CompiledJoint& joint, const GoalNames& names) {
  Goals goals;
  if (names.point) {
    goals.target = Target{names.point_name, *names.point, nullptr};
  } else if (!names.structure.empty()) {
    const auto region = find_region(joint, names.structure);
    ARTUS_TRY(region);
    goals.target = Target{names.structure, std::nullopt, make_region_body(joint, *region)};
  }
  for (const auto& [name, margin] : names.avoid) {
    const auto region = find_region(joint, name);
    ARTUS_TRY(region);
    goals.avoid.push_back({name, make_region_body(joint, *region), margin, false});
  }
  return goals;
}

void add_left_out(const AttemptMeasures& measures, std::vector<std::string>& notices) {
  for (const std::string& notice : {left_out_notice("needle", measures.needle_left_out),
                                    left_out_notice("probe", measures.probe_left_out)})
    if (!notice.empty()) notices.push_back(notice);
}

Assessment assess_list(const TrackedList& list, const std::shared_ptr<const Scene>& scene,
                       MeterOptions options) {
  options.longest = list.poses.back().time - list.poses.front().time + 1;
  AttemptMeter meter(scene, std::move(options));
  RawMotion needle(scene, true);
  RawMotion probe(nullptr, false);
  MotionGate needle_gate;
  MotionGate probe_gate;
  for (const TrackedPose& pose : list.poses) {
    if (pose.X_JN) {
      const Vec3 p = pose.X_JN->translation();
      const Eigen::Quaterniond q(pose.X_JN->linear());
      meter.add_needle(pose.time, p, q);
      if (needle_gate.passes(pose.time, p, q)) needle.add(pose.time, *pose.X_JN, pose.needle_given);
    }
    if (pose.X_JP) {
      const Vec3 p = pose.X_JP->translation();
      const Eigen::Quaterniond q(pose.X_JP->linear());
      meter.add_probe(pose.time, p, q);
      if (probe_gate.passes(pose.time, p, q)) probe.add(pose.time, *pose.X_JP, pose.probe_given);
    }
  }
  AttemptMeasures measures = meter.measure();
  Assessment out{std::move(measures.metrics), needle.metrics("Needle"), std::move(measures.events),
                 list.notices};
  add_left_out(measures, out.notices);
  for (Metric& m : probe.metrics("Probe")) out.table.push_back(std::move(m));
  return out;
}

Result<Assessment> assess_recording(const Recording& recording,
                                    const std::shared_ptr<const Scene>& scene, Goals goals,
                                    SightSource sights) {
  MeterOptions meter = options_for(recording.head);
  meter.goals = std::move(goals);
  auto measures = assess(recording, scene, std::move(meter), sights);
  ARTUS_TRY(measures);
  Assessment out{
      std::move(measures->metrics), std::move(measures->raw), std::move(measures->events), {}};
  add_left_out(*measures, out.notices);
  if (recording.dropped > 0)
    out.notices.push_back(std::to_string(recording.dropped) +
                          " ticks or pictures are missing in the recording");
  if (!recording.complete) out.notices.emplace_back("the recording was cut off");
  return out;
}

nlohmann::json to_json(const Assessment& a) {
  auto events = nlohmann::json::array();
  for (const AttemptEvent& e : a.events)
    events.push_back({{"time_s", e.time},
                      {"kind", e.kind},
                      {"region", e.region},
                      {"value", e.value},
                      {"text", e.text}});
  return {{"metrics_version", kMetricsVersion},
          {"metrics", to_json(a.metrics)},
          {"perktutor", to_json(a.table)},
          {"events", events},
          {"notices", a.notices}};
}

}  // namespace artus
