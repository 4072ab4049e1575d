// SPDX-License-Identifier: AGPL-3.0-or-later
#include "echo/renderer.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "core/units.h"
#include "echo/beam_profile.h"
#include "echo/display.h"
#include "echo/labels.h"
#include "tests/echo/echo_fixture.h"

namespace artus {
namespace {

using test::FlatLayer;

constexpr std::array<FlatLayer, 4> kLayers{
    {{"skin", 2e-3}, {"fat", 6e-3}, {"muscle", 14e-3}, {"bone", 20e-3}}};

TEST(Renderer, GivesTheSameBytesAtAnyThreadCount) {
  const auto scene = test::make_block_scene(kLayers);
  const Pose X_JP = make_pose(Vec3(1e-3, 2e-3, 0), Vec3(0.1, 0.05, 1), Vec3(1, 0.2, 0));
  const NeedleView needle = test::needle_at(X_JP, Vec3(2e-3, 0, 14e-3), 0.4);
  std::vector<Frame> frames;
  for (const int threads : {1, 2, 7}) {
    ImageSettings settings;
    settings.n_threads = threads;
    frames.push_back(render_bmode(scene, X_JP, needle, {}, settings));
  }
  for (std::size_t k = 1; k < frames.size(); ++k) {
    EXPECT_EQ(frames[0].in_phase, frames[k].in_phase);
    EXPECT_EQ(frames[0].envelope, frames[k].envelope);
    EXPECT_EQ(frames[0].image, frames[k].image);
  }
}

TEST(Renderer, RigidMotionOfBodyAndProbeLeavesTheBytes) {
  const auto scene = test::make_block_scene(kLayers);
  Renderer renderer(scene, Transducer{}, ImageSettings{});
  const Pose X_JP = make_pose(Vec3(1e-3, 2e-3, 0), Vec3(0.1, 0.05, 1), Vec3(1, 0.2, 0));
  const Frame still = renderer.render(probe_in_joint(Pose::Identity(), X_JP));
  for (int k = 1; k <= 3; ++k) {
    Pose X_WJ = Pose::Identity();
    X_WJ.linear() = Eigen::AngleAxisd(0.7 * k, Vec3(1, 2, -k).normalized()).toRotationMatrix();
    X_WJ.translation() = Vec3(0.3 * k, -1.1, 0.7);
    const Frame& moved = renderer.render(probe_in_joint(X_WJ, X_WJ * X_JP));
    EXPECT_EQ(still.envelope, moved.envelope);
    EXPECT_EQ(still.image, moved.image);
  }
}

TEST(Renderer, PointTargetsAreAsWideAsTheBeam) {
  const std::array<FlatLayer, 1> layers{{{"muscle", 60e-3}}};
  const auto scene = test::make_block_scene(layers, [](CompiledJoint& joint) {
    Acoustic& muscle = test::acoustic_of(joint, "muscle");
    muscle.attenuation = 0;
    muscle.backscatter = 0;
  });
  Transducer transducer;
  transducer.n_lines = 1001;  // 0.04 mm apart: the width is read between lines
  transducer.width = 40e-3;
  Renderer renderer(scene, transducer, test::bare_settings());
  const auto amplitude = [&](int line, double depth) {
    const Frame& frame = renderer.render(test::probe_at());
    return test::envelope_line(
        frame,
        line)[static_cast<std::size_t>(test::find_peak(frame, line, depth - 1e-3, depth + 1e-3))];
  };
  for (const double depth : {10e-3, 20e-3, 30e-3}) {
    renderer.set_point_reflectors({{Vec3(0, 0, depth), 1}});
    const Frame& frame = renderer.render(test::probe_at());
    const int middle = test::find_peak(frame, 500, depth - 1e-3, depth + 1e-3);
    const float half = test::envelope_line(frame, 500)[static_cast<std::size_t>(middle)] / 2;
    int above = 0;
    for (int l = 400; l <= 600; ++l) {
      const int peak = test::find_peak(frame, l, depth - 1e-3, depth + 1e-3);
      above += test::envelope_line(frame, l)[static_cast<std::size_t>(peak)] > half ? 1 : 0;
    }
    EXPECT_NEAR(above * 0.04e-3, 0.25e-3, 0.15 * 0.25e-3) << depth;  // 0.97 wavelengths * F/2
  }
  for (const double depth : {20e-3, 30e-3}) {
    // elevation: half the amplitude where half the profile's width lies beside the plane
    renderer.set_point_reflectors({{Vec3(0, 0, depth), 1}});
    const double centre = amplitude(500, depth);
    const double half = BeamProfile(transducer, 50e-3).elevation_width(depth) / 2;
    renderer.set_point_reflectors({{Vec3(0, half, depth), 1}});
    EXPECT_NEAR(amplitude(500, depth) / centre, 0.5, 0.1) << depth;
  }
}

TEST(Renderer, SliceIsAsThickAsTheLensMakesIt) {
  // measured with a wave model for 12 MHz and a lens at 20 mm: depth, width per element height
  struct Row {
    double height;
    std::array<double, 4> widths;  // m, at 10, 20, 30 and 40 mm
  };
  const std::array<Row, 3> rows{{{4e-3, {1.4e-3, 0.64e-3, 1.0e-3, 1.6e-3}},
                                 {5e-3, {1.9e-3, 0.51e-3, 1.04e-3, 3.3e-3}},
                                 {6e-3, {2.3e-3, 0.43e-3, 1.95e-3, 4.3e-3}}}};
  for (const Row& row : rows) {
    Transducer transducer;
    transducer.elevation_height = row.height;
    const BeamProfile profile(transducer, 41e-3);
    for (std::size_t i = 0; i < 4; ++i) {
      const double depth = 10e-3 * static_cast<double>(i + 1);
      EXPECT_NEAR(profile.elevation_width(depth), row.widths[i], 0.15 * row.widths[i])
          << row.height << " " << depth;
    }
  }
}

TEST(Renderer, LabelsSayWhatLiesInThePlane) {
  const auto scene = test::make_block_scene(kLayers);
  const ImageSettings settings;
  const LabelImage labels = render_labels(*scene, test::probe_at(), Transducer{}, settings);
  const auto at = [&](double depth) {
    const auto y = static_cast<std::size_t>(depth / settings.pixel);
    return scene->joint()
        .regions[labels.regions[y * static_cast<std::size_t>(labels.width) + 200]]
        .name;
  };
  EXPECT_EQ(at(1e-3), "skin");
  EXPECT_EQ(at(5e-3), "fat");
  EXPECT_EQ(at(15e-3), "muscle");
  EXPECT_EQ(at(30e-3), "bone");
}

TEST(Renderer, BadInputIsRefusedOrBlack) {
  const auto scene = test::make_block_scene(kLayers);
  Transducer transducer;
  transducer.n_lines = 10000;
  EXPECT_FALSE(validate(transducer).has_value());
  EXPECT_THROW(Renderer(scene, transducer, ImageSettings{}), std::invalid_argument);
  transducer = {};
  transducer.width = 0;
  EXPECT_FALSE(validate(transducer).has_value());
  transducer = {};
  transducer.frequency = 1e12;
  EXPECT_FALSE(validate(transducer).has_value());
  ImageSettings settings;
  settings.depth = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(validate(settings).has_value());

  Renderer renderer(scene, Transducer{}, ImageSettings{});
  Pose nan = test::probe_at();
  nan.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(renderer.render(nan), std::invalid_argument);
  const Frame& inside_bone = renderer.render(test::probe_at(0, 0, 30e-3));
  EXPECT_EQ(*std::max_element(inside_bone.image.begin(), inside_bone.image.end()), 0);
  const Frame& far_off = renderer.render(test::probe_at(1, 1, -1));
  EXPECT_EQ(far_off.image.back(), 0);
}

TEST(Renderer, CompressionIsTwentyTimesTheLogarithm) {
  std::vector<float> envelope;
  for (int k = 0; k < 340; ++k) {
    envelope.push_back(static_cast<float>(1e-9 * std::pow(1.07, k)));
  }
  std::vector<float> levels(envelope.size());
  compress(envelope, 3, levels);
  for (std::size_t i = 0; i < envelope.size(); ++i) {
    EXPECT_NEAR(levels[i], 20 * std::log10(static_cast<double>(envelope[i])) + 3, 0.01);
  }
}

TEST(Renderer, GainAndDynamicRangeMoveTheGreyScale) {
  const auto scene = test::make_block_scene(kLayers);
  const auto mean_grey = [&](double gain, double range) {
    ImageSettings settings;
    settings.gain_db = gain;
    settings.dynamic_range_db = range;
    const Frame frame = render_bmode(scene, test::probe_at(), std::nullopt, {}, settings);
    double sum = 0;
    const std::size_t first = 100 * static_cast<std::size_t>(frame.width);
    const std::size_t last = 180 * static_cast<std::size_t>(frame.width);
    for (std::size_t i = first; i < last; ++i) sum += frame.image[i];
    return sum / static_cast<double>(last - first);
  };
  const double plain = mean_grey(0, 80);
  EXPECT_NEAR(mean_grey(8, 80) - plain, 8 * 255.0 / 80, 0.5);
  EXPECT_GT(plain, mean_grey(0, 60));
}

TEST(Renderer, CurvedProbeFansOut) {
  const auto scene = test::make_block_scene(kLayers);
  Transducer transducer;
  transducer.radius = 40e-3;
  transducer.frequency = 5e6;
  ImageSettings settings;
  settings.gel_limit = 10e-3;
  const Frame frame = render_bmode(scene, test::probe_at(), std::nullopt, transducer, settings);
  EXPECT_GT(frame.width * frame.pixel, 60e-3);
  EXPECT_EQ(frame.image[0], 0);  // beside the sector
}

}  // namespace
}  // namespace artus
