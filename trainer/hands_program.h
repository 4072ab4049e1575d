// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <sys/types.h>

#include "artus/core/result.h"

namespace artus {

/// A program beside this one that tells what it does in lines: `artus-hands`. It ends with the
/// object.
class HandsProgram {
 public:
  /// Errors: failed (it cannot be started).
  HandsProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments);
  ~HandsProgram();
  HandsProgram(const HandsProgram&) = delete;
  HandsProgram& operator=(const HandsProgram&) = delete;

  /// The newest lines, oldest first, eight at most.
  [[nodiscard]] std::vector<std::string> lines() const;
  [[nodiscard]] bool ended() const;
  /// Its exit code; -1 before it ended, or where it could not be started.
  [[nodiscard]] int exit_code() const;

 private:
  void read(int from);

  pid_t child_ = -1;
  mutable std::mutex mutex_;  // of the three below
  std::vector<std::string> lines_;
  bool ended_ = false;
  int exit_code_ = -1;
  std::thread reader_;
};

/// What of a kit was measured: the line of `artus hands state`.
struct HandsState {
  bool camera = false;
  bool markers = false;
  bool tip = false;
  bool face = false;
  double error_mm = 0;  ///< 95 %, of tip and face
};
/// Errors: malformed.
[[nodiscard]] Result<HandsState> parse_hands_state(const std::string& line);

}  // namespace artus
