// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/fluid_core.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/simulation/haptic_core.h"
#include "artus/detail/simulation/image_core.h"
#include "artus/detail/soft/liquid/kept_volume.h"
#include "tests/session/session_support.h"
#include "tests/support/layered_body.h"
#include "tests/support/meshed_block.h"
#include "tests/support/probe_press.h"

namespace artus {
namespace {

/// Flat layers of `length` x `width`, m, whose walls have vertices to be lifted by.
std::shared_ptr<const Scene> make_soft_scene(double length = 0.096, double width = 0.064,
                                             const std::string& cleft = "bursa") {
  const std::array<FlatLayer, 6> layers{{{"skin", 2e-3},
                                         {"fat", 5e-3},
                                         {"muscle", 15e-3},
                                         {"bursa", 2e-3},
                                         {"tendon", 5e-3},
                                         {"bone", 30e-3}}};
  CompiledJoint joint = test::make_meshed_block(layers, length, width, 4e-3);
  for (Tissue& tissue : joint.tissues)
    if (tissue.name == "bursa") tissue.name = cleft;
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(joint)));
}

InjectedSite site_in(const CompiledJoint& joint, const std::string& name, double depth,
                     double volume) {
  InjectedSite site;
  site.p_J[2] = depth;
  site.volume = volume;
  site.region = region_named(joint, name);
  site.cavity = name == "bursa" ? 1 : 0;
  return site;
}

/// m of a region along +z at the origin.
double thickness(const Scene& scene, const std::string& name) {
  double sum = 0;
  for (const TissueInterval& s :
       tissue_intervals(scene, {Vec3(1e-4, 2e-4, -20e-3), Vec3(1e-4, 2e-4, 40e-3)}))
    if (scene.joint().regions[s.region].name == name) sum += s.exit - s.entry;
  return sum;
}

TEST(FluidCore, OpensABursaAFixedNumberOfImagesAfterTheLiquidCame) {
  const auto scene = make_soft_scene();
  FluidCore core(scene->shared_joint(), Liquid{}, 30);
  EXPECT_EQ(core.step({}, nullptr), nullptr);
  const std::vector<InjectedSite> sites{site_in(scene->joint(), "bursa", 23e-3, 2e-6)};
  for (std::uint64_t k = 0; k < core.images_to_change(); ++k)
    EXPECT_EQ(core.step(sites, nullptr), nullptr) << k;
  const auto filled = core.step(sites, nullptr);
  ASSERT_NE(filled, nullptr);
  EXPECT_NEAR(thickness(*scene, "bursa"), 2e-3, 1e-6);
  EXPECT_GT(thickness(*filled, "bursa"), 3e-3);
  EXPECT_NEAR(thickness(*filled, "tendon"), 5e-3, 1e-5) << "the floor stays";
  EXPECT_EQ(core.step(sites, nullptr), filled) << "no more, no other shape";
  EXPECT_EQ(core.step({}, nullptr), nullptr) << "a new syringe";
}

TEST(FluidCore, PartsMuscleWhereTheBevelWas) {
  const auto scene = make_soft_scene();
  FluidCore core(scene->shared_joint(), Liquid{}, 30);
  const std::vector<InjectedSite> sites{site_in(scene->joint(), "muscle", 14e-3, 1e-6)};
  std::shared_ptr<const Scene> filled;
  for (std::uint64_t k = 0; k <= core.images_to_change(); ++k) filled = core.step(sites, nullptr);
  ASSERT_NE(filled, nullptr);
  EXPECT_EQ(filled->joint().regions[filled->region_at(Vec3(0, 0, 14e-3))].name, "injected");
  EXPECT_GT(thickness(*filled, "injected"), 1e-3);
}

TEST(FluidCore, LiquidInARegionThatIsNowhereIsNotDrawn) {
  CompiledJoint joint = make_soft_scene()->joint();
  const auto missing = static_cast<std::uint32_t>(joint.regions.size());
  joint.regions.push_back(joint.regions.back());
  FluidCore core(std::make_shared<const CompiledJoint>(std::move(joint)), Liquid{}, 30);
  InjectedSite site;
  site.volume = 1e-6;
  for (const std::uint32_t region : {std::uint32_t{kOutside}, missing, missing + 1}) {
    site.region = region;
    site.cavity = region == missing ? 1 : 0;
    for (int k = 0; k < 30; ++k) EXPECT_NO_THROW(static_cast<void>(core.step({&site, 1}, nullptr)));
  }
}

