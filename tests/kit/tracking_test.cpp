// SPDX-License-Identifier: AGPL-3.0-or-later
// Rendered hands with truth: how far the needle is off in the probe's frame, whether the told error
// covers it, false markers and time a picture. ARTUS_KIT_TRIALS makes it long
// (scripts/check-hands).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <opencv2/core.hpp>

#include <gtest/gtest.h>

#include "artus/detail/devices/kit/edge_lines.h"
#include "artus/detail/devices/kit/marker_dictionary.h"
#include "artus/detail/devices/kit/tracker.h"
#include "tests/kit/scenes.h"

namespace artus::kit {
namespace {

int trials(int few) {
  const char* wanted = std::getenv("ARTUS_KIT_TRIALS");  // NOLINT(concurrency-mt-unsafe)
  return wanted == nullptr ? few : few * std::atoi(wanted);
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// What rendered trials gave.
struct Misses {
  std::vector<double> across;  // m, across the picture's plane
  std::vector<double> space;   // m
  std::vector<double> plunger;
  int pictures = 0;
  int found = 0;
  int wrong = 0;
  int covered = 0;
  double seconds = 0;
};

void follow_one(const Kit& real, const Kit& known, std::uint64_t seed,
                const test::ViewRenderer& renderer, double farthest, Misses& out) {
  constexpr int kPictures = 7;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  test::KitScene scene =
      test::make_scene(random, 0.4 + (farthest - 0.4) * any(random), -0.01 + 0.04 * any(random));
  Tracker tracker(known);
  for (int k = 0; k < kPictures; ++k) {
    scene.X_SN.translation() += Vec3(0.4e-3, 0, -0.3e-3);
    test::ViewFlaws flaws;
    flaws.picture = static_cast<std::uint64_t>(k);
    const cv::Mat view = renderer.render(test::bodies_of(scene, real), flaws, seed);
    const std::clock_t begin = std::clock();
    const HandsFrame frame = tracker.take(view, k / 30.0);
    out.seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    ++out.pictures;
    if (!frame.X_PN) continue;
    ++out.found;
    const Vec3 truth = (scene.X_SP.inverse() * scene.X_SN).translation();
    const Vec3 miss = frame.X_PN->translation() - truth;
    out.across.push_back(std::abs(miss.y()));
    out.space.push_back(miss.norm());
    out.wrong += miss.norm() > 10e-3 ? 1 : 0;
    out.covered += frame.told_error >= miss.norm() ? 1 : 0;
    if (frame.plunger) out.plunger.push_back(std::abs(*frame.plunger - scene.plunger));
  }
}

void print(const char* what, const Misses& m) {
  std::printf(
      "%s: %d pictures, found %d, across p50 %.2f p95 %.2f mm, 3D p50 %.2f p95 %.2f mm, wrong %d, "
      "covered %.1f %%, plunger p95 %.2f mm, %.1f ms a picture\n",
      what, m.pictures, m.found, 1e3 * percentile(m.across, 0.5), 1e3 * percentile(m.across, 0.95),
      1e3 * percentile(m.space, 0.5), 1e3 * percentile(m.space, 0.95), m.wrong,
      100.0 * m.covered / m.found, 1e3 * percentile(m.plunger, 0.95), 1e3 * m.seconds / m.pictures);
}

/// Pictures of one scene are not independent: of few scenes the 95th percentile is that of the
/// worst one, and the bar is held by four of five.
void expect_within_bars(const Misses& misses) {
  const double share = misses.found >= 100 ? 0.95 : 0.8;
  EXPECT_LE(percentile(misses.across, share), 1.0e-3);
  EXPECT_LE(percentile(misses.space, share), 1.7e-3);
  EXPECT_LE(misses.wrong, 2 * misses.found / 1000);
  EXPECT_GE(misses.covered, 0.9 * misses.found);
}

TEST(KitTracking, RenderedHandsAreFoundWithinTheBars) {
  cv::setNumThreads(1);
  Kit kit;
  kit.lens.distortion = {0.08, -0.12, 5e-4, -3e-4, 0};
  kit.tip_error = kit.face_error = 0;
  const test::ViewRenderer renderer(kit.lens);
  Misses misses;
  const int n = trials(16);
  for (int k = 0; k < n; ++k)
    follow_one(kit, kit, static_cast<std::uint64_t>(k + 1), renderer, 0.7, misses);
  print("exact bodies", misses);
  expect_within_bars(misses);
  EXPECT_GE(misses.found, 0.33 * misses.pictures) << "the first two of seven do not count";
  EXPECT_LE(percentile(misses.plunger, 0.95), 0.3e-3);
}

/// As a kit is after its calibration: the lens, the tip, the face and glued markers are a little
/// otherwise than they are known. From 40 to 60 cm: further away errors of the lens count more.
TEST(KitTracking, ACalibratedKitIsWithinTheBarsToo) {
  cv::setNumThreads(1);
  Misses misses;
  const int n = trials(6);
  Kit known;
  known.lens.distortion = {0.08, -0.12, 5e-4, -3e-4, 0};
  known.lens.focal_error = 0.006;
  known.tip_error = known.face_error = 0.6e-3;
  std::mt19937_64 random(11);
  std::normal_distribution<double> one(0, 1);
  const auto some = [&](double size) {
    return Vec3(size * Vec3(one(random), one(random), one(random)));
  };
  for (int k = 0; k < n; ++k) {
    Kit real = known;
    real.lens.fx *= 1 + 0.003 * std::clamp(one(random), -1.5, 1.5);
    real.lens.fy = real.lens.fx;
    real.X_BN.translation() += some(0.15e-3);
    real.X_BP.translation() += some(0.15e-3);
    for (MarkerBody* body : {&real.probe, &real.syringe})
      for (Marker& marker : body->markers) {
        const Vec3 off = some(0.015e-3);
        for (Vec3& corner : marker.corners) corner += off;
      }
    follow_one(real, known, static_cast<std::uint64_t>(k + 1001), test::ViewRenderer(real.lens),
               0.6, misses);
  }
  print("calibrated kit", misses);
  expect_within_bars(misses);
}

TEST(KitTracking, NothingIsSeenInClutter) {
  cv::setNumThreads(1);
  const test::ViewRenderer renderer{Lens()};
  test::ViewFlaws flaws;
  flaws.clutter = 200;
  std::size_t seen = 0;
  const int n = trials(20);
  for (int k = 0; k < n; ++k)
    seen += see_markers(renderer.render({}, flaws, static_cast<std::uint64_t>(k + 77))).size();
  EXPECT_EQ(seen, 0U) << "in " << n << " pictures";
}

}  // namespace
}  // namespace artus::kit
