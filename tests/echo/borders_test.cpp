// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/display/image_fields.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"
#include "tests/support/no_alloc.h"

namespace artus {
namespace {

const std::array<test::FlatLayer, 4> kBorderLayers{
    {{"skin", 2e-3}, {"fat", 6e-3}, {"muscle", 14e-3}, {"bone", 20e-3}}};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Borders, RenderingAllocatesNothingAfterTheFirstFrames) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP();
  ImageSettings settings;
  settings.n_threads = 1;
  settings.persistence = 0.3;
  settings.smoothing = 0.5;
  Renderer renderer(test::make_block_scene(kBorderLayers), Transducer{}, settings);
  std::vector<float> contact(128, 1.0F);
  const auto frame_at = [&](int k) {
    const Pose X_JP = test::probe_at(0.2e-3 * k, 0.1e-3 * k);
    contact[127] = 0.1F * static_cast<float>(k % 10);
    renderer.set_contact(contact);
    renderer.render(X_JP, test::needle_at(X_JP, Vec3(2e-3, 0, 14e-3), 0.4));
  };
  for (int k = 0; k < 4; ++k) frame_at(k);
  const test::AllocationCounter counter;
  for (int k = 4; k < 12; ++k) frame_at(k);
  EXPECT_EQ(counter.count(), 0);
}

/// A copy of `params` whose number `name` is `value`.
template <class P>
P with_value(P params, const std::string& name, double value) {
  visit_fields(params, [&](const std::string& other, auto& member) {
    using Member = std::remove_cvref_t<decltype(member)>;
    if constexpr (!std::is_same_v<Member, bool>) {
      if (other == name) member = static_cast<Member>(value);
    }
  });
  return params;
}

template <class P>
void expect_refused(const P& params, const std::string& name, double value) {
  const Result<void> result = validate(with_value(params, name, value));
  ASSERT_FALSE(result.has_value()) << name << " = " << value;
  EXPECT_NE(result.error().to_string().find(name), std::string::npos);
}

/// Every number of `params` is refused where it makes no sense for any of them.
template <class P>
void expect_each_refused(const P& params) {
  visit_fields(params, [&](const std::string& name, const auto& member) {
    using Member = std::remove_cvref_t<decltype(member)>;
    if constexpr (std::is_same_v<Member, double>) {
      for (const double value : {kNan, kInfinity, -kInfinity, 1e300, -1e300})
        expect_refused(params, name, value);
    } else if constexpr (std::is_same_v<Member, int>) {
      for (const double value : {-1.0, 1e9}) expect_refused(params, name, value);
    }
  });
}

TEST(Borders, EveryImpossibleTransducerIsRefusedByName) {
  expect_each_refused(Transducer{});
  for (const char* name : {"width", "n_lines", "frequency", "bandwidth", "pulse_cycles", "f_number",
                           "max_aperture", "elevation_height", "elevation_focus"})
    expect_refused(Transducer{}, name, 0);
  expect_refused(Transducer{}, "steering", 2);
  expect_refused(Transducer{}, "radius", 1e-3);
  EXPECT_THROW(
      Renderer(test::make_block_scene(kBorderLayers), with_value(Transducer{}, "width", 0), {}),
      std::invalid_argument);
}

TEST(Borders, EveryImpossibleSettingIsRefusedByName) {
  expect_each_refused(ImageSettings{});
  for (const char* name : {"depth", "n_samples", "n_planes", "dynamic_range_db", "pixel",
                           "compound_angles", "doppler_limit"})
    expect_refused(ImageSettings{}, name, 0);
  expect_refused(ImageSettings{}, "compound_angles", 2);
  expect_refused(ImageSettings{}, "persistence", 1);
}

TEST(Borders, ACurvedProbeCannotBeCompounded) {
  Transducer transducer;
  transducer.radius = 40e-3;
  ImageSettings settings;
  settings.compound_angles = 3;
  EXPECT_THROW(Renderer(test::make_block_scene(kBorderLayers), transducer, settings),
               std::invalid_argument);
}

/// Ways in which a pose that comes from elsewhere is none.
std::vector<Pose> impossible_poses(const Pose& good) {
  std::vector<Pose> poses(8, good);
  poses[0].translation().y() = kNan;
  poses[1].translation().x() = kInfinity;
  poses[2].linear()(0, 0) = kNan;
  poses[3].linear() *= 1.01;
  poses[4].linear().col(0) *= -1;  // a mirror
  poses[5].linear().setZero();
  poses[6].translation().z() = 1e4;
  poses[7].translation().z() = -1e300;
  return poses;
}

