// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/beam_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr double kSteeper = 3;    // from beam to beam, of a round wall where it grows steep
constexpr double kStretches = 2;  // times its length before, a wall at most; assumed

using Stretches = std::vector<BeamStretch>;

/// From the first roof to the last floor. Requires: one at least.
BeamStretch hull(const Stretches& stretches) {
  return {stretches.front().roof, stretches.back().floor};
}

/// The same of those that lie beside a stretch; nullopt: none does.
std::optional<BeamStretch> beside(const BeamStretch& one, const Stretches& others) {
  Stretches found;
  for (const BeamStretch& other : others)
    if (std::min(one.floor, other.floor) > std::max(one.roof, other.roof)) found.push_back(other);
  return found.empty() ? std::nullopt : std::optional(hull(found));
}

/// What of two beams lies beside each other, directly or by others in between.
struct Pair {
  Stretches left;
  Stretches right;
};
std::vector<Pair> pair_up(const Stretches& left, const Stretches& right) {
  std::vector<Pair> pairs;
  double floor = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = 0; i < left.size() || j < right.size();) {
    const bool is_left = j == right.size() || (i < left.size() && left[i].roof < right[j].roof);
    const BeamStretch& next = is_left ? left[i++] : right[j++];
    if (next.roof >= floor) pairs.emplace_back();
    (is_left ? pairs.back().left : pairs.back().right).push_back(next);
    floor = std::max(floor, next.floor);
  }
  return pairs;
}

/// The tissue between stretches.
Stretches between(const Stretches& stretches) {
  Stretches tissue;
  for (std::size_t i = 0; i + 1 < stretches.size(); ++i)
    tissue.push_back({stretches[i].floor, stretches[i + 1].roof});
  return tissue;
}

/// By how much a wall goes too far from a beam to the next: a round one grows steep before it does
/// so, a cut does not. `before`, `behind`: the same a beam away; none: it ends there.
double sudden(double step, std::optional<double> before, std::optional<double> behind) {
  const double sign = step < 0 ? -1 : 1;
  double least = before || behind ? std::abs(step) : 0;
  for (const auto& other : {before, behind})
    if (other) least = std::min(least, std::max(0.0, sign * *other));
  return std::max(0.0, std::abs(step) - kSteeper * least);
}

/// The largest step from one of two beams to the other. `length_before`: m that the wall between
/// the two was long, from one depth to another.
template <class LengthBefore>
class LargestStep {
 public:
  explicit LargestStep(LengthBefore length_before) : length_before_(length_before) {}

  /// Of four beams that follow each other, from the second to the third.
  void add_beams(const Stretches& before, const Stretches& left, const Stretches& right,
                 const Stretches& behind) {
    for (const Pair& pair : pair_up(left, right)) {
      if (pair.right.empty()) {
        add_end(hull(pair.left), before);
      } else if (pair.left.empty()) {
        add_end(hull(pair.right), behind);
      } else {
        add_walls(before, hull(pair.left), hull(pair.right), behind);
        const Stretches tissue_left = between(pair.left);
        const Stretches tissue_right = between(pair.right);
        if (!tissue_left.empty() || !tissue_right.empty())
          add_beams(between(before), tissue_left, tissue_right, between(behind));
      }
    }
  }
  [[nodiscard]] double step() const { return step_; }

 private:
  /// `share`: of the wall from one depth to the other, what the step is.
  void add(double sudden_step, double from, double to, double share = 1) {
    if (sudden_step <= step_) return;
    const double there = share * length_before_(std::min(from, to), std::max(from, to));
    if (sudden_step > kStretches * there) step_ = sudden_step;
  }
  /// Both walls meet.
  void add_end(const BeamStretch& one, const Stretches& before) {
    const auto last = beside(one, before);
    using Step = std::optional<double>;
    const Step narrower =
        last ? Step(std::max(one.roof - last->roof, last->floor - one.floor)) : Step();
    add(sudden((one.floor - one.roof) / 2, narrower, {}), one.roof, one.floor, 0.5);
  }
  void add_walls(const Stretches& before, const BeamStretch& left, const BeamStretch& right,
                 const Stretches& behind) {
    const auto last = beside(left, before);
    const auto far = beside(right, behind);
    const auto add_wall = [&](double BeamStretch::*wall) {
      using Step = std::optional<double>;
      add(sudden(right.*wall - left.*wall, last ? Step(left.*wall - (*last).*wall) : Step(),
                 far ? Step((*far).*wall - right.*wall) : Step()),
          left.*wall, right.*wall);
    };
    add_wall(&BeamStretch::roof);
    add_wall(&BeamStretch::floor);
  }

  LengthBefore length_before_;
  double step_ = 0;
};

}  // namespace

Transducer spaced_evenly(const Transducer& transducer) {
  Transducer even = transducer;
  even.n_lines = static_cast<int>(transducer.width / kBeamSpacing) + 1;
  return even;
}

BeamWalls find_walls(const Scene& scene, const Pose& X_JP, const Transducer& transducer,
                     double depth, const std::vector<bool>& regions) {
  const Transducer even = spaced_evenly(transducer);
  BeamWalls walls(static_cast<std::size_t>(even.n_lines));
  std::array<TissueInterval, 128> intervals;
  for (int i = 0; i < even.n_lines; ++i) {
    const Scanline line = scanline(even, i);
    const Segment beam{X_JP * line.origin, X_JP * Vec3(line.origin + depth * line.direction)};
    const QueryCount count = scene.find_intervals(beam, intervals);
    auto& stretches = walls[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < count.size; ++k) {
      if (!regions[intervals[k].region]) continue;
      const bool goes_on = k > 0 && regions[intervals[k - 1].region];
      if (!goes_on) stretches.push_back({intervals[k].entry, intervals[k].exit});
      stretches.back().floor = intervals[k].exit;
    }
  }
  return walls;
}

std::vector<double> wall_steps(const BeamWalls& walls, const SliceWall* wall) {
  std::vector<double> steps;
  const std::vector<BeamStretch> none;
  for (std::size_t i = 0; i + 1 < walls.size(); ++i) {
    const auto& left = i > 0 ? walls[i - 1] : none;
    const auto& right = i + 2 < walls.size() ? walls[i + 2] : none;
    const auto length_before = [&](double from, double to) {
      return wall != nullptr ? wall->length_before(i, from, to) : 0;
    };
    LargestStep largest(length_before);
    largest.add_beams(left, walls[i], walls[i + 1], right);
    steps.push_back(largest.step());
  }
  return steps;
}

WallJump find_wall_jump(const BeamWalls& before, const BeamWalls& after, const SliceWall* wall) {
  ARTUS_REQUIRE(before.size() == after.size(), "as many beams before as after");
  constexpr std::size_t kBeside = 15;  // beams, 3 mm: liquid moves a wall aside
  const std::vector<double> was = wall_steps(before, nullptr);
  const std::vector<double> is = wall_steps(after, wall);
  WallJump out;
  for (std::size_t i = 0; i < is.size(); ++i) {
    const auto first = was.begin() + static_cast<std::ptrdiff_t>(i > kBeside ? i - kBeside : 0);
    const auto last =
        was.begin() + static_cast<std::ptrdiff_t>(std::min(i + kBeside + 1, was.size()));
    const double jump = is[i] - *std::max_element(first, last);
    if (jump > out.jump) out = {jump, i};
  }
  return out;
}

}  // namespace artus
