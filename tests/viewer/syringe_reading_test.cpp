// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/syringe_reading.h"

#include <gtest/gtest.h>

#include "tests/support/layered_body.h"

namespace artus {
namespace {

class SyringeReadingTest : public testing::Test {
 protected:
  SyringeReadingTest() {
    const std::vector<FlatLayer> layers{
        {"skin", 2e-3}, {"muscle", 8e-3}, {"bursa", 3e-3}, {"tendon", 5e-3}, {"bone", 5e-3}};
    scene_ = std::make_shared<const Scene>(
        std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 60e-3, 60e-3)));
    spaces_ = *make_joint_spaces(scene_->joint());
    const RegionId deep = scene_->region_at(Vec3(0, 0, 16e-3));
    spaces_.spaces[spaces_.of_region[deep]].like = "nerve";
  }

  /// With the tip so deep, and 5 ml drawn up.
  [[nodiscard]] SyringeReading read(double depth, const PlungerFeedback& felt) const {
    HapticSnapshot now;
    now.X_JN = to_plain(make_pose(Vec3(0, 0, depth), Vec3::UnitZ(), Vec3::UnitX()));
    now.inserted = 1;
    now.input.device.plunger = PlungerSign::force;
    now.feedback.plunger = felt;
    return read_syringe(*scene_, spaces_, now, SessionParams{});
  }

  std::shared_ptr<const Scene> scene_;
  JointSpaces spaces_;
};

TEST_F(SyringeReadingTest, TellsWhatIsLeftAndIsSilentUntilItIsUsed) {
  EXPECT_FALSE(read_syringe(*scene_, spaces_, HapticSnapshot{}, SessionParams{}).used);
  PlungerFeedback felt;
  felt.given = 1.2e-6;
  felt.thumb_force = 3;
  felt.flow = 1e-7;
  felt.tip_pressure = 2e3;
  const SyringeReading reading = read(12e-3, felt);
  EXPECT_TRUE(reading.used);
  EXPECT_NEAR(reading.left, 3.8e-6, 1e-15);
  EXPECT_EQ(reading.thumb, 3);
  EXPECT_EQ(reading.flow, 1e-7);
  EXPECT_EQ(reading.pressure, 2e3);
}

TEST_F(SyringeReadingTest, TellsWhatWasDrawnBackOnceItIsInTheBarrel) {
  const RegionId bursa = scene_->region_at(Vec3(0, 0, 12e-3));
  spaces_.spaces[spaces_.of_region[bursa]].liquid = "effusion";
  PlungerFeedback felt;
  felt.drawn = 0.2e-6;
  EXPECT_EQ(read(12e-3, felt).drawn, 0) << "in the bore";
  felt.status = PlungerStatus::kFlash;
  EXPECT_EQ(read(12e-3, felt).drawn, 0.2e-6);
  EXPECT_EQ(read(12e-3, felt).own, "effusion");
}

TEST_F(SyringeReadingTest, ThePatientFeelsWhereItGoesAndHowFast) {
  PlungerFeedback felt;
  felt.flow = 1e-7;
  felt.tip_pressure = 1e3;
  EXPECT_EQ(read(12e-3, felt).patient, PatientFeeling::nothing) << "a bursa, slowly";
  EXPECT_EQ(read(16e-3, felt).patient, PatientFeeling::shoots) << "a nerve";
  felt.flow = 0.8e-6;
  EXPECT_EQ(read(12e-3, felt).patient, PatientFeeling::burns);
  felt.flow = 1e-7;
  felt.tip_pressure = 80e3;
  EXPECT_EQ(read(8e-3, felt).patient, PatientFeeling::hurts);
  felt.status = PlungerStatus::kClosed;
  EXPECT_EQ(read(8e-3, felt).patient, PatientFeeling::nothing) << "nothing goes in";
  felt.flow = 0;
  felt.status = 0;
  EXPECT_EQ(read(16e-3, felt).patient, PatientFeeling::nothing) << "given elsewhere, not here";
}

}  // namespace
}  // namespace artus
