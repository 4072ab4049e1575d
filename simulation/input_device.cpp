// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/simulation/input_device.h"

#include <cmath>

namespace artus {

const char* to_string(PeerState state) noexcept {
  switch (state) {
    case PeerState::absent:
      return "absent";
    case PeerState::alive:
      return "alive";
    case PeerState::lost:
      return "lost";
    case PeerState::invalid:
      return "invalid";
  }
  return "";
}

bool is_plunger(const DeviceSample& sample) noexcept {
  constexpr double kFarthest = 1;      // m
  constexpr double kStrongest = 1000;  // N
  return sample.plunger <= PlungerSign::force && std::abs(sample.plunger_travel) <= kFarthest &&
         std::abs(sample.plunger_force) <= kStrongest;
}

}  // namespace artus
