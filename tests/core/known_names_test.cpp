// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/known_names.h"

#include <array>

#include <gtest/gtest.h>

namespace artus {
namespace {

constexpr std::array<std::string_view, 3> kNames{"muscle", "bone", "tendon"};

TEST(KnownNames, GivesThePlaceOfAName) {
  EXPECT_EQ(find_name(kNames, "bone", "tissue").value(), 1U);
}

TEST(KnownNames, ARefusalTellsWhatThereIsAndTheNearest) {
  const auto refused = find_name(kNames, "muscel", "tissue", "--tissue");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::not_found);
  EXPECT_EQ(refused.error().to_string(),
            "--tissue: no tissue \"muscel\"; there are muscle, bone, tendon (did you mean "
            "'muscle'?)");
}

TEST(KnownNames, ANameIsNoPartOfAnother) {
  EXPECT_FALSE(find_name(kNames, "bon", "tissue"));
  EXPECT_FALSE(find_name(kNames, "", "tissue"));
}

TEST(KnownNames, OfItemsComeInTheirOrder) {
  struct Item {
    std::string name;
  };
  const std::array<Item, 2> items{Item{"b"}, Item{"a"}};
  EXPECT_EQ(listed(item_names(items)), "b, a");
}

TEST(DidYouMean, KeepsQuietWhenNothingIsNear) {
  EXPECT_EQ(did_you_mean("muscl", kNames), " (did you mean 'muscle'?)");
  EXPECT_EQ(did_you_mean("zzz", kNames), "");
}

}  // namespace
}  // namespace artus
