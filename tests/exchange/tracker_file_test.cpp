// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/tracker_file.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/rigid.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/exchange/faults.h"
#include "artus/detail/exchange/perk_recording.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/sequence_header.h"
#include "artus/detail/exchange/table_columns.h"
#include "artus/detail/exchange/tracker_table.h"
#include "artus/detail/exchange/transform_graph.h"

namespace artus {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Pose some_pose(double along) {
  return make_pose(Vec3(0.01 + along, -0.02, 0.03), Vec3(1, 2, 3), Vec3(1, 0, 0));
}

std::string matrix_text(const Pose& pose) {
  const igtl::Matrix m = millimetres_of(pose);
  std::string text;
  for (Eigen::Index i = 0; i < 12; ++i) text += printed("%.12g ", m(i / 4, i % 4));
  return text + "0 0 0 1";
}

/// A header as PLUS writes it, of three frames, in each transform's own frame.
std::string plus_header(const std::function<Pose(int)>& X_RP, const Pose& X_TR,
                        const char* tail = "ElementDataFile = LOCAL\n") {
  std::string text = "ObjectType = Image\nNDims = 3\nDimSize = 0 0 3\nElementType = MET_OTHER\n";
  for (int i = 0; i < 3; ++i) {
    const std::string key = printed("Seq_Frame%04d_", i);
    const std::string tracker = matrix_text(X_TR);
    text += key + "ProbeToTrackerTransform = " + matrix_text(X_TR * X_RP(i)) + "\n" + key +
            "ProbeToTrackerTransformStatus = OK\n" + key +
            "ReferenceToTrackerTransform = " + tracker + "\n" + key +
            "ReferenceToTrackerTransformStatus = OK\n" + key +
            printed("Timestamp = %.2f\n", 5 + 0.1 * i);
  }
  return text + tail;
}

TrackerTrack track_in(const std::string& text, const TrackNames& names = {}) {
  const auto header = parse_sequence_header(text, "x.igs.mha");
  EXPECT_TRUE(header) << header.error().to_string();
  auto track = track_of(*header, "x.igs.mha", names);
  EXPECT_TRUE(track) << track.error().to_string();
  return *track;
}

TEST(TransformNames, PartAtTheToBeforeACapital) {
  EXPECT_EQ(frames_of_transform("ProbeToTracker"),
            std::pair(std::string("Probe"), std::string("Tracker")));
  EXPECT_EQ(frames_of_transform("TopToTorso"), std::pair(std::string("Top"), std::string("Torso")));
  EXPECT_FALSE(frames_of_transform("Tolerance"));
  EXPECT_FALSE(frames_of_transform("ProbeTo"));
}

TEST(TransformGraph, FollowsAnyWayAgainstTheDirection) {
  const Pose X_TP = some_pose(0);
  const Pose X_TR = make_pose(Vec3(0.2, 0, 0.5), Vec3(0, 1, 0.2), Vec3(1, 0, 0));
  TransformGraph graph;
  graph.set("ProbeToTracker", millimetres_of(X_TP));
  graph.set("TrackerToReference", millimetres_of(X_TR.inverse()));
  const auto found = graph.find("Probe", "Reference");
  ASSERT_TRUE(found && *found);
  EXPECT_TRUE((*found)->isApprox(X_TR.inverse() * X_TP, 1e-9));
  const auto back = graph.find("Reference", "Probe");
  EXPECT_TRUE((*back)->isApprox((*found)->inverse(), 1e-9));
  EXPECT_FALSE(*graph.find("Needle", "Reference"));
}

TEST(TransformGraph, AsksOnlyMatricesOnTheWayToBeRigid) {
  TransformGraph graph;
  graph.set("ProbeToReference", millimetres_of(some_pose(0)));
  graph.set("ImageToProbe", 0.2 * millimetres_of(some_pose(0)));
  EXPECT_TRUE(graph.find("Probe", "Reference"));
  const auto image = graph.find("Image", "Reference");
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().where, "ImageToProbe");
}

TEST(SequenceHeader, ATrackersFrameIsComposedWithTheReferences) {
  const Pose X_TR = make_pose(Vec3(0.2, -0.1, 0.5), Vec3(0, 1, 0.2), Vec3(1, 0, 0));
  const auto track = track_in(plus_header([](int i) { return some_pose(0.001 * i); }, X_TR));
  ASSERT_EQ(track.frames.size(), 3U);
  EXPECT_TRUE(track.reference_is_ras);
  EXPECT_THAT(track.notices, IsEmpty());
  for (int i = 0; i < 3; ++i)
    EXPECT_TRUE(
        track.frames[static_cast<std::size_t>(i)].probe->isApprox(some_pose(0.001 * i), 1e-6));
}

