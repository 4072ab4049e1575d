// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "artus/raycast/scene.h"

namespace artus {

/// A body of one region, "inside", from a closed surface wound outward: what any query of a Scene
/// then says about inside, entry and distance. Requires: indices in range, finite vertices.
[[nodiscard]] std::shared_ptr<const Scene> make_closed_body(
    std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles,
    const std::string& name);

/// One region of a joint as a body of its own, whose signed distance is that of the structure.
/// Empty when the region has no interface.
[[nodiscard]] std::shared_ptr<const Scene> make_region_body(const CompiledJoint& joint,
                                                            RegionId region);

/// m behind the tip within which a needle's entry is looked for.
inline constexpr double kEntryReach = 0.3;

/// Where the line from the tip back along the needle first leaves the body: the needle's entry.
/// Empty when it does not within kEntryReach. `axis`: unit, hub to tip.
[[nodiscard]] std::optional<Vec3> find_entry(const Scene& scene, const Vec3& tip,
                                             const Vec3& axis) noexcept;

/// The region that a needle's tip is in. Where the body is not meshed, "beyond" says no more than
/// that its cut is the nearest surface: a tip whose line back crosses no skin is outside.
[[nodiscard]] RegionId region_of_tip(const Scene& scene, const Vec3& tip,
                                     const Vec3& axis) noexcept;

}  // namespace artus
