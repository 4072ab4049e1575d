// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/training/metrics/needle_course.h"
#include "artus/detail/training/metrics/tip_sight.h"

namespace artus {

/// Sight of the tip at each point of a course, from the probe's track on the same steps; empty
/// where no probe was.
[[nodiscard]] std::vector<std::optional<TipSight>> look_along(const Scene& scene,
                                                              const TipSightFinder& finder,
                                                              std::span<const TrackPoint> needle,
                                                              std::span<const TrackPoint> probe);

/// What the pictures of each moment showed of the tip: the median of those within kGlance of it;
/// one without contrast shows nothing. Moments without a picture keep what geometry says. `images`:
/// by time. Requires: spans of one length.
void look_at_pictures(std::span<const CoursePoint> course, std::span<const ImageSight> images,
                      std::span<std::optional<TipSight>> sights);
inline constexpr double kGlance = 0.125;  ///< s; assumed: what the eye takes together

/// How the needle was kept in the picture.
struct SightTotals {
  double advanced = 0;           ///< m forward inside, with a probe there
  double advanced_in_plane = 0;  ///< m of it with tip in the slice and shaft within 5 degrees
  double time = 0;               ///< s inside with a probe there
  double time_seen = 0;          ///< s of it with the tip seen
  std::vector<double> offsets;   ///< m, |tip - plane| inside
  std::vector<double> angles;    ///< rad, |shaft to plane| inside
  std::vector<Run> unseen;       ///< runs of at least kUnseenDistance advanced unseen; amount in m,
                                 ///< from the first advance to the last
  int unseen_advances = 0;     ///< those runs, each whole kBlind of one beyond the entry a further
  double outside_picture = 0;  ///< m of the first run before the tip came between its edges
};
inline constexpr double kInPlane = 0.08726646259971647;  ///< rad: 5 degrees
inline constexpr double kUnseenDistance = 1e-3;          ///< m
inline constexpr double kUnseenRest = 3;                 ///< s without advance that end a run
inline constexpr double kBlind = 5e-3;                   ///< m; assumed

/// Requires: spans of one length.
[[nodiscard]] SightTotals sum_sight(std::span<const CoursePoint> course,
                                    std::span<const std::optional<TipSight>> sights);

/// The value below which a share of `values` lies (nearest rank); empty for none.
[[nodiscard]] std::optional<double> percentile(std::vector<double> values, double share);

}  // namespace artus
