// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <string_view>

namespace artus {

/// Told how far long work has come: a step in words and the fraction done of it, 0 to 1.
/// An empty function means nobody listens. Called from the thread that does the work.
using Progress = std::function<void(std::string_view step, double fraction)>;

}  // namespace artus
