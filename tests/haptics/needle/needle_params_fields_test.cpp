// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/needle_params_fields.h"

#include <cstddef>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "artus/detail/haptics/guard_fields.h"
#include "artus/detail/haptics/probe/probe_contact_fields.h"
#include "artus/haptics/needle_feel.h"

namespace artus {
namespace {

template <class P>
class ParameterFields : public ::testing::Test {};
using All = ::testing::Types<NeedleParams, GuardParams, PassivityParams, ProbeContactParams,
                             PatientProfile>;
TYPED_TEST_SUITE(ParameterFields, All);

// From one field to the next there is never room for another.
TYPED_TEST(ParameterFields, FillTheStructInOrderUnderDifferentNames) {
  TypeParam params;
  const auto* const begin = reinterpret_cast<const std::byte*>(&params);
  std::ptrdiff_t end = 0;
  std::set<std::string> names;
  visit_fields(params, [&](const std::string& name, const auto& member) {
    const std::ptrdiff_t at = reinterpret_cast<const std::byte*>(&member) - begin;
    EXPECT_GE(at, end) << name;
    EXPECT_LT(at - end, std::ptrdiff_t{8}) << "a field before " << name << " is not visited";
    end = at + static_cast<std::ptrdiff_t>(sizeof member);
    EXPECT_TRUE(names.insert(name).second) << name;
  });
  EXPECT_LT(static_cast<std::ptrdiff_t>(sizeof params) - end, std::ptrdiff_t{8});
}

TEST(ParameterFields, NamesJoinTheStructsByDots) {
  NeedleParams params;
  bool found = false;
  visit_fields(params, [&](const std::string& name, auto& member) {
    if (name != "contact.motion.moving_band") return;
    if constexpr (std::is_same_v<std::remove_reference_t<decltype(member)>, double>) member = 7;
    found = true;
  });
  EXPECT_TRUE(found);
  EXPECT_EQ(params.contact.motion.moving_band, 7);
}

}  // namespace
}  // namespace artus
