// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/insertion_trace.h"

#include <cmath>

namespace artus {

void InsertionTrace::clear() {
  points_.clear();
  outside_ = true;
}

void InsertionTrace::add(const TracePoint& point) {
  if (!point.felt) return;  // the tip is where it was
  const bool outside = point.region == kOutside;
  if (outside_ && !outside) points_.clear();
  outside_ = outside;
  if (outside || points_.size() >= kMaxPoints) return;
  const bool changed = points_.empty() || points_.back().region != point.region ||
                       std::abs(points_.back().depth - point.depth) >= kStep;
  if (changed) points_.push_back(point);
}

}  // namespace artus