/// Images of a session whose simulated thumb presses, as live and replay make them.
struct Pictures {
  std::vector<std::uint64_t> digests;
  std::vector<std::uint64_t> ticks;  // of 1 ms, at which they were asked for
  std::uint64_t flows = 0;           // the first tick with more than 1 ul in the tissue
  double given = 0;                  // m^3 at the end
  double drawn = 0;                  // m^3 of the patient's own
};

Pictures pictures_of(const std::shared_ptr<const Scene>& scene, int threads, double force) {
  SessionParams params = test::make_small_session();
  params.image.n_threads = threads;
  HapticCore haptics(scene, params);
  ImageCore images(scene, params);
  Pictures pictures;
  std::uint64_t frames = 0;
  for (std::uint64_t n = 1; n <= 1900; ++n) {
    const double depth = std::min(-10e-3 + 20e-6 * static_cast<double>(n), 23.9e-3);
    TickInput input;
    input.tick = n;
    input.device = test::sample_at(depth, static_cast<std::int64_t>(n) * 1'000'000, n);
    input.device.plunger = n > 1700 ? PlungerSign::force : PlungerSign::none;
    input.device.plunger_force = force;
    const HapticSnapshot& out = haptics.step(input);
    if (pictures.flows == 0 && out.feedback.plunger.given > 1e-9) pictures.flows = n;
    if (n <= 1600 || n % 33 != 0) continue;
    pictures.ticks.push_back(n);
    pictures.digests.push_back(
        digest_of(images.render(frame_input(out, controls_of(params), ++frames))));
    pictures.given = out.feedback.plunger.given;
    pictures.drawn = std::max(pictures.drawn, out.feedback.plunger.drawn);
  }
  return pictures;
}

TEST(FluidCore, APictureOfASessionShowsTheFlowWithinAHundredMillisecondsAndTheSameBytesAgain) {
  const auto scene = make_soft_scene();
  const Pictures pressed = pictures_of(scene, 1, 8);
  EXPECT_EQ(pressed.digests, pictures_of(scene, 2, 8).digests);
  const Pictures rested = pictures_of(scene, 1, 0);
  ASSERT_EQ(pressed.digests.size(), rested.digests.size());
  ASSERT_GT(pressed.flows, 1700U);
  const auto first =
      std::mismatch(pressed.digests.begin(), pressed.digests.end(), rested.digests.begin()).first;
  ASSERT_NE(first, pressed.digests.end());
  const std::uint64_t shown =
      pressed.ticks[static_cast<std::size_t>(first - pressed.digests.begin())];
  EXPECT_GT(shown, pressed.flows);
  EXPECT_LE(shown, pressed.flows + 100);
  RecordProperty("shown_after_ms", static_cast<int>(shown - pressed.flows));
  EXPECT_NE(pressed.digests.back(), rested.digests.back());
}

TEST(FluidCore, AVesselShowsNothingOfWhatIsGivenIntoItAndGivesBlood) {
  const auto vein = make_soft_scene(0.096, 0.064, "vein");
  const Pictures pressed = pictures_of(vein, 1, 8);
  const Pictures rested = pictures_of(vein, 1, 0);
  EXPECT_GT(pressed.given, 10e-9);
  EXPECT_EQ(pressed.digests, rested.digests) << "washed away";
  EXPECT_GT(pictures_of(vein, 1, -8).drawn, 1e-9) << "aspired";
  // The same thumb in a bursa at the same place is seen.
  EXPECT_NE(pictures_of(make_soft_scene(), 1, 8).digests.back(),
            pictures_of(make_soft_scene(), 1, 0).digests.back());
}

