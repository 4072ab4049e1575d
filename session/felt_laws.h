// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "artus/core/result.h"
#include "artus/session/session_core.h"

namespace artus {

/// What the needle of a session is felt by, as far as a user can choose it: with these and the
/// inputs a replay gives the same forces.
struct FeltLaws {
  LawSelection laws;
  PatientProfile patient;
  HardLaw tap = HardLaw::decaying_sinusoid;
  ClampingLaw clamping = ClampingLaw::projection;
  LugreParams friction;
  bool use_workspace = false;
  HemisphereParams workspace;
  PassivityParams passivity;
};
[[nodiscard]] FeltLaws felt_laws_of(const SessionParams& params);
void apply(const FeltLaws& felt, SessionParams& params);

[[nodiscard]] nlohmann::json to_json(const FeltLaws& felt);
/// Errors: not_found for a law of another name. Throws nlohmann::json::exception where a member is
/// missing or of another type.
[[nodiscard]] Result<FeltLaws> to_felt_laws(const nlohmann::json& json);

}  // namespace artus
