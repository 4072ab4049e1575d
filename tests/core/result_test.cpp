// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/core/result.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

TEST(Result, FailureCarriesCodeMessageAndPlace) {
  const Result<int> r = fail(ErrorCode::malformed, "no colon", "joint.toml:3");
  ASSERT_FALSE(r.has_value());
  EXPECT_EQ(r.error().code, ErrorCode::malformed);
  EXPECT_EQ(r.error().to_string(), "joint.toml:3: no colon");
}

TEST(Result, FailureWithoutPlacePrintsTheMessageAlone) {
  EXPECT_EQ((Error{ErrorCode::failed, "gave up", ""}).to_string(), "gave up");
}

TEST(Result, EveryCodeHasItsOwnName) {
  std::set<std::string> names;
  for (int c = 0; c <= static_cast<int>(ErrorCode::failed); ++c)
    names.insert(to_string(static_cast<ErrorCode>(c)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(ErrorCode::failed) + 1);
}

TEST(Check, RequireThrowsWithTheFunctionAndTheReason) {
  const auto border = [](int n) {
    ARTUS_REQUIRE(n > 0, "n must be positive");
  };
  EXPECT_NO_THROW(border(1));
  EXPECT_THROW(border(0), std::invalid_argument);
}

}  // namespace
}  // namespace artus
