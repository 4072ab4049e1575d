// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/result.h"
#include "artus/detail/soft/solver/face_contact.h"
#include "artus/echo/transducer.h"

namespace artus {

/// The face with which a probe presses on tissue: as long as its row of scanlines, 6 mm wide, a
/// piece every 2.5 mm. Errors: unsupported (a curved face: contact knows flat ones alone).
[[nodiscard]] Result<ProbeFace> pressing_face(const Transducer& transducer);

}  // namespace artus
