// SPDX-License-Identifier: AGPL-3.0-or-later
// The kit's parts as they are drawn: markers on faces, solids that a printer can print, and poses
// from corners without a camera's flaws.
#include "artus/detail/devices/kit/body.h"

#include <gtest/gtest.h>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/devices/kit/body_pose.h"
#include "artus/detail/devices/kit/hand_state.h"
#include "artus/detail/devices/kit/lens.h"
#include "artus/detail/devices/kit/one_euro.h"
#include "artus/detail/devices/kit/solid.h"
#include "tests/kit/scenes.h"

namespace artus::kit {
namespace {

TEST(KitBody, APrismHasSixMarkersOnThreeFacesFortyDegreesApart) {
  for (const MarkerBody& body : {make_probe_body(), make_syringe_body()}) {
    ASSERT_EQ(body.markers.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
      const Marker& marker = body.markers[i];
      EXPECT_NEAR((marker.corners[1] - marker.corners[0]).norm(), marker.side, 1e-12);
      EXPECT_NEAR(marker.normal().dot(body.markers[(i + 3) % 6].normal()), 1, 1e-12);
    }
    EXPECT_NEAR(body.markers[0].normal().dot(body.markers[1].normal()), std::cos(kFaceTurn), 1e-12);
    EXPECT_NEAR(body.markers[1].normal().y(), 1, 1e-12);
  }
}

TEST(KitBody, TheSheetLooksUpAndMarkersScaleWithThePaper) {
  const MarkerBody sheet = make_sheet_body(0.97);
  for (const Marker& marker : sheet.markers) EXPECT_NEAR(marker.normal().z(), 1, 1e-12);
  EXPECT_NEAR(sheet.markers[0].side, 0.97 * kSheetSide, 1e-12);
  const Marker glued = make_probe_body(0.97).markers[0];
  EXPECT_NEAR((glued.centre() - make_probe_body().markers[0].centre()).norm(), 0, 1e-12)
      << "the printed body is not the paper's";
}

TEST(KitSolid, EveryPartIsClosedAndCanBePrinted) {
  DefectOptions options;
  options.largest = 1;
  for (const Hand hand : {Hand::right, Hand::left})
    for (const SurfaceMesh& mesh :
         {make_probe_mock(hand), make_plunger_flag(hand), make_syringe_clip(13.5e-3),
          make_syringe_clip(20e-3), make_divot_plate()}) {
      for (const Defect& defect : find_defects(mesh, options)) ADD_FAILURE() << defect.message;
      EXPECT_GT(signed_volume(mesh), 1e-6);
    }
}

TEST(KitSolid, PartsOfTheOtherHandAreMirrored) {
  EXPECT_NEAR(signed_volume(make_probe_mock(Hand::right)),
              signed_volume(make_probe_mock(Hand::left)), 1e-12);
  const Vec3 right = nominal_face(Hand::right).linear().col(0);
  const Vec3 left = nominal_face(Hand::left).linear().col(0);
  EXPECT_NEAR(right.x(), left.x(), 1e-12);
  EXPECT_NEAR(right.y(), -left.y(), 1e-12);
}

TEST(KitLens, APixelLooksWhereItsPointIs) {
  Lens lens;
  lens.distortion = {0.12, -0.2, 1e-3, -5e-4, 0.05};
  for (const Vec3& p : {Vec3(0.2, -0.1, 0.6), Vec3(-0.3, 0.15, 0.55), Vec3(0, 0, 1)}) {
    const Eigen::Vector2d back = lens.looks_at(lens.project(p));
    EXPECT_NEAR(back.x(), p.x() / p.z(), 1e-7);
    EXPECT_NEAR(back.y(), p.y() / p.z(), 1e-7);
  }
}

std::vector<SeenMarker> seen_by(const Lens& lens, const MarkerBody& body, const Pose& X_CB) {
  std::vector<SeenMarker> seen;
  for (const Marker& marker : body.markers) {
    if ((X_CB.linear() * marker.normal()).dot(X_CB * marker.centre()) >= 0) continue;
    SeenMarker one{marker.id, {}};
    for (std::size_t i = 0; i < 4; ++i) one.corners[i] = lens.project(X_CB * marker.corners[i]);
    seen.push_back(one);
  }
  return seen;
}

TEST(KitPose, OfExactCornersIsExactAndAWrongMarkerIsDropped) {
  const Lens lens;
  const MarkerBody body = make_syringe_body();
  std::mt19937_64 random(3);
  for (int k = 0; k < 20; ++k) {
    const auto scene = test::make_scene(random, 0.55, 0.02);
    const Pose X_CB = scene.X_SC.inverse() * scene.X_SN * nominal_needle().inverse();
    auto seen = seen_by(lens, body, X_CB);
    ASSERT_GE(seen.size(), 4U);
    const auto found = find_pose(body, seen, lens, nullptr);
    ASSERT_TRUE(found);
    EXPECT_LT((found->X_CB.matrix() - X_CB.matrix()).norm(), 1e-6);
    for (auto& corner : seen[1].corners) corner += Eigen::Vector2d(3, 1);
    const auto without = find_pose(body, seen, lens, nullptr);
    ASSERT_TRUE(without);
    EXPECT_EQ(without->n_dropped, 1);
    EXPECT_LT((without->X_CB.matrix() - X_CB.matrix()).norm(), 1e-6);
  }
}

TEST(KitPose, AFlatFaceFromTheFrontIsADoubtThatOnlyThePastSettles) {
  const Lens lens;
  MarkerBody flat = make_syringe_body();
  flat.markers = {flat.markers[1], flat.markers[4]};
  const Vec3 towards(0.02, -0.02, -1);
  Pose X_CB = Pose::Identity();
  X_CB.linear().col(1) = towards.normalized();
  X_CB.linear().col(0) = Vec3(1, 0, 0.02).normalized();
  X_CB.linear().col(2) = X_CB.linear().col(0).cross(X_CB.linear().col(1)).normalized();
  X_CB.linear().col(0) = X_CB.linear().col(1).cross(X_CB.linear().col(2));
  X_CB.linear() = X_CB.linear() * Eigen::AngleAxisd(0.22, Vec3::UnitX());
  X_CB.translation() = Vec3(0.01, 0, 0.7);
  auto seen = seen_by(lens, flat, X_CB);
  ASSERT_EQ(seen.size(), 2U);
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.15);
  int doubts = 0;
  for (int k = 0; k < 40; ++k) {
    auto noisy = seen;
    for (auto& one : noisy)
      for (auto& corner : one.corners) corner += Eigen::Vector2d(noise(random), noise(random));
    const auto alone = find_pose(flat, noisy, lens, nullptr);
    doubts += alone ? 0 : 1;
    const auto after = find_pose(flat, noisy, lens, &X_CB);
    ASSERT_TRUE(after);
    EXPECT_LT(Eigen::AngleAxisd(after->X_CB.linear().transpose() * X_CB.linear()).angle(), 0.2);
  }
  EXPECT_GT(doubts, 5);
}

TEST(KitFilter, RestIsQuietAndMotionLagsLittle) {
  PoseFilter filter({});
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.3e-3);
  double sum = 0;
  for (int k = 0; k < 300; ++k) {
    Pose raw = Pose::Identity();
    raw.translation() = Vec3(noise(random), noise(random), noise(random));
    const Pose out = filter.take(k / 30.0, raw, Vec3::Zero());
    if (k > 100) sum += out.translation().squaredNorm() / 3 / 199;
  }
  EXPECT_LT(std::sqrt(sum), 0.5 * 0.3e-3);
  double lag = 0;
  for (int k = 0; k < 90; ++k) {
    Pose raw = Pose::Identity();
    raw.translation().x() = 20e-3 * k / 30.0;
    const Pose out = filter.take(10 + k / 30.0, raw, Vec3::Zero());
    lag = (raw.translation() - out.translation()).x() / 20e-3;
  }
  EXPECT_LT(lag, 0.05) << "s at 20 mm/s";
  EXPECT_GT(lag, 0.01);
}

TEST(KitPresence, IsGoneAfterAWhileAndBackAfterThreeFramesThatAgree) {
  Presence presence(0.1);
  const Pose here = Pose::Identity();
  Pose away = here;
  away.translation().x() = 0.2;
  EXPECT_FALSE(presence.take(0.00, here));
  EXPECT_FALSE(presence.take(0.03, away)) << "does not agree";
  EXPECT_FALSE(presence.take(0.06, here));
  EXPECT_FALSE(presence.take(0.09, here));
  EXPECT_TRUE(presence.take(0.12, here));
  EXPECT_FALSE(presence.take(0.15, away)) << "one frame that leaps";
  EXPECT_TRUE(presence.take(0.18, here));
  EXPECT_FALSE(presence.take(0.21, std::nullopt));
  EXPECT_NE(presence.recent(0.24), nullptr);
  EXPECT_FALSE(presence.take(0.40, here)) << "it was gone";
}

}  // namespace
}  // namespace artus::kit
