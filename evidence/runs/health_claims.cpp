// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/health_claims.h"

namespace artus {

std::vector<Claim> claims_of(const BodyHealth& health, const std::string& state) {
  std::vector<Claim> claims;
  for (const HealthMeasure& m : health.measures) {
    if (!m.value) continue;
    ClaimBasis basis(ClaimKind::independent);
    if (m.key == "volume_error_percent")
      basis = {ClaimKind::input, "the shapes are scaled to the volumes"};
    std::string text = state + ": " + m.name;
    if (!m.holds() && !m.where.empty()) text += " (" + m.where + ")";
    claims.push_back(claim_at_most(basis, std::move(text), *m.value, m.limit, m.unit));
  }
  return claims;
}

}  // namespace artus
