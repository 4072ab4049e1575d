// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "hand.h"

namespace artus::bridge {

/// What one message of Haply's service says of one Inverse3 and its grip. Parts that a message
/// leaves out stay as they were: only the first message is full.
struct HaplyState {
  std::string id;  ///< of the Inverse3; empty: none was seen yet
  Reading reading;
};

/// Takes a message. `wanted`: an id, a number from 0, or empty for the first. False, and the
/// reading is not sound, when the message is no JSON, has no such device, or numbers that are none.
/// Source [Haply] service's WebSocket interface.
bool take_haply_message(std::string_view text, const std::string& wanted, HaplyState& state);

/// The command that answers it: a force in N. The service sends its next state only after one.
[[nodiscard]] std::string haply_command(const std::string& id, const Triple& force);

}  // namespace artus::bridge
