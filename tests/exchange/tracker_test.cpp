// SPDX-License-Identifier: AGPL-3.0-or-later
// Frames, calibrations, registration, and the device that a tracker's poses arrive at.
#include <limits>
#include <memory>
#include <string>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/echo/display/scan_converter.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/remote_command.h"
#include "artus/detail/exchange/tracker_calibration.h"
#include "artus/detail/exchange/tracker_device.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

using test::use;
using testing::HasSubstr;

Pose some_pose() {
  return make_pose(Vec3(0.04, -0.02, 0.1), Vec3(0.3, -0.5, 0.8), Vec3(1, 0.2, 0));
}

igtl::Message tracker_transform(const std::string& device, const igtl::Matrix& matrix) {
  igtl::Message message;
  message.type = "TRANSFORM";
  message.device = device;
  message.content = igtl::pack_transform(matrix);
  return message;
}

TEST(ReferenceFrame, IsRasInMillimetresWithoutARegistration) {
  Pose X_JA = Pose::Identity();
  X_JA.translation() = Vec3(0.01, 0.02, 0.03);
  const igtl::Matrix matrix = ReferenceFrame().to_reference(X_JA);
  EXPECT_TRUE(matrix.col(3).isApprox(Vec3(-10, -20, 30)));
  EXPECT_TRUE(matrix.leftCols<3>().isApprox(Vec3(-1, -1, 1).asDiagonal().toDenseMatrix()));
}

TEST(ReferenceFrame, APoseComesBack) {
  const Pose X_JR = make_pose(Vec3(0.5, 0.1, -0.3), Vec3(0.1, 0.9, 0.2), Vec3::UnitX());
  for (const ReferenceFrame& frame : {ReferenceFrame(), ReferenceFrame(X_JR)}) {
    const auto back = frame.from_reference(frame.to_reference(some_pose()));
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->isApprox(some_pose(), 1e-12));
  }
}

TEST(ReferenceFrame, RefusesWhatIsNoRigidPose) {
  const ReferenceFrame frame;
  const igtl::Matrix good = frame.to_reference(some_pose());
  igtl::Matrix scaled = good;
  scaled.leftCols<3>() *= 1.01;
  igtl::Matrix mirrored = good;
  mirrored.col(0) *= -1;
  igtl::Matrix far = good;
  far(0, 3) = 20'000;
  igtl::Matrix zero = igtl::Matrix::Zero();
  for (const igtl::Matrix& bad : {scaled, mirrored, far, zero})
    EXPECT_FALSE(frame.from_reference(bad));
}

TEST(ImageToProbe, PutsEveryPixelWhereTheScanConverterHasIt) {
  Transducer curved;
  curved.radius = 50e-3;
  curved.width = 60e-3;
  Transducer steered;
  steered.steering = 0.2;
  ImageSettings settings;
  settings.depth = 55e-3;
  for (const Transducer& transducer : {Transducer(), curved, steered}) {
    const ScanConverter converter(transducer, settings);
    const igtl::Matrix matrix = image_to_probe(transducer, settings.pixel, converter.height());
    for (const auto& [x, y] : {std::pair{0, 0}, std::pair{17, 230}, std::pair{399, 3}}) {
      const Vec3 p = matrix.leftCols<3>() * Vec3(x, y, 0) + matrix.col(3);
      EXPECT_LT((p - 1e3 * converter.point_of(x, y)).norm(), 0.051) << x << ' ' << y;
    }
    EXPECT_GT(matrix.leftCols<3>().determinant(), 0);
  }
}

TEST(TrackerCalibration, ComesBackFromItsText) {
  TrackerCalibration calibration;
  calibration.X_ProbeP = some_pose();
  calibration.X_NeedleN.translation() = Vec3(0, 0, 0.12);
  calibration.X_JR = some_pose().inverse();
  calibration.registered = true;
  const auto back = parse_tracker_calibration(to_toml(calibration), "tracker.toml");
  ASSERT_TRUE(back) << back.error().to_string();
  EXPECT_TRUE(back->registered);
  EXPECT_TRUE(back->X_ProbeP.isApprox(calibration.X_ProbeP, 1e-12));
  EXPECT_TRUE(back->X_NeedleN.isApprox(calibration.X_NeedleN, 1e-12));
  EXPECT_TRUE(back->X_JR.isApprox(calibration.X_JR, 1e-12));
}

TEST(TrackerCalibration, WithoutARegistrationReferenceIsTheJointInRas) {
  const auto empty = parse_tracker_calibration("", "tracker.toml");
  ASSERT_TRUE(empty);
  EXPECT_FALSE(empty->registered);
  EXPECT_TRUE(empty->X_JR.isApprox(ReferenceFrame().X_JR()));
}

