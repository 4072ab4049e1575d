// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <imgui.h>

namespace artus {

/// An opaque colour of text, 0 to 1 each, that is there at compile time, as an ImVec4 cannot be.
struct Shade {
  float red, green, blue;
  operator ImVec4() const { return {red, green, blue, 1}; }  // NOLINT(google-explicit-constructor)
};

}  // namespace artus
