// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <string>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/viewer/words/translation.h"
#include "artus/raycast/scene.h"

namespace artus {

/// What a clinician calls a structure or tissue of a joint file ("subacromial_bursa"): its name
/// without underlines, in French as far as po/anatomy.fr.po goes.
[[nodiscard]] std::string clinical_name(Language language, const std::string& name);
/// The same; empty when the language has no name for it.
[[nodiscard]] std::optional<std::string> known_name(Language language, const std::string& name);

/// The name of the k-th stretch of a line through the body. What fills the room between the
/// structures is named by where it lies: under the skin, around a bursa, or between the muscles.
[[nodiscard]] std::string layer_name(Language language, const CompiledJoint& joint,
                                     std::span<const TissueInterval> line, std::size_t k);

}  // namespace artus
