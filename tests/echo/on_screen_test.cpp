// SPDX-License-Identifier: AGPL-3.0-or-later
// What screens show otherwise than single rays: skin flat under the face, no black bands below
// edges, bone that slopes across the slice as one line.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/shown_places.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

constexpr double kSkin = 60e-3;  // m, radius of the round body

ImageSettings look_of(Look look) {
  ImageSettings settings;
  settings.look = look;
  settings.clutter = false;
  settings.n_threads = 1;
  return settings;
}

/// A probe on, or `above` (m), a round limb.
Renderer over_round_limb(Look look) {
  const std::array<test::SphereLayer, 4> layers{
      {{"skin", kSkin}, {"fat", 58e-3}, {"muscle", 52e-3}, {"bone", 20e-3}}};
  const auto joint = std::make_shared<CompiledJoint>(test::make_nested_spheres(layers));
  return Renderer(std::make_shared<Scene>(joint), Transducer{}, look_of(look));
}

/// m of the picture above the skin on a line.
double gap_shown(const ShownPlaces& places, int line) {
  const double sample_depth = 40e-3 / 1024;
  for (const ShownPlaces::Piece& piece : places.line(line))
    if (piece.region >= kFirstRegion) return piece.begin * sample_depth;
  return 40e-3;
}

TEST(FlatSkin, LiesUnderAFaceThatTouchesARoundLimb) {
  const Pose touching = test::probe_at(0, 0, -kSkin);
  const ShownPlaces flat = over_round_limb(Look::clinical).shown_places(touching);
  const ShownPlaces round = over_round_limb(Look::raw).shown_places(touching);
  const Transducer probe;
  for (const int line : {0, 20, 60, 100, 128}) {
    const double x = (line - 0.5 * (probe.n_lines - 1)) * probe.pitch();
    const double gap = kSkin - std::sqrt(kSkin * kSkin - x * x);
    EXPECT_NEAR(gap_shown(round, line), gap * 1540 / 1480, 0.15e-3);
    EXPECT_NEAR(gap_shown(flat, line), std::max(0.0, gap - 3e-3), 0.15e-3) << "gap " << gap;
    // five times as deep nothing has moved, but for the speed of what took the gel's place
    const double deep = 6.5 * std::min(gap, 3e-3) + 1e-3;
    EXPECT_NEAR(flat.sample_of(line, deep), round.sample_of(line, deep), 8);
    EXPECT_LT((flat.needle_place(line, 30) - round.needle_place(line, 30)).norm(), 0.15e-3);
    EXPECT_LT((flat.place(line, 900) - round.place(line, 900)).norm(), 0.4e-3);
  }
}

TEST(FlatSkin, IsNotPulledToAFaceThatHovers) {
  const Pose hovering = test::probe_at(0, 0, -kSkin - 1e-3);
  const ShownPlaces shown = over_round_limb(Look::clinical).shown_places(hovering);
  EXPECT_NEAR(gap_shown(shown, 128), 1e-3 * 1540 / 1480, 0.1e-3);
  EXPECT_GT(gap_shown(shown, 30), 2e-3);
}

/// The least of the lines' mean levels (dB, over their median) below the edges of a ball of tendon
/// in fat; three lines side by side.
double darkest_below_ball(Look look) {
  test::BlockWithSphere block;
  block.tissue = "fat";
  block.size = Vec3(80e-3, 40e-3, 60e-3);
  block.inclusion = "tendon";
  block.centre = Vec3(0, 0, 12e-3);
  block.radius = 5e-3;
  auto joint = std::make_shared<CompiledJoint>(test::make_block_with_sphere(block));
  test::acoustic_of(*joint, "tendon").attenuation = test::acoustic_of(*joint, "fat").attenuation;
  const auto scene = std::make_shared<Scene>(joint);
  const Frame frame = render_bmode(scene, test::probe_at(), {}, {}, look_of(look));
  std::vector<double> levels;
  for (int l = 40; l + 2 < frame.n_lines - 40; ++l) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const auto line = test::envelope_line(frame, l + k);
      for (std::size_t i = 560; i < 760; ++i)
        sum += static_cast<double>(line[i]) * static_cast<double>(line[i]);
    }
    levels.push_back(10 * std::log10(sum));
  }
  std::vector<double> sorted = levels;
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  return *std::min_element(levels.begin(), levels.end()) - sorted[sorted.size() / 2];
}

TEST(EdgesOnScreen, ThrowNoBlackBand) {
  EXPECT_LT(darkest_below_ball(Look::raw), -12);
  EXPECT_GT(darkest_below_ball(Look::clinical), -7);
}

/// The darkest place between the outermost echoes above -12 dB of a bone that slopes across the
/// slice by 30 degrees, dB under its brightest.
double gap_in_bone(Look look) {
  const std::array<test::FlatLayer, 2> layers{{{"muscle", 20e-3}, {"bone", 60e-3}}};
  const auto scene = test::make_block_scene(
      layers, [](CompiledJoint& joint) { test::acoustic_of(joint, "muscle").backscatter = 0; });
  ImageSettings settings = look_of(look);
  settings.noise_db = -200;
  const Pose tilted = test::probe_at() * Pose(Eigen::AngleAxisd(30 * kDegree, Vec3::UnitX()));
  const Frame frame = render_bmode(scene, tilted, {}, {}, settings);
  std::vector<double> line;
  for (const float e : test::envelope_line(frame, 128)) line.push_back(static_cast<double>(e));
  const double most = *std::max_element(line.begin() + 300, line.end());
  const auto seen = [&](double e) {
    return e > 0.25 * most;
  };
  const auto first = std::find_if(line.begin() + 300, line.end(), seen);
  const auto last = std::find_if(line.rbegin(), line.rend(), seen).base();
  return test::decibel(*std::min_element(first, last) / most);
}

TEST(BoneOnScreen, IsOneLineWhereItSlopesAcrossTheSlice) {
  EXPECT_LT(gap_in_bone(Look::raw), -14);
  EXPECT_GT(gap_in_bone(Look::clinical), -12.5);
}

}  // namespace
}  // namespace artus
