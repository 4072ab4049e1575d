// SPDX-License-Identifier: AGPL-3.0-or-later
// The same for the plunger: syringe, needle, liquid, the laws of a place, and what joins them.
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/units.h"
#include "tests/haptics/plunger/plunger_fixture.h"
#include "tests/mutations/mutations.h"

namespace artus {

ARTUS_FIELDS(Syringe, volume, diameter, break_loose, glide, ageing, compliance, air, dead_space,
             filled);

ARTUS_FIELDS(NeedleBore, diameter, outer_diameter, length);

ARTUS_FIELDS(Viscosity, zero, infinite, relaxation, power);

template <Like<Liquid> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [name, viscosity, density, tissue, backscatter, solids, grain_radius, source] = params;
  ARTUS_VISIT_FIELDS(visit, viscosity, density, backscatter, solids, grain_radius);
}

template <Like<PlungerParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [syringe, needle, liquid, liquids, entry_loss, unbalanced, max_force, reopen_distance,
         reopen_time, lost_resistance, grip, track_resistance, clog_time, seed] = params;
  ARTUS_VISIT_FIELDS(visit, syringe, needle, liquid, entry_loss, unbalanced, max_force,
                     reopen_distance, reopen_time, lost_resistance, grip, track_resistance,
                     clog_time, seed);
}

ARTUS_FIELDS(SpaceLaw, kind, opening, resistance, rest, stiffness, slack, toe, yield, rupture,
             suction, suction_volume, relaxing, relaxation, film_gap, film_area, peak, peak_volume,
             stop, contents);