TEST(TrackerCalibration, SaysEverythingThatIsWrong) {
  const auto bad = parse_tracker_calibration(
      "[transducer_to_probe]\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0]]\n"
      "[needle_tip_to_needle]\nmatrix = [[2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]\n"
      "[needle]\n",
      "tracker.toml");
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, HasSubstr("four rows"));
  EXPECT_THAT(bad.error().message, HasSubstr("scaled"));
  EXPECT_THAT(bad.error().message, HasSubstr("'needle'"));
}

TEST(TrackerCalibration, TheInsertionPointComesBackAndIsRefusedWithAReason) {
  const auto read = parse_tracker_calibration(
      "[insertion_point]\npoint_mm = [10, -20, 30]\naxis = [0, 0, -2]\nsteepness_deg = 30\n", "t");
  ASSERT_TRUE(read) << read.error().to_string();
  ASSERT_TRUE(read->insertion);
  EXPECT_TRUE(read->insertion->p_W.isApprox(Vec3(0.01, -0.02, 0.03)));
  EXPECT_TRUE(read->insertion->axis_W.isApprox(Vec3(0, 0, -1)));
  EXPECT_NEAR(read->insertion->steepness, 0.5235987755982988, 1e-12);
  EXPECT_EQ(read->insertion->beside_probe, GestureParams().beside_probe);
  const auto again = parse_tracker_calibration(to_toml(*read), "t");
  ASSERT_TRUE(again) << again.error().to_string();
  EXPECT_TRUE(again->insertion->p_W.isApprox(read->insertion->p_W));
  EXPECT_FALSE(TrackerCalibration().insertion);
  for (const char* bad : {"axis = [0, 0, 1]", "point_mm = [0, 0, 0]\naxis = [0, 0, 0]",
                          "point_mm = [0, 0, 1e9]\naxis = [0, 0, 1]",
                          "point_mm = [0, 0, 0]\naxis = [0, 0, 1]\nsteepness_deg = 99",
                          "point_mm = [0, 0, 0]\naxis = [0, 0, 1]\nother = 1"})
    EXPECT_FALSE(parse_tracker_calibration(std::string("[insertion_point]\n") + bad, "t")) << bad;
}

TEST(TrackerCalibration, AScaleIsOfPlacesInReferenceAlone) {
  const auto read = parse_tracker_calibration("scale = 0.97\n", "t");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(parse_tracker_calibration(to_toml(*read), "t")->scale, 0.97);
  EXPECT_FALSE(parse_tracker_calibration("scale = 25.4\n", "t")) << "a wrong unit is no scale";
  TrackerCalibration calibration = *read;
  calibration.X_JR = Pose::Identity();
  calibration.X_NeedleN.translation() = Vec3(0, 0, 0.1);
  TrackerInbox inbox(calibration, {});
  const Pose X_RSensor = make_pose(Vec3(0.1, 0.2, 0.3), Vec3::UnitX(), Vec3::UnitZ());
  ASSERT_TRUE(inbox.take(tracker_transform("NeedleToReference", millimetres_of(X_RSensor)), 1));
  TrackedPoses poses;
  ASSERT_TRUE(inbox.load(poses));
  EXPECT_LT((to_pose(poses.X_WN).translation() - Vec3(0.197, 0.194, 0.291)).norm(), 1e-6);
}

TEST(TrackerInbox, IsRegisteredAnewAsATaskBegins) {
  TrackerInbox inbox({}, {});
  const Pose X_JP = make_pose(Vec3(0.05, 0.02, 0.1), Vec3::UnitY(), Vec3::UnitX());
  inbox.register_at(block_in_joint(X_JP));
  Pose X_RP = Pose::Identity();  // a probe on the block: its z down, its x along the block's
  X_RP.linear().diagonal() = Vec3(1, -1, -1);
  ASSERT_TRUE(inbox.take(tracker_transform("ProbeToReference", millimetres_of(X_RP)), 1));
  TrackedPoses poses;
  ASSERT_TRUE(inbox.load(poses));
  EXPECT_TRUE(to_pose(poses.X_WP).isApprox(X_JP, 1e-6));
}

