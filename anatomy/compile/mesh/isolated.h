// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace artus {

/// Runs each of `works` in a child process of its own, at most `at_once` at a time, and returns the
/// bytes they produced, in the order of `works`; empty where a child crashed, threw, or took longer
/// than `seconds`. For library code that may abort or hang on bad input: the caller goes on
/// unharmed. Work sees a copy of this process with one thread: it must not wait for other threads.
/// Cost: a fork each, and the bytes through a pipe.
[[nodiscard]] std::vector<std::optional<std::string>> run_isolated(
    const std::vector<std::function<std::string()>>& works, double seconds, std::size_t at_once);

/// The same of one.
[[nodiscard]] std::optional<std::string> run_isolated(const std::function<std::string()>& work,
                                                      double seconds);

/// The most memory that this process or any child it has ended held at a time, bytes, as the system
/// counts; 0 where it does not tell.
[[nodiscard]] double peak_memory() noexcept;

}  // namespace artus
