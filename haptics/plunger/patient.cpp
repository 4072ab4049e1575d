// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/plunger/patient.h"

namespace artus {
namespace {

constexpr double kSome = 0.02e-6;  // m^3
constexpr double kMuch = 0.2e-6;   // m^3
constexpr double kHurts = 60e3;    // Pa
constexpr double kPresses = 8e3;   // Pa
constexpr double kFelt = 1e-9;     // m^3/s
constexpr double kHasty = 0.6e-6;  // m^3/s

}  // namespace

std::string patient_says(const Plunger& plunger, std::size_t tip) {
  const Space& space = plunger.spaces()[tip];
  const SpaceState& state = plunger.states()[tip];
  const double p = plunger.pressure(tip);
  const bool pushed = plunger.state().flow > kFelt;
  if (space.like == "nerve" && ((pushed && state.open) || state.volume > 0))
    return "Ow! It shoots down my arm.";
  if (state.ruptured) return "Something gave way.";
  if ((space.like == "vein" || space.like == "artery") && state.volume > kMuch)
    return "My heart is racing.";
  if (!pushed || !state.open) return {};
  if (p > space.law.stop || p > kHurts) return "That hurts.";
  if (plunger.state().flow > kHasty) return "That is too fast, it burns.";
  if (p > kPresses && state.volume > kSome) return "I feel pressure.";
  return {};
}

}  // namespace artus
