// SPDX-License-Identifier: AGPL-3.0-or-later
#include "bench/raycast/workloads.h"

#include <array>

#include "artus/detail/core/noise.h"
#include "tests/support/layered_body.h"

namespace artus::bench {
namespace {

constexpr double kSkinRadius = 0.06;  // m

Vec3 body_centre() {
  return {-0.18, -0.05, 1.32};
}

Vec3 random_point(std::uint64_t seed, std::uint64_t i, double half) {
  return half * Vec3(2 * uniform_noise(seed, 3 * i) - 1, 2 * uniform_noise(seed, 3 * i + 1) - 1,
                     2 * uniform_noise(seed, 3 * i + 2) - 1);
}

}  // namespace

CompiledJoint make_body() {
  const std::array<test::SphereLayer, 5> layers{{{"skin", kSkinRadius},
                                                 {"fat", 0.058},
                                                 {"muscle", 0.05},
                                                 {"tendon", 0.035},
                                                 {"bone", 0.025}}};
  return test::make_nested_spheres(layers, body_centre(), 5);
}

std::vector<Segment> make_random_segments(std::size_t count) {
  std::vector<Segment> segments;
  segments.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    segments.push_back({body_centre() + random_point(1, 2 * i, kSkinRadius),
                        body_centre() + random_point(1, 2 * i + 1, kSkinRadius)});
  }
  return segments;
}

std::vector<Segment> make_strokes(std::size_t count) {
  constexpr std::uint64_t kTicks = 1000;
  constexpr double kNeedleLength = 0.05;  // m
  constexpr double kOutside = 0.01;       // m
  constexpr double kDepth = 0.045;        // m
  std::vector<Segment> segments;
  segments.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t stroke = i / kTicks;
    const double share = static_cast<double>(i % kTicks) / static_cast<double>(kTicks);
    const Vec3 outward = random_point(2, 2 * stroke, 1).normalized();
    const Vec3 target = random_point(2, 2 * stroke + 1, 0.02);
    const Vec3 entry = kSkinRadius * outward;
    const Vec3 along = (target - entry).normalized();
    const Vec3 tip = body_centre() + entry + (share * (kOutside + kDepth) - kOutside) * along;
    segments.push_back({tip - kNeedleLength * along, tip});
  }
  return segments;
}

}  // namespace artus::bench
