// SPDX-License-Identifier: AGPL-3.0-or-later
#include "hand.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "bridge.h"
#include "check.h"
#include "driver.h"
#include "haply_messages.h"
#include "library.h"
#include "options.h"

namespace artus::bridge {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kMs = 1'000'000;

/// A hand, a device that moves as it is told, and artus' answers, tick after tick.
class HandTest : public testing::Test {
 protected:
  HandTest() {
    setup_.limits = {3, 1};
    reading_.sound = true;
    felt_ = artus_shm_force{};
    felt_.force[2] = 0.5;
    begin();
  }
  void begin() { hand_ = Hand(setup_); }
  Triple tick(std::uint64_t ms = 1) {
    now_ += ms * kMs;
    pos_ = artus_shm_pos_init();
    there_ = hand_.pose(reading_, felt_, now_, pos_);
    return hand_.force(felt_, fresh_, now_);
  }
  /// Until the hand is let go and the ramp is over; slower than 1 m/s.
  void settle() {
    for (int i = 0; i < 20; ++i) {
      reading_.position[0] += 0.3e-3;
      tick();
    }
    for (int i = 0; i < 300; ++i) tick();
  }
  HandSetup setup_;
  Hand hand_{setup_};
  Reading reading_;
  artus_shm_force felt_;
  artus_shm_pos pos_{};
  std::uint64_t now_ = kMs;
  bool fresh_ = true;
  bool there_ = false;
};

TEST_F(HandTest, ADeviceThatIsXRightYUpZToTheUserStandsInTheWorld) {
  reading_.position = {0.01, 0.02, 0.03};
  reading_.has_wrist = true;
  tick();
  ASSERT_TRUE(there_);
  EXPECT_EQ(pos_.present, 1U);
  EXPECT_NEAR(pos_.needle_position[0], 0.01, 1e-12);
  EXPECT_NEAR(pos_.needle_position[1], -0.03, 1e-12);
  EXPECT_NEAR(pos_.needle_position[2], 0.02, 1e-12);
  const double* q =
      pos_.needle_rotation;  // z of the needle: against the tool's z, away from the user
  EXPECT_NEAR(2 * (q[1] * q[3] + q[0] * q[2]), 0, 1e-12);
  EXPECT_NEAR(2 * (q[2] * q[3] - q[0] * q[1]), 1, 1e-12);
}

TEST_F(HandTest, WorkIsTheSameOnBothSides) {
  felt_.force[0] = 0.2;
  felt_.force[1] = -0.1;
  settle();
  const artus_shm_pos before = pos_;
  const Triple from = reading_.position;
  reading_.position = {from[0] + 1e-4, from[1] - 2e-4, from[2] + 3e-4};
  const Triple force = tick();
  double in_device = 0;
  double in_world = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    in_device += force[i] * (reading_.position[i] - from[i]);
    in_world += felt_.force[i] * (pos_.needle_position[i] - before.needle_position[i]);
  }
  EXPECT_NEAR(in_device, in_world, 1e-12);
}

TEST_F(HandTest, NothingIsFeltBeforeTheFirstMotionThenItRampsUp) {
  for (int i = 0; i < 500; ++i) EXPECT_EQ(tick(), Triple{});
  EXPECT_EQ(hand_.rest(), Rest::waiting);
  reading_.buttons = 4;
  const double first = std::abs(tick()[1]);
  EXPECT_LT(first, 0.01);
  double last = first;
  for (int i = 0; i < 199; ++i) {
    const double now = std::abs(tick()[1]);
    EXPECT_GE(now, last);
    EXPECT_LT(now - last, 0.01);
    last = now;
  }
  EXPECT_NEAR(std::abs(tick()[1]), 0.5, 1e-9);  // W's z is the device's y
}

TEST_F(HandTest, SilenceFaultSpeedAndNumbersThatAreNoneAreZeroAtOnce) {
  const auto zero = [&](Rest why, const std::function<void()>& spoil) {
    begin();
    settle();
    ASSERT_NEAR(std::abs(tick()[1]), 0.5, 1e-9);
    spoil();
    EXPECT_EQ(tick(4), Triple{}) << static_cast<int>(why);
    EXPECT_EQ(hand_.rest(), why);
    fresh_ = true;
    reading_.sound = true;
    felt_.force[2] = 0.5;
    EXPECT_LT(std::abs(tick(4)[1]), 0.02) << "it ramps up again";
  };
  zero(Rest::silent, [&] { fresh_ = false; });
  zero(Rest::fault, [&] { reading_.sound = false; });
  zero(Rest::not_finite, [&] { felt_.force[2] = std::numeric_limits<double>::quiet_NaN(); });
  zero(Rest::fast, [&] { reading_.position[0] += 0.01; });
  const double position = reading_.position[0];
  zero(Rest::fault, [&] { reading_.position[0] = std::nan(""); });
  EXPECT_FALSE(std::isfinite(reading_.position[0]));
  reading_.position[0] = position;
}

