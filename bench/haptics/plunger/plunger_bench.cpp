// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: what does a tick of the plunger cost: stopper, bore, two places that the bevel is in,
//   leaks, status?
// Command: ninja -C build/release bench_plunger && build/release/bench/haptics/bench_plunger
// Reading: each of 200,000 ticks is timed alone; percentiles in microseconds with the clock's own
//   cost (about 0.03 us). A wild thumb, by force and by travel; water and a liquid that thins.
// Peer: an empty tick (the clock alone), printed first.
// Budget: p50 <= 1 us: a fifth of the needle's tick.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "artus/detail/core/noise.h"
#include "artus/detail/haptics/plunger/syringe_choice.h"

namespace {

using Clock = std::chrono::steady_clock;
constexpr int kTicks = 200'000;

void print(const std::string& what, std::vector<double>& us) {
  std::sort(us.begin(), us.end());
  const auto at = [&](double share) {
    return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  };
  std::printf("%-44s p50 %.3f us  p99 %.3f  p99.9 %.3f  most %.1f\n", what.c_str(), at(0.5),
              at(0.99), at(0.999), us.back());
}

std::vector<artus::Space> bursa_and_muscle() {
  const auto profiles = artus::read_bundled_space_profiles();
  std::vector<artus::Space> spaces;
  for (const artus::SpaceProfile& profile : *profiles)
    if (profile.space.name == "bursa" || profile.space.name == "muscle" ||
        profile.space.name == "joint")
      spaces.push_back(profile.space);
  return spaces;
}

void bench(const char* liquid, bool by_travel) {
  artus::SyringeChoice choice;
  choice.liquid = liquid;
  choice.filled = 50e-6;
  artus::PlungerParams params = *artus::make_plunger_params(choice, 0.05);
  artus::Plunger plunger(params, bursa_and_muscle(), 1e-3);
  std::vector<double> us;
  us.reserve(kTicks);
  artus::PlungerInput input;
  for (int k = 0; k < kTicks; ++k) {
    const auto phase = static_cast<std::uint64_t>(k / 250);
    const double wild = 40 * (artus::uniform_noise(7, phase) - 0.2);
    if (by_travel) {
      input.stiffness = 1300;
      input.position = 1e-6 * k + 1e-4 * wild;
    } else {
      input.force = wild;
    }
    const double share = artus::uniform_noise(8, phase);
    input.tip = {{{0, share}, {1, 1 - share}}};
    const auto start = Clock::now();
    plunger.step(input);
    us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
  }
  print(std::string("plunger, ") + liquid + (by_travel ? ", by travel" : ", by force"), us);
}

}  // namespace

int main() {
  std::vector<double> us;
  for (int k = 0; k < kTicks; ++k) {
    const auto start = Clock::now();
    us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
  }
  print("nothing", us);
  for (const bool by_travel : {false, true}) {
    bench("saline", by_travel);
    bench("hyaluronic", by_travel);
  }
  return 0;
}
