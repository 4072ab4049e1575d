// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include <nlohmann/json_fwd.hpp>

namespace artus {

/// What a claim that holds is worth.
enum class ClaimKind : std::uint8_t {
  input,       ///< the number was put in, or the code is written to keep it: the machinery works
  fitted,      ///< a parameter or the bound was chosen with the answer in view
  independent  ///< neither: only these are evidence
};
[[nodiscard]] const char* to_string(ClaimKind kind) noexcept;

/// A claim's kind, and what makes it so: what was put in, or what was chosen by which answer.
struct ClaimBasis {
  // NOLINTNEXTLINE(google-explicit-constructor): a kind alone is a basis.
  ClaimBasis(ClaimKind of, std::string because = {}) : kind(of), why(std::move(because)) {}
  ClaimKind kind;
  std::string why;
};

/// One line of a "must show" list: what was measured and whether it holds.
struct Claim {
  std::string text;
  double value = 0;
  std::string bound;  ///< in words and figures: "<= 0.055 s"
  bool pass = false;
  ClaimBasis basis;
};

[[nodiscard]] Claim claim_at_most(ClaimBasis basis, std::string text, double value, double limit,
                                  const std::string& unit);
[[nodiscard]] Claim claim_at_least(ClaimBasis basis, std::string text, double value, double limit,
                                   const std::string& unit);
/// |value - expected| <= share * |expected|.
[[nodiscard]] Claim claim_near(ClaimBasis basis, std::string text, double value, double expected,
                               double share, const std::string& unit);
/// |value - expected| <= tolerance, both in `unit`.
[[nodiscard]] Claim claim_within(ClaimBasis basis, std::string text, double value, double expected,
                                 double tolerance, const std::string& unit);
/// Something without a measure: 1 when it is so, 0 when not.
[[nodiscard]] Claim claim_that(ClaimBasis basis, std::string text, bool holds);

[[nodiscard]] bool all_hold(std::span<const Claim> claims) noexcept;

/// "31 independent hold, 2 fail; 40 fitted; 60 inputs checked"; fitted ones and inputs that fail
/// are said apart.
[[nodiscard]] std::string count_claims(std::span<const Claim> claims);

/// Nothing, or a sentence that says what claims are worth when none is independent: that they hold
/// is no evidence.
[[nodiscard]] std::string tell_lack_of_evidence(std::span<const Claim> claims);

/// "FAILS  independent  ejection: 0.34 (<= 0.2 mm)"
[[nodiscard]] std::string to_line(const Claim& claim);

/// A Markdown table, a row for each claim, and their count.
[[nodiscard]] std::string to_markdown(std::span<const Claim> claims);

/// {"pass": all, "counts": {kind: {hold, fail}}, "claims": [{claim, value, bound, pass, kind,
/// why}]}
[[nodiscard]] nlohmann::json verdict(std::span<const Claim> claims);

}  // namespace artus
