// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "artus/detail/training/metrics/attempt_meter.h"
#include "artus/detail/training/session_meter.h"
#include "artus/detail/training/tracked_list.h"
#include "artus/session/recording.h"

namespace artus {

/// What an attempt is measured against, as people name it.
struct GoalNames {
  std::optional<Vec3> point;             ///< m, frame J, where the tip should come
  std::string point_name = "the point";  ///< in definitions
  std::string structure;                 ///< without a point: anywhere in it will do; empty: none
  std::vector<std::pair<std::string, double>> avoid;  ///< structures, m of margin around each
};

/// The goals of such names. Errors: not_found (no such structure in the joint), naming it.
[[nodiscard]] Result<Goals> make_goals(const CompiledJoint& joint, const GoalNames& names);

/// What was assessed, and what was peculiar about it.
struct Assessment {
  std::vector<Metric> metrics;
  std::vector<Metric> table;  ///< PerkTutor's rows
  std::vector<AttemptEvent> events;
  std::vector<std::string> notices;  ///< for people
};

/// Adds what is to be told of poses that were left out of an attempt.
void add_left_out(const AttemptMeasures& measures, std::vector<std::string>& notices);

/// Measures tracked poses: a stream for the metrics, unfiltered for the table. Requires: at least
/// one pose, times that do not fall. Cost: linear in poses.
[[nodiscard]] Assessment assess_list(const TrackedList& list,
                                     const std::shared_ptr<const Scene>& scene,
                                     MeterOptions options);

/// Measures a recording with its own probe and needle against `goals`; `pictures`: draws them
/// again, without which tip_visible has no value. Errors: those of replay.
[[nodiscard]] Result<Assessment> assess_recording(const Recording& recording,
                                                  const std::shared_ptr<const Scene>& scene,
                                                  Goals goals, SightSource sights);

/// All of it, as metrics.json has it.
[[nodiscard]] nlohmann::json to_json(const Assessment& assessment);

}  // namespace artus
