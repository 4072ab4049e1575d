// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>

#include <opencv2/core.hpp>

#include <gtest/gtest.h>

#include "artus/detail/viewer/joint3d/body_mark.h"
#include "artus/detail/viewer/joint3d/joint_sheets.h"
#include "artus/detail/viewer/joint3d/surface_detail.h"
#include "artus/detail/viewer/panels/caption.h"
#include "artus/detail/viewer/panels/cine_loop.h"
#include "artus/detail/viewer/panels/curve.h"
#include "artus/detail/viewer/panels/display_look.h"
#include "artus/detail/viewer/panels/guide.h"
#include "artus/detail/viewer/panels/image_place.h"
#include "artus/detail/viewer/panels/insertion_trace.h"
#include "artus/detail/viewer/panels/label_places.h"
#include "artus/detail/viewer/panels/needle_reading.h"
#include "artus/detail/viewer/panels/presets.h"
#include "artus/detail/viewer/words/anatomy_names.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

ImageSnapshot grey_image(std::uint8_t grey, int width = 100, int height = 80) {
  ImageSnapshot image;
  image.width = width;
  image.height = height;
  image.pixel = 0.5e-3;
  image.grey.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), grey);
  image.input.controls.dynamic_range_db = 51;  // 5 grey values a dB
  return image;
}

TEST(DisplayLook, ASliderActsAtItsDepthAndBlackStaysBlack) {
  DisplayLook look;
  look.tgc_db[7] = 10;
  EXPECT_EQ(slider_gain(look, 0), 0);
  EXPECT_NEAR(slider_gain(look, 15.0 / 16), 10, 1e-12);
  EXPECT_NEAR(slider_gain(look, 14.0 / 16), 5, 1e-12);
  const auto shown = displayed_grey(grey_image(100), look);
  EXPECT_EQ(shown.front(), 100);
  EXPECT_EQ(shown.back(), 150);
  EXPECT_EQ(displayed_grey(grey_image(0), look).back(), 0);
}

TEST(DisplayLook, ColoursShowWhatMovesInTheirBoxAlone) {
  ImageSnapshot image = grey_image(90);
  image.motion.assign(image.grey.size(), 0);
  DisplayLook look;
  look.colour = true;
  look.box = {0.25, 0.5, 0.3, 0.5};
  const auto at = [&image](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(x);
  };
  image.motion[at(25, 40)] = 255;  // toward the probe
  image.motion[at(26, 40)] = 1;
  image.motion[at(75, 40)] = 255;  // beside the box
  const auto shown = displayed_colour(image, look);
  const auto red_less_blue = [&shown](std::size_t i) {
    return static_cast<int>(shown[3 * i]) - static_cast<int>(shown[3 * i + 2]);
  };
  EXPECT_GT(red_less_blue(at(25, 40)), 100);
  EXPECT_LT(red_less_blue(at(26, 40)), -100);
  EXPECT_EQ(red_less_blue(at(75, 40)), 0);
  EXPECT_EQ(shown[3 * at(75, 40)], 90);
  look.box.move(9, -9);
  EXPECT_NEAR(look.box.x, 0.85, 1e-12) << "it stays within the picture";
  EXPECT_NEAR(look.box.y, 0.25, 1e-12);
  EXPECT_GT(displayed_colour(image, look).size(), 0U);
  EXPECT_EQ(plain_picture(image, look).channels(), 3);
}

TEST(BodyMark, TheProbeStandsOnItsMapAndGoesWhereItGoes) {
  const auto scene = test::make_layered_scene();
  CompiledJoint joint = scene->joint();
  joint.X_JP_default = make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX());
  const BodyMark mark = make_body_mark(joint);
  ASSERT_EQ(mark.grey.size(), static_cast<std::size_t>(mark.size) * mark.size);
  const auto grey_at = [&mark](int x, int y) {
    return mark.grey[static_cast<std::size_t>(y) * static_cast<std::size_t>(mark.size) +
                     static_cast<std::size_t>(x)];
  };
  EXPECT_GT(grey_at(mark.size / 2, mark.size / 2), 60) << "body";
  EXPECT_EQ(grey_at(0, 0), 0) << "beside it";
  const MarkLine here = probe_on_mark(mark, joint.X_JP_default, 40e-3);
  EXPECT_NEAR(here.x1 - here.x0, 40e-3 / mark.pixel, 1e-3);
  EXPECT_NEAR((here.x0 + here.x1) / 2, mark.size / 2.0 + 10e-3 / mark.pixel, 0.5);
  const Pose turned = joint.X_JP_default * Eigen::Translation3d(0, 20e-3, 0) *
                      Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ());
  const MarkLine there = probe_on_mark(mark, turned, 40e-3);
  EXPECT_NEAR(there.x1, there.x0, 1e-3) << "it was turned";
  EXPECT_GT(there.y1, there.y0);
  EXPECT_NEAR((there.y0 + there.y1) / 2 - here.y0, 20e-3 / mark.pixel, 0.1);
}

