// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/evidence/validation/injection/injection_gates.h"
#include "artus/detail/haptics/plunger/space_pressure.h"

namespace artus {
namespace {

using namespace injection_gate;  // NOLINT(google-build-using-namespace): what the gates share

/// N of the thumb beyond friction, at a rate into a place of one pressure.
double steady_force(double pressure, const NeedleBore& needle, double rate) {
  PlungerParams params = water_syringe(NeedleFlow::kEntryLoss);
  params.needle = needle;
  Plunger plunger(params, {level("target", pressure)}, 1e-3);
  PlungerInput input = thumb(0);
  input.stiffness = 2000;
  const double drop = NeedleFlow(needle, {}, 1000).drop(rate) + pressure;
  const double ahead = (params.syringe.area() * drop + params.syringe.glide) / input.stiffness;
  double force = 0;
  for (int i = 0; i < 20000; ++i) {
    input.position = ahead + rate / params.syringe.area() * 1e-3 * i;
    force = plunger.step(input).force;
  }
  return force - params.syringe.glide;
}

/// s until blood is seen behind the hub, at -40 kPa.
double flash_time(int gauge, double length, double entry_loss) {
  PlungerParams params = water_syringe(entry_loss);
  params.syringe.filled = kMl;
  params.needle = *bore_of_gauge(gauge, length);
  params.liquids = {Liquid{"blood", {3.5e-3, 3.5e-3, 0, 1}, 1000, "blood", 0, 0, 0, ""}};
  Space vein = level("vein", 0);
  vein.liquid = "blood";
  vein.law.contents = 1;
  Plunger plunger(params, {vein}, 1e-4);
  const double pull = -(40e3 * params.syringe.area() + params.syringe.glide);
  int k = 0;
  while ((plunger.step(thumb(pull)).status & PlungerStatus::kFlash) == 0 && k < 100000) ++k;
  return 1e-4 * k;
}

SpaceLaw shoulder(double stiffness, double slack, double toe) {
  SpaceLaw law;
  law.kind = SpaceKind::cavity;
  law.stiffness = stiffness * kMercury / kMl;
  law.slack = slack * kMl;
  law.toe = toe * kMl;
  return law;
}

}  // namespace

Gate gate_hand() {
  Gate gate;
  gate.title = "the hand's table: 7 places, 4 needles, 2 rates, a barrel of 5 ml";
  struct Target {
    const char* name;
    double pressure;
    std::array<double, 8> force;  // N by an independent model: 18, 21, 22, 25 G at 0.1, 0.3 ml/s
  };
  constexpr std::array<Target, 7> kTargets{
      {{"open air", 0, {0.0419, 0.1504, 0.3626, 1.2628, 0.8699, 3.0297, 4.3160, 15.6225}},
       {"bursa", 20 * kMercury, {0.3465, 0.4550, 0.6672, 1.5674, 1.1745, 3.3343, 4.6206, 15.9271}},
       {"muscle", 20e3, {2.3265, 2.4351, 2.6472, 3.5475, 3.1545, 5.3143, 6.6006, 17.9071}},
       {"perineural", 6 * kPsi, {4.7675, 4.8760, 5.0882, 5.9884, 5.5955, 7.7553, 9.0416, 20.3481}},
       {"capsulitis",
        300 * kMercury,
        {4.6107, 4.7193, 4.9314, 5.8317, 5.4387, 7.5986, 8.8848, 20.1914}},
       {"nerve",
        25 * kPsi,
        {19.7318, 19.8403, 20.0525, 20.9527, 20.5598, 22.7196, 24.0059, 35.3124}},
       {"tendon",
        300e3,
        {34.3112, 34.4198, 34.6319, 35.5322, 35.1392, 37.2991, 38.5853, 49.8918}}}};
  constexpr std::array<std::pair<int, double>, 4> kNeedles{
      {{18, 0.04}, {21, 0.05}, {22, 0.05}, {25, 0.038}}};
  for (const Target& target : kTargets) {
    double worst = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      const NeedleBore needle = *bore_of_gauge(kNeedles[k / 2].first, kNeedles[k / 2].second);
      const double force = steady_force(target.pressure, needle, k % 2 == 0 ? 1e-7 : 3e-7);
      worst = std::max(worst, std::abs(force / target.force[k] - 1));
    }
    gate.claims.push_back(
        claim_at_most({ClaimKind::input, "the table is made with the same formulas"},
                      std::string(target.name) + ", worst of 8", 100 * worst, 2, "%"));
  }
  return gate;
}

