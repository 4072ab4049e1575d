// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/session/session.h"

namespace artus {

/// What one insertion felt from the skin on, however long it takes: a point for each tenth of a
/// millimetre of way. The next one begins where the needle goes in again.
class InsertionTrace {
 public:
  static constexpr double kStep = 0.1e-3;            ///< m of way between two points
  static constexpr std::size_t kMaxPoints = 20'000;  ///< 2 m of way to and fro

  void add(const TracePoint& point);
  void clear();
  [[nodiscard]] const std::vector<TracePoint>& points() const noexcept { return points_; }

 private:
  std::vector<TracePoint> points_;
  bool outside_ = true;
};

}  // namespace artus
