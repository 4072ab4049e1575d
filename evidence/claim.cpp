// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/claim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/printed.h"

namespace artus {
namespace {

constexpr std::array<ClaimKind, 3> kKinds{ClaimKind::independent, ClaimKind::fitted,
                                          ClaimKind::input};

std::string with_unit(double value, const std::string& unit) {
  return to_csv(value) + (unit.empty() ? "" : " " + unit);
}

std::string in_short(double value) {
  return printed("%.4g", value);
}

std::ptrdiff_t count(std::span<const Claim> claims, ClaimKind kind, bool pass) {
  return std::count_if(claims.begin(), claims.end(), [kind, pass](const Claim& c) {
    return c.basis.kind == kind && c.pass == pass;
  });
}

}  // namespace

const char* to_string(ClaimKind kind) noexcept {
  switch (kind) {
    case ClaimKind::input:
      return "input";
    case ClaimKind::fitted:
      return "fitted";
    case ClaimKind::independent:
      return "independent";
  }
  return "";
}

Claim claim_at_most(ClaimBasis basis, std::string text, double value, double limit,
                    const std::string& unit) {
  return {std::move(text), value, "<= " + with_unit(limit, unit), value <= limit, std::move(basis)};
}

Claim claim_at_least(ClaimBasis basis, std::string text, double value, double limit,
                     const std::string& unit) {
  return {std::move(text), value, ">= " + with_unit(limit, unit), value >= limit, std::move(basis)};
}

Claim claim_near(ClaimBasis basis, std::string text, double value, double expected, double share,
                 const std::string& unit) {
  return {std::move(text), value, with_unit(expected, unit) + " +- " + to_csv(100 * share) + " %",
          std::abs(value - expected) <= share * std::abs(expected), std::move(basis)};
}

Claim claim_within(ClaimBasis basis, std::string text, double value, double expected,
                   double tolerance, const std::string& unit) {
  return {std::move(text), value, to_csv(expected) + " +- " + with_unit(tolerance, unit),
          std::abs(value - expected) <= tolerance, std::move(basis)};
}

Claim claim_that(ClaimBasis basis, std::string text, bool holds) {
  return {std::move(text), holds ? 1.0 : 0.0, "1 (yes)", holds, std::move(basis)};
}

bool all_hold(std::span<const Claim> claims) noexcept {
  return std::all_of(claims.begin(), claims.end(), [](const Claim& c) { return c.pass; });
}

std::string count_claims(std::span<const Claim> claims) {
  const auto number = [claims](ClaimKind kind, bool pass) {
    return std::to_string(count(claims, kind, pass));
  };
  const auto others = [claims](ClaimKind kind, const char* what) {
    const auto failed = count(claims, kind, false);
    std::string text = std::to_string(count(claims, kind, true) + failed) + what;
    if (failed > 0) text += " (" + std::to_string(failed) + (failed == 1 ? " fails)" : " fail)");
    return text;
  };
  return number(ClaimKind::independent, true) + " independent hold, " +
         number(ClaimKind::independent, false) + " fail; " + others(ClaimKind::fitted, " fitted") +
         "; " + others(ClaimKind::input, " inputs checked");
}

std::string tell_lack_of_evidence(std::span<const Claim> claims) {
  const bool has_evidence = std::any_of(claims.begin(), claims.end(), [](const Claim& c) {
    return c.basis.kind == ClaimKind::independent;
  });
  if (has_evidence) return {};
  return "no claim is independent: that they hold shows that what was put in comes out, and is no "
         "evidence that the joint is right";
}

std::string to_line(const Claim& claim) {
  return std::string(claim.pass ? "holds" : "FAILS") + "  " + to_string(claim.basis.kind) + "  " +
         claim.text + ": " + in_short(claim.value) + " (" + claim.bound + ")";
}

std::string to_markdown(std::span<const Claim> claims) {
  std::string table = "| claim | value | bound | kind | holds |\n|---|---|---|---|---|\n";
  for (const Claim& c : claims) {
    table += "| " + c.text + " | " + in_short(c.value) + " | " + c.bound + " | " +
             to_string(c.basis.kind) + (c.basis.why.empty() ? "" : ": " + c.basis.why) + " | " +
             (c.pass ? "yes" : "**no**") + " |\n";
  }
  return table + "\n" + count_claims(claims) + ".\n";
}

nlohmann::json verdict(std::span<const Claim> claims) {
  nlohmann::json list = nlohmann::json::array();
  for (const Claim& c : claims) {
    list.push_back({{"claim", c.text},
                    {"value", c.value},
                    {"bound", c.bound},
                    {"pass", c.pass},
                    {"kind", to_string(c.basis.kind)},
                    {"why", c.basis.why}});
  }
  nlohmann::json counts;
  for (const ClaimKind kind : kKinds)
    counts[to_string(kind)] = {{"hold", count(claims, kind, true)},
                               {"fail", count(claims, kind, false)}};
  nlohmann::json all{{"pass", all_hold(claims)}, {"counts", counts}, {"claims", list}};
  if (const std::string lack = tell_lack_of_evidence(claims); !lack.empty()) all["evidence"] = lack;
  return all;
}

}  // namespace artus
