// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/hip.h"

#include <array>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

Field make_limb(const Millimetres& mm, const std::vector<std::array<double, 4>>& stations) {
  std::vector<TubeStation> out;
  for (const auto& s : stations) out.push_back({mm.at(s[0], s[1], s[2]), mm.length(s[3])});
  return make_tube(out);
}

// The skin: thin fat over the groin, more over the side and most behind.
Field make_hip_body(const Millimetres& mm) {
  const Field thigh =
      make_limb(mm, {{-12, 8, 40, 72}, {-15, 7, 0, 72}, {-17, 5, -50, 70}, {-20, 4, -150, 66}});
  const Field groin = make_limb(mm, {{30, 8, 45, 70}, {30, 9, -20, 69}});
  const Field seat = make_ellipsoid(mm.at(-2, 40, 0), mm.at(84, 52, 90));
  const Field trunk = make_ellipsoid(mm.at(45, 18, 80), mm.at(112, 86, 95));
  return unite(unite(unite(thigh, groin, mm.length(20)), seat, mm.length(30)), trunk,
               mm.length(30));
}

// Down the groin before the medial third of the head, and back toward the thigh's inner side.
std::vector<Vec3> femoral_course(const Millimetres& mm, double x, double y) {
  return {mm.at(x - 2, y + 5, 80), mm.at(x - 2, y + 2, 50), mm.at(x, y, 10),
          mm.at(x - 1, y + 2, -30), mm.at(x - 3, y + 8, -90)};
}

Solid make_vessel(const char* name, const Millimetres& mm, double x, double y, double radius) {
  const double r = mm.length(radius);
  std::vector<TubeStation> stations;
  for (const Vec3& p : femoral_course(mm, x, y)) stations.push_back({p, r});
  return {name, make_tube(stations), mm.at(x, y, 10), mm.length(160), r, 0.05 * r};
}

// Flat on the iliopsoas, 3.1 by 9.8 mm [Gruber2003].
Solid make_femoral_nerve(const Millimetres& mm) {
  std::vector<RibbonStation> stations;
  for (const Vec3& p : femoral_course(mm, 10.5, -50.5))
    stations.push_back({p, Vec3(-0.15, -1, 0), mm.length(4.9), mm.length(1.55)});
  return {"femoral_nerve", make_ribbon(stations), mm.at(10.5, -50.5, 10), mm.length(160), 2.2e-3,
          0.08e-3};
}

}  // namespace

std::vector<Solid> make_hip(const HipSize& size) {
  ARTUS_REQUIRE(size.head_radius > 0 && size.cartilage > 0 && size.recess > 0 && size.capsule > 0,
                "every size must be positive");
  const Millimetres mm(size.head_radius);
  std::vector<Solid> solids{
      {"body", make_hip_body(mm), Vec3::Zero(), mm.length(480), 6e-3, 0.2e-3}};
  for (auto parts : {make_hip_bones(size), make_hip_capsule(size), make_hip_muscles(size),
                     make_hip_variants(size)})
    for (Solid& s : parts) solids.push_back(std::move(s));
  solids.push_back(make_femoral_nerve(mm));
  solids.push_back(make_vessel("femoral_artery", mm, 22, -50, 4.2));
  solids.push_back(make_vessel("femoral_vein", mm, 33, -48, 4.8));
  return solids;
}

}  // namespace artus
