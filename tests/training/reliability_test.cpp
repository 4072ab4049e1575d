// SPDX-License-Identifier: AGPL-3.0-or-later
// Reliability by closed forms and by the table of a published example.
#include "artus/detail/training/reliability.h"

#include <array>
#include <random>

#include <gtest/gtest.h>

namespace artus {
namespace {

/// The example of [Shrout1979], table 1: six targets by four judges.
Eigen::MatrixXd published() {
  Eigen::MatrixXd m(6, 4);
  m << 9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8, 7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7;
  return m;
}

TEST(Reliability, IsThatOfThePublishedExample) {
  const VarianceParts parts = split_variance(published());
  EXPECT_NEAR(parts.absolute(1), 0.29, 0.005);  // ICC(2,1)
  EXPECT_NEAR(parts.relative(1), 0.71, 0.006);  // ICC(3,1)
  EXPECT_NEAR(parts.absolute(4), 0.62, 0.005);  // ICC(2,4)
  EXPECT_NEAR(parts.relative(4), 0.91, 0.005);  // ICC(3,4)
}

TEST(Reliability, AlphaIsTheRelativeCoefficientOfAllItems) {
  EXPECT_NEAR(cronbach_alpha(published()), split_variance(published()).relative(4), 1e-12);
  Eigen::MatrixXd same(3, 2);
  same << 1, 1, 2, 2, 5, 5;
  EXPECT_NEAR(cronbach_alpha(same), 1, 1e-12);
}

TEST(Reliability, PartsComeBackFromWhatTheyWereDrawnWith) {
  std::mt19937 random(7);
  std::normal_distribution<double> person(0, 3);
  std::normal_distribution<double> condition(0, 2);
  std::normal_distribution<double> rest(0, 1);
  Eigen::MatrixXd m(400, 60);
  Eigen::RowVectorXd c(60);
  for (Eigen::Index j = 0; j < c.size(); ++j) c[j] = condition(random);
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    const double p = person(random);
    for (Eigen::Index j = 0; j < m.cols(); ++j) m(i, j) = p + c[j] + rest(random);
  }
  const VarianceParts parts = split_variance(m);
  EXPECT_NEAR(parts.person, 9, 2);       // three standard errors of 400 persons
  EXPECT_NEAR(parts.condition, 4, 2.2);  // of 60
  EXPECT_NEAR(parts.rest, 1, 0.05);
}

TEST(Reliability, AsManyConditionsAsItTakesReachWhatIsWanted) {
  const VarianceParts parts = split_variance(published());
  const int n = parts.conditions_for(0.8);
  EXPECT_GE(parts.absolute(n), 0.8);
  EXPECT_LT(parts.absolute(n - 1), 0.8);
  Eigen::MatrixXd alike(2, 2);
  alike << 1, 2, 1, 2;
  EXPECT_EQ(split_variance(alike).conditions_for(0.8), 0);
}

TEST(Reliability, ACutBetweenGroupsThatAreApartIsInTheMiddleAndErrsNowhere) {
  const std::array<double, 3> experts{80, 90, 100};
  const std::array<double, 3> novices{10, 20, 40};
  const GroupCut cut = find_group_cut(experts, novices);
  EXPECT_EQ(cut.cut, 60);
  EXPECT_EQ(cut.experts_fail, 0);
  EXPECT_EQ(cut.novices_pass, 0);
}

TEST(Reliability, ACutBetweenGroupsThatOverlapErrsLeast) {
  const std::array<double, 4> experts{50, 80, 90, 100};
  const std::array<double, 4> novices{10, 20, 40, 85};
  const GroupCut cut = find_group_cut(experts, novices);
  EXPECT_DOUBLE_EQ(cut.cut, 45);
  EXPECT_EQ(cut.experts_fail, 0);
  EXPECT_EQ(cut.novices_pass, 0.25);
}

}  // namespace
}  // namespace artus
