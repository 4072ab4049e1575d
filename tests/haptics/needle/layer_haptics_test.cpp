// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/layer_haptics.h"

#include <set>

#include <gtest/gtest.h>

#include "artus/detail/haptics/needle/law_catalogue.h"
#include "artus/detail/haptics/needle/needle_params.h"
#include "tests/haptics/needle/tick_builder.h"

namespace artus {
namespace {

TEST(LayerTable, RegionsOutOfRangeFeelLikeNothing) {
  const LayerTable table = test::table_of({test::soft(2)});
  EXPECT_EQ(table[kFirstRegion].tissue.cutting_force, 2);
  for (const RegionId region : {kOutside, RegionId{3}, RegionId{65535}}) {
    EXPECT_EQ(table[region].tissue.cutting_force, 0) << region;
    EXPECT_EQ(table[region].tissue.clamping_stiffness, 0) << region;
  }
}

TEST(LawNames, ReadBackAsTheLawTheyName) {
  for (const CuttingLaw law :
       {CuttingLaw::tracking_wall, CuttingLaw::direct, CuttingLaw::spring, CuttingLaw::voigt})
    EXPECT_EQ(find_cutting_law(to_string(law)), law);
  for (const PrepunctureLaw law : {PrepunctureLaw::membrane, PrepunctureLaw::simone_okamura,
                                   PrepunctureLaw::barbe, PrepunctureLaw::god_object})
    EXPECT_EQ(find_prepuncture_law(to_string(law)), law);
  EXPECT_EQ(find_cutting_law("glue").error().code, ErrorCode::not_found);
}

TEST(LawCatalogue, EveryLawSaysWhatItIsAndWhereItIsFrom) {
  std::set<std::string> names;
  for (const LawDescription& law : describe_laws()) {
    EXPECT_FALSE(law.says.empty()) << law.name;
    EXPECT_FALSE(law.source.empty()) << law.name;
    EXPECT_TRUE(names.insert(std::string(law.component) + "/" + std::string(law.name)).second);
    for (const LawParameter& p : law.parameters) {
      EXPECT_FALSE(p.source.empty()) << p.name;
      if (p.name == "settling_time") {
        EXPECT_EQ(p.value, NeedleParams{}.wall.settling_time);
      }
    }
  }
  for (const std::string_view name : kCuttingLawNames)
    EXPECT_TRUE(names.contains("cutting/" + std::string(name))) << name;
}

}  // namespace
}  // namespace artus
