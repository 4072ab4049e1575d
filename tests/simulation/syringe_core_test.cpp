// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/syringe_core.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/simulation/haptic_core.h"
#include "tests/session/session_support.h"
#include "tests/support/no_alloc.h"

namespace artus {
namespace {

/// A session's haptic core with the needle driven in to a depth, and a plunger after that.
class SessionSyringe : public ::testing::Test {
 protected:
  const HapticSnapshot& step(double z, PlungerSign sign, double value) {
    TickInput input;
    input.tick = ++tick_;
    input.device = test::sample_at(z, static_cast<std::int64_t>(tick_) * test::kTickTime, tick_);
    input.device.plunger = sign;
    (sign == PlungerSign::travel ? input.device.plunger_travel : input.device.plunger_force) =
        value;
    return core_.step(input);
  }
  void insert_to(double depth) {
    for (double z = -10e-3; z < depth; z += 20e-6) step(z, PlungerSign::none, 0);
  }
  double volume_in(const char* name) const {
    const Plunger& plunger = core_.syringe().plunger();
    for (std::size_t k = 0; k < plunger.spaces().size(); ++k)
      if (plunger.spaces()[k].name == name) return plunger.states()[k].volume;
    return -1;
  }

  /// m^3 that left the syringe and are nowhere.
  double lost() const {
    const Plunger& plunger = core_.syringe().plunger();
    double left = plunger.params().syringe.filled - plunger.state().content;
    for (const SpaceState& state : plunger.states()) left -= state.volume - state.drawn;
    return left;
  }
  bool told(std::uint32_t bit) const { return (core_.syringe().feedback().status & bit) != 0; }