/// Images of a probe that presses over a bursa that holds `volume`.
std::vector<std::uint64_t> pressed_pictures(const std::shared_ptr<const Scene>& scene, int threads,
                                            double volume) {
  SessionParams params = test::make_small_session();
  params.deform = true;
  params.image.n_threads = threads;
  ImageCore core(scene, params);
  EXPECT_TRUE(core.refusal().empty()) << core.refusal();
  std::vector<std::uint64_t> digests;
  for (std::uint64_t i = 1; i <= 6; ++i) {
    FrameInput input;
    input.controls = controls_of(params);
    Pose X_JP = scene->joint().X_JP_default;
    X_JP.translation() += 1e-4 * static_cast<double>(i) * X_JP.linear().col(2);
    input.X_JP = to_plain(X_JP);
    input.number = i;
    input.has_probe = 1;
    if (volume > 0) {
      input.sites[0] = site_in(scene->joint(), "bursa", 23e-3, volume);
      input.n_sites = 1;
    }
    digests.push_back(digest_of(core.render(input)));
  }
  return digests;
}

TEST(FluidCore, IsInABodyThatGivesWayToTheProbeToo) {
  const auto scene = make_soft_scene(0.064, 0.048);
  const auto filled = pressed_pictures(scene, 1, 2e-6);
  EXPECT_EQ(filled, pressed_pictures(scene, 2, 2e-6));
  const auto empty = pressed_pictures(scene, 1, 0);
  EXPECT_EQ(filled.front(), empty.front());
  EXPECT_NE(filled.back(), empty.back());
}

/// m^3 of a region within its walls.
double volume(const CompiledJoint& body, const std::string& name) {
  const RegionId region = test::region_named(body, name);
  const auto& p = body.mesh.vertices;
  double six = 0;
  for (const Interface& f : body.mesh.interfaces)
    if ((f.front == region) != (f.back == region))
      six +=
          (f.back == region ? 1 : -1) *
          (p[f.vertices[0]] - p[0]).dot((p[f.vertices[1]] - p[0]).cross(p[f.vertices[2]] - p[0]));
  return six / 6;
}
/// The same as tissue has moved them.
double volume(const Scene& scene, const std::string& name) {
  return volume(scene.tissue() ? scene.tissue()->moved_joint() : scene.joint(), name);
}

SessionParams giving_session() {
  SessionParams params = test::make_small_session();
  params.deform = true;
  return params;
}

/// A bursa with liquid, `depth` m deep, and a face over it.
class PressedBursa {
 public:
  PressedBursa(const std::shared_ptr<const Scene>& scene, double depth, double volume)
      : core(scene, giving_session()) {
    EXPECT_TRUE(core.refusal().empty()) << core.refusal();
    input_.controls = controls_of(giving_session());
    input_.has_probe = 1;
    input_.sites[0] = site_in(scene->joint(), "bursa", depth, volume);
    input_.n_sites = 1;
  }
  /// The next images with the face `depth` m below where it touches.
  void press(double depth, int images) {
    X_JP = core.scene()->joint().X_JP_default;
    X_JP.translation() += depth * X_JP.linear().col(2);
    input_.X_JP = to_plain(X_JP);
    for (int k = 0; k < images; ++k) {
      ++input_.number;
      static_cast<void>(core.render(input_));
    }
  }

  /// From now on, on what is `depth` m below the skin beside the face's middle, N along the needle.
  void push_needle(double depth, double force) {
    input_.has_needle = 1;
    input_.X_JN = to_plain(make_pose(Vec3(2e-3, 0, depth), Vec3::UnitZ(), Vec3::UnitY()));
    input_.load.tip = force;
    input_.load.tip_depth = depth;
  }

  ImageCore core;
  Pose X_JP = Pose::Identity();

 private:
  FrameInput input_;
};

TEST(FluidCore, AProbeThatPressesSqueezesTheBursaAndMeetsTheSkinThatItLifts) {
  const auto scene = make_soft_scene();
  PressedBursa bursa(scene, 23e-3, 3e-6);
  const ImageCore& core = bursa.core;
  const auto press = [&](double depth, int images) {
    bursa.press(depth, images);
    return thickness(*core.drawn_scene(), "bursa");
  };
  const double open = press(-5e-3, 20);
  EXPECT_GT(open, 3e-3);
  const double touching = press(0, 60);
  EXPECT_GT(force_at_rest(core.packet()->probe, scene->joint().X_JP_default).force, 0.02)
      << "the lens lifts the skin to the face";
  const double pressed = press(4e-3, 90);
  EXPECT_NEAR(volume(*core.drawn_scene(), "bursa") - volume(*core.scene(), "bursa"), 3e-6, 0.03e-6)
      << "a press takes no liquid";
  EXPECT_LT(pressed, 0.9 * touching);
  EXPECT_NEAR(press(-5e-3, 90), open, 0.02e-3) << "it comes back";
}

