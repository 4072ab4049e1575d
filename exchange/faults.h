// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "artus/core/result.h"

namespace artus {

/// Collects what is wrong with a file of somebody else, so that all of it is told at once.
class Faults {
 public:
  void add(const std::string& where, const std::string& message) {
    if (lines_.size() < kShown) lines_.push_back(where.empty() ? message : where + ": " + message);
    ++count_;
  }
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  /// One refusal of `file`: the only fault as it is, several as a list of at most twelve.
  [[nodiscard]] tl::unexpected<Error> refusal(ErrorCode code, const std::string& file) const {
    if (count_ == 1) return fail(code, lines_.front(), file);
    std::string all = std::to_string(count_) + " faults:";
    for (const std::string& line : lines_) all += "\n  " + line;
    if (count_ > lines_.size())
      all += "\n  and " + std::to_string(count_ - lines_.size()) + " more";
    return fail(code, all, file);
  }

 private:
  static constexpr std::size_t kShown = 12;
  std::vector<std::string> lines_;
  std::size_t count_ = 0;
};

}  // namespace artus
