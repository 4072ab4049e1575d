// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/training/metrics/goals.h"
#include "artus/detail/training/metrics/syringe_course.h"

namespace artus {

/// A while in which the needle kept its place.
struct Stay {
  std::size_t first = 0;  ///< point of the course
  std::size_t last = 0;
  bool on_way_out = false;  ///< withdrawn by 5 mm or more, and never brought forward again
};

/// Half-seconds and more inside in which the tip neither drifts (faster than 0.5 mm/s) nor leaves
/// 0.75 mm around its mean; tremor within that is rest. Cost: linear in points.
[[nodiscard]] std::vector<Stay> find_stays(std::span<const CoursePoint> course);

/// Where the needle was placed: where half of what was given had been given, when at least 0.1 ml
/// were; else the stay that came nearest to the target; else the deepest point. A pause on the way
/// out, shorter than 5 s, is no stay. Without a target the longest stay. Empty when the needle
/// never was inside. `target`: may be null.
[[nodiscard]] std::optional<std::size_t> find_placement(std::span<const CoursePoint> course,
                                                        const Target* target = nullptr,
                                                        std::span<const Dose> doses = {});

}  // namespace artus
