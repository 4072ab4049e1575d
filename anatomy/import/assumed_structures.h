// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/imported_joint.h"

namespace artus {

/// What can be asked for where a segmentation does not have it.
inline constexpr std::array<std::string_view, 3> kAssumable{"cartilage", "recess", "tendons"};

/// Adds what `options.assume` and `options.bursa` ask for, as constructs of joint.toml that are
/// told as assumed:
/// - cartilage: 1.5 mm on each bone where another one is within 8 mm, where none was segmented;
/// - recess: 1 mm between the two bones that make the joint and what cartilage they have;
/// - tendons: the end of each muscle within 20 mm of where it meets its nearest bone, for muscles
///   within 5 mm of one that have no segmented tendon;
/// - bursa: 1.5 mm between two structures.
/// Recess and bursa reach 40 mm around where their walls are nearest.
/// Bones and segmented cartilage stand before all of it and keep their shape; the soft walls of a
/// bursa stand after it. All lengths are assumed. Errors: invalid (something else is asked for),
/// not_found (a name; no two bones for a recess; nothing that could be made).
[[nodiscard]] Result<void> add_assumed(ImportedJoint& joint, const ImportOptions& options);

}  // namespace artus
