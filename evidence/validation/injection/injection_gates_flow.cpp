// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "artus/detail/core/noise.h"
#include "artus/detail/evidence/validation/injection/injection_gates.h"

namespace artus {
namespace {

using namespace injection_gate;  // NOLINT(google-build-using-namespace): what the gates share

constexpr double kExact = 1e-3;  // of a closed form

/// m^3 that are missing after ten seconds of a wild thumb over two places, with leak and rupture.
double missing_volume(double rate, std::uint64_t seed) {
  PlungerParams params = water_syringe(NeedleFlow::kEntryLoss);
  params.needle = *bore_of_gauge(18, 0.04);
  Space joint = cavity("joint", -3e3, 3e9);
  joint.law.relaxing = 0.5;
  joint.law.relaxation = 30;
  joint.law.yield = 4e-6;
  joint.law.rupture = 6e-6;
  joint.leaks_to = "bursa";
  Plunger plunger(params, {joint, cavity("bursa", 1e3, 1.5e9)}, 1 / rate);
  PlungerInput input;
  for (int k = 0; k < static_cast<int>(10 * rate); ++k) {
    const auto phase = static_cast<std::uint64_t>(k / (0.25 * rate));
    input.force = 60 * (uniform_noise(seed, phase) - 0.3);
    const double share = uniform_noise(seed + 1, phase);
    input.tip = {{{0, share}, {1, 1 - share}}};
    plunger.step(input);
  }
  double in = 0;
  for (const SpaceState& s : plunger.states()) in += s.volume - s.drawn;
  const PlungerState& state = plunger.state();
  const Syringe& syringe = params.syringe;
  return std::abs(in - (syringe.area() * state.travel - syringe.squeezed(state.pressure)));
}

double power_law_drop(double q, double d, double length, double k, double n) {
  const double r = d / 2;
  return 2 * k * length / r * std::pow((3 * n + 1) / n * q / (std::numbers::pi * r * r * r), n);
}

}  // namespace

Gate gate_needle() {
  Gate gate;
  gate.title = "pressure drop of water by gauge and rate, a power law's closed form";
  struct Row {
    int gauge;
    double length;
    double drop;  // Pa at 0.2 ml/s by the independent model
  };
  for (const Row& row : {Row{18, 0.040, 805}, Row{21, 0.050, 6.86e3}, Row{22, 0.050, 16.46e3},
                         Row{25, 0.038, 83.4e3}}) {
    const NeedleFlow flow(*bore_of_gauge(row.gauge, row.length), {}, 1000);
    gate.claims.push_back(claim_near({ClaimKind::input, "the law is the table's own"},
                                     std::to_string(row.gauge) + " G at 0.2 ml/s",
                                     flow.drop(2e-7) / 1e3, row.drop / 1e3, 0.02, "kPa"));
  }
  const NeedleFlow flow(*bore_of_gauge(22, 0.05), {}, 1000);
  gate.claims.push_back(claim_near({ClaimKind::input, "a quadratic and its own solution"},
                                   "inverse of the drop at 0.2 ml/s",
                                   flow.flow(flow.drop(2e-7)) * 1e6, 0.2, 1e-9, "ml/s"));
  // Far above its knee Carreau's law is a power law of k = mu_0 lambda^(n-1).
  const Viscosity thin{100, 1e-9, 100, 0.5};
  const NeedleBore bore = *bore_of_gauge(22, 0.05);
  const double k = thin.zero * std::pow(thin.relaxation, thin.power - 1);
  const double drop = NeedleFlow(bore, thin, 1e-9, 0).drop(1e-7);
  gate.claims.push_back(
      claim_near(ClaimKind::independent, "power law of 0.5 at 0.1 ml/s, by Rabinowitsch's integral",
                 drop / 1e3, power_law_drop(1e-7, bore.diameter, bore.length, k, thin.power) / 1e3,
                 2e-3, "kPa"));
  return gate;
}

Gate gate_compliance() {
  Gate gate;
  gate.title = "constant pressure into a bursa: V = C dP (1 - exp(-t/RC))";
  for (const double rate : {1e3, 10e3}) {
    PlungerParams params = water_syringe(0);
    params.syringe.break_loose = params.syringe.glide;
    Plunger plunger(params, {cavity("bursa", kRest, 1 / kCompliance)}, 1 / rate);
    const double over = 50 * kMercury;
    const double force = params.syringe.glide + params.syringe.area() * (kRest + over);
    const double tau = needle_resistance() * kCompliance;
    double worst = 0;
    for (int k = 1; k <= 60 * static_cast<int>(rate); ++k) {
      plunger.step(thumb(force));
      const double wanted = kCompliance * over * (1 - std::exp(-k / rate / tau));
      worst = std::max(worst, std::abs(plunger.states()[0].volume - wanted));
    }
    gate.claims.push_back(
        claim_at_most(ClaimKind::independent,
                      "worst of its filling at " + std::to_string(static_cast<int>(rate)) + " Hz",
                      worst / (kCompliance * over), kExact, "of it"));
  }
  return gate;
}

Gate gate_air() {
  Gate gate;
  gate.title = "after-flow of a stopped plunger with 0.2 ml of air";
  PlungerParams params = water_syringe(0);
  params.syringe.compliance = 0;
  params.syringe.air = 0.2 * kMl;
  params.syringe.break_loose = 7;
  params.syringe.glide = 0;
  Plunger plunger(params, {cavity("bursa", 0, 1 / kCompliance)}, 1e-3);
  plunger.step(thumb(8));
  plunger.step(thumb(4));
  // Boyle's law by many small steps: what is in the barrel runs out into the bursa.
  const double v0 = plunger.states()[0].volume;
  const double whole = params.syringe.squeezed(plunger.state().pressure) + v0;
  double volume = v0;
  double worst = 0;
  constexpr int kSmall = 100;
  const auto flow = [&](double v) {
    return (params.syringe.pressure_of(whole - v) - v / kCompliance) / needle_resistance();
  };
  for (int k = 1; k <= 1000; ++k) {
    plunger.step(thumb(4));
    for (int n = 0; n < kSmall; ++n)
      volume += 1e-3 / kSmall * flow(volume + 0.5e-3 / kSmall * flow(volume));
    worst = std::max(worst, std::abs(plunger.states()[0].volume - volume));
  }
  Syringe half;
  half.air = 0.5 * kMl;
  gate.claims.push_back(claim_near({ClaimKind::independent, "Boyle: 0.5 ml 192 / 293.3, and 0.192"},
                                   "0.5 ml of air and barrel under 192 kPa",
                                   half.squeezed(192e3) / kMl, 0.519, 1e-3, "ml"));
  gate.claims.push_back(claim_near({ClaimKind::independent, "Boyle: 0.5 ml 35 / 66.3, and 0.035"},
                                   "the same drawn by 35 kPa", -half.squeezed(-35e3) / kMl, 0.299,
                                   1e-3, "ml"));
  gate.claims.push_back(claim_at_most(ClaimKind::independent, "worst of the after-flow",
                                      worst / (volume - v0), kExact, "of it"));
  return gate;
}

Gate gate_leak() {
  Gate gate;
  gate.title = "steady leak over a yield pressure: Q = (ps - py)/(R + Rl)";
  PlungerParams params = water_syringe(0);
  params.syringe.break_loose = params.syringe.glide;
  Space full = cavity("full", 100 * kMercury, 1 / 2e-12);
  full.leaks_to = "sink";
  full.leak_opening = 100 * kMercury;
  full.leak_resistance = 2e10;
  Plunger plunger(params, {full, level("sink", 0)}, 1e-3);
  const double force = params.syringe.glide + params.syringe.area() * (100 * kMercury + 2e4);
  for (int k = 0; k < 5000; ++k) plunger.step(thumb(force));
  gate.claims.push_back(claim_near({ClaimKind::input, "a closed form of the values put in"}, "flow",
                                   plunger.state().flow * 1e6,
                                   2e4 / (needle_resistance() + 2e10) * 1e6, kExact, "ml/s"));
  return gate;
}

Gate gate_energy() {
  Gate gate;
  gate.title = "work of the thumb: friction, needle, target, barrel's spring";
  PlungerParams params = water_syringe(0);
  constexpr double kDt = 1e-4;
  Plunger plunger(params, {cavity("bursa", kRest, 1 / kCompliance)}, kDt);
  const double force = 4 + params.syringe.area() * (kRest + 50 * kMercury);
  double needle = 0;
  for (int k = 0; k < 50000; ++k) {
    const double q = plunger.step(thumb(force)).flow;
    needle += q * q * needle_resistance() * kDt;
  }
  const double x = plunger.state().travel;
  const double v = plunger.states()[0].volume;
  const double p = plunger.state().pressure;
  const double target = kRest * v + v * v / (2 * kCompliance);
  // A step of force on a spring: half is stored, half is lost at once.
  const double spent =
      params.syringe.glide * x + needle + target + params.syringe.softness() * p * p;
  gate.claims.push_back(claim_at_most(ClaimKind::independent, "what is not accounted for",
                                      std::abs(force * x - spent) / (force * x), kExact, "of it"));
  return gate;
}

Gate gate_mass() {
  Gate gate;
  gate.title = "volumes under wild thumbs, two places, a leak and a rupture";
  double worst = 0;
  for (std::uint64_t seed = 100; seed < 110; ++seed)
    worst = std::max(worst, missing_volume(1e3, seed));
  gate.claims.push_back(claim_at_most({ClaimKind::input, "the scalars are written to balance"},
                                      "most that is missing in ten runs", worst * 1e6, 1e-9, "ml"));
  return gate;
}

}  // namespace artus
