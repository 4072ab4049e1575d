// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "artus/core/result.h"
#include "artus/detail/core/check.h"
#include "artus/detail/echo/probe/setting_ranges.h"

namespace artus {

/// Collects every value of a group of settings that is out of its range into one message.
class RangeCheck {
 public:
  explicit RangeCheck(std::string group) : group_(std::move(group)) {}

  /// Notes `value` unless it is finite and within its range.
  void in_range(const char* name, double value, const Range& range) {
    if (std::isfinite(value) && value >= range.low && value <= range.high) return;
    if (!message_.empty()) message_ += "; ";
    char text[160];
    std::snprintf(text, sizeof text, "%s is %.6g, must be %.6g .. %.6g", name, value, range.low,
                  range.high);
    message_ += text;
  }

  /// Errors: invalid when anything was noted.
  [[nodiscard]] Result<void> result() const {
    if (message_.empty()) return {};
    return fail(ErrorCode::invalid, message_, group_);
  }

 private:
  std::string group_;
  std::string message_;
};

/// `value` itself, for initialisers. Requires: validate(value) finds nothing wrong.
template <class T>
const T& require_valid(const T& value) {
  const Result<void> result = validate(value);
  ARTUS_REQUIRE(result.has_value(), result.error().to_string());
  return value;
}

}  // namespace artus
