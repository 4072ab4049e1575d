// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/tissue_core.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/simulation/image_core.h"
#include "artus/echo/renderer.h"
#include "tests/session/session_support.h"
#include "tests/support/meshed_block.h"
#include "tests/support/probe_press.h"
#include "tests/support/trials.h"

namespace artus {
namespace {

std::shared_ptr<const CompiledJoint> make_soft_block() {
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  return std::make_shared<const CompiledJoint>(test::make_meshed_block(layers, 0.064, 0.048, 4e-3));
}

Pose pressed(const CompiledJoint& joint, double depth) {
  Pose pose = joint.X_JP_default;
  pose.translation() += depth * pose.linear().col(2);
  return pose;
}

/// N that a hand feels in the end of what the tissue last said.
double felt(const TissueCore& core, const Pose& X_JP) {
  return force_at_rest(core.packet().probe, X_JP).force;
}

TEST(TissueCore, GivesTheHandAForceThatGrowsWithThePressAndNoneWhenLifted) {
  const auto joint = make_soft_block();
  auto core = TissueCore::make(joint, joint->X_JP_default, 30);
  ASSERT_TRUE(core) << core.error().to_string();
  std::vector<double> normal;
  for (const double depth : {1e-3, 2e-3, 3e-3}) {
    for (int i = 0; i < 15; ++i) core->step(pressed(*joint, depth));
    normal.push_back(felt(*core, pressed(*joint, depth)));
    const double pressing =
        -core->tissue()->contact().force.dot(joint->X_JP_default.linear().col(2));
    EXPECT_NEAR(normal.back(), pressing, 0.03 * pressing) << depth;
  }
  EXPECT_GT(normal[0], 0.01);
  EXPECT_GT(normal[1], 1.5 * normal[0]);
  EXPECT_GT(normal[2], normal[1]);
  // what is felt between packets is near what the next one says
  const double foreseen = felt(*core, pressed(*joint, 3.2e-3)) - normal[2];
  for (int i = 0; i < 15; ++i) core->step(pressed(*joint, 3.2e-3));
  const double rise = felt(*core, pressed(*joint, 3.2e-3)) - normal[2];
  EXPECT_NEAR(foreseen, rise, 0.35 * rise);
  for (int i = 0; i < 40; ++i) core->step(pressed(*joint, -20e-3));
  EXPECT_EQ(felt(*core, pressed(*joint, -20e-3)), 0);
}

TEST(TissueCore, SaysBeforeTheFaceTouchesWhatAPressWillFeelLike) {
  const auto joint = make_soft_block();
  auto core = TissueCore::make(joint, joint->X_JP_default, 30);
  ASSERT_TRUE(core) << core.error().to_string();
  core->step(pressed(*joint, -5e-3));
  const double foreseen = felt(*core, pressed(*joint, 2e-3));
  for (int i = 0; i < 30; ++i) core->step(pressed(*joint, 2e-3));
  const double force = felt(*core, pressed(*joint, 2e-3));
  EXPECT_NEAR(foreseen, force, 0.3 * force);
}

TEST(TissueCore, AFaceThatJumpsFromTheAirIntoTheSkinAndStaysThereIsFelt) {
  const auto joint = make_soft_block();
  auto core = TissueCore::make(joint, joint->X_JP_default, 30);
  auto by_steps = TissueCore::make(joint, joint->X_JP_default, 30);
  ASSERT_TRUE(core && by_steps);
  for (int i = 0; i < 5; ++i) core->step(pressed(*joint, -20e-3));
  for (int i = 0; i < 60; ++i) {
    core->step(pressed(*joint, 2e-3));
    by_steps->step(pressed(*joint, std::min(2e-3, 1e-4 * i)));
  }
  const double force = felt(*by_steps, pressed(*joint, 2e-3));
  EXPECT_GT(force, 0.1);
  EXPECT_NEAR(felt(*core, pressed(*joint, 2e-3)), force, 0.05 * force);
}

TEST(TissueCore, PressesTheFaceOfItsProbe) {
  const auto joint = make_soft_block();
  ProbeFace shorter;
  shorter.length = 25e-3;
  shorter.points_x = 10;
  std::vector<double> normal;
  for (const ProbeFace& face : {ProbeFace(), shorter}) {
    auto core = TissueCore::make(joint, joint->X_JP_default, 30, face);
    ASSERT_TRUE(core) << core.error().to_string();
    for (int i = 0; i < 15; ++i) core->step(pressed(*joint, 2e-3));
    normal.push_back(felt(*core, pressed(*joint, 2e-3)));
  }
  EXPECT_LT(normal[1], 0.85 * normal[0]);
  EXPECT_GT(normal[1], 0.4 * normal[0]);
  SessionParams params = test::make_small_session();
  params.deform = true;
  params.transducer.radius = 60e-3;
  const ImageCore curved(std::make_shared<const Scene>(joint), params);
  EXPECT_NE(curved.refusal().find("only a straight probe"), std::string::npos);
  EXPECT_EQ(curved.packet(), nullptr);
}

/// A probe put down 10 mm aside of its cage, a needle between that pushes the tissue all the while.
struct SlidAside {
  static constexpr double kRate = 10;  // Hz
  std::shared_ptr<const CompiledJoint> joint = make_wide_block();
  TissueCore core = TissueCore::make(joint, joint->X_JP_default, kRate).value();
  Pose X_JP = joint->X_JP_default;
  NeedleGrip needle;

