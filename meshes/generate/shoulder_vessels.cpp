// SPDX-License-Identifier: AGPL-3.0-or-later
#include <string>
#include <utility>

#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

Solid make_line(std::string name, const std::vector<Vec3>& course, double radius) {
  std::vector<TubeStation> stations;
  stations.reserve(course.size());
  for (const Vec3& p : course) stations.push_back({p, radius});
  return {std::move(name), make_tube(stations), course.at(1), 0.3, radius, 0.05 * radius};
}

// From the axilla through the quadrangular space around the surgical neck to the deep face of the
// anterior deltoid, `drop` mm below the nerve.
std::vector<Vec3> quadrangular_course(const Millimetres& mm, double drop) {
  return {mm.at(40, -14, -22 - drop),   mm.at(24, 4, -36 - drop),       mm.at(9, 16, -40 - drop),
          mm.at(-10, 18.5, -41 - drop), mm.at(-23.5, 13.5, -39 - drop), mm.at(-29, 0, -37 - drop),
          mm.at(-25.5, -11, -36 - drop)};
}

}  // namespace

std::vector<Solid> make_shoulder_vessels(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  return {make_line("axillary_nerve", quadrangular_course(mm, 0), mm.length(1.4)),
          make_line("circumflex_artery", quadrangular_course(mm, 4.2), mm.length(1.7)),
          make_line("circumflex_vein", quadrangular_course(mm, 8.6), mm.length(2.0)),
          make_line("suprascapular_nerve",
                    {mm.at(60, -4, 34), mm.at(54, 12, 22), mm.at(50, 24, 11), mm.at(47, 33, 7),
                     mm.at(46, 38, -4), mm.at(54, 42, -16)},
                    mm.length(1.3))};
}

}  // namespace artus