TEST(SequenceHeader, ReadsNrrdToo) {
  std::string nrrd = "NRRD0004\n# a remark\ntype: unsigned char\n";
  for (int i = 0; i < 2; ++i)
    nrrd += printed("Seq_Frame%04d_", i) +
            "NeedleToReferenceTransform:=" + matrix_text(some_pose(0)) + "\n" +
            printed("Seq_Frame%04d_Timestamp:=%d\n", i, i);
  const auto track = track_in(nrrd + "\npixels");
  ASSERT_EQ(track.frames.size(), 2U);
  EXPECT_TRUE(track.frames[1].needle->isApprox(some_pose(0), 1e-9));
  EXPECT_FALSE(track.frames[1].probe);
}

TEST(SequenceHeader, WithoutAReferenceTheTrackerIsTakenAndTold) {
  std::string text = plus_header([](int i) { return some_pose(0.001 * i); }, Pose::Identity());
  for (std::size_t at; (at = text.find("ReferenceToTracker")) != std::string::npos;)
    text.replace(at, 18, "OtherToOther2");
  const auto track = track_in(text);
  EXPECT_THAT(track.notices, testing::Contains("Probe in Tracker is taken for the probe"));
}

TEST(SequenceHeader, TellsAllFaultsAtOnceAndWhatTheFileHas) {
  std::string text = plus_header([](int i) { return some_pose(0.001 * i); }, Pose::Identity());
  std::string bad = text;
  bad.replace(bad.find("Timestamp = 5.10"), 16, "Timestamp = 4.10");
  const std::string first = "Seq_Frame0002_ProbeToTrackerTransform = ";
  bad.replace(bad.find(first) + first.size(), 3, "x");
  const auto faults = track_of(*parse_sequence_header(bad, "x"), "x");
  ASSERT_FALSE(faults);
  EXPECT_THAT(faults.error().message, AllOf(HasSubstr("frame 1"), HasSubstr("must rise"),
                                            HasSubstr("frame 2"), HasSubstr("16 numbers")));
  for (std::size_t at; (at = text.find("ProbeTo")) != std::string::npos;)
    text.replace(at, 7, "WandTo");
  const auto none = track_of(*parse_sequence_header(text, "x"), "x");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("WandToTracker"));
  EXPECT_EQ(track_in(text, {"WandToReference", "NeedleToReference"}).frames.size(), 3U);
}

TEST(SequenceHeader, FramesThatAreInvalidOrOfOneTimeAreLeftOutAndTold) {
  std::string text = plus_header([](int i) { return some_pose(0.001 * i); }, Pose::Identity());
  const std::string status = "Seq_Frame0001_ProbeToTrackerTransformStatus = OK";
  std::string lost = text;
  lost.replace(lost.find(status), status.size(), status.substr(0, status.size() - 2) + "INVALID");
  const auto track = track_in(lost);
  EXPECT_EQ(track.frames.size(), 2U);
  EXPECT_THAT(track.notices, testing::ElementsAre(HasSubstr("1 frames were left out")));
  text.replace(text.find("Timestamp = 5.10"), 16, "Timestamp = 5.00");
  EXPECT_EQ(track_in(text).frames.size(), 2U);
}

TEST(TableColumns, KnowsTheNamesOfSeveralPrograms) {
  const auto ndi =
      find_columns({"Sample:", "Hour", "Minutes", "Seconds", "ms", "Xa", "Ya", "Za", "qoa", "qxa",
                    "qya", "qza", "Xb", "Yb", "Zb", "qob", "qxb", "qyb", "qzb"});
  ASSERT_EQ(ndi.tools.size(), 2U);
  EXPECT_EQ(ndi.tools[1].tool, "b");
  EXPECT_EQ(ndi.tools[0].at, (std::array<std::size_t, 7>{5, 6, 7, 8, 9, 10, 11}));
  EXPECT_TRUE(ndi.of_ndi);
  const auto ros =
      find_columns({"%time", "field.pose.position.x", "field.pose.position.y",
                    "field.pose.position.z", "field.pose.orientation.x", "field.pose.orientation.y",
                    "field.pose.orientation.z", "field.pose.orientation.w"});
  ASSERT_EQ(ros.tools.size(), 1U);
  EXPECT_EQ(ros.tools[0].at, (std::array<std::size_t, 7>{1, 2, 3, 7, 4, 5, 6}));
  EXPECT_TRUE(ros.time);
  const auto track =
      find_columns({"Tools", "Frame", "State", "Q0", "Qx", "Qy", "Qz", "Tx", "Ty", "Tz",
                    "Error", "State", "Q0",    "Qx", "Qy", "Qz", "Tx", "Ty", "Tz", "Error"});
  ASSERT_EQ(track.tools.size(), 2U);
  EXPECT_EQ(track.tools[1].at[0], 16U);
  EXPECT_EQ(track.tools[1].status, std::vector<std::size_t>{11});
  EXPECT_TRUE(find_columns({"a", "b"}).tools.empty());
}

