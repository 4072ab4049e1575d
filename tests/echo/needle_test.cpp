// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

struct Bright {
  int grey = 0;
  PixelPoint place;
};

/// The brightest pixel less than `reach` pixels from `p`, the first one in reading order.
Bright brightest_near(const Frame& frame, const PixelPoint& p, int reach) {
  Bright best;
  for (int y = static_cast<int>(p.y) - reach; y < p.y + reach; ++y) {
    for (int x = static_cast<int>(p.x) - reach; x < p.x + reach; ++x) {
      const int grey =
          frame.image[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
                      static_cast<std::size_t>(x)];
      if (grey > best.grey) best = {grey, {static_cast<double>(x), static_cast<double>(y)}};
    }
  }
  return best;
}

using test::FlatLayer;

TEST(Needle, GaugesRingAtTheirOwnPitch) {
  for (const auto& [gauge, pitch_mm] :
       {std::pair(18, 0.98), {20, 0.70}, {21, 0.61}, {22, 0.51}, {23, 0.43}, {25, 0.34}}) {
    const auto shape = needle_of_gauge(gauge);
    ASSERT_TRUE(shape.has_value());
    EXPECT_NEAR(reverberation_pitch(*shape) * 1e3, pitch_mm, 0.01) << gauge;
  }
  EXPECT_FALSE(needle_of_gauge(24).has_value());
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
  // the aperture looks round the tip: half the shadow straight below it, none 5 mm beside it
  const double edge = below(with, 124, 132) / below(without, 124, 132);
  EXPECT_LT(below(with, 90, 100) / below(without, 90, 100), edge);
  EXPECT_LT(edge, below(with, 140, 148) / below(without, 140, 148));
  EXPECT_DOUBLE_EQ(below(with, 165, 220), below(without, 165, 220));
}

/// Silent muscle at the display's speed of sound: nothing but the needle, and that in its place.
std::shared_ptr<const Scene> silent_block() {
  const std::array<FlatLayer, 1> layers{{{"muscle", 60e-3}}};
  return test::make_block_scene(layers, [](CompiledJoint& joint) {
    Acoustic& muscle = test::acoustic_of(joint, "muscle");
    muscle.speed_of_sound = 1540;
    muscle.attenuation = 0;
    muscle.backscatter = 0;
  });
}

TEST(Needle, ShowsItsTipWithinAPixelOfTheTruth) {
  const ImageSettings settings = test::bare_settings();  // pixels of 0.1 mm
  Renderer renderer(silent_block(), Transducer{}, settings);
  const Pose X_JP = test::probe_at();
  for (const int gauge : {18, 20, 22, 25}) {
    for (const double degrees : {40.0, 50.0, 60.0, 70.0}) {  // the tip outshines the shaft
      for (const Vec3& tip : {Vec3(2.03e-3, 0, 22e-3), Vec3(-3.1e-3, 0, 11.4e-3)}) {
        NeedleView needle = test::needle_at(X_JP, tip, degrees * kDegree);
        needle.shape = *needle_of_gauge(gauge);
        const Frame& frame = renderer.render(X_JP, needle);
        const NeedleTruth truth = locate_needle(needle, X_JP, Transducer{}, settings);
        const auto [best, seen] = brightest_near(frame, truth.tip, 5);
        EXPECT_GT(best, 150) << gauge << " G, " << degrees;
        EXPECT_NEAR(seen.x, truth.tip.x, 1) << gauge << " G, " << degrees;
        EXPECT_NEAR(seen.y, truth.tip.y, 1) << gauge << " G, " << degrees;
      }
    }
  }
}

