// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/learn.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/trainer/pages.h"
#include "artus/detail/training/player.h"

namespace artus {
namespace {

std::string text_of(const std::vector<PageLine>& lines) {
  std::string all;
  for (const PageLine& line : lines) all += line.text + "\n";
  return all;
}

TEST(Learn, TellsWhatLiesInThePictureAndFadesItsTruthIn) {
  const auto scenario = find_scenario("gel-align");
  ASSERT_TRUE(scenario);
  const auto scene = make_gel_scene(*scenario->gel);
  ASSERT_TRUE(scene);
  const LearnContent content = make_learn_content(*scenario, *scene, Language::english);
  const std::string looks = text_of(content.looks);
  EXPECT_NE(looks.find("0 mm: skin: the bright line under the face"), std::string::npos) << looks;
  EXPECT_NE(looks.find("2 mm: muscle: dark, with bright strands"), std::string::npos) << looks;
  // the entry at 26 mm, the target 5 mm to the other side and 20 mm deep: 31 and 20 mm of way
  const std::string stand = text_of(content.stand);
  EXPECT_NE(stand.find("26 mm from the probe's middle, at 33 degrees"), std::string::npos) << stand;
  EXPECT_NE(stand.find("the target is 20 mm deep"), std::string::npos) << stand;
  ASSERT_GE(content.fading.size(), 3U);
  const auto brightness = [](const PagePicture& picture) {
    long sum = 0;
    for (const std::uint8_t grey : picture.grey) sum += grey;
    return sum;
  };
  for (std::size_t i = 1; i < content.fading.size(); ++i)
    EXPECT_GT(brightness(*content.fading[i]), brightness(*content.fading[i - 1])) << i;
}

TEST(Learn, SaysWhyAStructureMustNotBeEntered) {
  auto scenario = find_scenario("gel-align");
  ASSERT_TRUE(scenario);
  scenario->gel->balls.push_back({"artery", Vec3(0, 0, 30e-3), 3e-3});
  const auto scene = make_gel_scene(*scenario->gel);
  ASSERT_TRUE(scene) << scene.error().to_string();
  scenario->avoid.push_back({"artery", 0, true});
  const std::string never = text_of(make_learn_content(*scenario, *scene, Language::english).never);
  EXPECT_NE(never.find("Never: artery"), std::string::npos) << never;
  EXPECT_NE(never.find("it bleeds"), std::string::npos) << never;
}

TEST(Learn, GoesFromLookingToOneHandToBoth) {
  const auto scenario = find_scenario("gel-align");
  ASSERT_TRUE(scenario);
  const LearnContent content;
  const Page page = make_learn_page(*scenario, content, LearnChoice::expert, Language::english);
  ASSERT_EQ(page.choices.size(), 7U);
  EXPECT_EQ(page.at, 3U);
  EXPECT_TRUE(page.may_back);
  EXPECT_EQ(led_in(LearnChoice::probe_alone), LedHand::needle);
  EXPECT_EQ(led_in(LearnChoice::needle_alone), LedHand::probe);
  EXPECT_FALSE(led_in(LearnChoice::expert).has_value());
  EXPECT_TRUE(for_one_hand(*scenario).aided()) << "nobody passes by it";
  const auto choices = briefing_choices(*scenario);
  EXPECT_EQ(choices.back().kind, BriefingChoice::Kind::learn);
}

/// A hand at rest at a place of its own.
class RestingHand final : public InputDevice {
 public:
  DeviceSample read(std::int64_t now_ns) noexcept override {
    DeviceSample sample;
    sample.time_ns = now_ns;
    sample.X_WN = to_plain(make_pose(Vec3(1, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
    sample.X_WP = to_plain(make_pose(Vec3(2, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
    sample.has_probe = 1;
    return sample;
  }
  void write(const DeviceFeedback& /*feedback*/) noexcept override {}
  [[nodiscard]] std::string_view name() const noexcept override { return "at rest"; }
};

TEST(LedHands, OneHandGoesItsWayAgainAndAgainAndTheOtherIsOnesOwn) {
  constexpr double kPeriod = 1e-3;  // s
  std::vector<LedPose> way;
  for (int i = 0; i <= 50; ++i)
    way.push_back(
        {0.02 * i, to_plain(make_pose(Vec3(0, 0, 0.4e-3 * i), Vec3::UnitZ(), Vec3::UnitX()))});
  for (const LedHand led : {LedHand::needle, LedHand::probe}) {
    LedHands hands(std::make_unique<RestingHand>(), led, way, kPeriod);
    double deepest = 0;
    double last = 0;
    double fastest = 0;
    int turns = 0;
    for (std::int64_t i = 1; i <= 8000; ++i) {
      const DeviceSample sample = hands.read(i * 1'000'000);
      const PlainPose& its = led == LedHand::needle ? sample.X_WN : sample.X_WP;
      const PlainPose& own = led == LedHand::needle ? sample.X_WP : sample.X_WN;
      EXPECT_EQ(own.position[0], led == LedHand::needle ? 2 : 1);
      fastest = std::max(fastest, std::abs(its.position[2] - last) / kPeriod);
      if (last > 10e-3 && its.position[2] <= 10e-3) ++turns;
      last = its.position[2];
      deepest = std::max(deepest, last);
    }
    EXPECT_NEAR(deepest, 20e-3, 0.1e-3);
    EXPECT_EQ(turns, 2) << "8 s of ways of 1 s with 2 s of rest";
    EXPECT_LE(fastest, HandDevice::Limits{}.speed + 1e-9);
  }
}

TEST(LedHands, TheWayIsThatOfTheRecordedHand) {
  Recording recording;
  recording.head.params.haptic_rate = 1000;
  for (int i = 0; i < 101; ++i) {
    TickRecord tick;
    tick.input.device.X_WN =
        to_plain(make_pose(Vec3(0, 0, 1e-3 * i), Vec3::UnitZ(), Vec3::UnitX()));
    recording.ticks.push_back(tick);
  }
  const auto way = way_of(recording, LedHand::needle);
  ASSERT_EQ(way.size(), 6U);
  EXPECT_DOUBLE_EQ(way[3].time, 0.06);
  EXPECT_DOUBLE_EQ(way[3].pose.position[2], 0.06);
}

}  // namespace
}  // namespace artus
