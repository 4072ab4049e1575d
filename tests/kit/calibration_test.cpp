// SPDX-License-Identifier: AGPL-3.0-or-later
// Calibrations against truth: the error that is told covers the one that is made, and what cannot
// give a calibration is refused with what to do.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/devices/kit/board.h"
#include "artus/detail/devices/kit/camera_calibration.h"
#include "artus/detail/devices/kit/kit_file.h"
#include "artus/detail/devices/kit/marker_fit.h"
#include "artus/detail/devices/kit/tip_calibration.h"
#include "tests/kit/scenes.h"

namespace artus::kit {
namespace {

using Random = std::mt19937_64;

Pose shaken(const Pose& X, double metres, double radians, Random& random) {
  std::normal_distribution<double> one(0, 1);
  const Vec3 axis = Vec3(one(random), one(random), one(random)).normalized();
  Pose out = X;
  out.linear() = Eigen::AngleAxisd(radians * one(random), axis) * X.linear();
  out.translation() += metres * Vec3(one(random), one(random), one(random));
  return out;
}

/// Poses of a syringe whose tip is at `tip_B` and rests at `pivot`, leaning by up to `cone`;
/// `slip`: m that the tip wanders off on one side.
std::vector<Pose> cone_of(const Vec3& tip_B, const Vec3& pivot, double cone, double slip,
                          Random& random) {
  std::vector<Pose> poses;
  for (int k = 0; k < 200; ++k) {
    const double lean = cone * std::sin(0.11 * k);
    const double round = 0.37 * k;
    const Vec3 axis(std::cos(round), std::sin(round), 0);
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(lean, axis) *
                 Eigen::AngleAxisd(std::acos(-1), Vec3::UnitX()).toRotationMatrix();
    const Vec3 slipped = pivot + slip * Vec3(lean > 0 ? 1 : 0, 0, 0);
    X.translation() = slipped - X.linear() * tip_B;
    X = shaken(X, 0.1e-3, 0.15 * kDegree, random);
    poses.push_back(X);
  }
  return poses;
}

TEST(KitTip, TheToldErrorCoversTheTruthAlsoWhereTheTipSlips) {
  Random random(5);
  const Vec3 pivot(0.03, -0.01, 0.0);
  int covered = 0;
  int fits = 0;
  for (int k = 0; k < 60; ++k) {
    const Vec3 tip = nominal_needle().translation() + Vec3(1e-3, -2e-3, 3e-3);
    const auto fit = fit_tip(cone_of(tip, pivot, 0.6, k % 3 == 0 ? 0.8e-3 : 0, random));
    ASSERT_TRUE(fit) << fit.error().to_string();
    ++fits;
    covered += fit->error >= (fit->tip_B - tip).norm() ? 1 : 0;
    const double most = k % 3 == 0 ? 3e-3 : 0.4e-3;
    EXPECT_LT((fit->tip_B - tip).norm(), most);
  }
  EXPECT_GE(covered, 0.9 * fits);
}

TEST(KitTip, ANarrowConeIsRefusedAndPitsThatAreElsewhereAreTold) {
  Random random(6);
  const Vec3 tip = nominal_needle().translation();
  const auto narrow = fit_tip(cone_of(tip, Vec3::Zero(), 0.15, 0, random));
  ASSERT_FALSE(narrow);
  EXPECT_NE(narrow.error().message.find("too narrow"), std::string::npos);
  EXPECT_FALSE(fit_tip({}));
  const auto fit = fit_tip(cone_of(tip, Vec3::Zero(), 0.6, 0, random));
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->condition, 12);
  const auto rest = [&](double x) {
    return cone_of(tip, Vec3(x, 0, 0), 0.1, 0, random);
  };
  const auto good = with_divots(*fit, {rest(-0.030), rest(0.030)});
  ASSERT_TRUE(good);
  EXPECT_NEAR(good->error, fit->error, 0.3e-3);
  const auto scaled = with_divots(*fit, {rest(-0.031), rest(0.031)});
  ASSERT_TRUE(scaled);
  EXPECT_GT(scaled->error, 1.8e-3) << "a scale that is off by 3 % is told";
  EXPECT_FALSE(with_divots(*fit, {rest(-0.04), rest(0.04)}));
}

TEST(KitTip, TheAxisIsFoundByRolling) {
  Random random(7);
  const Vec3 axis = Vec3(0.03, -0.02, 1).normalized();
  std::vector<Pose> poses;
  for (int k = 0; k < 90; ++k) {
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(0.5, Vec3(1, 0.2, 0).normalized()) *
                 Eigen::AngleAxisd(0.8 * std::sin(0.1 * k), axis).toRotationMatrix();
    poses.push_back(shaken(X, 0, 0.2 * kDegree, random));
  }
  const auto found = fit_axis(poses, Vec3::UnitZ());
  ASSERT_TRUE(found) << found.error().to_string();
  EXPECT_LT(std::acos(std::min(1.0, found->dot(axis))), 0.6 * kDegree);
  EXPECT_FALSE(fit_axis({poses.begin(), poses.begin() + 3}, Vec3::UnitZ()));
}

TEST(KitFace, ThreeTouchedMarksGiveTheFaceAndWrongOnesAreRefused) {
  Random random(8);
  std::normal_distribution<double> noise(0, 0.3e-3);
  const Pose X_BP = shaken(nominal_face(Hand::left), 0.5e-3, 1 * kDegree, random);
  std::array<std::vector<Vec3>, 3> touches;
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 0; i < 30; ++i)
      touches[k].push_back(X_BP * Vec3((static_cast<double>(k) - 1) * kTouchSpan, 0, 0) +
                           Vec3(noise(random), noise(random), noise(random)));
  const auto fit = fit_face(touches, nominal_face(Hand::left), 0.3e-3);
  ASSERT_TRUE(fit) << fit.error().to_string();
  EXPECT_LT((fit->X_BP.translation() - X_BP.translation()).norm(), fit->error);
  EXPECT_LT(fit->error, 1e-3);
  EXPECT_LT(std::acos(fit->X_BP.linear().col(0).dot(X_BP.linear().col(0))), 1 * kDegree);
  std::swap(touches[0], touches[1]);
  EXPECT_FALSE(fit_face(touches, nominal_face(Hand::left), 0.3e-3));
}

