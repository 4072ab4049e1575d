// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>

namespace artus {

/// Runs `work` in a child process and returns the bytes it produced; empty when the child crashed,
/// threw, or took longer than `seconds`. For library code that may abort or hang on bad input: the
/// caller goes on unharmed. `work` sees a copy of this process with one thread: it must not wait
/// for other threads. Cost: a fork, and the bytes through a pipe.
[[nodiscard]] std::optional<std::string> run_isolated(const std::function<std::string()>& work,
                                                      double seconds);

}  // namespace artus
