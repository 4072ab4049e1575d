// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/probe/gain_ramp.h"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/echo/probe/setting_ranges.h"

namespace artus {
namespace {

std::vector<float> gains(const GainRamp& ramp, double slope) {
  std::vector<float> all(40, 1.0F);
  apply_ramp<double>(
      ramp, [&](std::size_t i) { return 1 - slope * static_cast<double>(i); },
      [&](std::size_t i, float gain) { all[i] *= gain; });
  return all;
}

TEST(GainRamp, AStraightGainIsExactAtEverySampleWhateverTheStride) {
  for (const std::size_t stride : {1U, 4U, 16U}) {
    const auto all = gains({3, 37, stride}, 0.01);
    for (std::size_t i = 0; i < all.size(); ++i)
      EXPECT_FLOAT_EQ(all[i],
                      i >= 3 && i < 37 ? static_cast<float>(1 - 0.01 * static_cast<double>(i)) : 1)
          << i;
  }
}

TEST(GainRamp, StridesThatNobodySeesAreLeftAlone) {
  const auto all = gains({0, 40, 8, 0.9}, 0.01);
  EXPECT_EQ(all[4], 1.0F);          // nodes at 1 and 0.92
  EXPECT_FLOAT_EQ(all[12], 0.88F);  // nodes at 0.92 and 0.84
}

TEST(GainRamp, AnEmptyRampAsksNothing) {
  apply_ramp<float>(
      {5, 5, 8}, [](std::size_t) -> double { throw 1; }, [](std::size_t, float) {});
}

bool is_within(const Range& inner, const Range& outer) {
  return outer.low <= inner.low && inner.low < inner.high && inner.high <= outer.high;
}

TEST(SettingRanges, AKnobReachesNothingThatIsNotValid) {
  EXPECT_TRUE(is_within(KnobRanges::depth, ImageRanges::depth));
  EXPECT_TRUE(is_within(KnobRanges::gain_db, ImageRanges::gain_db));
  EXPECT_TRUE(is_within(KnobRanges::tgc_db_cm_mhz, ImageRanges::tgc_db_cm_mhz));
  EXPECT_TRUE(is_within(KnobRanges::dynamic_range_db, ImageRanges::dynamic_range_db));
  EXPECT_TRUE(is_within(KnobRanges::frequency, TransducerRanges::frequency));
  EXPECT_TRUE(is_within(KnobRanges::elevation_focus, TransducerRanges::elevation_focus));
}

TEST(SettingRanges, AnotherUnitShowsRoundNumbers) {
  const Range degrees = in_unit(TransducerRanges::steering, kDegree);
  EXPECT_EQ(degrees.low, -40);
  EXPECT_EQ(degrees.high, 40);
  EXPECT_EQ(in_unit(ImageRanges::pixel, kMillimetre).low, 0.02);
}

}  // namespace
}  // namespace artus