TEST(LabelPlaces, NamesMeetNoneAndStayWithinThePicture) {
  std::vector<LabelBox> requested;
  for (int i = 0; i < 40; ++i)
    requested.push_back(
        {static_cast<float>(i * 37 % 300) - 20, static_cast<float>(i * 53 % 200) - 5, 60, 13});
  const auto placed = place_labels(requested, 280, 190);
  int shown = 0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (!placed[i]) continue;
    ++shown;
    EXPECT_TRUE(placed[i]->x >= 0 && placed[i]->x + 60 <= 280);
    EXPECT_TRUE(placed[i]->y >= 0 && placed[i]->y + 13 <= 190);
    for (std::size_t j = 0; j < i; ++j) {
      if (!placed[j]) continue;
      EXPECT_TRUE(std::abs(placed[i]->x - placed[j]->x) >= 60 ||
                  std::abs(placed[i]->y - placed[j]->y) >= 13)
          << i << " meets " << j;
    }
  }
  EXPECT_GT(shown, 15);
  EXPECT_FALSE(place_labels(std::vector<LabelBox>{{0, 0, 300, 13}}, 280, 190)[0]);
}

TEST(ImagePlace, FlippedPointsComeBack) {
  for (const bool flipped : {false, true}) {
    const ImagePlace place{400, 50, 6, flipped};
    const ImagePoint p = place.point_at(place.x_of({12, 7}), place.y_of({12, 7}));
    EXPECT_NEAR(p.x_mm, 12, 1e-12);
    EXPECT_NEAR(p.y_mm, 7, 1e-12);
  }
}

TEST(Curve, AThinnedCurveKeepsItsEndsAndExtremesInOrder) {
  std::vector<CurvePoint> curve;
  for (int i = 0; i < 10000; ++i)  // there and back over 100 columns
    curve.push_back({100 - std::abs(0.02F * static_cast<float>(i) - 100),
                     std::sin(0.7F * static_cast<float>(i))});
  curve[4321].y = 9;
  const auto kept = thinned(curve);
  EXPECT_LE(kept.size(), 4U * 203U);
  EXPECT_EQ(kept.front().x, curve.front().x);
  EXPECT_EQ(kept.back().x, curve.back().x);
  const auto higher = [](const CurvePoint& a, const CurvePoint& b) {
    return a.y < b.y;
  };
  EXPECT_EQ(std::max_element(kept.begin(), kept.end(), higher)->y, 9);
  std::size_t at = 0;
  for (const CurvePoint& p : kept) {
    while (at < curve.size() && (curve[at].x != p.x || curve[at].y != p.y)) ++at;
    ASSERT_LT(at, curve.size()) << "each is a point of the curve, in its order";
  }
  EXPECT_TRUE(thinned({}).empty());
}

TEST(CineLoop, KeepsTheLastTwentySeconds) {
  CineLoop cine(nullptr);
  for (int i = 0; i <= 300; ++i) {
    ImageSnapshot image = grey_image(1);
    image.input.number = static_cast<std::uint64_t>(i);
    cine.add(image, {}, 0.1 * i);
  }
  EXPECT_NEAR(cine.age(0), CineLoop::kSeconds, 0.11);
  EXPECT_EQ(cine.at(cine.size() - 1).input.number, 300U);
  EXPECT_EQ(cine.at(cine.size() - 11).input.number, 290U);
}