namespace test {
namespace {

/// A syringe whose needle ends in one place, which leaks into the open.
struct InjectionSetup {
  PlungerParams plunger;
  SpaceLaw space;
  double leak_resistance = 2e10;  // Pa s/m^3
  double leak_opening = 2e3;      // Pa
};
ARTUS_FIELDS(InjectionSetup, plunger, space, leak_resistance, leak_opening);

/// What the thumb does for some time.
struct Thumb {
  double seconds = 0;
  PlungerInput input;
  double by_second = 0;  ///< N/s more
};

Thumb push(double seconds, double force, double depth = 0) {
  PlungerInput input = thumb(force);
  input.depth = depth;
  return {seconds, input};
}

Thumb push_harder(double seconds, double force, double by_second) {
  return {seconds, thumb(force), by_second};
}

Thumb lead(double seconds, double position) {
  PlungerInput input = thumb(0);
  input.position = position;
  input.stiffness = 5e3;
  return {seconds, input};
}

std::vector<std::string> injection_trace(const InjectionSetup& setup,
                                         const std::vector<Thumb>& strokes) {
  constexpr double kTick = 1e-3;  // s
  std::vector<Space> spaces = one_space(setup.space, "place");
  spaces[0].liquid = "own";
  spaces[0].leaks_to = "around";
  spaces[0].leak_resistance = setup.leak_resistance;
  spaces[0].leak_opening = setup.leak_opening;
  spaces.push_back(one_space(level(0), "around")[0]);
  PlungerParams params = setup.plunger;
  params.liquids = {Liquid{}};
  params.liquids[0].name = "own";
  Plunger plunger(params, spaces, kTick);
  std::vector<std::string> lines{
      "travel,pressure,flow,force,on_needle,tip,bevel,content,drawn,volume,taken,relaxing,status"};
  for (const Thumb& stroke : strokes) {
    const long n = std::lround(stroke.seconds / kTick);
    std::uint32_t status = ~0U;
    for (long i = 0; i < n; ++i) {
      PlungerInput input = stroke.input;
      input.force += stroke.by_second * kTick * static_cast<double>(i);
      const PlungerState& s = plunger.step(input);
      if (i % 100 != 99 && s.status == status) continue;
      status = s.status;
      const SpaceState& place = plunger.states()[0];
      std::string line;
      for (const double v :
           {s.travel, s.pressure, s.flow, s.force, s.on_needle, s.tip_pressure, s.bevel_pressure,
            s.content, s.drawn, place.volume, place.drawn, place.relaxing})
        line += to_csv(v * 1e6) + ',';
      lines.push_back(line + std::to_string(s.status) + ' ' + std::to_string(i));
    }
  }
  return lines;
}

Subject<InjectionSetup> stroke(const std::string& name, const InjectionSetup& setup,
                               const std::vector<Thumb>& strokes) {
  return {name, setup, [strokes](const InjectionSetup& s) {
            return injection_trace(s, strokes);
          }};
}

/// A bag in which every term of its curve counts within two millilitres.
InjectionSetup bag() {
  InjectionSetup setup;
  setup.plunger.liquid = {};
  SpaceLaw& law = setup.space;
  law.kind = SpaceKind::cavity;
  law.opening = 1.5e3;
  law.resistance = 1e9;
  law.rest = 800;
  law.stiffness = 2e10;
  law.slack = 0.1e-6;
  law.toe = 0.2e-6;
  law.yield = 1e-6;
  law.rupture = 1.6e-6;
  law.suction = 400;
  law.suction_volume = 0.05e-6;
  law.relaxing = 0.3;
  law.relaxation = 0.5;
  law.film_gap = 10e-6;
  law.film_area = 1.5e-4;
  law.stop = 10e3;
  law.contents = 0.3e-6;
  return setup;
}

InjectionSetup split() {
  InjectionSetup setup;
  setup.plunger.unbalanced = 0.1;
  setup.space.kind = SpaceKind::split;
  setup.space.opening = 40e3;
  setup.space.peak = 60e3;
  setup.space.peak_volume = 0.02e-6;
  return setup;
}

InjectionSetup thinning() {
  InjectionSetup setup = bag();
  setup.plunger.liquid.viscosity = {10, 5e-3, 1, 0.3};
  return setup;
}

InjectionSetup grains() {
  InjectionSetup setup = bag();
  setup.plunger.liquid.solids = 0.04;
  setup.plunger.needle.diameter = 0.21e-3;
  setup.plunger.clog_time = 1;
  return setup;
}

/// Opens at a pressure at which liquid follows the needle out.
InjectionSetup tight() {
  InjectionSetup setup = bag();
  setup.space.stiffness = 2e11;
  setup.space.rupture = 1e-6;
  setup.leak_opening = 1e6;
  return setup;
}

/// What keeps flowing at a pressure at which it would not open.
InjectionSetup closing() {
  InjectionSetup setup;
  setup.plunger.reopen_time = 0.4;
  setup.space = bag().space;
  setup.space.opening = 30e3;
  setup.space.relaxing = 0;
  setup.leak_opening = 1e6;
  return setup;
}

InjectionSetup aspirating() {
  InjectionSetup setup;
  setup.plunger.syringe.volume = 1e-6;
  setup.plunger.syringe.filled = 0.5e-6;
  setup.plunger.syringe.air = 0.01e-6;
  setup.space = bag().space;
  setup.space.opening = 0;
  setup.space.film_area = 0;  // its walls are apart
  return setup;
}

/// Drawn out to its rim.
InjectionSetup full() {
  InjectionSetup setup = aspirating();
  setup.plunger.syringe.filled = 0.8e-6;
  return setup;
}

TEST(Mutations, EveryParameterOfThePlungerIsNoticed) {
  const std::string kPicture = "what the picture and what settles in it take";
  const std::vector<Thumb> draw{push(3, 0), push_harder(2, 0, -6), push(3, -12), push(1, 0),
                                push(3, 8)};
  expect_noticed(
      "plunger",
      try_mutations<InjectionSetup>(
          {stroke("bag", bag(), {push_harder(1, 0, 10), push(2, 10), push(3, 30), push(1, 0)}),
           stroke("led", bag(), {lead(0.1, 0), lead(3, 5e-3), lead(2, 0)}),
           stroke("split", split(), {push(1, 8), push(1, 12), push(1, 120)}),
           stroke("thinning", thinning(), {push(3, 20)}),
           stroke("grains", grains(), {push(1, 8), push(12, 0), push(3, 12)}),
           stroke("tight", tight(), {push(4, 20), push(2, 0)}),
           stroke("away", closing(), {push(1, 8), push(1, 5, 0.51e-3)}),
           stroke("closing", closing(), {push(1, 8), push(2, 0), push(1, 5)}),
           stroke("aspirating", aspirating(), draw), stroke("full", full(), draw)}),
      {{"plunger.liquid.backscatter", kPicture},
       {"plunger.liquid.grain_radius", kPicture},
       {"plunger.liquid.solids", "there are grains or there are none"}});
}

}  // namespace
}  // namespace test
}  // namespace artus