TEST(TrackerTable, AnNdiLogIsRead) {
  const std::string log =
      "Test Date:\nday, month\n1, 1\n\nSample:,Hour,Minutes,Seconds,ms,Xa,Ya,Za,qoa,qxa,qya,qza\n"
      "1, 10 , 0 , 0, 0,10, -20, 30, 1, 0, 0, 0, \n2, 10 , 0 , 0, 40,0, 0, 0, 0, 0, 0, 0, \n"
      "3, 10 , 0 , 0, 80,11, -20, 30, 1, 0, 0, 0, \n4, 10 , 0 , 0, 120,MISSING,,,,,,, \n";
  ASSERT_TRUE(is_tracker_table(log));
  const auto track = parse_tracker_table(log, "log.csv");
  ASSERT_TRUE(track) << track.error().to_string();
  ASSERT_EQ(track->frames.size(), 2U);
  EXPECT_NEAR(track->frames[1].time, 0.08, 1e-9);
  EXPECT_TRUE(track->frames[1].needle->translation().isApprox(Vec3(0.011, -0.02, 0.03)));
  EXPECT_THAT(track->notices, AllOf(testing::Contains(HasSubstr("2 rows were left out")),
                                    testing::Contains(HasSubstr("millimetres"))));
}

TEST(TrackerTable, AClockGoesOverMidnight) {
  const std::string head = "Hour,Minutes,Seconds,ms,Xa,Ya,Za,qoa,qxa,qya,qza\n";
  const auto track = parse_tracker_table(
      head + "23,59,59,900,10,0,0,1,0,0,0\n0,0,0,100,11,0,0,1,0,0,0\n", "log.csv");
  ASSERT_TRUE(track) << track.error().to_string();
  EXPECT_NEAR(track->frames[1].time, 0.2, 1e-6);
}

TEST(TrackerTable, SofaAndPlainLinesAreMetresOfTheSamePose) {
  const auto sofa = parse_tracker_table(
      "T= 0\n  X= 0.01 0.02 0.03 0.1 0.2 0.3 0.9273618\n  V= 0 0 0 0 0 0\nT= 0.04\n"
      "  X= 0.011 0.02 0.03 0.1 0.2 0.3 0.9273618\n",
      "s.txt");
  const auto plain = parse_tracker_table(
      "# time x y z qx qy qz qw\n5.00 0.01 0.02 0.03 0.1 0.2 0.3 0.9273618\n"
      "5.04 0.011 0.02 0.03 0.1 0.2 0.3 0.9273618\n",
      "p.txt");
  ASSERT_TRUE(sofa) << sofa.error().to_string();
  ASSERT_TRUE(plain) << plain.error().to_string();
  ASSERT_EQ(sofa->frames.size(), 2U);
  ASSERT_EQ(plain->frames.size(), 2U);
  EXPECT_NEAR(plain->frames[1].time, 0.04, 1e-9);
  EXPECT_TRUE(sofa->frames[1].needle->isApprox(*plain->frames[1].needle, 1e-9));
  EXPECT_NEAR(sofa->frames[0].needle->translation().x(), 0.01, 1e-12);
}

TEST(TrackerTable, ToolsAreTakenByTheirNames) {
  const auto track = parse_tracker_table(
      "timestamp_ms;probe_x_mm;probe_y_mm;probe_z_mm;probe_qw;probe_qx;probe_qy;probe_qz;"
      "Needle Tx [mm];Needle Ty [mm];Needle Tz [mm];Needle Q0;Needle Qx;Needle Qy;Needle Qz\n"
      "1000;1;2;3;1;0;0;0;4;5;6;1;0;0;0\n1020;1;2;3;1;0;0;0;nan;nan;nan;nan;nan;nan;nan\n",
      "t.csv");
  ASSERT_TRUE(track) << track.error().to_string();
  ASSERT_EQ(track->frames.size(), 2U);
  EXPECT_NEAR(track->frames[0].needle->translation().x(), 0.004, 1e-12);
  EXPECT_NEAR(track->frames[0].probe->translation().x(), 0.001, 1e-12);
  EXPECT_FALSE(track->frames[1].needle);
  EXPECT_NEAR(track->frames[1].time, 0.02, 1e-9);
}