TEST(Caption, ThePictureKeepsItsPixelsAndTheRestIsBesideIt) {
  ImageSnapshot image = grey_image(60);
  image.grey[0] = 200;
  Caption caption;
  caption.patient = "P-07";
  caption.date = "2026-01-02 03:04:05";
  const cv::Mat bare = captioned_picture(image, caption);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto shown = bare.at<cv::Vec3b>(kCaptionTop + y, kCaptionLeft + x);
      const int grey = x == 0 && y == 0 ? 200 : 60;
      if (std::abs(x - 6) > 12 || y > 6) {
        ASSERT_EQ(shown, cv::Vec3b::all(static_cast<uchar>(grey))) << x << ' ' << y;
      }
    }
  }
  caption.calipers = {{5, 20}, {25, 20}};
  const cv::Mat measured = captioned_picture(image, caption);
  const auto on_line = measured.at<cv::Vec3b>(kCaptionTop + 40, kCaptionLeft + 30);  // 15 mm, 20 mm
  EXPECT_GT(on_line[1], 180) << "the caliper's line";
  cv::Mat changed;
  cv::absdiff(bare, measured, changed);
  EXPECT_GT(cv::countNonZero(changed.reshape(1)), 100);
  caption.date.clear();
  cv::absdiff(measured, captioned_picture(image, caption), changed);
  EXPECT_GT(cv::countNonZero(changed.reshape(1)), 100) << "the date is written";
  EXPECT_EQ(plain_picture(image, {}).size(), cv::Size(image.width, image.height));
  DisplayLook flipped;
  flipped.flipped = true;
  EXPECT_EQ(plain_picture(image, flipped).at<uchar>(0, image.width - 1), 200);
}

TEST(Presets, AreWithinTheKnobs) {
  for (const ScannerPreset& preset : kPresets) {
    const ImageControls c = with_preset({}, preset);
    EXPECT_TRUE(c.depth >= 20e-3 && c.depth <= 80e-3);
    EXPECT_TRUE(c.frequency >= 5e6 && c.frequency <= 18e6);
    EXPECT_EQ(c.gain_db, ImageControls{}.gain_db);
  }
}

TEST(InsertionTrace, KeepsTheWholeInsertionAndForgetsItAtTheNext) {
  InsertionTrace trace;
  const auto go = [&trace](double from, double to) {
    for (int i = 0; i <= 20000; ++i) {
      TracePoint p;
      p.depth = from + (to - from) * i / 20000;
      p.region = p.depth > 0 ? 2 : 0;
      trace.add(p);
    }
  };
  go(-5e-3, 30e-3);  // as long as it may take
  EXPECT_NEAR(trace.points().front().depth, 0, 0.1e-3);
  EXPECT_NEAR(trace.points().back().depth, 30e-3, 0.1e-3);
  EXPECT_LT(trace.points().size(), 310U);
  go(30e-3, -5e-3);
  EXPECT_GT(trace.points().size(), 500U) << "and the way out";
  go(-5e-3, 1e-3);
  EXPECT_LT(trace.points().size(), 15U);
}

TEST(InsertionTrace, ALateTickIsNoWayOut) {
  InsertionTrace trace;
  for (int i = 0; i <= 200; ++i) {
    TracePoint p;
    p.felt = i % 20 != 7;
    p.depth = p.felt ? 1.5e-4 * i : 0;
    p.region = p.felt && i > 0 ? 2 : 0;
    trace.add(p);
  }
  EXPECT_NEAR(trace.points().front().depth, 0.15e-3, 1e-9);
  EXPECT_NEAR(trace.points().back().depth, 30e-3, 1e-9);
  EXPECT_GT(trace.points().size(), 150U);
}

