// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/input_device.h"

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

}  // namespace artus