TEST(TrackerTable, TellsAllFaultsAtOnceWithTheirLines) {
  const auto track = parse_tracker_table(
      "time,x,y,z,qw,qx,qy,qz\n0,1,2,3,1,0,0,0\n1,1,2,3,2,0,0,0\n0.5,1,2,3,1,0,0,0\n2,1,2,,1,0,0,"
      "0\n"
      "-1,1,2,3,1,0,0,0\n",
      "t.csv");
  ASSERT_FALSE(track);
  EXPECT_THAT(track.error().message,
              AllOf(HasSubstr("line 3"), HasSubstr("norm 2"), HasSubstr("line 5"),
                    HasSubstr("incomplete"), HasSubstr("line 6"), HasSubstr("falls")));
}

TEST(PerkRecording, TransformsThatComeOneByOneBecomeFrames) {
  std::string xml = "<TransformRecorderLog>\n";
  const auto log = [&](double time, const char* device, const Pose& pose) {
    const auto seconds = static_cast<int>(time);
    xml +=
        printed(
            "  <log TimeStampSec=\"%d\" TimeStampNSec=\"%d\" type=\"transform\" DeviceName=\"%s\" ",
            seconds, static_cast<int>(1e9 * (time - seconds)), device) +
        "transform=\"" + matrix_text(pose) + "\" />\n";
  };
  log(100, "ReferenceToTracker", some_pose(0.3));
  log(100, "ProbeToTracker", some_pose(0.3) * some_pose(0.1));
  log(100.25, "NeedleToTracker", some_pose(0.3) * some_pose(0));
  log(100.5, "NeedleToTracker", some_pose(0.3) * some_pose(0.01));
  log(101.5, "ReferenceToTracker", some_pose(0.3));
  log(101.5, "NeedleToTracker", some_pose(0.3) * some_pose(0.02));
  xml +=
      "  <log TimeStampSec=\"100\" TimeStampNSec=\"0\" type=\"message\" message=\"Start\" />\n"
      "</TransformRecorderLog>\n";
  const auto track = parse_perk_recording(xml, "r.xml");
  ASSERT_TRUE(track) << track.error().to_string();
  ASSERT_EQ(track->frames.size(), 3U);
  EXPECT_NEAR(track->frames[1].time, 0.5, 1e-6);
  EXPECT_TRUE(track->frames[1].needle->isApprox(some_pose(0.01), 1e-6));
  EXPECT_TRUE(track->frames[1].probe->isApprox(some_pose(0.1), 1e-6));
  EXPECT_FALSE(track->frames[2].probe);  // seen 1.5 s ago
  EXPECT_THAT(track->notices, testing::Contains("message at 0.00 s: Start"));
}

TEST(PerkRecording, AMatrixOffARotationIsKeptAsItIsBesideItsPose) {
  const auto track = parse_perk_recording(
      "<TransformRecorderLog><log TimeStampSec='1' TimeStampNSec='0' type='transform' "
      "DeviceName='NeedleToReference' transform='0.9998 0 0 10 0 1 0 0 0 0 1 0 0 0 0 1'/>"
      "</TransformRecorderLog>",
      "r.xml");
  ASSERT_TRUE(track) << track.error().to_string();
  const TrackFrame& frame = track->frames.at(0);
  EXPECT_TRUE(is_rigid(*frame.needle));
  ASSERT_TRUE(frame.needle_given);
  EXPECT_EQ((*frame.needle_given)(0, 0), 0.9998);
}

TEST(PerkRecording, SaysWhatIsWrong) {
  EXPECT_THAT(parse_perk_recording("<a><b></a>", "r.xml").error().to_string(),
              HasSubstr("r.xml:1"));
  const auto faults = parse_perk_recording(
      "<l>\n<log TimeStampSec=\"1\" TimeStampNSec=\"0\" type=\"transform\" DeviceName=\"A\" "
      "transform=\"1 2\"/>\n"
      "<log type=\"transform\" DeviceName=\"A\"/>\n</l>",
      "r.xml");
  ASSERT_FALSE(faults);
  EXPECT_THAT(faults.error().message, AllOf(HasSubstr("line 2"), HasSubstr("line 3")));
  EXPECT_THAT(parse_perk_recording("<l/>", "r.xml").error().message, HasSubstr("no transforms"));
}

