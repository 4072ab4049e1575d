// SPDX-License-Identifier: AGPL-3.0-or-later
// A tracker's Reference in the joint, from landmarks that were touched.
#include <limits>
#include <optional>
#include <string>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/exchange/landmark_registration.h"
#include "artus/detail/exchange/touched_landmarks.h"

namespace artus {
namespace {

using testing::HasSubstr;

Pose turned_pose() {
  return make_pose(Vec3(0.04, -0.02, 0.1), Vec3(0.3, -0.5, 0.8), Vec3(1, 0.2, 0));
}

CompiledJoint joint_with_landmarks() {
  CompiledJoint joint;
  joint.landmarks = {{"acromion", Vec3(0, 0, 0)},
                     {"coracoid", Vec3(0.05, 0.01, 0)},
                     {"tubercle", Vec3(0.02, 0.06, 0.01)},
                     {"groove", Vec3(0.01, 0.02, 0.05)}};
  return joint;
}

std::vector<LandmarkPair> touched(const CompiledJoint& joint, const Pose& X_JR) {
  std::vector<LandmarkPair> pairs;
  for (const Landmark& landmark : joint.landmarks)
    pairs.push_back({landmark.name, landmark.position, X_JR.inverse() * landmark.position});
  return pairs;
}

TEST(Registration, FindsTheMotionThatExactPointsHave) {
  const auto fit = register_landmarks(touched(joint_with_landmarks(), turned_pose()), 1e-3);
  ASSERT_TRUE(fit) << fit.error().to_string();
  EXPECT_TRUE(fit->X_JR.isApprox(turned_pose(), 1e-9));
  EXPECT_LT(fit->rms, 1e-12);
}

TEST(Registration, PrintsTheResidualsWhenTwoLandmarksWereSwapped) {
  auto pairs = touched(joint_with_landmarks(), turned_pose());
  std::swap(pairs[0].p_R, pairs[1].p_R);
  const auto fit = register_landmarks(pairs, 5e-3);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("the limit is 5.00 mm"));
  EXPECT_THAT(fit.error().message, HasSubstr("groove "));
}

TEST(Registration, ResidualsAreThoseOfOnePointThatWasTouchedBeside) {
  auto pairs = touched(joint_with_landmarks(), turned_pose());
  pairs[3].p_R += Vec3(0, 0, 2e-3);
  const auto fit = register_landmarks(pairs, 5e-3);
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->rms, 0.1e-3);
  EXPECT_LT(fit->rms, 1e-3);  // 2 mm over four points at most, and the fit takes its share
}

TEST(Registration, RefusesTwoPointsAndALine) {
  auto pairs = touched(joint_with_landmarks(), turned_pose());
  pairs.resize(2);
  EXPECT_FALSE(register_landmarks(pairs, 1));
  CompiledJoint line;
  line.landmarks = {{"a", Vec3(0, 0, 0)}, {"b", Vec3(0.05, 0, 0)}, {"c", Vec3(0.09, 0.001, 0)}};
  const auto fit = register_landmarks(touched(line, turned_pose()), 1);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("on one line"));
}

TEST(Registration, ATouchCountsWhereTheTipRests) {
  constexpr std::int64_t kStep = 20'000'000;  // ns
  const CompiledJoint joint = joint_with_landmarks();
  const Pose X_JR = turned_pose();
  TouchedLandmarks landmarks(joint.landmarks, 1e-3);
  std::int64_t now = 0;
  EXPECT_FALSE(landmarks.touch(0));
  const auto hold = [&](const Vec3& p_J, double trembling, int looks) {
    for (int k = 0; k < looks; ++k) {
      Pose X_RN = Pose::Identity();
      X_RN.translation() = X_JR.inverse() * p_J + Vec3(k % 2 == 0 ? trembling : -trembling, 0, 0);
      landmarks.see(now += kStep, X_RN);
    }
  };
  for (std::size_t k = 0; k < joint.landmarks.size(); ++k) {
    hold(joint.landmarks[k].position, 0.5e-3, 10);
    EXPECT_FALSE(landmarks.touch(k)) << "a fifth of a second at the new place";
    hold(joint.landmarks[k].position, 2e-3, 30);
    EXPECT_EQ(landmarks.tip().rest, TipRest::moving);
    EXPECT_FALSE(landmarks.touch(k));
    hold(joint.landmarks[k].position, 0.5e-3, 40);
    EXPECT_TRUE(landmarks.touch(k));
    EXPECT_EQ(landmarks.n_touched(), k + 1);
  }
  const auto fit = landmarks.fit();
  ASSERT_TRUE(fit) << fit.error().to_string();
  EXPECT_TRUE(fit->X_JR.isApprox(X_JR, 1e-3));
  EXPECT_LT(fit->rms, 0.1e-3);
  landmarks.see(now += kStep, std::nullopt);
  EXPECT_EQ(landmarks.tip().rest, TipRest::unseen);
}

TEST(Registration, SaysThatPointsAreInAnotherUnit) {
  const auto refusal = [](double scale) {
    auto pairs = touched(joint_with_landmarks(), turned_pose());
    for (LandmarkPair& pair : pairs) pair.p_R *= scale;
    const auto fit = register_landmarks(pairs, 1e3);
    return fit ? std::string() : fit.error().message;
  };
  EXPECT_THAT(refusal(1e-3), HasSubstr("look like metres"));
  EXPECT_THAT(refusal(0.1), HasSubstr("look like centimetres"));
  EXPECT_EQ(refusal(1), "");
  EXPECT_EQ(refusal(1.1), "") << "a joint of another size is the residuals' affair";
}

TEST(Registration, ReadsPairsByTheJointsNames) {
  const CompiledJoint joint = joint_with_landmarks();
  const auto pairs = parse_landmark_pairs(
      "landmark,x_mm,y_mm,z_mm\nacromion, 1, 2.5,-3\r\n\ngroove,0,0,7\n", "pairs.csv", joint);
  ASSERT_TRUE(pairs) << pairs.error().to_string();
  ASSERT_EQ(pairs->size(), 2U);
  EXPECT_TRUE((*pairs)[0].p_R.isApprox(Vec3(1e-3, 2.5e-3, -3e-3)));
  EXPECT_EQ((*pairs)[1].p_J, joint.landmarks[3].position);
  const auto refusal = [&](const char* text) {
    const auto bad = parse_landmark_pairs(text, "pairs.csv", joint);
    return bad ? std::string() : bad.error().to_string();
  };
  EXPECT_THAT(refusal("patella,1,2,3\n"), HasSubstr("pairs.csv:1"));
  EXPECT_THAT(refusal("patella,1,2,3\n"), HasSubstr("acromion, coracoid"));
  EXPECT_THAT(refusal("\nacromion,1,2\n"), HasSubstr("pairs.csv:2"));
  EXPECT_THAT(refusal("acromion,1,2,nan\n"), HasSubstr("not a finite number"));
  EXPECT_THAT(refusal("acromion,1,2,3\nacromion,1,2,3\n"), HasSubstr("twice"));
}

}  // namespace
}  // namespace artus
