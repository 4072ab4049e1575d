// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace artus {

/// One line of a "must show" list: what was measured and whether it holds.
struct Claim {
  std::string text;
  double value = 0;
  std::string bound;  ///< in words and figures: "<= 0.055 s"
  bool pass = false;
};

[[nodiscard]] Claim claim_at_most(std::string text, double value, double limit,
                                  const std::string& unit);
[[nodiscard]] Claim claim_at_least(std::string text, double value, double limit,
                                   const std::string& unit);
/// |value - expected| <= share * |expected|.
[[nodiscard]] Claim claim_near(std::string text, double value, double expected, double share,
                               const std::string& unit);

/// |value - expected| <= tolerance, both in `unit`.
[[nodiscard]] Claim claim_within(std::string text, double value, double expected, double tolerance,
                                 const std::string& unit);

/// A Markdown table, a row for each claim.
[[nodiscard]] std::string to_markdown(const std::vector<Claim>& claims);

/// {"pass": all, "claims": [{claim, value, bound, pass}]}
[[nodiscard]] nlohmann::json verdict(const std::vector<Claim>& claims);

}  // namespace artus
