// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/session_options.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/haptics/plunger/needle_flow.h"
#include "tests/apps/run_tool.h"

namespace artus {
namespace {

class SessionGauge : public ::testing::TestWithParam<int> {};

TEST_P(SessionGauge, IsThatOfThePictureAndOfTheFlow) {
  SessionOptions options;
  options.joint.joint = test::kSimple;
  options.gauge = GetParam();
  const auto joint = load(options.joint, {});
  ASSERT_TRUE(joint) << joint.error().to_string();
  const auto params = make_session_params(options, **joint);
  ASSERT_TRUE(params) << params.error().to_string();
  EXPECT_EQ(params->syringe.gauge, GetParam());
  const auto bore = bore_of_gauge(GetParam(), needle_length_of(*params));
  ASSERT_TRUE(bore);
  EXPECT_DOUBLE_EQ(params->needle_shape.bore, bore->diameter);
  // Two catalogues that round differently.
  EXPECT_LT(std::abs(params->needle_shape.outer_diameter - bore->outer_diameter), 2.5e-6);
}

INSTANTIATE_TEST_SUITE_P(Gauges, SessionGauge, ::testing::Values(18, 19, 20, 21, 22, 23, 25, 27));

TEST(SessionOptions, AGaugeThatThereIsNotIsRefusedWithItsFlag) {
  SessionOptions options;
  options.joint.joint = test::kSimple;
  const auto joint = load(options.joint, {});
  ASSERT_TRUE(joint) << joint.error().to_string();
  for (const int gauge : {0, -22, 24, 26}) {
    options.gauge = gauge;
    const auto params = make_session_params(options, **joint);
    ASSERT_FALSE(params) << gauge;
    EXPECT_EQ(params.error().code, ErrorCode::invalid);
    EXPECT_EQ(params.error().where, "--gauge");
  }
}

}  // namespace
}  // namespace artus
