// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/knee.h"

#include <string>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

// The skin: close to bone over patella, tuberosity and the sides of the joint, with a cushion of
// fat in the hollow behind it; wider with the muscles of thigh and calf.
Field make_knee_body(const Millimetres& mm) {
  const Field leg = make_tube({{mm.at(0, 1, 170), mm.length(67)},
                               {mm.at(0, 1, 100), mm.length(63)},
                               {mm.at(0, 0, 66), mm.length(59)},
                               {mm.at(0, 0, 36), mm.length(54)},
                               {mm.at(0, 1, 10), mm.length(51)},
                               {mm.at(0, 3, -20), mm.length(49)},
                               {mm.at(0, 7, -50), mm.length(48)},
                               {mm.at(0, 9, -90), mm.length(50)},
                               {mm.at(0, 9, -150), mm.length(50)}});
  const Field knee_cap = make_ellipsoid(mm.at(-1, -34, 14), mm.at(27, 22.5, 27));
  const Field below = make_ellipsoid(mm.at(-1, -27, -14), mm.at(24, 24, 38));
  return unite(leg, unite(knee_cap, below, mm.length(10)), mm.length(14));
}

// Along the back of the knee: `radius` at the level of the joint, where the vessels lie between
// the heads of the gastrocnemius.
Solid make_line(std::string name, const Millimetres& mm, double x, double y, double radius) {
  const double r = mm.length(radius);
  return {std::move(name),
          make_tube({{mm.at(x + 5, y - 3, 120), r},
                     {mm.at(x + 1.5, y - 1, 50), r},
                     {mm.at(x, y, 15), r},
                     {mm.at(x - 0.5, y - 0.5, -20), r},
                     {mm.at(x - 2, y - 3, -100), r}}),
          mm.at(x, y, 15),
          mm.length(190),
          r,
          0.05 * r};
}

}  // namespace

std::vector<Solid> make_knee(const KneeSize& size) {
  ARTUS_REQUIRE(size.scale > 0 && size.cartilage > 0 && size.recess > 0 &&
                    size.patellar_tendon > 0 && size.quadriceps_tendon > 0,
                "every size must be positive");
  const Millimetres mm = Millimetres::of_scale(size.scale);
  std::vector<Solid> solids{
      {"body", make_knee_body(mm), Vec3::Zero(), mm.length(420), 6e-3, 0.2e-3}};
  for (auto parts : {make_knee_bones(size), make_knee_soft_tissue(size), make_knee_muscles(size),
                     make_knee_variants(size)})
    for (Solid& s : parts) solids.push_back(std::move(s));
  solids.push_back(make_line("popliteal_artery", mm, 0, 33.5, 2.7));
  solids.push_back(make_line("popliteal_vein", mm, -2.5, 40.5, 3.8));
  solids.push_back(make_line("tibial_nerve", mm, -5, 46.5, 2.3));
  return solids;
}

}  // namespace artus
