// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/plunger/patient.h"

#include <array>

namespace artus {
namespace {

constexpr double kSome = 0.02e-6;  // m^3
constexpr double kMuch = 0.2e-6;   // m^3
constexpr double kHurts = 60e3;    // Pa
constexpr double kPresses = 8e3;   // Pa
constexpr double kFelt = 1e-9;     // m^3/s
constexpr double kHasty = 0.6e-6;  // m^3/s

}  // namespace

PatientFeeling feeling_of(const PatientInput& input) noexcept {
  const bool pushed = input.flow > kFelt;
  if (input.like == "nerve" && ((pushed && input.open) || input.volume > 0))
    return PatientFeeling::shoots;
  if (input.torn) return PatientFeeling::gave_way;
  if ((input.like == "vein" || input.like == "artery") && input.volume > kMuch)
    return PatientFeeling::racing;
  if (!pushed || !input.open) return PatientFeeling::nothing;
  if (input.pressure > input.stop || input.pressure > kHurts) return PatientFeeling::hurts;
  if (input.flow > kHasty) return PatientFeeling::burns;
  if (input.pressure > kPresses && input.volume > kSome) return PatientFeeling::pressed;
  return PatientFeeling::nothing;
}

std::string patient_says(const Plunger& plunger, std::size_t tip) {
  constexpr std::array<const char*, 7> kWords{"",
                                              "Ow! It shoots down my arm.",
                                              "Something gave way.",
                                              "My heart is racing.",
                                              "That hurts.",
                                              "That is too fast, it burns.",
                                              "I feel pressure."};
  const Space& space = plunger.spaces()[tip];
  const SpaceState& state = plunger.states()[tip];
  const PatientFeeling feeling =
      feeling_of({space.like, space.law.stop, plunger.pressure(tip), state.volume,
                  plunger.state().flow, state.open, state.ruptured});
  return kWords.at(static_cast<std::size_t>(feeling));
}

}  // namespace artus