TEST(KitMarkers, GluedMarkersAreFoundByTurningTheBody) {
  Random random(9);
  std::normal_distribution<double> noise(0, 0.08);
  const Lens lens;
  const MarkerBody drawn = make_syringe_body();
  MarkerBody glued = drawn;
  for (Marker& marker : glued.markers) {
    const Pose off = shaken(Pose::Identity(), 0.3e-3, 0.7 * kDegree, random);
    const Vec3 centre = marker.centre();
    for (Vec3& corner : marker.corners)
      corner = centre + off.linear() * (corner - centre) + off.translation();
  }
  std::vector<std::vector<SeenMarker>> pictures;
  for (int k = 0; k < 120; ++k) {
    Pose X_CB = Pose::Identity();
    X_CB.linear() = Eigen::AngleAxisd(0.9 * std::sin(0.21 * k), Vec3::UnitY()) *
                    Eigen::AngleAxisd(-1.57 + 0.5 * std::sin(0.13 * k), Vec3::UnitX()) *
                    Eigen::AngleAxisd(0.4 * std::sin(0.05 * k), Vec3::UnitZ()).toRotationMatrix();
    if ((X_CB.linear() * Vec3::UnitY()).z() > 0)
      X_CB.linear() = X_CB.linear() * Eigen::AngleAxisd(std::acos(-1), Vec3::UnitZ());
    X_CB.translation() = Vec3(0.05 * std::sin(0.3 * k), 0.03 * std::cos(0.2 * k), 0.5);
    std::vector<SeenMarker> seen;
    for (const Marker& marker : glued.markers) {
      const Vec3 centre = X_CB * marker.centre();
      if ((X_CB.linear() * marker.normal()).dot(centre.normalized()) > -0.3) continue;
      SeenMarker one{marker.id, {}};
      for (std::size_t i = 0; i < 4; ++i)
        one.corners[i] =
            lens.project(X_CB * marker.corners[i]) + Eigen::Vector2d(noise(random), noise(random));
      seen.push_back(one);
    }
    pictures.push_back(seen);
  }
  const auto fit = fit_markers(drawn, pictures, lens);
  ASSERT_TRUE(fit) << fit.error().to_string();
  EXPECT_GT(fit->before, 2 * fit->after);
  EXPECT_LT(fit->after, 0.12);
  // How markers stand to each other is what poses need; the body's frame is free.
  const auto apart = [](const MarkerBody& body) {
    std::vector<double> distances;
    for (const Marker& a : body.markers)
      for (const Marker& b : body.markers)
        distances.push_back((a.corners[0] - b.corners[2]).norm());
    return distances;
  };
  const auto truth = apart(glued);
  const auto before = apart(drawn);
  const auto after = apart(fit->body);
  double off_before = 0;
  double off_after = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    off_before += std::abs(before[i] - truth[i]);
    off_after += std::abs(after[i] - truth[i]);
  }
  EXPECT_LT(off_after, 0.35 * off_before);
  EXPECT_FALSE(fit_markers(drawn, {pictures.begin(), pictures.begin() + 10}, lens));
}

