// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/knee.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

const Vec3 kForward(0, -1, 0);

// Across (medial), upward, forward: how a cushion lies before the femur.
Eigen::Matrix3d before_femur() {
  Eigen::Matrix3d axes;
  axes << Vec3::UnitX(), Vec3::UnitZ(), kForward;
  return axes;
}

// What the fat pads and the recess lie on: the femur's front without its fine shape.
Field make_front_of_femur(const Millimetres& mm) {
  return make_ribbon({{mm.at(-1, -6, 20), kForward, mm.length(28), mm.length(19)},
                      {mm.at(0, -4, 36), kForward, mm.length(27), mm.length(18)},
                      {mm.at(0, -3, 52), kForward, mm.length(22), mm.length(17)},
                      {mm.at(0, -4, 72), kForward, mm.length(17), mm.length(15)},
                      {mm.at(0, -4, 120), kForward, mm.length(15), mm.length(14)}});
}

// Fluid between the fat before the femur and the fat behind the tendon, 5 cm wide, down to the
// patella's cartilage; fluid gathers beside the midline [Schmidt2004].
Field make_recess(const Millimetres& mm, const KneeSize& size) {
  return make_cushion(make_front_of_femur(mm), mm.length(8.2), mm.at(-1, -33, 49),
                      Vec3(mm.length(27), mm.length(25), 0.5 * size.recess), before_femur());
}

Field make_prefemoral_fat(const Millimetres& mm) {
  return make_cushion(make_front_of_femur(mm), mm.length(3.5), mm.at(0, -26, 52),
                      mm.at(21, 25, 6.5), before_femur());
}

// Fills the corner between tendon, patella and recess.
Field make_quadriceps_fat(const Millimetres& mm) {
  return make_ribbon({{mm.at(-1, -37, 31), kForward, mm.length(20), mm.length(8)},
                      {mm.at(-1, -37, 42), kForward, mm.length(20), mm.length(8)},
                      {mm.at(-1, -36.5, 54), kForward, mm.length(16), mm.length(6)},
                      {mm.at(-1, -36, 68), kForward, mm.length(9), mm.length(1.5)}},
                     2.2);
}

// Behind the patellar tendon, between patella, trochlea and tibia.
Field make_hoffa_fat(const Millimetres& mm) {
  return unite(make_ellipsoid(mm.at(-1, -33, -9), mm.at(27, 15, 17)),
               make_ellipsoid(mm.at(-1, -30, -26), mm.at(18, 11, 17)), mm.length(8));
}

Field make_quadriceps_tendon(const Millimetres& mm, const KneeSize& size) {
  const double half = 0.5 * size.quadriceps_tendon;
  const auto flat = [&](double y, double z, double half_width, double share) {
    return RibbonStation{mm.at(-1, y, z), kForward, mm.length(half_width), share * half};
  };
  // Over the patella it runs on as a thin sheet into the patellar tendon.
  return make_ribbon(
      {flat(-51, 10, 10, 0.16), flat(-50.6, 22, 14, 0.2), flat(-48.4, 30, 16, 0.7),
       flat(-46.4, 36, 17, 1), flat(-44.8, 46, 16.5, 1), flat(-43.4, 58, 16, 0.95),
       flat(-42.6, 70, 15, 0.7), flat(-42.4, 84, 12, 0.35), flat(-42.6, 102, 8, 0.1)},
      2.4);
}

Field make_patellar_tendon(const Millimetres& mm, const KneeSize& size) {
  const double half = 0.5 * size.patellar_tendon;
  const auto flat = [&](double y, double z, double half_width, double share) {
    return RibbonStation{mm.at(-1, y, z), Vec3(0, -1, 0.25), mm.length(half_width), share * half};
  };
  return make_ribbon({flat(-50.6, 12, 11, 0.3), flat(-49.6, 5, 13, 0.8), flat(-47.6, -4, 13.2, 1),
                      flat(-44, -18, 12.6, 1), flat(-39, -32, 12, 1), flat(-34, -45, 11.5, 0.95),
                      flat(-31.3, -54, 11, 0.5), flat(-29.5, -64, 9, 0.1)},
                     2.4);
}