Gate gate_loss() {
  Gate gate;
  gate.title = "loss of resistance: dF = A (p1 - p2) at a rate, dQ = (p1 - p2)/R at a force";
  const NeedleBore needle = *bore_of_gauge(22, 0.05);
  const double area = water_syringe(0).syringe.area();
  const double bursa = 20 * kMercury;
  const double tendon_fall = steady_force(300e3, needle, 1e-7) - steady_force(bursa, needle, 1e-7);
  gate.claims.push_back(claim_near({ClaimKind::input, "a closed form of the values put in"},
                                   "tendon to bursa at 0.1 ml/s", tendon_fall,
                                   area * (300e3 - bursa), 2e-3, "N"));
  const double muscle_fall = steady_force(20e3, needle, 1e-7) - steady_force(bursa, needle, 1e-7);
  gate.claims.push_back(claim_near({ClaimKind::input, "a closed form of the values put in"},
                                   "muscle to bursa at 0.1 ml/s", muscle_fall,
                                   area * (20e3 - bursa), 2e-3, "N"));
  Plunger plunger(water_syringe(0), {level("muscle", 20e3), level("bursa", bursa)}, 1e-3);
  for (int k = 0; k < 100; ++k) plunger.step(thumb(6));
  const double before = plunger.state().flow;
  PlungerInput input = thumb(6);
  input.tip[0].space = 1;
  plunger.step(input);
  gate.claims.push_back(claim_near({ClaimKind::input, "a closed form of the values put in"},
                                   "muscle to bursa at 6 N", (plunger.state().flow - before) * 1e6,
                                   (20e3 - bursa) / needle_resistance() * 1e6, 1e-3, "ml/s"));
  // The hand tells 7-14 % [Pang1991]: what a thin needle and a fast push hide.
  const NeedleBore thin = *bore_of_gauge(25, 0.038);
  const NeedleBore wide = *bore_of_gauge(21, 0.05);
  const auto share = [&](const NeedleBore& bore, double rate) {
    return 100 * area * (20e3 - bursa) / (steady_force(20e3, bore, rate) + 2);
  };
  gate.claims.push_back(claim_at_most({ClaimKind::input, "of the pressures put in"},
                                      "muscle to bursa, 25 G at 0.3 ml/s, of what is felt",
                                      share(thin, 3e-7), 14, "%"));
  gate.claims.push_back(claim_at_least({ClaimKind::input, "of the pressures put in"},
                                       "muscle to bursa, 21 G at 0.1 ml/s, of what is felt",
                                       share(wide, 1e-7), 14, "%"));
  return gate;
}

Gate gate_aspiration() {
  Gate gate;
  gate.title = "time to a flash of blood at -40 kPa, 0.07 ml of hub";
  struct Row {
    int gauge;
    double length;
    double plain;  // s by Hagen and Poiseuille alone, as the published order of size is told
    double whole;  // s with the loss at the entry, by an independent model
  };
  for (const Row& row : {Row{18, 0.040, 0.0202, 0.0335}, Row{21, 0.050, 0.179, 0.1948},
                         Row{22, 0.050, 0.429, 0.4457}, Row{25, 0.038, 2.075, 2.0980}}) {
    const std::string name = std::to_string(row.gauge) + " G";
    gate.claims.push_back(claim_near({ClaimKind::input, "of the same formula"},
                                     name + ", without the loss at the entry",
                                     flash_time(row.gauge, row.length, 0), row.plain, 0.02, "s"));
    gate.claims.push_back(claim_near({ClaimKind::input, "of the same formula"}, name,
                                     flash_time(row.gauge, row.length, NeedleFlow::kEntryLoss),
                                     row.whole, 0.02, "s"));
  }
  return gate;
}

Gate gate_capsule() {
  Gate gate;
  gate.title = "pressure by volume of shoulders: toe, straight part";
  struct Row {
    const char* name = nullptr;
    SpaceLaw law;
    std::array<double, 3> mercury{};  // at 5, 10, 15 ml
  };
  const std::array<Row, 4> rows{
      {{"healthy", shoulder(2, 10, 10), {0, 0, 2.5}},
       {"capsulitis, man", shoulder(20.2, 3, 5), {8.08, 90.9, 191.9}},
       {"capsulitis, woman", shoulder(29.5, 3, 5), {11.8, 132.75, 280.25}},
       {"capsulitis, first visit", shoulder(47.6, 2, 4), {53.55, 285.6, 523.6}}}};
  for (const Row& row : rows) {
    double worst = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double volume = 5e-6 * static_cast<double>(k + 1);
      worst = std::max(worst, std::abs(pressure_of(row.law, volume) / kMercury - row.mercury[k]));
    }
    gate.claims.push_back(claim_at_most({ClaimKind::input, "the curve is the published one"},
                                        std::string(row.name) + ", worst at 5, 10, 15 ml", worst,
                                        0.5, "mmHg"));
  }
  return gate;
}

/// A bursa gives way at a tenth of muscle's pressure: whatever share of the bevel is in it, it gets
/// what a gentle rate gives; a hard push parts the muscle, too.
Gate gate_bevel() {
  Gate gate;
  gate.title = "a bevel in two layers: share of what goes into the bursa";
  Space muscle = level("muscle", 0);
  muscle.law.kind = SpaceKind::split;
  muscle.law.opening = 8e3;
  muscle.law.peak = 20e3;
  muscle.law.peak_volume = 0.1e-6;
  Space bursa = cavity("bursa", kRest, 1 / kCompliance);
  bursa.law.opening = 2e3;
  const auto share_at = [&](double in_bursa, double rate) {
    Plunger plunger(water_syringe(NeedleFlow::kEntryLoss), {muscle, bursa}, 1e-3);
    PlungerInput input = thumb(0);
    input.stiffness = 2000;
    input.tip = {{{0, 1 - in_bursa}, {1, in_bursa}}};
    const double speed = rate / plunger.params().syringe.area();
    while (plunger.states()[0].volume + plunger.states()[1].volume < kMl) {
      input.position += speed * 1e-3;
      plunger.step(input);
    }
    const double muscle_volume = plunger.states()[0].volume;
    const double bursa_volume = plunger.states()[1].volume;
    return 100 * bursa_volume / (bursa_volume + muscle_volume);
  };
  for (const double in_bursa : {0.2, 0.5, 0.8})
    gate.claims.push_back(claim_at_least(ClaimKind::independent,
                                         "of 1 ml at 0.1 ml/s, " +
                                             std::to_string(static_cast<int>(100 * in_bursa)) +
                                             " % of the bevel in it",
                                         share_at(in_bursa, 1e-7), 95, "%"));
  return gate;
}

}  // namespace artus
