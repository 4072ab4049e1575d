// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>
#include <vector>

#include "artus/raycast/scene.h"

namespace artus {

/// Layers whose crossings are known in closed form, for experiments that need no joint: a stack of
/// half spaces along an axis, or balls round a centre. Layer i (outermost first) is region
/// kFirstRegion + i.
class AnalyticBody {
 public:
  /// Half spaces: layer i begins at `begins[i]` m along `into` (unit) from `origin`, rising.
  static AnalyticBody make_stack(const Vec3& origin, const Vec3& into, std::vector<double> begins);
  /// Balls: layer i fills from `radii[i]` m inwards, falling.
  static AnalyticBody make_balls(const Vec3& centre, std::vector<double> radii);

  /// The segment cut into stretches of one region each, as Scene::find_intervals gives them.
  ARTUS_REALTIME QueryCount find_intervals(const Segment& segment,
                                           std::span<TissueInterval> out) const noexcept;

 private:
  struct Span {
    double from = 0;
    double to = 0;
  };
  AnalyticBody(bool balls, const Vec3& origin, const Vec3& into, std::vector<double> sizes)
      : balls_(balls), origin_(origin), into_(into), sizes_(std::move(sizes)) {}
  [[nodiscard]] Span clip(std::size_t layer, const Vec3& start, const Vec3& direction,
                          double length) const noexcept;

  bool balls_;
  Vec3 origin_;
  Vec3 into_;
  std::vector<double> sizes_;
};

}  // namespace artus
