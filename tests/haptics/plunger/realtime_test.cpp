// SPDX-License-Identifier: AGPL-3.0-or-later
// The plunger's tick under the allocation and lock counters.
#include <gtest/gtest.h>

#include "artus/detail/haptics/plunger/bevel.h"
#include "artus/detail/haptics/plunger/plunger.h"
#include "artus/detail/haptics/plunger/space_pressure.h"
#include "artus/haptics/needle_feel.h"
#include "tests/haptics/plunger/plunger_fixture.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

using test::use;

TEST(RealTimePlunger, NeitherAllocatesNorLocks) {
  SpaceLaw law = test::compliance(1e3, 2e9);
  law.rupture = 1e-6;
  law.film_gap = 1e-4;
  law.film_area = 1e-3;
  PlungerParams params = test::water_syringe();
  params.liquid.viscosity = {5, 1e-3, 1, 0.35};
  Plunger plunger(params, test::one_space(law), 1e-3);
  ARTUS_RUNS_REALTIME(
      Plunger::step, for (int k = 0; k < 3000; ++k) {
        PlungerInput input = test::thumb(k < 2000 ? 60 : -20);
        input.depth = 1e-6 * k;
        use(plunger.step(input));
      });
  EXPECT_GT(plunger.states()[0].volume, 0);
  ARTUS_RUNS_REALTIME(Plunger::clear_needle, plunger.clear_needle());
  ARTUS_RUNS_REALTIME(Plunger::reset, plunger.reset());
  ARTUS_RUNS_REALTIME(Plunger::pressure, use(plunger.pressure(0)));
}

TEST(RealTimePlunger, ItsLawsNeitherAllocateNorLock) {
  const SpaceLaw law = test::compliance(1e3, 2e9);
  ARTUS_RUNS_REALTIME(pressure_of, use(pressure_of(law, 1e-6)));
  ARTUS_RUNS_REALTIME(opening_of, use(opening_of(law, 1e-6)));
  ARTUS_RUNS_REALTIME(slope_of, use(slope_of(law, 1e-6)));
  ARTUS_RUNS_REALTIME(film_resistance, use(film_resistance(law, 1e-6, 1e-3)));
  const NeedleFlow flow({}, {5, 1e-3, 1, 0.35}, 1000);
  ARTUS_RUNS_REALTIME(NeedleFlow::flow, use(flow.flow(1e4)));
  ARTUS_RUNS_REALTIME(NeedleFlow::drop, use(flow.drop(1e-7)));
  const LayerTable table;
  const NeedleContact contact({}, {}, table, 1e-3);
  const BevelPlaces places{{0}, {SpaceKind::open}};
  ARTUS_RUNS_REALTIME(bevel_shares, use(bevel_shares(contact, 1e-3, places, {})));
}

}  // namespace
}  // namespace artus
