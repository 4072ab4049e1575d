// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <string>
#include <vector>

#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/surfacing.h"

namespace artus {

/// Where a round part (a shaft, a nerve, a vessel, a belly) passes: x, y, z and radius, mm.
using RodStation = std::array<double, 4>;

/// Where a flat part (a tendon, a ligament, a sheet) passes: x, y, z, half width, half thickness,
/// mm.
using StrapStation = std::array<double, 5>;

/// A round tube through the stations. Requires: at least two.
[[nodiscard]] Field make_rod(const Millimetres& mm, const std::vector<RodStation>& stations);

/// A flat band through the stations, its thickness along `normal`; it keeps its thickness toward
/// its edges. Requires: at least two stations.
[[nodiscard]] Field make_strap(const Millimetres& mm, const Vec3& normal,
                               const std::vector<StrapStation>& stations);

/// The same as parts to be written, triangles as fine as their thickness needs; the second station
/// lies well inside.
[[nodiscard]] Solid make_rod_part(std::string name, const Millimetres& mm,
                                  const std::vector<RodStation>& stations);
[[nodiscard]] Solid make_strap_part(std::string name, const Millimetres& mm, const Vec3& normal,
                                    const std::vector<StrapStation>& stations);

/// What lies between `begin` and `end` outside of `inner`, within `outline`; its rim thins out.
[[nodiscard]] Field make_layer(const Field& inner, double begin, double end, const Field& outline);

/// The first point from `from` along `direction` that lies `distance` outside of `field`.
/// Requires: there is one within 0.2 m.
[[nodiscard]] Vec3 find_outside(const Field& field, const Vec3& from, const Vec3& direction,
                                double distance);

/// Puts `parts` behind what is there.
void append(std::vector<Solid>& solids, std::vector<Solid> parts);

}  // namespace artus
