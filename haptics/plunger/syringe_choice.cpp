// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/syringe_choice.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kBeyondMark = 1.2;  // of a barrel's volume; assumed
constexpr double kLargest = 100e-6;  // m^3
constexpr double kMaxAir = 10e-6;    // m^3

}  // namespace

Result<PlungerParams> make_plunger_params(const SyringeChoice& choice, double needle_length) {
  if (!(choice.filled > 0 && choice.filled <= kLargest) || !(choice.barrel >= 0))
    return fail(ErrorCode::invalid, "the volume must be above 0 and at most 100 ml", "syringe");
  if (!(choice.air >= 0 && choice.air <= kMaxAir) ||
      !(choice.unbalanced >= 0 && choice.unbalanced <= 1))
    return fail(ErrorCode::invalid, "air must be 0 to 10 ml, the unbalanced share 0 to 1",
                "syringe");
  PlungerParams params;
  const auto liquids = read_bundled_liquids();
  ARTUS_TRY(liquids);
  params.liquids = *liquids;
  const auto liquid = find_liquid(*liquids, choice.liquid);
  ARTUS_TRY(liquid);
  params.liquid = *liquid;
  const auto bore = bore_of_gauge(choice.gauge, needle_length);
  if (!bore)
    return fail(ErrorCode::not_found, "there are 18, 19, 20, 21, 22, 23, 25 and 27 gauge", "gauge");
  params.needle = *bore;
  params.syringe = syringe_for(choice.barrel > 0 ? choice.barrel : choice.filled / kBeyondMark);
  params.syringe.volume *= kBeyondMark;
  if (params.syringe.volume < choice.filled)
    return fail(ErrorCode::invalid,
                printed("a syringe of %g ml does not hold %g ml; take a larger one, or less",
                        choice.barrel / kCubicCentimetre, choice.filled / kCubicCentimetre),
                "syringe");
  params.syringe.filled = choice.filled;
  params.syringe.air = choice.air;
  params.unbalanced = choice.unbalanced;
  params.seed = choice.seed;
  return params;
}

}  // namespace artus
