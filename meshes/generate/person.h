// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/solids/surfacing.h"

namespace artus {

/// The skin of a whole person around the bundled joints, for sight alone: `sitting` with the
/// forearms forward and the palms up, in the frame of the shoulder; `lying` with straight legs, in
/// that of the hip. At the right joints it is their own skin of the usual size; segments are as
/// long as those of a person of 1.7 m [Drillis1966], their thickness is assumed. LPS, m.
[[nodiscard]] std::vector<Solid> make_person();

}  // namespace artus