/// A needle that tents a wall takes as much of a large bursa as there is liquid in it.
TEST(FluidCore, TissueThatANeedleMovesTakesNoLiquid) {
  const auto scene = make_soft_scene();
  PressedBursa bursa(scene, 23e-3, 0.3e-6);
  const auto held = [&] {
    const Scene& drawn = *bursa.core.drawn_scene();
    const double opened = volume(drawn.joint(), "bursa") - volume(scene->joint(), "bursa");
    return opened * kept_volume(drawn.joint(), scene->joint(), *drawn.tissue());
  };
  bursa.press(-5e-3, 40);
  EXPECT_NEAR(held(), 0.3e-6, 0.003e-6);
  for (const double force : {1.0, 2.0, -1.0, 0.0}) {
    bursa.push_needle(22e-3, force);
    bursa.press(-5e-3, 80);
    EXPECT_NEAR(held(), 0.3e-6, 0.003e-6) << force << " N";
  }
}

/// Under the skin of a wrist the face presses several times as much as the space opens below it, so
/// that what is squeezed aside at once would come back at once.
TEST(FluidCore, AFaceThatIsHeldAndTheLiquidBelowItComeToRest) {
  const std::array<FlatLayer, 5> layers{
      {{"skin", 1.5e-3}, {"fat", 1.5e-3}, {"bursa", 1e-3}, {"tendon", 3e-3}, {"bone", 20e-3}}};
  const auto scene = std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_meshed_block(layers, 0.096, 0.064, 3e-3)));
  PressedBursa bursa(scene, 3.5e-3, 1e-6);
  bursa.press(0.3e-3, 250);
  double least = 1e3;
  double most = 0;
  for (int k = 0; k < 150; ++k) {
    bursa.press(0.3e-3, 1);
    const double force = force_at_rest(bursa.core.packet()->probe, bursa.X_JP).force;
    least = std::min(least, force);
    most = std::max(most, force);
  }
  EXPECT_GT(least, 0.2);
  EXPECT_LT(most, 1.3 * least);
}

/// Pixels in colour of the last of `flowing` images with 0.1 ml/s and `still` without.
std::ptrdiff_t coloured_pixels(const std::shared_ptr<const Scene>& scene, std::uint64_t flowing,
                               std::uint64_t still) {
  SessionParams params = test::make_small_session();
  params.transducer.n_lines = 128;
  params.image.doppler = true;
  ImageCore core(scene, params);
  for (std::uint64_t i = 1; i <= flowing + still; ++i) {
    FrameInput input;
    input.controls = controls_of(params);
    input.controls.motion = MotionShown::velocity;
    input.X_JP = to_plain(scene->joint().X_JP_default);
    input.X_JN = to_plain(make_pose(Vec3(0, 0, 23e-3), Vec3(1, 0, 1), Vec3::UnitY()));
    input.has_probe = 1;
    input.has_needle = 1;
    input.number = i;
    input.sample_time_ns = static_cast<std::int64_t>(i) * 33'000'000;
    input.sites[0] =
        site_in(scene->joint(), "bursa", 23e-3, 3.3e-9 * static_cast<double>(std::min(i, flowing)));
    input.n_sites = 1;
    static_cast<void>(core.render(input));
  }
  const auto motion = core.motion();
  return std::count_if(motion.begin(), motion.end(), [](std::uint8_t level) { return level != 0; });
}

TEST(FluidCore, TheJetIsAFlashOfColourWhileItFlowsAndNoLonger) {
  const auto scene = make_soft_scene();
  EXPECT_GT(coloured_pixels(scene, 40, 0), 5);
  EXPECT_EQ(coloured_pixels(scene, 40, 45), 0);
}

}  // namespace
}  // namespace artus
