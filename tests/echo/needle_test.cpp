// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>

#include <gtest/gtest.h>

#include "core/units.h"
#include "echo/labels.h"
#include "echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

using test::FlatLayer;

TEST(Needle, GaugesRingAtTheirOwnPitch) {
  for (const auto& [gauge, pitch_mm] :
       {std::pair(18, 0.98), {20, 0.70}, {21, 0.61}, {22, 0.51}, {23, 0.43}, {25, 0.34}}) {
    const auto shape = needle_of_gauge(gauge);
    ASSERT_TRUE(shape.has_value());
    EXPECT_NEAR(reverberation_pitch(*shape) * 1e3, pitch_mm, 0.01) << gauge;
  }
  EXPECT_FALSE(needle_of_gauge(19).has_value());
}

TEST(Needle, CastsAShadowAndEndsAtItsTip) {
  const std::array<FlatLayer, 1> layers{{{"muscle", 60e-3}}};
  ImageSettings settings = test::bare_settings();
  Renderer renderer(test::make_block_scene(layers), Transducer{}, settings);
  const Pose X_JP = test::probe_at();
  const Frame without = renderer.render(X_JP);
  const Frame& with = renderer.render(X_JP, test::needle_at(X_JP, Vec3(0, 0, 20e-3), 20 * kDegree));
  const auto below = [](const Frame& frame, int first, int last) {
    double sum = 0;
    for (int l = first; l < last; ++l) {
      for (std::size_t i = 700; i < 900; ++i) sum += test::envelope_line(frame, l)[i];
    }
    return sum;
  };
  EXPECT_LT(below(with, 60, 120), 0.7 * below(without, 60, 120));
  EXPECT_DOUBLE_EQ(below(with, 140, 200), below(without, 140, 200));
}

TEST(Needle, TruthTellsTipOffsetAndAngles) {
  const Transducer transducer;
  const ImageSettings settings;
  const Pose X_JP = test::probe_at();
  NeedleView needle = test::needle_at(X_JP, Vec3(3e-3, 0, 20e-3), 30 * kDegree);
  const NeedleTruth in = locate_needle(needle, X_JP, transducer, settings);
  EXPECT_TRUE(in.in_plane);
  EXPECT_NEAR(in.face_angle, 30 * kDegree, 1e-9);
  EXPECT_NEAR(in.plane_angle, 0, 1e-9);
  EXPECT_NEAR(in.tip.x, 23e-3 / settings.pixel - 0.5, 1e-6);
  EXPECT_NEAR(in.tip.y, 20e-3 / settings.pixel - 0.5, 1e-6);
  needle = test::needle_at(X_JP, Vec3(3e-3, 2e-3, 20e-3), 30 * kDegree);
  const NeedleTruth off = locate_needle(needle, X_JP, transducer, settings);
  EXPECT_FALSE(off.in_plane);
  EXPECT_NEAR(off.tip_offset, 2e-3, 1e-12);
}

}  // namespace
}  // namespace artus
