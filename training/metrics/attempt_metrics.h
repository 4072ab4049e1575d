// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <vector>

#include "artus/detail/training/metrics/attempt_meter.h"

namespace artus {

/// What compute_metrics and find_events look at: tracks, course and sights are there already.
struct AttemptView {
  const Scene& scene;
  const MeterOptions& options;
  const AttemptMeasures& measures;
  std::span<const ImageSight> images;
  std::span<const double> coloured;  ///< s, times of pictures of Doppler, ascending
  bool no_forces = false;
  std::size_t touch_count = 0;
};

/// Every metric, in a fixed order; one that cannot be said of these data has no value.
[[nodiscard]] std::vector<Metric> compute_metrics(const AttemptView& view);

/// The names that compute_metrics can give, those of layers and zones aside.
[[nodiscard]] std::vector<std::string> metric_names();

}  // namespace artus
