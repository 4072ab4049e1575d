// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/beam_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr double kSteeper = 3;  // from beam to beam, of a round wall where it grows steep

/// The stretch of the next beam that lies beside this one for longest; null: none does.
const BeamStretch* beside(const BeamStretch& one, const std::vector<BeamStretch>& next) {
  const BeamStretch* found = nullptr;
  double longest = 0;
  for (const BeamStretch& other : next) {
    const double shared = std::min(one.floor, other.floor) - std::max(one.roof, other.roof);
    if (shared <= longest) continue;
    longest = shared;
    found = &other;
  }
  return found;
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

/// The largest from one beam to the next, `before` and `behind` the beams that go on from there.
double step_to(const std::vector<BeamStretch>& before, const std::vector<BeamStretch>& beam,
               const std::vector<BeamStretch>& next, const std::vector<BeamStretch>& behind) {
  double step = 0;
  for (const BeamStretch& one : beam) {
    const BeamStretch* last = beside(one, before);
    const BeamStretch* other = beside(one, next);
    using Step = std::optional<double>;
    const Step roof = last ? Step(one.roof - last->roof) : Step();
    const Step floor = last ? Step(one.floor - last->floor) : Step();
    if (other == nullptr) {  // both walls meet
      const Step narrower = last ? Step(std::max(*roof, -*floor)) : Step();
      step = std::max(step, sudden((one.floor - one.roof) / 2, narrower, {}));
      continue;
    }
    const BeamStretch* far = beside(*other, behind);
    const Step far_roof = far ? Step(far->roof - other->roof) : Step();
    const Step far_floor = far ? Step(far->floor - other->floor) : Step();
    step = std::max({step, sudden(other->roof - one.roof, roof, far_roof),
                     sudden(other->floor - one.floor, floor, far_floor)});
  }
  return step;
}

}  // namespace

BeamWalls find_walls(const Scene& scene, const Pose& X_JP, const Transducer& transducer,
                     double depth, const std::vector<bool>& regions) {
  Transducer even = transducer;
  even.n_lines = static_cast<int>(transducer.width / kBeamSpacing) + 1;
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

std::vector<double> wall_steps(const BeamWalls& walls) {
  std::vector<double> steps;
  const std::vector<BeamStretch> none;
  for (std::size_t i = 0; i + 1 < walls.size(); ++i) {
    const auto& left = i > 0 ? walls[i - 1] : none;
    const auto& right = i + 2 < walls.size() ? walls[i + 2] : none;
    steps.push_back(std::max(step_to(left, walls[i], walls[i + 1], right),
                             step_to(right, walls[i + 1], walls[i], left)));
  }
  return steps;
}

WallJump find_wall_jump(const BeamWalls& before, const BeamWalls& after) {
  ARTUS_REQUIRE(before.size() == after.size(), "as many beams before as after");
  constexpr std::size_t kBeside = 15;  // beams, 3 mm: liquid moves a wall aside
  const std::vector<double> was = wall_steps(before);
  const std::vector<double> is = wall_steps(after);
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
