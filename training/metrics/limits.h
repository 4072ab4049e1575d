// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>

#include "artus/detail/training/metrics/metric.h"

namespace artus {

/// What every attempt keeps to, whatever the task's marks are: the bands of what harms and of what
/// misses the purpose. Verdict, score and faults share them. A mark of the task on the same metric
/// takes a band's place. All assumed.
inline constexpr double kMostPressureKpa = 100;
inline constexpr double kMostOffTargetMm = 1.5;
inline constexpr double kMostUnseenMm = 1;
inline constexpr double kMostMisplacedMl = 0.5;
inline constexpr double kGivenMl = 0.1;  ///< from which something was injected

/// A metric's value; 0 where there is none.
[[nodiscard]] double value_of(std::span<const Metric> metrics, const std::string& name);
/// ml beside the target; 0 where the target is no structure.
[[nodiscard]] double misplaced_ml(std::span<const Metric> metrics);
/// mm advanced without seeing a tip that the picture could have shown: who enters beside it as
/// asked cannot see the tip before its edge.
[[nodiscard]] double unseen_mm(std::span<const Metric> metrics);
/// Something was injected, and nobody had aspirated.
[[nodiscard]] bool is_unaspirated(std::span<const Metric> metrics);

}  // namespace artus