TEST(Needle, SaysWhereItsTipShowsThroughLayers) {
  // fat delays what lies below by 5 % of its thickness; steering bends the beam as well
  const std::array<FlatLayer, 2> layers{{{"fat", 12e-3}, {"muscle", 50e-3}}};
  const auto scene = test::make_block_scene(layers, [](CompiledJoint& joint) {
    for (const char* name : {"fat", "muscle"}) {
      test::acoustic_of(joint, name).attenuation = 0;
      test::acoustic_of(joint, name).backscatter = 0;
    }
  });
  const ImageSettings settings = test::bare_settings();
  const Pose X_JP = test::probe_at();
  const NeedleView needle = test::needle_at(X_JP, Vec3(2e-3, 0, 20e-3), 60 * kDegree);
  for (const double steering : {0.0, 15 * kDegree}) {
    Transducer transducer;
    transducer.steering = steering;
    Renderer renderer(scene, transducer, settings);
    EXPECT_FALSE(renderer.render(X_JP).tip_shown.has_value());
    const Frame& frame = renderer.render(X_JP, needle);
    ASSERT_TRUE(frame.tip_shown.has_value());
    const NeedleTruth truth = locate_needle(needle, X_JP, transducer, settings);
    if (steering == 0) {
      const double late = 12e-3 * (1540.0 / 1462 - 1) + 8e-3 * (1540.0 / 1562 - 1);
      EXPECT_NEAR(frame.tip_shown->x, truth.tip.x, 1e-6);
      EXPECT_NEAR(frame.tip_shown->y - truth.tip.y, late / settings.pixel, 0.05);
    }
    const PixelPoint seen = brightest_near(frame, *frame.tip_shown, 4).place;
    EXPECT_NEAR(seen.x, frame.tip_shown->x, 1);
    EXPECT_NEAR(seen.y, frame.tip_shown->y, 1);
  }
  // behind bone it does not show
  const std::array<FlatLayer, 2> bone{{{"muscle", 10e-3}, {"bone", 50e-3}}};
  Renderer renderer(test::make_block_scene(bone), Transducer{}, settings);
  EXPECT_FALSE(renderer.render(X_JP, needle).tip_shown.has_value());
}

TEST(Needle, ShaftEndsWithinHalfAPixelOfItsTip) {
  const Transducer transducer;
  Renderer renderer(silent_block(), transducer, test::bare_settings());
  const Pose X_JP = test::probe_at();
  for (const double x_tip : {-3.1e-3, 0.3e-3, 2.03e-3, 2.07e-3}) {
    for (const double degrees : {0.0, 10.0, 20.0}) {
      const double angle = degrees * kDegree;
      const NeedleView needle = test::needle_at(X_JP, Vec3(x_tip, 0, 15e-3), angle);
      const Frame& frame = renderer.render(X_JP, needle);
      const auto wall_at = [&](int l) {
        const double x = scanline(transducer, l).origin.x();
        const double depth = 15e-3 + (x - x_tip) * std::tan(angle) -
                             needle.shape.outer_diameter / 2 / std::cos(angle);
        return peak_value(frame, l, depth - 0.1e-3, depth + 0.1e-3);
      };
      const int far = static_cast<int>((x_tip - 3e-3 + 20e-3) / transducer.pitch());
      const double half = wall_at(far) / 2;
      int l = far;
      while (wall_at(l + 1) > half) ++l;
      const double part = (wall_at(l) - half) / (wall_at(l) - wall_at(l + 1));
      const double end = scanline(transducer, l).origin.x() + part * transducer.pitch();
      EXPECT_NEAR(end, x_tip, 0.05e-3) << degrees;
    }
  }
}

TEST(Needle, LightTellsTheShadowWithoutNoise) {
  const std::array<FlatLayer, 1> layers{{{"muscle", 60e-3}}};
  Renderer renderer(test::make_block_scene(layers), Transducer{}, ImageSettings{});
  const Pose X_JP = test::probe_at();
  const Frame without = renderer.render(X_JP);
  EXPECT_EQ(*std::min_element(without.needle_light.begin(), without.needle_light.end()), 1.0F);
  const Frame& with = renderer.render(X_JP, test::needle_at(X_JP, Vec3(0, 0, 20e-3), 20 * kDegree));
  const auto at = [&](int line, double depth) {
    return with.needle_light[static_cast<std::size_t>(line) * 1024 +
                             static_cast<std::size_t>(depth / with.sample_depth)];
  };
  EXPECT_LT(at(80, 30e-3), 0.9);
  EXPECT_EQ(at(80, 10e-3), 1.0F);
  EXPECT_EQ(at(230, 30e-3), 1.0F);
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
