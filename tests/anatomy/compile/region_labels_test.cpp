// SPDX-License-Identifier: AGPL-3.0-or-later
// Who owns a point where balls overlap, against the closed form.
#include "artus/detail/anatomy/compile/labels/region_labels.h"

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

constexpr RegionId kFirst = kFirstRegion + 1;
constexpr RegionId kSecond = kFirstRegion + 2;

DistanceField ball(const Vec3& centre, double radius) {
  const FieldSampling sampling{{Vec3::Constant(-0.04), Vec3::Constant(0.04)}, 0.5e-3, 2.5e-3};
  return DistanceField::compute([=](const Vec3& p) { return (p - centre).norm() - radius; },
                                sampling);
}

const Vec3 kApart(0.008, 0, 0);

/// A body of 30 mm and two balls of 12 mm that overlap; the first wins. Meshed within 35 mm of a
/// point, so that a part of the body is beyond.
RegionLabels make_labels() {
  RegionLabels labels;
  labels.body = ball(Vec3::Zero(), 0.03);
  labels.layers.push_back({kFirst, ball(-kApart, 0.012)});
  labels.layers.push_back({kSecond, ball(kApart, 0.012)});
  labels.region_of_interest = RegionOfInterest{Vec3(-0.015, 0, 0), 0.035, std::nullopt};
  return labels;
}

RegionId expected(const Vec3& p) {
  if (p.norm() >= 0.03) return kOutside;
  if ((p + Vec3(0.015, 0, 0)).norm() >= 0.035) return kBeyond;
  if ((p + kApart).norm() < 0.012) return kFirst;
  return (p - kApart).norm() < 0.012 ? kSecond : kFirstRegion;
}

/// The distance to the nearest of all surfaces, where a sampled field may be wrong.
double doubt(const Vec3& p) {
  return std::min({std::abs(p.norm() - 0.03), std::abs((p + Vec3(0.015, 0, 0)).norm() - 0.035),
                   std::abs((p + kApart).norm() - 0.012), std::abs((p - kApart).norm() - 0.012)});
}

Vec3 random_point(std::uint64_t i) {
  return 0.07 *
         (Vec3(uniform_noise(5, 3 * i), uniform_noise(5, 3 * i + 1), uniform_noise(5, 3 * i + 2)) -
          Vec3::Constant(0.5));
}

TEST(RegionLabels, TheFirstLayerWinsTheFillerTakesTheRest) {
  const RegionLabels labels = make_labels();
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const Vec3 p = random_point(i);
    if (doubt(p) < 0.05e-3) continue;
    ASSERT_EQ(labels.at(p), expected(p)) << p.transpose();
  }
}

TEST(RegionLabels, AnswersAreTheSameWithTheIndex) {
  const RegionLabels plain = make_labels();
  RegionLabels indexed = make_labels();
  indexed.make_index({Vec3::Constant(-0.025), Vec3::Constant(0.03)});
  ASSERT_GT(indexed.index.edge, 0);
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const Vec3 p = random_point(i);
    ASSERT_EQ(indexed.at(p), plain.at(p)) << p.transpose();
  }
}

TEST(RegionLabels, TheSeparationIsNegativeInTheOneThatComesFirst) {
  const RegionLabels labels = make_labels();
  const Vec3 in_first = -kApart;
  EXPECT_LT(labels.separation(kFirst, kSecond, in_first), 0);
  EXPECT_LT(labels.separation(kSecond, kFirst, in_first), 0) << "in whichever order they are named";
  EXPECT_GT(labels.separation(kFirst, kSecond, kApart + Vec3(0.006, 0, 0)), 0);
  EXPECT_LT(labels.separation(kOutside, kFirstRegion, Vec3::Zero()), 0) << "the body's";
  EXPECT_NEAR(labels.separation(kBeyond, kFirstRegion, Vec3(0.01, 0, 0)), -0.01, 1e-12)
      << "the region of interest's, exact";
}

TEST(RegionLabels, FindsALayerByItsRegion) {
  const RegionLabels labels = make_labels();
  EXPECT_EQ(labels.layer_of(kSecond), &labels.layers[1]);
  EXPECT_EQ(labels.layer_of(kFirstRegion), nullptr);
}

TEST(SignedDistance, OfABoxAndABallOfInterestIsExact) {
  const RegionOfInterest sphere{Vec3(1, 0, 0), 0.5, std::nullopt};
  EXPECT_DOUBLE_EQ(signed_distance(sphere, Vec3(1, 0, 0)), -0.5);
  EXPECT_DOUBLE_EQ(signed_distance(sphere, Vec3(3, 0, 0)), 1.5);
  const RegionOfInterest box{Vec3::Zero(), 0, Vec3(1, 2, 3)};
  EXPECT_DOUBLE_EQ(signed_distance(box, Vec3::Zero()), -1) << "to the nearest side";
  EXPECT_DOUBLE_EQ(signed_distance(box, Vec3(1, 1, 1)), 0);
  EXPECT_DOUBLE_EQ(signed_distance(box, Vec3(4, 6, 3)), 5) << "to the nearest edge";
}

/// Two balls that touch but for a film of 0.1 mm, in one partition of 0.2 mm.
RegionLabels with_film(double film) {
  RegionLabels labels;
  labels.body = ball(Vec3::Zero(), 0.03);
  labels.layers.push_back({kFirst, ball(-kApart, 0.00795), film > 0 ? 1U : 0U, film});
  labels.layers.push_back({kSecond, ball(kApart, 0.00795), film > 0 ? 1U : 0U, film});
  return labels;
}

TEST(RegionLabels, AFilmBetweenMembersOfAPartitionBelongsToTheNearer) {
  RegionLabels labels = with_film(0.2e-3);
  labels.make_index({Vec3::Constant(-0.035), Vec3::Constant(0.035)});
  EXPECT_EQ(with_film(0).at(Vec3(0.02e-3, 0, 0)), kFirstRegion);
  EXPECT_EQ(labels.at(Vec3(0.02e-3, 0, 0)), kSecond);
  EXPECT_EQ(labels.at(Vec3(-0.02e-3, 0, 0)), kFirst);
  EXPECT_EQ(labels.at(Vec3(0, 2e-3, 0)), kFirstRegion);  // 0.6 mm apart there
  EXPECT_EQ(labels.at(Vec3(0.02e-3, 0, 0)), labels.at_film(Vec3(0.02e-3, 0, 0)));
}

TEST(RegionLabels, TheIndexKnowsFilmsToo) {
  const RegionLabels plain = with_film(0.2e-3);
  RegionLabels indexed = with_film(0.2e-3);
  indexed.make_index({Vec3::Constant(-0.035), Vec3::Constant(0.035)});
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const Vec3 p = 0.2 * random_point(i);
    ASSERT_EQ(indexed.at(p), plain.at(p)) << p.transpose();
  }
}

TEST(RegionLabels, PartitionsAreNumberedInTheOrderOfTheFile) {
  JointFile file;
  file.partitions = {{"a", 1e-3}, {"b", 2e-3}};
  Structure s;
  EXPECT_EQ(partition_of(file, s).first, 0U);
  s.partition = "b";
  EXPECT_EQ(partition_of(file, s), (std::pair<std::size_t, double>{2, 2e-3}));
}

}  // namespace
}  // namespace artus
