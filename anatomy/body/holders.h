// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/anatomy/compiled_joint.h"

namespace artus {

/// What keeps a body's tissue from going away as a whole when something pushes it.
struct Holders {
  std::vector<std::string> bones;  ///< names of what is hard
  bool cut_faces = false;          ///< where the region of interest or a cut ends the body
  [[nodiscard]] bool any() const noexcept { return cut_faces || !bones.empty(); }
};

/// Those of a compiled joint: a bone counts when some of it is there. Cost: of a walk over all
/// tetrahedra and interfaces.
[[nodiscard]] Holders find_holders(const CompiledJoint& joint);

/// "the tissue is held by bone (humerus, scapula) and by the faces where the body is cut".
[[nodiscard]] std::string describe(const Holders& holders);

/// Why a body without holders is refused, and what to do.
[[nodiscard]] std::string explain_unheld();

}  // namespace artus
