// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/fields.h"

#include <vector>

#include <gtest/gtest.h>

namespace artus {
namespace {

struct Inner {
  double a = 1;
  int b = 2;
};
ARTUS_FIELDS(Inner, a, b);

struct Outer {
  bool flag = false;
  Inner inner;
};
ARTUS_FIELDS(Outer, flag, inner);

TEST(VisitFields, GoesThroughTheMembersOfMembersInOrderWithDottedNames) {
  const Outer outer;
  std::vector<std::string> names;
  visit_fields(outer, [&names](const std::string& name, const auto&) { names.push_back(name); });
  EXPECT_EQ(names, (std::vector<std::string>{"flag", "inner.a", "inner.b"}));
}

TEST(VisitFields, GivesReferencesThatCanBeWritten) {
  Outer outer;
  visit_fields(outer, [](const std::string&, auto& member) {
    member = static_cast<std::remove_reference_t<decltype(member)>>(7);
  });
  EXPECT_TRUE(outer.flag);
  EXPECT_EQ(outer.inner.a, 7);
  EXPECT_EQ(outer.inner.b, 7);
}

static_assert(HasFields<Outer> && HasFields<const Inner> && !HasFields<double>);

}  // namespace
}  // namespace artus