TEST(TrackerInbox, PutsCalibrationsAndRegistrationTogether) {
  TrackerCalibration calibration;
  calibration.X_ProbeP = some_pose();
  calibration.X_NeedleN.translation() = Vec3(0, 0, 0.12);
  calibration.X_JR = make_pose(Vec3(0.5, 0, 0), Vec3::UnitY(), Vec3::UnitX());
  TrackerInbox inbox(calibration, {"Stylus", "Needle"});
  const Pose X_RSensor = make_pose(Vec3(0.1, 0.2, 0.3), Vec3::UnitX(), Vec3::UnitZ());
  ASSERT_TRUE(inbox.take(tracker_transform("Stylus", millimetres_of(X_RSensor)), 5));
  ASSERT_TRUE(inbox.take(tracker_transform("Needle", millimetres_of(X_RSensor)), 6));
  ASSERT_TRUE(inbox.take(tracker_transform("Other", igtl::Matrix::Zero()), 7));
  TrackedPoses poses;
  ASSERT_TRUE(inbox.load(poses));
  EXPECT_EQ(poses.probe_ns, 5);
  EXPECT_EQ(poses.needle_ns, 6);
  EXPECT_EQ(poses.number, 2U);
  const Pose probe = calibration.X_JR * X_RSensor * calibration.X_ProbeP;
  const Pose needle = calibration.X_JR * X_RSensor * calibration.X_NeedleN;
  EXPECT_TRUE(to_pose(poses.X_WP).isApprox(probe, 1e-6));  // single precision on the way
  EXPECT_TRUE(to_pose(poses.X_WN).isApprox(needle, 1e-6));
}

class TrackerDeviceTest : public testing::Test {
 protected:
  void send(const char* name, double x_mm, std::int64_t now_ns, const char* status = "") {
    igtl::Matrix matrix = igtl::Matrix::Identity();
    matrix(0, 3) = x_mm;
    igtl::Message message = tracker_transform(name, matrix);
    if (*status != '\0') message.meta = {{"TransformStatus", status}};
    static_cast<void>(inbox_->take(message, now_ns));
  }
  static constexpr std::int64_t kMs = 1'000'000;
  std::shared_ptr<TrackerInbox> inbox_ =
      std::make_shared<TrackerInbox>(TrackerCalibration(), TrackerInbox::Names());
  TrackerDevice device_{inbox_, TrackerDevice::Holds()};
};

TEST_F(TrackerDeviceTest, IsAbsentUntilSomethingCame) {
  EXPECT_EQ(device_.read(kMs).state, PeerState::absent);
}

TEST_F(TrackerDeviceTest, HoldsAProbeButNoNeedle) {
  send("ProbeToReference", 1, 100 * kMs);
  send("NeedleToReference", 2, 100 * kMs);
  const DeviceSample fresh = device_.read(110 * kMs);
  EXPECT_EQ(fresh.state, PeerState::alive);
  EXPECT_EQ(fresh.has_needle, 1U);
  EXPECT_EQ(fresh.has_probe, 1U);
  const DeviceSample held = device_.read(120 * kMs);
  EXPECT_EQ(held.state, PeerState::alive);
  EXPECT_EQ(held.has_needle, 0U);
  EXPECT_EQ(held.has_probe, 1U);
  EXPECT_EQ(device_.read(601 * kMs).state, PeerState::lost);
}

TEST_F(TrackerDeviceTest, WhatTheTrackerDidNotSeeIsNotTaken) {
  send("ProbeToReference", 1, 100 * kMs);
  send("ProbeToReference", 50, 110 * kMs, "INVALID");
  send("ProbeToReference", 60, 120 * kMs, "OK");
  EXPECT_NEAR(device_.read(121 * kMs).X_WP.position[0], -60e-3, 1e-9);
  EXPECT_EQ(device_.read(121 * kMs).number, 2U);
}

igtl::Message plunger_message(std::uint64_t unit, const std::vector<double>& values) {
  igtl::Message message;
  message.type = "SENSOR";
  message.device = "Plunger";
  message.content = igtl::pack_sensor({unit, values});
  return message;
}