TEST_F(HandTest, TheClutchHoldsThePoseAndFeelsNothing) {
  settle();
  reading_.buttons = 2;
  tick();
  const double x = pos_.needle_position[0];
  for (int i = 0; i < 50; ++i) {
    reading_.position[0] += 0.5e-3;
    EXPECT_EQ(tick(), Triple{});
    EXPECT_NEAR(pos_.needle_position[0], x, 1e-12);
  }
  reading_.buttons = 0;
  EXPECT_LT(std::abs(tick()[1]), 0.01);
  EXPECT_NEAR(pos_.needle_position[0], x, 1e-12);
  reading_.position[0] += 1e-4;
  tick();
  EXPECT_NEAR(pos_.needle_position[0], x + 1e-4, 1e-12);  // 1:1 from here on
}

TEST_F(HandTest, AForceIsCutAtThePeakAndFoldsBackToWhatLasts) {
  felt_.force[2] = 10;
  settle();
  EXPECT_LE(std::abs(tick()[1]), 3.0);
  EXPECT_GT(std::abs(tick()[1]), 2.5);
  double last = std::abs(tick()[1]);
  for (int i = 0; i < 60'000; ++i) {
    const double now = std::abs(tick()[1]);
    EXPECT_LE(now, last + 1e-6);
    EXPECT_GT(now, last - 0.01) << "no step";
    last = now;
  }
  EXPECT_NEAR(last, 1, 0.01);
  felt_.force[2] = 0.2;
  for (int i = 0; i < 60'000; ++i) tick();
  felt_.force[2] = 10;
  EXPECT_GT(std::abs(tick()[1]), 2.9);  // it has rested
}

TEST_F(HandTest, ANeedleWithoutAWristPointsFromItsEntry) {
  setup_.R_WD = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  begin();
  const auto z_of = [&] {
    const double* q = pos_.needle_rotation;
    return Triple{2 * (q[1] * q[3] + q[0] * q[2]), 2 * (q[2] * q[3] - q[0] * q[1]),
                  1 - 2 * (q[1] * q[1] + q[2] * q[2])};
  };
  tick();
  EXPECT_NEAR(z_of()[2], -1, 1e-9);
  felt_.contact = 1;
  tick();
  reading_.position = {0.03, 0, -0.04};
  tick();
  EXPECT_NEAR(z_of()[0], 0.6, 1e-9);
  EXPECT_NEAR(z_of()[2], -0.8, 1e-9);
  felt_.contact = 0;
  tick();
  EXPECT_NEAR(z_of()[2], -1, 1e-9);
}

TEST_F(HandTest, TheOtherHandFeelsItsOwnForceFromTheBeginning) {
  felt_.probe_force[2] = -0.4;
  settle();
  hand_.become(true);
  EXPECT_LT(std::abs(tick()[1]), 0.01);
  EXPECT_EQ(pos_.present, 2U);
  for (int i = 0; i < 250; ++i) tick();
  EXPECT_NEAR(tick()[1], -0.4, 1e-9);
}

TEST_F(HandTest, AHandlesWeightIsCarriedUpwards) {
  setup_.gravity = 0.3;
  begin();
  felt_.force[2] = 0;
  settle();
  EXPECT_NEAR(tick()[1], 0.3, 1e-9);
}

class NoDriver final : public Driver {
 public:
  std::unique_ptr<Device> open(const std::string&, std::string& why) override {
    why = "none";
    return nullptr;
  }
  std::string describe() override { return "none"; }
  [[nodiscard]] HandLimits limits() const override { return {3.3, 0.88}; }
  [[nodiscard]] Triple workspace() const override { return {160, 120, 70}; }
  [[nodiscard]] const char* maker() const override { return "Nobody"; }
};

std::string parsed(std::vector<std::string> words, Options& options) {
  words.insert(words.begin(), "bridge");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  return parse_options(static_cast<int>(argv.size()), argv.data(), NoDriver(), options);
}

TEST(BridgeOptions, NameDevicesAndHands) {
  Options options;
  EXPECT_EQ(parsed({"A=needle", "B=probe", "--centre-mm", "1,-2,3", "--axes", "x,-z,y", "--left"},
                   options),
            "");
  ASSERT_EQ(options.devices.size(), 2U);
  EXPECT_TRUE(options.devices[0].probe);
  EXPECT_EQ(options.devices[1].name, "B");
  EXPECT_NEAR(options.setup.centre[1], -2e-3, 1e-15);
  EXPECT_EQ(options.setup.limits.lasting, 0.88);
}

TEST(BridgeOptions, SayWhatIsWrong) {
  for (const auto& words : std::vector<std::vector<std::string>>{{"A"},
                                                                 {"A=needle", "B=needle"},
                                                                 {"--axes", "x,y,-z"},
                                                                 {"--axes", "x,x,y"},
                                                                 {"--force-n", "9"},
                                                                 {"--centre-mm", "1,2"},
                                                                 {"--gravity-n", "x"},
                                                                 {"--clutch", "9"},
                                                                 {"--bad", "1"},
                                                                 {"--prefix", "a/b"},
                                                                 {"--direction", "0,0,0"},
                                                                 {"--seconds"}}) {
    Options options;
    EXPECT_NE(parsed(words, options), "") << words.front();
  }
  EXPECT_THAT(device_file(NoDriver()),
              testing::AllOf(HasSubstr("force_n = 3.30"), HasSubstr("[160.0, 70.0, 120.0]")));
  EXPECT_THAT(help(NoDriver()), HasSubstr("Nobody"));
}

TEST(BridgeCheck, FailsWhereThereIsNoDevice) {
  NoDriver driver;
  Options options;
  options.devices.push_back({});
  EXPECT_EQ(run_check(driver, options), 1);
}

TEST(BridgeStatistics, KnowsItsPercentiles) {
  Statistics statistics;
  for (std::uint64_t i = 0; i < 100; ++i) statistics.add_round_trip(i < 99 ? 505'000 : 5'005'000);
  EXPECT_EQ(statistics.round_trips(), 100U);
  EXPECT_NEAR(statistics.percentile(0.5), 510, 1e-9);
  EXPECT_NEAR(statistics.percentile(1), 5010, 1e-9);
}

TEST(BridgeLibrary, SaysWhatIsMissing) {
  Library none("libnothing-of-the-kind.so");
  EXPECT_THAT(none.why(), HasSubstr("libnothing-of-the-kind.so"));
  Library maths("libm.so.6");
  void (*missing)() = nullptr;
  maths.find("no_such_function", missing);
  EXPECT_THAT(maths.why(), HasSubstr("no_such_function is missing"));
}

TEST(HaplyMessages, TakeFullAndShortOnesAndRefuseHalves) {
  HaplyState state;
  const std::string full =
      R"({"inverse3":[{"device_id":"0A1","config":{},"state":{"cursor_position":{"x":0.01,"y":0.02,"z":0.03}}}],)"
      R"("wireless_verse_grip":[{"device_id":"9","state":{"orientation":{"x":0,"y":0,"z":1,"w":0},"buttons":{"a":true,"b":false,"c":false}}}]})";
  ASSERT_TRUE(take_haply_message(full, "", state));
  EXPECT_EQ(state.id, "0A1");
  EXPECT_EQ(state.reading.position[2], 0.03);
  EXPECT_TRUE(state.reading.has_wrist);
  EXPECT_NEAR(state.reading.rotation[0], -1, 1e-12);
  EXPECT_EQ(state.reading.buttons, 1U);
  ASSERT_TRUE(take_haply_message(
      R"({"inverse3":[{"device_id":"0A1","state":{"cursor_position":{"x":0.02,"y":0,"z":0}}}]})",
      "0A1", state));
  EXPECT_NEAR(state.reading.rotation[0], -1, 1e-12);  // the grip is as it was
  for (
      const std::string& half :
      {full.substr(0, 60), std::string("[]"), std::string("{}"), std::string(R"({"inverse3":[]})"),
       std::string(R"({"inverse3":[7]})"),
       std::string(R"({"inverse3":[{"device_id":"0A1","state":{"cursor_position":{"x":1}}}]})"),
       std::string(
           R"({"inverse3":[{"device_id":"0A1","state":{"cursor_position":{"x":1e999,"y":0,"z":0}}}]})"),
       std::string(
           R"({"inverse3":[{"device_id":"0A1","state":{"cursor_position":{"x":"a","y":0,"z":0}}}]})")}) {
    EXPECT_FALSE(take_haply_message(half, "", state)) << half;
    EXPECT_FALSE(state.reading.sound);
  }
  EXPECT_FALSE(take_haply_message(full, "other", state));
  EXPECT_EQ(
      haply_command("0A1", {1, 2, 3}),
      R"({"inverse3":[{"commands":{"set_cursor_force":{"values":{"x":1.0,"y":2.0,"z":3.0}}},"device_id":"0A1"}]})");
}

}  // namespace
}  // namespace artus::bridge
