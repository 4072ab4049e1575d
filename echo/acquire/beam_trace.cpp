// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/beam_trace.h"

#include <algorithm>

namespace artus {

bool BeamTrace::find_sample(double path, double& sample, double& log_gain) const noexcept {
  for (std::size_t i = 0; i < n_runs; ++i) {
    const BeamRun& run = runs[i];
    if (path > run.path_end) continue;
    const double length = run.path_end - run.path_begin;
    const double t = length > 0 ? std::clamp((path - run.path_begin) / length, 0.0, 1.0) : 0;
    sample = run.begin + t * (run.end - run.begin);
    log_gain = run.log_gain_begin + t * (run.log_gain_end - run.log_gain_begin);
    return true;
  }
  return false;
}

Vec3 BeamPath::at(double length_m) const noexcept {
  if (size < 2) return p_J[0];
  std::size_t i = 0;
  while (i + 2 < size && length_m > length[i + 1]) ++i;
  const double t = (length_m - length[i]) / (length[i + 1] - length[i]);
  return p_J[i] + t * (p_J[i + 1] - p_J[i]);
}

}  // namespace artus