TEST_F(TrackerDeviceTest, AThumbIsAForceOrATravelUntilItIsSilent) {
  ASSERT_TRUE(inbox_->take(plunger_message(igtl::kNewton, {4.5}), 1'000));
  DeviceSample sample = device_.read(2'000);
  EXPECT_EQ(sample.plunger, PlungerSign::force);
  EXPECT_EQ(sample.plunger_force, 4.5);
  EXPECT_EQ(sample.has_needle, 0);
  ASSERT_TRUE(inbox_->take(plunger_message(igtl::kMetre, {-3e-3}), 3'000));
  sample = device_.read(4'000);
  EXPECT_EQ(sample.plunger, PlungerSign::travel);
  EXPECT_EQ(sample.plunger_travel, -3e-3);
  EXPECT_EQ(sample.plunger_force, 0);
  EXPECT_EQ(device_.read(3'000 + kPeerTimeout).plunger, PlungerSign::none);
}

TEST_F(TrackerDeviceTest, AThumbThatCannotBeLetsGoAndIsTold) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  igtl::Message cut = plunger_message(igtl::kNewton, {1});
  cut.content.pop_back();
  for (const igtl::Message& wrong :
       {plunger_message(igtl::kNewton, {kNan}), plunger_message(igtl::kNewton, {kInfinity}),
        plunger_message(igtl::kNewton, {-1e300}), plunger_message(igtl::kMetre, {1e300}),
        plunger_message(igtl::kMetre, {kNan}), plunger_message(igtl::kMetre, {1.5}),
        plunger_message(igtl::kNewton, {}), plunger_message(igtl::kNewton, {1, 2}),
        plunger_message(0, {1}), cut}) {
    ASSERT_TRUE(inbox_->take(plunger_message(igtl::kNewton, {5}), 1'000));
    const auto taken = inbox_->take(wrong, 2'000);
    ASSERT_FALSE(taken);
    EXPECT_THAT(taken.error().message, HasSubstr("Plunger"));
    const DeviceSample sample = device_.read(3'000);
    EXPECT_EQ(sample.plunger, PlungerSign::none);
    EXPECT_EQ(sample.plunger_force, 0);
    EXPECT_EQ(sample.plunger_travel, 0);
  }
  // Another program's sensor of another name is nobody's thumb.
  igtl::Message other = plunger_message(igtl::kNewton, {7});
  other.device = "Load";
  ASSERT_TRUE(inbox_->take(other, 4'000));
  EXPECT_EQ(device_.read(5'000).plunger, PlungerSign::none);
}

TEST_F(TrackerDeviceTest, PosesThatCannotBeAreNoPoses) {
  igtl::Matrix bad = igtl::Matrix::Zero();
  EXPECT_FALSE(inbox_->take(tracker_transform("NeedleToReference", bad), 100 * kMs));
  EXPECT_EQ(device_.read(101 * kMs).state, PeerState::invalid);
  send("NeedleToReference", 2, 102 * kMs);
  EXPECT_EQ(device_.read(103 * kMs).state, PeerState::alive);
}

TEST_F(TrackerDeviceTest, IsReadWithoutWaiting) {
  send("ProbeToReference", 1, 100 * kMs);
  TrackedPoses poses;
  ARTUS_RUNS_REALTIME(TrackerInbox::load, use(inbox_->load(poses)));
  ARTUS_RUNS_REALTIME(TrackerDevice::read, use(device_.read(101 * kMs)));
  ARTUS_RUNS_REALTIME(TrackerDevice::write, device_.write(DeviceFeedback{}));
}

TEST(RemoteCommand, TakesItsValueFromXmlOrPlainText) {
  const auto value_of = [](const char* content) {
    return remote_command_of({1, "Gain", 3, content}).value().value;
  };
  EXPECT_EQ(value_of("<Command Name=\"Gain\" Value=\" 12.5 \"/>"), "12.5");
  EXPECT_EQ(value_of(" 7\n"), "7");
  EXPECT_EQ(value_of("<Command Name=\"Gain\"/>"), "");
  EXPECT_EQ(value_of(""), "");
  EXPECT_EQ(value_of("<Command Name='Gain' Value='12.5'/>"), "12.5");
  EXPECT_EQ(value_of("<Command Name='a \"Value=\"9' Value = '12.5' />"), "12.5");
  EXPECT_EQ(value_of("<Command\n\tValue=\"a &lt;&amp;&apos;b\"></Command>"), "a <&'b");
  EXPECT_EQ(value_of("<Command NewValue=\"3\"/>"), "");
  for (const char* broken :
       {"<Command Value>", "<Command Value=>", "<Command Value=3/>", "<Command ='3'/>"})
    EXPECT_EQ(value_of(broken), "") << broken;
}

TEST(RemoteCommand, AnswersSayToSlicerWhetherItWasDone) {
  igtl::Message asked;
  asked.device = "Slicer";
  asked.id = 4;
  const igtl::CommandText command{42, "Gain", 3, "<Command/>"};
  const igtl::Message yes = answer_message(asked, command, {true, "done"});
  EXPECT_EQ(yes.type, "RTS_COMMAND");
  EXPECT_EQ(yes.device, "Slicer");
  EXPECT_EQ(yes.meta_value("Status"), "SUCCESS");
  EXPECT_EQ(igtl::parse_command(yes.content)->number, 42U);
  igtl::CommandText newer = command;
  newer.name_bytes = 128;
  const auto read = igtl::parse_command(igtl::pack_command(newer));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->name, "Gain");
  EXPECT_EQ(read->content, "<Command/>");
  EXPECT_EQ(answer_message(asked, *read, {true, ""}).content.size(),
            yes.content.size() + 108 - std::string("done").size())
      << "the answer has the form of the question";
  const igtl::Message no = answer_message(asked, command, {false, "a < b & \"c\""});
  EXPECT_EQ(no.meta_value("Status"), "FAIL");
  EXPECT_EQ(no.meta_value("ErrorMessage"), "a < b & \"c\"");
  EXPECT_THAT(igtl::parse_command(no.content)->content, HasSubstr("a &lt; b &amp; &quot;c&quot;"));
}

}  // namespace
}  // namespace artus