  SlidAside() {
    X_JP.translate(Vec3(10e-3, 0, 2e-3));
    needle.X_JN = joint->X_JP_default;
    needle.X_JN.translate(Vec3(5e-3, 10e-3, 6e-3));
    needle.load.tip = 0.2;
    needle.load.tip_depth = 6e-3;
  }
  static std::shared_ptr<const CompiledJoint> make_wide_block() {
    const std::array<FlatLayer, 4> layers{
        {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
    return std::make_shared<const CompiledJoint>(
        test::make_meshed_block(layers, 0.12, 0.064, 4e-3));
  }
  /// Whether the tissue is pressed after another step.
  bool step() {
    core.step(X_JP, needle);
    return core.tissue()->contact().share > 0;
  }
  /// m that the tissue at the needle's tip gives way.
  [[nodiscard]] double tent() const {
    return core.tissue()->displacement(needle.X_JN.translation()).z();
  }
};

TEST(TissueCore, AProbeThatStaysOutOfReachGetsACageOfItsOwnByTheImagesNumber) {
  SlidAside slid;
  SlidAside again;
  ASSERT_FALSE(slid.core.reaches(slid.X_JP));
  int images = 0;  // until the face is felt
  double tent = 0;
  while (images < 200 && !slid.step()) {
    tent = slid.tent();
    ++images;
    again.step();
    ASSERT_EQ(digest_of(slid.core.packet()), digest_of(again.core.packet())) << images;
  }
  EXPECT_EQ(images, 20 + 50 - 1) << "20 images outside, then 5 s";
  EXPECT_TRUE(slid.core.reaches(slid.X_JP));
  EXPECT_GT(tent, 50e-6);
  EXPECT_NEAR(slid.tent(), tent, 0.2 * tent) << "the needle's tissue is the same in both cages";
  again.step();
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE(slid.step());
    again.step();
    ASSERT_EQ(digest_of(slid.core.packet()), digest_of(again.core.packet())) << i;
    EXPECT_EQ(slid.core.status() & (kSoftTakenBack | kSoftRestarted | kSoftNoFactor), 0U) << i;
  }
  // as in a session that began there
  auto there = TissueCore::make(slid.joint, slid.X_JP, SlidAside::kRate);
  ASSERT_TRUE(there) << there.error().to_string();
  for (int i = 0; i < 60; ++i) there->step(slid.X_JP, slid.needle);
  const double force = felt(*there, slid.X_JP);
  slid.step();
  EXPECT_NEAR(felt(slid.core, slid.X_JP), force, 0.01 * force);
}

TEST(TissueCore, AProbeThatIsBackKeepsItsCage) {
  for (const int away : {30, 65}) {  // images: back before the other is made, and made ready
    SlidAside slid;
    const Pose aside = slid.X_JP;
    Pose home = slid.joint->X_JP_default;
    home.translate(Vec3(0, 0, 2e-3));
    for (int i = 0; i < away; ++i) EXPECT_FALSE(slid.step()) << i;
    slid.X_JP = home;
    slid.step();  // the face meets the skin
    for (int i = away + 1; i < 110; ++i)
      EXPECT_TRUE(slid.step()) << "back after " << away << ", " << i;
    EXPECT_FALSE(slid.core.reaches(aside));
  }
}

TEST(TissueCore, GivesTheSameBytesAgain) {
  const auto joint = make_soft_block();
  SessionParams params = test::make_small_session();
  params.deform = true;
  const auto scene = std::make_shared<const Scene>(joint);
  std::vector<std::uint64_t> first;
  for (const int threads : {1, 2}) {
    params.image.n_threads = threads;
    ImageCore core(scene, params);
    ASSERT_TRUE(core.refusal().empty()) << core.refusal();
    std::vector<std::uint64_t> digests;
    for (std::uint64_t i = 1; i <= 4 * static_cast<std::uint64_t>(test::trials(10)); ++i) {
      FrameInput input;
      input.controls = controls_of(params);
      input.X_JP =
          to_plain(pressed(*joint, 1e-4 * static_cast<double>(std::min<std::uint64_t>(i, 20))));
      input.number = i;
      input.has_probe = 1;
      digests.push_back(digest_of(core.render(input)));
      digests.push_back(digest_of(*core.packet()));
    }
    if (first.empty()) first = digests;
    EXPECT_EQ(first, digests);
  }
}

TEST(TissueCore, StillProbeGivesTheSamePictureAgainOnceTheTissueHasComeToRest) {
  const auto joint = make_soft_block();
  auto core = TissueCore::make(joint, joint->X_JP_default, 30);
  ASSERT_TRUE(core) << core.error().to_string();
  const Pose X_JP = pressed(*joint, 2e-3);
  for (int i = 0; i < 60; ++i) core->step(X_JP);
  const auto look = [&] {
    return render_bmode(core->scene(), X_JP, std::nullopt, {}, {});
  };
  const Frame before = look();
  const double before_force = felt(*core, X_JP);
  for (int i = 0; i < 30; ++i) core->step(X_JP);
  const Frame after = look();
  EXPECT_EQ(before.in_phase, after.in_phase);
  EXPECT_EQ(before.image, after.image);
  EXPECT_EQ(felt(*core, X_JP), before_force);
  core->step(pressed(*joint, 2.1e-3));
  EXPECT_NE(look().in_phase, after.in_phase) << "it moves again with the probe";
}

TEST(TissueCore, AnImageSaysFromWhichBodyItWasDrawn) {
  const auto joint = make_soft_block();
  SessionParams params = test::make_small_session();
  params.deform = true;
  ImageCore core(std::make_shared<const Scene>(joint), params);
  FrameInput input;
  input.controls = controls_of(params);
  input.has_probe = 1;
  for (input.number = 1; input.number <= 12; ++input.number) {
    const Pose X_JP = pressed(*joint, 2e-4 * static_cast<double>(input.number));
    input.X_JP = to_plain(X_JP);
    if (input.number == 8) {  // from the next shape on the body has liquid, too
      input.n_sites = 1;
      input.sites[0].region = kFirstRegion + 2;
      input.sites[0].volume = 1e-6;
      input.sites[0].p_J[2] = 20e-3;
    }
    const Frame& frame = core.render(input);
    ASSERT_TRUE(core.drawn_scene()->tissue());
    if (core.drawn_scene()->shared_joint() != joint) continue;
    EXPECT_EQ(core.drawn_scene(), core.scene());
    const Frame again =
        render_bmode(core.drawn_scene(), X_JP, std::nullopt, params.transducer, params.image);
    EXPECT_EQ(frame.in_phase, again.in_phase) << input.number;
  }
  EXPECT_NE(core.drawn_scene()->shared_joint(), joint) << "the liquid's body was drawn at last";
}

TEST(TissueCore, RefusesABodyWithoutTetrahedraWithWords) {
  SessionParams params = test::make_small_session();
  params.deform = true;
  const ImageCore core(test::make_layered_scene(), params);
  EXPECT_NE(core.refusal().find("tetrahedra"), std::string::npos);
  EXPECT_EQ(core.packet(), nullptr);
}

}  // namespace
}  // namespace artus