TEST(Borders, AProbePoseThatIsNoneGivesABlackFrameThatSaysSo) {
  ImageSettings settings;
  settings.gain_db = 100;  // even silence would show
  settings.dynamic_range_db = 150;
  settings.persistence = 0.9;
  settings.doppler = true;
  Renderer renderer(test::make_block_scene(kBorderLayers), Transducer{}, settings);
  const Pose X_JP = test::probe_at();
  const NeedleView needle = test::needle_at(X_JP, Vec3(0, 0, 10e-3), 0.3);
  const Frame before = renderer.render(X_JP, needle);
  for (const Pose& bad : impossible_poses(X_JP)) {
    const Frame& frame = renderer.render(bad, needle);
    EXPECT_EQ(frame.status, FrameStatus::kBadProbe);
    EXPECT_EQ(frame.image.size(), before.image.size());
    EXPECT_EQ(*std::max_element(frame.image.begin(), frame.image.end()), 0);
    EXPECT_EQ(*std::max_element(frame.envelope.begin(), frame.envelope.end()), 0);
    EXPECT_EQ(*std::max_element(frame.contact.begin(), frame.contact.end()), 0);
    EXPECT_TRUE(std::all_of(frame.velocity.begin(), frame.velocity.end(),
                            [](float v) { return std::isnan(v); }));
    EXPECT_FALSE(frame.tip_shown.has_value());
  }
  // and nothing of it stays: the next image is the first one's again
  const Frame& after = renderer.render(X_JP, needle);
  EXPECT_EQ(after.status, FrameStatus::kOk);
  EXPECT_EQ(after.image, before.image);
  EXPECT_EQ(after.envelope, before.envelope);
}

TEST(Borders, ANeedlePoseThatIsNoneGivesTheFrameWithoutIt) {
  Renderer renderer(test::make_block_scene(kBorderLayers), Transducer{}, ImageSettings{});
  const Pose X_JP = test::probe_at();
  const Frame without = renderer.render(X_JP);
  const NeedleView good = test::needle_at(X_JP, Vec3(0, 0, 10e-3), 0.3);
  std::vector<NeedleView> needles;
  for (const Pose& bad : impossible_poses(good.X_JN)) {
    needles.push_back(good);
    needles.back().X_JN = bad;
  }
  needles.push_back(good);
  needles.back().v_JN.x() = kInfinity;
  needles.push_back(good);
  needles.back().shape.outer_diameter = kNan;
  for (const NeedleView& needle : needles) {
    const Frame& frame = renderer.render(X_JP, needle);
    EXPECT_EQ(frame.status, FrameStatus::kBadNeedle);
    EXPECT_EQ(frame.image, without.image);
  }
  EXPECT_EQ(renderer.render(impossible_poses(X_JP)[0], needles[0]).status,
            FrameStatus::kBadNeedle | FrameStatus::kBadProbe);
}

TEST(Borders, ReflectorsAndTracksThatAreNotFiniteAreRefused) {
  Renderer renderer(test::make_block_scene(kBorderLayers), Transducer{}, ImageSettings{});
  EXPECT_THROW(renderer.set_needle_tracks({{Vec3(kNan, 0, 0), Vec3::Zero(), 0.1}}),
               std::invalid_argument);
  EXPECT_THROW(renderer.set_point_reflectors({{Vec3(0, kInfinity, 0), 1}}), std::invalid_argument);
}

TEST(Borders, OddPosesGiveFiniteFrames) {
  Transducer curved;
  curved.radius = 40e-3;
  curved.frequency = 5e6;
  for (const Transducer& transducer : {Transducer{}, curved}) {
    Renderer renderer(test::make_block_scene(kBorderLayers), transducer, ImageSettings{});
    for (const Pose& X_JP :
         {test::probe_at(0, 0, 30e-3),                                       // inside bone
          test::probe_at(0, 0, 15e-3),                                       // inside muscle
          test::probe_at(1, 1, 1),                                           // far off
          test::probe_at(39e-3),                                             // half beside the body
          make_pose(Vec3::Zero(), -Vec3::UnitZ(), Vec3::UnitX()),            // looking away
          make_pose(Vec3(0, 0, 2e-3), Vec3::UnitX(), Vec3::UnitZ()),         // along an interface
          make_pose(Vec3(0, 0, -1e-3), Vec3(1, 0, 0.01), Vec3::UnitY())}) {  // grazing the skin
      NeedleView needle = test::needle_at(X_JP, Vec3(0, 0, -5e-3), 0);       // above the face
      const Frame& frame = renderer.render(X_JP, needle);
      EXPECT_TRUE(std::all_of(frame.envelope.begin(), frame.envelope.end(),
                              [](float a) { return std::isfinite(a); }));
      for (const double angle : {0.0, 1.57, -1.0}) {
        needle = test::needle_at(X_JP, Vec3(0, 0, 10e-3), angle);
        const Frame& with = renderer.render(X_JP, needle);
        EXPECT_TRUE(std::all_of(with.envelope.begin(), with.envelope.end(),
                                [](float a) { return std::isfinite(a); }));
      }
    }
  }
}

TEST(Borders, OneLineAndManyAreImages) {
  const auto scene = test::make_block_scene(kBorderLayers);
  for (const int lines : {1, 2, 3, 4096}) {
    Transducer transducer;
    transducer.n_lines = lines;
    ImageSettings settings;
    settings.n_samples = lines == 4096 ? 64 : 16;
    settings.n_planes = lines == 4096 ? 1 : 33;
    const Frame frame = render_bmode(scene, test::probe_at(), std::nullopt, transducer, settings);
    EXPECT_TRUE(std::all_of(frame.envelope.begin(), frame.envelope.end(),
                            [](float a) { return std::isfinite(a); }));
  }
}

}  // namespace
}  // namespace artus
