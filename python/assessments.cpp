// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <nlohmann/json.hpp>

#include "artus/detail/python/borders.h"
#include "artus/detail/training/assessment.h"

namespace artus::python {
namespace {

/// What the keywords of both functions say.
struct Asked {
  std::optional<Numbers> point;
  std::string structure;
  std::vector<std::pair<std::string, double>> avoid;
  int gauge = 22;       // of lists alone, as depth
  double depth = 0.04;  // m
};

Goals goals_of(const Joint& joint, const Asked& asked) {
  constexpr double kWidest = 0.05;  // m
  GoalNames names;
  if (asked.point) names.point = point_of(*asked.point, "target");
  names.structure = asked.structure;
  names.avoid = asked.avoid;
  for (const auto& [name, margin] : names.avoid)
    if (!(margin >= 0 && margin <= kWidest))
      throw py::value_error("the margin around '" + name +
                            "' must be 0 to 0.05 m; it is in metres");
  return value_by_name(make_goals(joint.data(), names));
}

MeterOptions meter_of(const Joint& joint, const Asked& asked) {
  MeterOptions meter;
  const auto shape = needle_of_gauge(asked.gauge);
  if (!shape) throw py::value_error("gauge must be 18, 20, 21, 22, 23 or 25");
  if (!(asked.depth >= 0.01 && asked.depth <= 0.3))
    throw py::value_error("depth must be 0.01 to 0.3 m");
  meter.needle = *shape;
  meter.image_depth = asked.depth;
  meter.goals = goals_of(joint, asked);
  return meter;
}

TrackedList list_of(const Numbers& times, const std::optional<Numbers>& needle,
                    const std::optional<Numbers>& probe) {
  if (times.ndim() != 1 || times.shape(0) == 0)
    throw py::value_error("times must have the shape (n,), with n at least 1");
  if (!needle && !probe) throw py::value_error("give poses of needle, probe or both");
  const auto n = static_cast<std::size_t>(times.shape(0));
  const auto take = [&](const std::optional<Numbers>& array, const char* what) {
    auto poses = array ? poses_of(*array, what) : std::vector<Pose>();
    if (array && poses.size() != n)
      throw py::value_error(std::string(what) + " has " + std::to_string(poses.size()) +
                            " poses for " + std::to_string(n) + " times");
    return poses;
  };
  const auto needles = take(needle, "needle");
  const auto probes = take(probe, "probe");
  TrackedList list;
  for (std::size_t i = 0; i < n; ++i) {
    const double time = times.data()[i];
    if (!std::isfinite(time) || (i > 0 && time < list.poses.back().time))
      throw py::value_error("times[" + std::to_string(i) + "] must be finite and not fall");
    list.poses.push_back({time, {}, {}});
    if (needle) list.poses.back().X_JN = needles[i];
    if (probe) list.poses.back().X_JP = probes[i];
  }
  if (list.poses.back().time - list.poses.front().time > TrackedListOptions{}.longest)
    throw py::value_error("times span more than three hours; they are in seconds");
  return list;
}

std::string measure(const Joint& joint, const Numbers& times, const std::optional<Numbers>& needle,
                    const std::optional<Numbers>& probe, const Asked& asked) {
  const TrackedList list = list_of(times, needle, probe);
  MeterOptions meter = meter_of(joint, asked);
  const py::gil_scoped_release others_may_run;
  return to_json(assess_list(list, joint.scene, std::move(meter))).dump();
}

std::string assess(const Joint& joint, const std::filesystem::path& file, const Asked& asked,
                   bool pictures) {
  Goals goals = goals_of(joint, asked);
  Result<Assessment> done = [&]() -> Result<Assessment> {
    const py::gil_scoped_release others_may_run;
    const auto recording = read_recording(file);
    ARTUS_TRY(recording);
    return assess_recording(*recording, joint.scene, std::move(goals),
                            pictures ? SightSource::recorded : SightSource::none);
  }();
  return to_json(value_of(std::move(done))).dump();
}

}  // namespace

void add_assessments(py::module_& module) {
  // Both give JSON text; the package gives it names, defaults and documentation.
  module.def("_metrics",
             [](const Joint& joint, const Numbers& times, const std::optional<Numbers>& needle,
                const std::optional<Numbers>& probe, const std::optional<Numbers>& point,
                const std::string& structure,
                const std::vector<std::pair<std::string, double>>& avoid, int gauge, double depth) {
               return measure(joint, times, needle, probe, {point, structure, avoid, gauge, depth});
             });
  module.def("_assess",
             [](const Joint& joint, const std::filesystem::path& file,
                const std::optional<Numbers>& point, const std::string& structure,
                const std::vector<std::pair<std::string, double>>& avoid, bool pictures) {
               return assess(joint, file, {point, structure, avoid}, pictures);
             });
}

}  // namespace artus::python
