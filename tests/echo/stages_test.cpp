// SPDX-License-Identifier: AGPL-3.0-or-later
// What a running renderer takes without stopping: live settings, and pipelines made beside it.
#include <array>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <type_traits>

#include <gtest/gtest.h>

#include "artus/detail/echo/display/echo_pipeline.h"
#include "artus/detail/echo/display/image_fields.h"
#include "artus/echo/renderer.h"
#include "tests/echo/echo_fixture.h"
#include "tests/support/no_alloc.h"

namespace artus {
namespace {

const std::array<test::FlatLayer, 3> kStageLayers{
    {{"skin", 2e-3}, {"fat", 6e-3}, {"muscle", 30e-3}}};

NeedleView some_needle() {
  return test::needle_at(test::probe_at(), Vec3(2e-3, 0, 14e-3), 0.4);
}

void expect_same(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.in_phase, b.in_phase);
  EXPECT_EQ(a.envelope, b.envelope);
  EXPECT_EQ(a.decibel, b.decibel);
  EXPECT_EQ(a.image, b.image);
}

TEST(Stages, LiveSettingsShowInTheNextFrameAsIfTheyHadAlwaysBeenThere) {
  const auto scene = test::make_block_scene(kStageLayers);
  ImageSettings changed;
  changed.gain_db = 21;
  changed.dynamic_range_db = 85;
  changed.tgc_db_cm_mhz = 0.4;
  changed.tgc_limit_db = 30;
  changed.smoothing = 0.6;
  Renderer running(scene, Transducer{}, ImageSettings{});
  running.render(test::probe_at(), some_needle());
  running.set_live(changed);
  EXPECT_EQ(running.settings(), changed);
  Renderer fresh(scene, Transducer{}, changed);
  expect_same(running.render(test::probe_at(), some_needle()),
              fresh.render(test::probe_at(), some_needle()));
}

TEST(Stages, GainAndRangeTouchTheDisplayAlone) {
  Renderer renderer(test::make_block_scene(kStageLayers), Transducer{}, ImageSettings{});
  const Frame before = renderer.render(test::probe_at());
  LiveSettings live;
  live.gain_db = 15;
  live.dynamic_range_db = 70;
  live.persistence = 0.5;
  renderer.set_live(live);
  const Frame& after = renderer.render(test::probe_at());
  EXPECT_EQ(after.in_phase, before.in_phase);
  EXPECT_EQ(after.envelope, before.envelope);
  for (std::size_t i = 0; i < after.decibel.size(); i += 997)
    EXPECT_NEAR(after.decibel[i] - before.decibel[i], 6, 1e-4);
  EXPECT_NE(after.image, before.image);
}

TEST(Stages, LiveSettingsThatAreNotValidAreRefusedAndChangeNothing) {
  Renderer renderer(test::make_block_scene(kStageLayers), Transducer{}, ImageSettings{});
  LiveSettings live;
  live.dynamic_range_db = 0;
  EXPECT_THROW(renderer.set_live(live), std::invalid_argument);
  EXPECT_EQ(renderer.settings(), ImageSettings{});
}

TEST(Stages, APipelineMadeElsewhereGivesTheImageOfAFreshRendererAndKeepsTheBody) {
  const auto scene = test::make_block_scene(kStageLayers);
  const std::vector<NeedleTrack> tracks{{Vec3(-15e-3, 0, 5e-3), Vec3(5e-3, 0, 20e-3), 0.025}};
  const std::vector<PointReflector> points{{Vec3(0, 0, 12e-3), 0.5}};
  std::vector<float> contact(64, 1.0F);
  contact[3] = 0;
  const auto set_body = [&](Renderer& renderer) {
    renderer.set_contact(contact);
    renderer.set_needle_tracks(tracks);
    renderer.set_point_reflectors(points);
  };
  Transducer deep;
  deep.frequency = 7e6;
  deep.elevation_focus = 30e-3;
  ImageSettings settings;
  settings.depth = 55e-3;
  Renderer running(scene, Transducer{}, ImageSettings{});
  set_body(running);
  std::unique_ptr<EchoPipeline> next;
  std::thread maker([&] { next = std::make_unique<EchoPipeline>(deep, settings); });
  for (int k = 0; k < 3; ++k) running.render(test::probe_at(1e-4 * k), some_needle());
  maker.join();
  running.set_pipeline(std::move(next));
  EXPECT_EQ(running.transducer(), deep);
  Renderer fresh(scene, deep, settings);
  set_body(fresh);
  expect_same(running.render(test::probe_at(), some_needle()),
              fresh.render(test::probe_at(), some_needle()));
}

TEST(Stages, RenderingAllocatesNothingWithCompoundDopplerAndTracks) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP();
  ImageSettings settings;
  settings.n_threads = 1;
  settings.doppler = true;
  settings.compound_angles = 3;
  settings.smoothing = 0.2;
  Renderer renderer(test::make_block_scene(kStageLayers), Transducer{}, settings);
  renderer.set_needle_tracks({{Vec3(-15e-3, 0, 5e-3), Vec3(5e-3, 0, 20e-3), 0.025}});
  for (int k = 0; k < 2; ++k) renderer.render(test::probe_at(), some_needle());
  Pose nowhere = Pose::Identity();
  nowhere.translation().x() = std::numeric_limits<double>::quiet_NaN();
  const test::AllocationCounter counter;
  renderer.render(test::probe_at(1e-4), some_needle());
  renderer.render(nowhere, some_needle());
  EXPECT_EQ(counter.count(), 0);
}

/// Changes each field of `params` alone and expects the whole to differ; returns the names.
template <class P>
std::set<std::string> change_each(const P& original) {
  std::set<std::string> names;
  visit_fields(original, [&](const std::string& name, const auto& /*member*/) {
    P changed = original;
    visit_fields(changed, [&](const std::string& other, auto& member) {
      if (other != name) return;
      using Member = std::remove_cvref_t<decltype(member)>;
      if constexpr (std::is_same_v<Member, bool>)
        member = !member;
      else if constexpr (std::is_enum_v<Member>)
        member = member == Member{} ? Member{1} : Member{};
      else
        member = static_cast<Member>(member + 1);
    });
    EXPECT_FALSE(changed == original) << name;
    EXPECT_TRUE(names.insert(name).second) << name << " is there twice";
  });
  return names;
}

TEST(ImageFields, EveryNameIsAMemberOfItsOwn) {
  EXPECT_EQ(change_each(ImageSettings{}).size(), 36U);
  EXPECT_EQ(change_each(Transducer{}).size(), 12U);
  EXPECT_EQ(change_each(ImageSettings{}).count("gain_db"), 1U);
}

}  // namespace
}  // namespace artus