TEST(Faults, AreCountedWhenTheyAreMany) {
  Faults faults;
  for (int i = 0; i < 20; ++i) faults.add("", "wrong");
  EXPECT_THAT(faults.refusal(ErrorCode::invalid, "x").value().message,
              AllOf(HasSubstr("20 faults"), HasSubstr("and 8 more")));
}

class PoseFiles : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, const std::string& text) {
    const auto path = std::filesystem::path(testing::TempDir()) / ("pose_files_" + name);
    EXPECT_TRUE(write_text(path, text));
    return path;
  }
};

TEST_F(PoseFiles, OnePoseIsTheSameInEveryFormat) {
  const Pose X_JN = some_pose(0);
  const igtl::Matrix m = ReferenceFrame().to_reference(X_JN);
  Pose X_RN = Pose::Identity();
  X_RN.linear() = m.leftCols<3>();
  X_RN.translation() = 1e-3 * m.col(3);
  std::string mha = "ObjectType = Image\n";
  std::string table = "t x_m y_m z_m qw qx qy qz\n";
  std::string list =
      "time_s,needle_x_m,needle_y_m,needle_z_m,needle_qw,needle_qx,needle_qy,needle_qz\n";
  const Eigen::Quaterniond q(X_JN.linear());
  const Vec3 p = X_JN.translation();
  for (int i = 0; i < 2; ++i) {
    mha += printed("Seq_Frame%04d_", i) + "NeedleToReferenceTransform = " + matrix_text(X_RN) +
           "\n" + printed("Seq_Frame%04d_Timestamp = %d\n", i, i);
    table += printed("%d %.12g %.12g %.12g %.12g %.12g %.12g %.12g\n", i, p.x(), p.y(), p.z(),
                     q.w(), q.x(), q.y(), q.z());
    list += printed("%d,%.12g,%.12g,%.12g,%.12g,%.12g,%.12g,%.12g\n", i, p.x(), p.y(), p.z(), q.w(),
                    q.x(), q.y(), q.z());
  }
  list += "3,,,,,,,\n4,0,0,0,0,0,0,0\n";
  PoseFileOptions needle;
  needle.needed = PoseHand::needle;
  for (const auto& path : {file("a.igs.mha", mha + "ElementDataFile = LOCAL\n"),
                           file("b.txt", table), file("c.csv", list)}) {
    const auto got = read_pose_file(path, needle);
    ASSERT_TRUE(got) << got.error().to_string();
    ASSERT_EQ(got->poses.size(), 2U) << path;
    EXPECT_TRUE(got->poses[1].X_JN->isApprox(X_JN, 1e-6)) << path;
    EXPECT_FALSE(got->poses[1].has_probe);
    EXPECT_FALSE(read_pose_file(path));
  }
  EXPECT_THAT(read_pose_file(file("c.csv", list), needle)->notices,
              testing::ElementsAre(HasSubstr("2 rows were left out")));
}

TEST_F(PoseFiles, ACalibrationPutsSensorsIntoTheJoint) {
  const auto path =
      file("d.txt", "t x_m y_m z_m qw qx qy qz\n0 0.1 0 0 1 0 0 0\n1 0.2 0 0 1 0 0 0\n");
  PoseFileOptions options;
  options.needed = PoseHand::needle;
  options.calibration = TrackerCalibration();
  options.calibration->X_NeedleN = make_pose(Vec3(0, 0, 0.12), Vec3::UnitZ(), Vec3::UnitX());
  options.calibration->X_JR = make_pose(Vec3(0, 0, -0.5), Vec3::UnitX(), Vec3::UnitY());
  options.calibration->registered = true;
  const auto got = read_pose_file(path, options);
  ASSERT_TRUE(got) << got.error().to_string();
  Pose sensor = Pose::Identity();
  sensor.translation() = Vec3(0.2, 0, 0);
  EXPECT_TRUE(got->poses[1].X_JN->isApprox(
      options.calibration->X_JR * sensor * options.calibration->X_NeedleN, 1e-9));
  options.calibration->registered =
      false;  // a table is in the joint's frame until it is registered
  EXPECT_TRUE(
      read_pose_file(path, options)->poses[1].X_JN->translation().isApprox(Vec3(0.2, 0, 0.12)));
}

}  // namespace
}  // namespace artus
