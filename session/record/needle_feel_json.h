// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "artus/core/result.h"
#include "artus/haptics/needle_feel.h"

namespace artus {

/// A choice of feel as recordings keep it; what is not set is left out.
[[nodiscard]] nlohmann::json to_json(const NeedleFeel& feel);
/// Errors: not_found (a law of another name), invalid (a value, as by validate). Throws
/// nlohmann::json::exception where a member is missing or of another type.
[[nodiscard]] Result<NeedleFeel> to_needle_feel(const nlohmann::json& json);

}  // namespace artus
