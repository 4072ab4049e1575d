// SPDX-License-Identifier: AGPL-3.0-or-later
// Ticks of the plunger against an integral of its equations that is continuous in time.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "artus/detail/evidence/validation/injection/injection_gates.h"
#include "artus/detail/evidence/validation/injection/plunger_integral.h"

namespace artus {
namespace {

using namespace injection_gate;  // NOLINT(google-build-using-namespace): what the gates share

constexpr double kLead = 2000;  // N/m of the thumb

Space split_muscle() {
  Space muscle = level("muscle", 0);
  muscle.law.kind = SpaceKind::split;
  muscle.law.opening = 8e3;
  muscle.law.peak = 20e3;
  muscle.law.peak_volume = 0.1e-6;
  return muscle;
}

/// Where a trembling thumb leads the plunger, m.
double trembling(double t, double tremor) {
  return 4e-3 * t + tremor * std::sin(60 * t);
}

/// % RMS of the flow by which ticks of 1, 2 and 10 kHz differ from the integral at most, at each
/// hundredth of a second.
double worst_of_rates(const NeedleBore& needle, double tremor) {
  constexpr double kSeconds = 2;
  constexpr double kEach = 0.01;  // s
  IntegralSetup setup;
  setup.plunger = water_syringe(NeedleFlow::kEntryLoss);
  setup.plunger.needle = needle;
  setup.law = split_muscle().law;
  setup.thumb = {[](double) { return 0.0; }, [tremor](double t) { return trembling(t, tremor); },
                 kLead};
  const auto rows = integrate_plunger(setup, kSeconds, kEach, 2e-4);
  double whole = 0;
  for (const IntegralRow& row : rows) whole += row.flow * row.flow;
  double worst = 0;
  for (const double rate : {1e3, 2e3, 10e3}) {
    Plunger plunger(setup.plunger, {split_muscle()}, 1 / rate);
    PlungerInput input = thumb(0);
    input.stiffness = kLead;
    const auto each = static_cast<int>(std::lround(rate * kEach));
    double sum = 0;
    for (int k = 0; k < static_cast<int>(rate * kSeconds); ++k) {
      input.position = trembling(k / rate, tremor);
      plunger.step(input);
      if (k % each == 0)
        sum += std::pow(plunger.state().flow - rows[static_cast<std::size_t>(k / each)].flow, 2);
    }
    worst = std::max(worst, 100 * std::sqrt(sum / whole));
  }
  return worst;
}

/// The greatest difference of ticks at 1 kHz from the integral in a few seconds, of the greatest
/// value: of the thumb's force, the barrel's pressure, the flow and the volume in the place.
double worst_of_place(const Space& place, int gauge) {
  constexpr int kTicks = 4000;
  IntegralSetup setup;
  setup.plunger = water_syringe(NeedleFlow::kEntryLoss);
  setup.plunger.needle = *bore_of_gauge(gauge, 0.05);
  setup.law = place.law;
  const auto lead = [](double t) {
    return 6e-3 * t + 2e-3 * (1 - std::cos(3 * t));
  };
  setup.thumb = {[](double) { return 0.0; }, lead, kLead};
  const auto rows = integrate_plunger(setup, 1e-3 * kTicks, 1e-3, 1e-3);
  Plunger plunger(setup.plunger, {place}, 1e-3);
  PlungerInput input = thumb(0);
  input.stiffness = kLead;
  std::array<double, 4> most{};
  std::array<double, 4> apart{};
  for (std::size_t k = 1; k <= kTicks; ++k) {
    input.position = lead(1e-3 * static_cast<double>(k));
    const PlungerState& s = plunger.step(input);
    const std::array<double, 4> ours{s.force, s.pressure, s.flow, plunger.states()[0].volume};
    const std::array<double, 4> theirs{rows[k].force, rows[k].pressure, rows[k].flow,
                                       rows[k].volume};
    for (std::size_t i = 0; i < 4; ++i) {
      most[i] = std::max(most[i], std::abs(theirs[i]));
      apart[i] = std::max(apart[i], std::abs(ours[i] - theirs[i]));
    }
  }
  double worst = 0;
  for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, apart[i] / most[i]);
  return worst;
}

}  // namespace

Gate gate_rates() {
  Gate gate;
  gate.title = "1, 2 and 10 kHz against an integral, 4 lengths and 3 tremors of the thumb, 2 % RMS";
  for (const int gauge : {18, 19, 20, 21, 22, 23, 25, 27}) {
    double worst = 0;
    for (const double length : {0.016, 0.038, 0.07, 0.12})
      for (const double tremor : {1e-4, 2e-4, 3e-4})
        worst = std::max(worst, worst_of_rates(*bore_of_gauge(gauge, length), tremor));
    gate.claims.push_back(claim_at_most(
        ClaimKind::independent, std::to_string(gauge) + " G, worst of 36", worst, 2, "% RMS"));
  }
  return gate;
}

Gate gate_places() {
  Gate gate;
  gate.title = "force, pressure, flow and volume at 1 kHz against an integral, by place";
  const auto profiles = read_bundled_space_profiles();
  ARTUS_REQUIRE(profiles.has_value(), "the bundled places are tested");
  for (const char* name : {"bursa", "joint", "capsulitis_man", "sheath", "fat", "muscle", "vein"}) {
    const auto profile = std::find_if(profiles->begin(), profiles->end(),
                                      [&](const SpaceProfile& p) { return p.space.name == name; });
    Space place = profile->space;
    place.liquid.clear();
    place.law.contents = 0;
    double worst = 0;
    for (const int gauge : {18, 22, 25}) worst = std::max(worst, worst_of_place(place, gauge));
    gate.claims.push_back(claim_at_most(ClaimKind::independent,
                                        std::string(name) + ", worst of 3 needles", worst, 1e-3,
                                        "of the greatest"));
  }
  return gate;
}

}  // namespace artus