TEST(KitCamera, RenderedBoardsGiveTheLensWithinTheToldError) {
  Lens truth;
  truth.fx = truth.fy = 985;
  truth.cx = 651;
  truth.cy = 352;
  truth.distortion = {0.08, -0.12, 5e-4, -3e-4, 0};
  const test::ViewRenderer renderer(truth);
  test::ViewFlaws flaws;
  flaws.hidden = 0;
  CameraCalibration camera(truth.width, truth.height, 1);
  EXPECT_FALSE(camera.solve()) << "no picture";
  EXPECT_NE(camera.missing().find("tilt"), std::string::npos);
  Random random(4);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int k = 0; k < 24 && (camera.pictures() < 18 || !camera.missing().empty()); ++k) {
    const double tilt = k % 4 == 3 ? 0.1 : 0.5 + 0.2 * any(random);
    const double to = 1.1 * k;
    Pose X_CB = Pose::Identity();
    X_CB.linear() = Eigen::AngleAxisd(tilt, Vec3(std::cos(to), std::sin(to), 0)) *
                    Eigen::AngleAxisd(std::acos(-1), Vec3::UnitX()) *
                    Eigen::AngleAxisd(0.3 * any(random), Vec3::UnitZ()).toRotationMatrix();
    X_CB.translation() = Vec3(0.1 * any(random), 0.05 * any(random), 0.42 + 0.1 * any(random));
    const test::ShownBoard board{X_CB, kBoardColumns, kBoardRows, kBoardSquare};
    camera.take(renderer.render({{make_board(), X_CB, 0, {}}}, flaws, static_cast<std::uint64_t>(k),
                                &board));
  }
  const auto lens = camera.solve();
  ASSERT_TRUE(lens) << lens.error().to_string();
  const double off = std::abs(lens->fx - truth.fx) / truth.fx;
  std::printf("focal length off by %.3f %%, told %.3f %%, of %d pictures\n", 100 * off,
              100 * lens->focal_error, camera.pictures());
  EXPECT_LT(off, 0.005);
  EXPECT_LE(off, lens->focal_error);
}

TEST(KitFile, IsReadAsItWasWrittenAndFaultsAreToldAtOnce) {
  MeasuredKit kit = make_kit(Hand::left, 0.985, 40e-3);
  kit.has_camera = kit.has_tip = kit.has_face = kit.has_markers = true;
  kit.kit.lens.fx = 1012.25;
  kit.kit.lens.distortion = {0.1, -0.2, 1e-3, 0, 0};
  kit.kit.lens.focal_error = 0.003;
  kit.kit.X_BN.translation().z() = 92e-3;
  kit.kit.tip_error = 0.7e-3;
  kit.kit.probe.markers[2].corners[1].x() += 1e-3;
  const std::string text = to_toml(kit);
  const auto back = parse_kit(text, "hands.toml");
  ASSERT_TRUE(back) << back.error().to_string();
  EXPECT_EQ(to_toml(*back), text);
  EXPECT_EQ(back->kit.hand, Hand::left);
  EXPECT_NEAR(back->kit.sheet.markers[0].side, 0.985 * kSheetSide, 1e-12);
  EXPECT_NEAR((back->kit.X_BN.matrix() - kit.kit.X_BN.matrix()).norm(), 0, 1e-9);
  const auto bad = parse_kit("[print]\nhand = \"third\"\n[needle]\npoint_mm = [0, 0, 0]\n", "x");
  ASSERT_FALSE(bad);
  EXPECT_NE(bad.error().message.find("hand"), std::string::npos);
  EXPECT_NE(bad.error().message.find("error_mm"), std::string::npos);
}

}  // namespace
}  // namespace artus::kit