HapticSnapshot needle_at(double depth, const Scene& scene) {
  HapticSnapshot now;
  now.X_JN = to_plain(make_pose(Vec3(0, 0, depth), Vec3::UnitZ(), Vec3::UnitX()));
  now.X_JP = to_plain(make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  now.inserted = 1;
  now.feedback.depth = depth;
  now.feedback.region = scene.region_at(Vec3(0, 0, depth));
  return now;
}

TEST(NeedleReading, BoneHoldsTheNeedleAndTheHubTheHand) {
  const auto scene = test::make_layered_scene();
  const auto deep =
      read_needle(*scene, needle_at(31e-3, *scene), 35e-3, std::nullopt, Language::english);
  EXPECT_TRUE(deep.on_bone);
  EXPECT_NEAR(deep.depth, 29e-3, 1e-6);
  EXPECT_NEAR(deep.hand_excess, 2e-3, 1e-6);
  EXPECT_EQ(deep.layer, "bone");
  const auto hub =
      read_needle(*scene, needle_at(20e-3, *scene), 20e-3, Vec3(3e-3, 0, 24e-3), Language::english);
  EXPECT_TRUE(hub.hub_on_skin);
  EXPECT_FALSE(hub.on_bone);
  EXPECT_NEAR(hub.to_target, 5e-3, 1e-9);
  EXPECT_TRUE(hub.in_plane);
  HapticSnapshot beside = needle_at(20e-3, *scene);
  beside.X_JP = to_plain(make_pose(Vec3(0, 4e-3, 0), Vec3::UnitZ(), Vec3::UnitX()));
  const auto out = read_needle(*scene, beside, 35e-3, std::nullopt, Language::french);
  EXPECT_FALSE(out.in_plane);
  EXPECT_NEAR(out.plane_offset, -4e-3, 1e-9);
}

TEST(NeedleReading, ThePicturesLabelsStandInTheirStructures) {
  const auto scene = test::make_layered_scene();
  const Pose X_JP = make_pose(Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX());
  const auto labels = find_picture_labels(*scene, X_JP, 40e-3, 35e-3, Language::english);
  EXPECT_EQ(labels.size(), 6U);
  for (const PictureLabel& label : labels) {
    const Vec3 p(1e-3 * label.x_mm - 20e-3, 0, 1e-3 * label.y_mm);
    EXPECT_EQ(scene->region_at(p), label.region) << label.name;
  }
  EXPECT_NE(labels.front().name, labels.back().name);
  const auto thickness = [&](const PictureLabel& label) {
    const double x = 1e-3 * label.x_mm - 20e-3;
    double sum = 0;
    for (const auto& s : tissue_intervals(*scene, {Vec3(x, 0, 0), Vec3(x, 0, 35e-3)}))
      if (s.region == label.region) sum += s.exit - s.entry;
    return sum;
  };
  for (std::size_t i = 1; i < labels.size(); ++i)
    EXPECT_LE(thickness(labels[i - 1]), thickness(labels[i]) + 1e-9) << "the thinnest first";
}

TEST(AnatomyNames, FillingFatIsNamedByWhereItLies) {
  CompiledJoint joint;
  joint.tissues.resize(4);
  joint.tissues[0].name = "fat";
  joint.tissues[0].acoustic.kind = TissueKind::fat;
  joint.tissues[1].name = "skin";
  joint.tissues[2].name = "bursa";
  joint.tissues[3].name = "muscle";
  joint.regions = {{"outside", 0},           {"beyond", 0}, {"subcutaneous_fat", 0}, {"skin", 1},
                   {"subacromial_bursa", 2}, {"deltoid", 3}};
  std::vector<TissueInterval> line(7);
  const RegionId path[] = {3, 2, 5, 2, 4, 2, 5};  // NOLINT(*-avoid-c-arrays)
  for (std::size_t i = 0; i < line.size(); ++i) line[i].region = path[i];
  EXPECT_EQ(layer_name(Language::english, joint, line, 1), "fat under the skin");
  EXPECT_EQ(layer_name(Language::english, joint, line, 3), "fat around the bursa");
  EXPECT_EQ(layer_name(Language::english, joint, line, 4), "subacromial bursa");
  EXPECT_EQ(layer_name(Language::french, joint, line, 4), "bourse sous-acromiale");
  std::vector<TissueInterval> out(3);
  out[0].region = 5;
  out[1].region = 2;
  out[2].region = 3;
  EXPECT_EQ(layer_name(Language::english, joint, out, 1), "fat under the skin");
  line[4].region = 5;
  EXPECT_EQ(layer_name(Language::english, joint, line, 3), "fat between the muscles");
}

TEST(Guide, SaysTheNextStepOfAnInjection) {
  const KeyMap keys;
  GuideInput in;
  in.keys = &keys;
  in.target = "subacromial bursa";
  in.target_region = 7;
  in.needle_length = 35e-3;
  Guide guide;
  const auto says = [&](const char* part) {
    const std::string next = guide.next(in);
    EXPECT_NE(next.find(part), std::string::npos) << next << " lacks " << part;
  };
  says("P takes the probe");
  EXPECT_EQ(guide.goal(in), "Bring the tip into the subacromial bursa");
  in.target_is_bone = true;
  EXPECT_EQ(guide.goal(in), "Touch this bone with the tip: subacromial bursa");
  in.target_is_bone = false;
  in.grab = Grab::probe;
  says("C chooses the entry");
  in.probe_lifted = true;
  says("off the skin");
  in.probe_lifted = false;
  in.grab = Grab::nothing;
  in.phase = GesturePhase::inserting;
  says("N takes the needle");
  in.grab = Grab::needle;
  says("pushes the needle in");
  in.needle.inside = true;
  in.needle.in_plane = false;
  says("not in the picture's plane");
  in.needle.plane_offset = -9e-3;
  says("9 mm beside the picture: P takes the probe");
  in.needle.plane_offset = 0;
  in.needle.in_plane = true;
  in.needle.to_target = 12e-3;
  says("12 mm to go");
  in.needle.on_bone = true;
  says("Bone");
  in.needle.on_bone = false;
  in.needle.region = 7;
  says("F freezes");
  in.frozen = true;
  says("F goes on");
  in.frozen = false;
  EXPECT_TRUE(guide.reached());
  in.needle.region = 3;
  says("S pulls the needle out");
  in.needle.inside = false;
  says("R starts again");
  in.peer = PeerState::lost;
  says("does not answer");
  in.peer = PeerState::absent;
  in.connect = "plug it in";
  says("plug it in");
}

TEST(SurfaceDetail, ADecimatedSphereStaysNearItAndGetsSmaller) {
  Surface sphere;
  constexpr std::uint32_t kRows = 60;
  for (std::uint32_t i = 0; i < kRows; ++i) {
    for (std::uint32_t j = 0; j < kRows; ++j) {
      const double a = M_PI * i / (kRows - 1);
      const double b = 2 * M_PI * j / kRows;
      sphere.points.emplace_back(Eigen::Vector3d(0.02 * std::sin(a) * std::cos(b),
                                                 0.02 * std::sin(a) * std::sin(b),
                                                 0.02 * std::cos(a))
                                     .cast<float>());
      const std::uint32_t next = (j + 1) % kRows;
      if (i + 1 < kRows)
        sphere.indices.insert(sphere.indices.end(),
                              {i * kRows + j, i * kRows + next, (i + 1) * kRows + j,
                               i * kRows + next, (i + 1) * kRows + next, (i + 1) * kRows + j});
    }
  }
  EXPECT_EQ(decimated(sphere, 0).indices.size(), sphere.indices.size());
  const Surface coarse = decimated(sphere, 3.2e-3);
  EXPECT_LT(coarse.indices.size(), sphere.indices.size() / 4);
  EXPECT_GT(coarse.indices.size(), 300U);
  for (const auto& p : coarse.points) EXPECT_NEAR(p.norm(), 0.02, 1.6e-3);
}

TEST(SurfaceDetail, TheSidesOfAThinLayerStayApartAndSharedEdgesStayTogether) {
  const auto scene = test::make_layered_scene();
  std::map<RegionId, std::vector<Sheet>> of;
  for (Sheet& sheet : find_sheets(scene->joint())) {
    EXPECT_NE(sheet.front, sheet.back);
    EXPECT_EQ(sheet.surface.labels.size(), sheet.surface.points.size());
    for (const RegionId r : {sheet.front, sheet.back}) of[r].push_back(sheet);
  }
  std::size_t triangles = 0;
  const std::vector<Sheet> all = find_sheets(scene->joint());
  for (const Sheet& sheet : all) triangles += sheet.surface.indices.size() / 3;
  EXPECT_EQ(triangles, scene->joint().mesh.interfaces.size()) << "each is drawn once";
  // Two flat sheets 1 mm apart in cubes of 3.2 mm.
  Surface thin;
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i < 100; ++i) {
      thin.points.emplace_back(1e-3F * static_cast<float>(i % 10),
                               1e-3F * static_cast<float>(i / 10),
                               1e-3F * static_cast<float>(side) + 1e-4F);
      thin.labels.push_back(static_cast<std::uint64_t>(side));
    }
  }
  thin.indices = {0, 9, 90, 100, 109, 190};
  const Surface apart = decimated(thin, 3.2e-3);
  for (const auto& p : apart.points)
    EXPECT_LT(std::min(std::abs(p.z() - 1e-4F), std::abs(p.z() - 1.1e-3F)), 1e-6F);
  thin.labels.clear();
  EXPECT_LT(decimated(thin, 3.2e-3).points.size(), apart.points.size()) << "they would melt";
}

TEST(SurfaceDetail, DetailFollowsTheMeasuredTime) {
  DetailChooser chooser(25e-3, 0);
  for (int i = 0; i < 100; ++i) chooser.note(10e-3);
  EXPECT_EQ(chooser.level(), 0U);
  for (int i = 0; i < 2; ++i) chooser.note(300e-3);
  EXPECT_EQ(chooser.level(), 1U);
  for (int i = 0; i < 2; ++i) chooser.note(60e-3);
  EXPECT_EQ(chooser.level(), 2U);
  for (int i = 0; i < 40; ++i) chooser.note(5e-3);
  EXPECT_EQ(chooser.level(), 1U) << "60 ms were a busy machine";
  for (int i = 0; i < 100; ++i) chooser.note(5e-3);
  EXPECT_EQ(chooser.level(), 1U) << "300 ms were the surface's";
}

}  // namespace
}  // namespace artus