  std::shared_ptr<const Scene> scene_ = test::make_layered_scene();
  SessionParams params_ = test::make_small_session();
  HapticCore core_{scene_, params_};
  std::uint64_t tick_ = 0;
};

TEST_F(SessionSyringe, AThumbsForceFillsTheBursaThatTheTipIsIn) {
  insert_to(23.9e-3);  // the bevel, 1.8 mm, lies in the bursa from 22 to 24 mm
  for (int k = 0; k < 5000; ++k) step(23.9e-3, PlungerSign::force, 5);
  const PlungerFeedback& felt = core_.syringe().feedback();
  EXPECT_GT(felt.given, 0.5e-6);
  EXPECT_GT(volume_in("bursa"), 0.95 * felt.given);
  EXPECT_NEAR(felt.thumb_force, 5, 1e-9);
  EXPECT_GT(felt.flow, 0);
}

TEST_F(SessionSyringe, TellsThePictureWhereTheLiquidWentAndForgetsItWithTheSyringe) {
  insert_to(23.9e-3);
  EXPECT_TRUE(core_.syringe().sites().empty());
  for (int k = 0; k < 5000; ++k) step(23.9e-3, PlungerSign::force, 5);
  ASSERT_FALSE(core_.syringe().sites().empty());
  const InjectedSite& site = core_.syringe().sites().front();
  EXPECT_EQ(scene_->joint().regions[site.region].name, "bursa");
  EXPECT_EQ(site.cavity, 1U);
  EXPECT_DOUBLE_EQ(site.volume, volume_in("bursa"));
  EXPECT_NEAR(site.p_J[2], 23e-3, 0.5e-3) << "the middle of the bevel";
  TickInput reset;
  reset.tick = ++tick_;
  reset.device =
      test::sample_at(23.9e-3, static_cast<std::int64_t>(tick_) * test::kTickTime, tick_);
  reset.command = SessionCommand::kReset;
  core_.step(reset);
  EXPECT_TRUE(core_.syringe().sites().empty());
}

TEST_F(SessionSyringe, APlungerThatTellsItsTravelIsPushedBackByASpringAndFromWhereItIs) {
  insert_to(15e-3);
  const double start = 0.31;  // m, wherever the device's own zero is
  EXPECT_NEAR(step(15e-3, PlungerSign::travel, start).feedback.plunger.thumb_force, 0, 1e-9);
  for (int k = 0; k < 1000; ++k) step(15e-3, PlungerSign::travel, start + 1e-6 * k);
  const PlungerFeedback& felt = core_.syringe().feedback();
  EXPECT_NEAR(felt.thumb_force, SyringeCore::kCoupling * (0.999e-3 - felt.travel), 1e-6);
  EXPECT_GT(felt.thumb_force, 1);
}

TEST_F(SessionSyringe, TheThumbFeelsNothingWhenTheDeviceIsLostOrNobodyIsOnIt) {
  insert_to(15e-3);
  for (int k = 0; k < 1000; ++k) step(15e-3, PlungerSign::force, 10);
  EXPECT_GT(core_.syringe().feedback().thumb_force, 9);
  TickInput lost;
  lost.tick = ++tick_;
  lost.device = test::sample_at(15e-3, static_cast<std::int64_t>(tick_) * test::kTickTime, tick_);
  lost.device.state = PeerState::lost;
  const double travel = core_.syringe().feedback().travel;
  EXPECT_EQ(core_.step(lost).feedback.plunger.thumb_force, 0);
  EXPECT_EQ(core_.syringe().feedback().travel, travel);
  EXPECT_EQ(step(15e-3, PlungerSign::none, 0).feedback.plunger.thumb_force, 0);
}

TEST_F(SessionSyringe, NoValueOfAPlungerGivesAForceThatIsNotFiniteOrOverItsLimit) {
  insert_to(15e-3);
  const double wild[] = {std::numeric_limits<double>::quiet_NaN(), 1e300, -1e300, 0.9, -0.9, 900};
  for (int k = 0; k < 3000; ++k) {
    const auto at = static_cast<std::uint64_t>(k / 7);
    const double value = wild[mix_bits(at) % 6];
    const auto sign = static_cast<PlungerSign>(mix_bits(at + 999) % 5);  // some there are not
    const HapticSnapshot& out = step(15e-3, sign, value);
    ASSERT_TRUE(std::isfinite(out.feedback.plunger.thumb_force));
    ASSERT_LE(std::abs(out.feedback.plunger.thumb_force), SyringeCore::kMaxForce * (1 + 1e-12));
    for (const double f : out.feedback.force) ASSERT_TRUE(std::isfinite(f));
    ASSERT_EQ(find_fault(to_record(out), tick_ - 1), nullptr);
  }
}

TEST_F(SessionSyringe, PushingTheThumbPushesTheNeedleOnByItsUnbalancedShare) {
  insert_to(15e-3);
  for (int k = 0; k < 1000; ++k) step(15e-3, PlungerSign::none, 0);
  const double before = step(15e-3, PlungerSign::none, 0).force_J[2];
  for (int k = 0; k < 1000; ++k) step(15e-3, PlungerSign::force, 10);
  const double after = step(15e-3, PlungerSign::force, 10).force_J[2];
  EXPECT_NEAR(after - before, 0.05 * 10, 0.02);
}

TEST_F(SessionSyringe, ADeviceThatTurnsFromForceToTravelIsNotPushedByWhereItsZeroIs) {
  insert_to(15e-3);
  for (int k = 0; k < 500; ++k) step(15e-3, PlungerSign::force, 2);
  step(15e-3, PlungerSign::travel, 0.31);
  const double felt = step(15e-3, PlungerSign::travel, 0.31).feedback.plunger.thumb_force;
  EXPECT_NEAR(felt, 0, 1e-9);
}

TEST_F(SessionSyringe, ATravelThatJumpsIsFeltAsALimitedForceAndLosesNothing) {
  insert_to(15e-3);
  for (const double jump : {0.5, -0.5, 0.0}) {
    bool refused = false;
    for (int k = 0; k < 3000; ++k) {
      const HapticSnapshot& out = step(15e-3, PlungerSign::travel, k < 10 ? 0 : jump);
      refused = refused || told(PlungerStatus::kJumped) || told(PlungerStatus::kLimited);
      ASSERT_LE(std::abs(out.feedback.plunger.thumb_force), SyringeCore::kMaxForce + 1e-9);
    }
    EXPECT_NEAR(lost(), 0, 1e-15) << jump;
    EXPECT_LE(core_.syringe().plunger().state().content,
              core_.syringe().plunger().params().syringe.volume + 1e-15);
    EXPECT_TRUE(jump == 0 || refused) << jump;
  }
}

TEST_F(SessionSyringe, APlungerThatIsRunToItsEndSaysSoAndGivesNoMore) {
  insert_to(23.9e-3);
  for (int k = 0; k < 60000 && !told(PlungerStatus::kEmpty); ++k)
    step(23.9e-3, PlungerSign::force, 12);
  for (int k = 0; k < 5000; ++k) step(23.9e-3, PlungerSign::force, 12);
  EXPECT_TRUE(told(PlungerStatus::kEmpty));
  EXPECT_NEAR(core_.syringe().feedback().flow, 0, 1e-12);
  EXPECT_LE(core_.syringe().feedback().given,
            core_.syringe().plunger().params().syringe.filled * (1 + 1e-12));
  EXPECT_NEAR(lost(), 0, 1e-15);
}

TEST_F(SessionSyringe, OutOfTheBodyThePushSquirtsIntoTheAirAgainstTheBoreAlone) {
  for (int k = 0; k < 3000; ++k) step(-5e-3, PlungerSign::force, 5);
  EXPECT_TRUE(told(PlungerStatus::kOutside));
  EXPECT_GT(volume_in("outside"), 0.1e-6);
  EXPECT_EQ(core_.syringe().feedback().tip_pressure, 0);
  EXPECT_NEAR(core_.syringe().feedback().thumb_force, 5, 1e-9);
  EXPECT_NEAR(lost(), 0, 1e-15);
  EXPECT_TRUE(core_.syringe().sites().empty()) << "and nothing of it is drawn";
}

TEST_F(SessionSyringe, AResetGivesANewSyringe) {
  insert_to(15e-3);
  for (int k = 0; k < 2000; ++k) step(15e-3, PlungerSign::force, 10);
  ASSERT_GT(core_.syringe().feedback().given, 0);
  TickInput reset;
  reset.tick = ++tick_;
  reset.command = SessionCommand::kReset;
  reset.device = test::sample_at(15e-3, static_cast<std::int64_t>(tick_) * test::kTickTime, tick_);
  EXPECT_EQ(core_.step(reset).feedback.plunger.given, 0);
}

TEST_F(SessionSyringe, TicksWithAPlungerDoNotAllocate) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP() << "no allocation counter in this build";
  insert_to(15e-3);
  const test::AllocationCounter counter;
  for (int k = 0; k < 2000; ++k) step(15e-3, PlungerSign::force, 10);
  EXPECT_EQ(counter.count(), 0);
  EXPECT_GT(core_.syringe().feedback().given, 0);
}

}  // namespace
}  // namespace artus