std::vector<Solid> make_ligaments(const Millimetres& mm) {
  const auto medial = [&](double x, double y, double z, double width, double half) {
    return RibbonStation{mm.at(x, y, z), Vec3::UnitX(), mm.length(width), mm.length(half)};
  };
  const Field mcl = make_ribbon(
      {medial(38.6, 2.5, 22, 5, 0.3), medial(40.2, 2, 15, 6, 1.3), medial(41.2, 1, 2, 6.5, 1.5),
       medial(40.4, 0, -16, 7, 1.5), medial(36.6, -1, -34, 7, 1.4), medial(28, -3, -56, 6.5, 1.2),
       medial(19, -4, -80, 5, 0.4)},
      2.4);
  const Field lcl = make_tube({{mm.at(-38, 2, 17), mm.length(0.6)},
                               {mm.at(-40.4, 4, 11), mm.length(2)},
                               {mm.at(-41.8, 9, -8), mm.length(2)},
                               {mm.at(-41.6, 14, -26), mm.length(2)},
                               {mm.at(-41, 16, -36), mm.length(1.2)}});
  const auto band = [&](double x, double y, double z, double width, double half) {
    return RibbonStation{mm.at(x, y, z), Vec3(-1, -0.45, 0), mm.length(width), mm.length(half)};
  };
  const Field iliotibial =
      make_ribbon({band(-50, -2, 110, 14, 0.7), band(-46, -4, 60, 12, 0.8), band(-43, -6, 24, 9, 1),
                   band(-40.5, -10, -2, 7.5, 1.1), band(-34.5, -14, -22, 6.5, 1.2),
                   band(-30, -16.5, -34, 5, 0.4)},
                  2.4);
  const double reach = mm.length(200);
  return {{"medial_collateral_ligament", mcl, mm.at(41.2, 1, 2), reach, 1.8e-3, 0.08e-3},
          {"lateral_collateral_ligament", lcl, mm.at(-41.8, 9, -8), reach, 1.6e-3, 0.08e-3},
          {"iliotibial_band", iliotibial, mm.at(-43, -6, 24), reach, 2.2e-3, 0.1e-3}};
}

}  // namespace

std::vector<Solid> make_knee_soft_tissue(const KneeSize& size) {
  const Millimetres mm = Millimetres::of_scale(size.scale);
  const double reach = mm.length(220);
  // The first point before the femur that lies inside of what lies on it.
  const auto before = [&](const Field& field, double x, double z) {
    Vec3 p = mm.at(x, -10, z);
    while (field(p) > -0.4e-3 && p.y() > mm.at(0, -70, 0).y()) p.y() -= 0.05e-3;
    return p;
  };
  const Field recess = make_recess(mm, size);
  const Field prefemoral = make_prefemoral_fat(mm);
  std::vector<Solid> solids{
      {"suprapatellar_recess", recess, before(recess, -1, 49), reach, 1.8e-3, 0.06e-3},
      {"quadriceps_tendon", make_quadriceps_tendon(mm, size), mm.at(-1, -44.8, 46), reach, 2e-3,
       0.06e-3},
      {"patellar_tendon", make_patellar_tendon(mm, size), mm.at(-1, -44, -18), reach, 1.8e-3,
       0.06e-3},
      {"prefemoral_fat_pad", prefemoral, before(prefemoral, 0, 52), reach, 2.6e-3, 0.1e-3},
      {"quadriceps_fat_pad", make_quadriceps_fat(mm), mm.at(-1, -38.5, 42), reach, 2.2e-3, 0.1e-3},
      {"infrapatellar_fat_pad", make_hoffa_fat(mm), mm.at(-1, -35, -9), reach, 3e-3, 0.12e-3}};
  for (Solid& s : make_ligaments(mm)) solids.push_back(std::move(s));
  return solids;
}

}  // namespace artus
