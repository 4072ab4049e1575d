// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "artus/detail/meshes/generate/knee.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

// Both condyles are nearly balls, below and behind [BasicCircle]; the medial is longer. Before
// them two ridges carry the patella, the lateral one higher, with the groove's floor between them.
Field make_condyles(const Millimetres& mm) {
  const Field medial = unite(make_ball(mm.at(19, 8, 7.5), mm.length(20)),
                             make_ball(mm.at(18.6, 1, 8.5), mm.length(20.6)), mm.length(6));
  const Field lateral = unite(make_ball(mm.at(-19.3, 8, 7.5), mm.length(19.7)),
                              make_ball(mm.at(-19.5, -1, 8.5), mm.length(20.5)), mm.length(6));
  const Field medial_ridge = make_tube({{mm.at(14, -12, 27), mm.length(12)},
                                        {mm.at(16.5, -14, 17), mm.length(14)},
                                        {mm.at(18, -8, 9), mm.length(19)}});
  const Field lateral_ridge = make_tube({{mm.at(-15, -14, 30), mm.length(12.5)},
                                         {mm.at(-17.5, -16, 18), mm.length(14.5)},
                                         {mm.at(-18.5, -9, 9), mm.length(19)}});
  const Field floor = make_tube({{mm.at(-1, -8, 30), mm.length(13.2)},
                                 {mm.at(-1, -8.5, 18), mm.length(14)},
                                 {mm.at(-0.5, -6, 12), mm.length(14)}});
  const Field trochlea = unite(unite(medial_ridge, lateral_ridge, 0), floor, mm.length(7));
  return unite(unite(medial, lateral, mm.length(4)), trochlea, mm.length(8));
}

// Twice as wide as deep above the trochlea, where it flares to the epicondyles.
Field make_femoral_shaft(const Millimetres& mm) {
  const Vec3 front(0, -1, 0);
  return make_ribbon({{mm.at(0, 0, 18), front, mm.length(35), mm.length(19)},
                      {mm.at(0, -1, 32), front, mm.length(29), mm.length(18.5)},
                      {mm.at(0, -2.5, 48), front, mm.length(22), mm.length(17)},
                      {mm.at(0, -4, 70), front, mm.length(16.5), mm.length(15)},
                      {mm.at(0, -4, 130), front, mm.length(14), mm.length(14)}},
                     2.4);
}

Field make_tibia(const Millimetres& mm) {
  const Vec3 up = Vec3::UnitZ();
  const Field plateau = make_ribbon({{mm.at(-20, 4, -27.5), up, mm.length(20), mm.length(9.5)},
                                     {mm.at(0, 3, -28), up, mm.length(22), mm.length(9.5)},
                                     {mm.at(20, 3, -27.5), up, mm.length(25), mm.length(9.5)}},
                                    3);
  const Field sides = unite(make_ball(mm.at(-22, 4, -28), mm.length(16.5)),
                            make_ball(mm.at(22, 3, -28), mm.length(16.5)), mm.length(3));
  const Field top = make_half_space(mm.at(0, 0, -18), up);
  const Field shaft = make_tube({{mm.at(0, 3, -44), mm.length(22)},
                                 {mm.at(1, 1, -64), mm.length(17)},
                                 {mm.at(2, -1, -84), mm.length(14)},
                                 {mm.at(3, -2, -130), mm.length(12.5)}});
  const Field tuberosity = make_tube({{mm.at(-1, -22, -44), mm.length(8)},
                                      {mm.at(-1, -22.5, -55), mm.length(8.5)},
                                      {mm.at(0, -14, -75), mm.length(8)}});
  const Field head = intersect(unite(plateau, sides, mm.length(6)), top, mm.length(4));
  const Field spine =
      make_tube({{mm.at(4, 4, -22), mm.length(6)}, {mm.at(-4, 4, -22), mm.length(5.5)}});
  return unite(unite(unite(head, spine, mm.length(4)), shaft, mm.length(12)), tuberosity,
               mm.length(7));
}

// A rounded triangle with its apex below; behind, two facets meet in a ridge, the lateral wider.
Field make_patella(const Millimetres& mm) {
  const Field upper = make_ellipsoid(mm.at(-0.5, -41, 21), mm.at(23.5, 11, 16));
  const Field apex = make_ellipsoid(mm.at(-0.5, -44.5, 9), mm.at(11, 6, 12));
  const Field shield = unite(upper, apex, mm.length(9));
  const Vec3 ridge = mm.at(-1, -32.6, 20);
  const Field lateral = make_half_space(ridge, Vec3(-0.36, 1, 0));
  const Field medial = make_half_space(ridge, Vec3(0.46, 1, 0));
  const Field facets = intersect(lateral, medial, mm.length(2));
  const Field front = make_half_space(mm.at(0, -51, 18), Vec3(0, -1, 0));
  return intersect(intersect(shield, facets, mm.length(3)), front, mm.length(4));
}

// A C around the middle of a plateau, open toward the other; condyle and plateau make a wedge of
// it.
Field make_meniscus(const Millimetres& mm, double side, double forward) {
  std::vector<TubeStation> stations;
  constexpr int kStations = 11;
  for (int i = 0; i < kStations; ++i) {
    const double angle = (-135 + 27.0 * i) * std::numbers::pi / 180;
    stations.push_back({mm.at(side * (20 + 12.8 * std::cos(angle)),
                              forward + (side > 0 ? 17.5 : 15) * std::sin(angle), -11.6),
                        mm.length(5)});
  }
  return make_tube(stations);
}

// On bone, thicker by `more` where it is thickest and within `reach` of there.
Field make_coat(const Field& bone, double thickness, double more, const Vec3& thickest,
                double reach) {
  const Field outer = [=](const Vec3& p) {
    const double near = (p - thickest).squaredNorm() / (reach * reach);
    return bone(p) - thickness - more * std::exp(-near);
  };
  return subtract(outer, grow(bone, -1e-3), 0.3e-3);
}

// Cartilage on the femur, thickest in the groove of the trochlea.
Field make_femoral_cartilage(const Millimetres& mm, const KneeSize& size) {
  const Field coat =
      make_coat(make_condyles(mm), size.cartilage, 1.1e-3, mm.at(-1, -25, 16), mm.length(15));
  const Field below = make_half_space(mm.at(0, -26, 31), Vec3(0, 0.3, 1));
  const Field medial = make_half_space(mm.at(35, 0, 0), Vec3(1, 0, 0.25));
  const Field lateral = make_half_space(mm.at(-35, 0, 0), Vec3(-1, 0, 0.25));
  return intersect(intersect(coat, below, 2e-3), intersect(medial, lateral, 0), 2e-3);
}

// On both facets, thickest at the ridge between them.
Field make_patellar_cartilage(const Millimetres& mm, const KneeSize& size) {
  const Field coat = make_coat(make_patella(mm), 0.6 * size.cartilage, 2.6e-3, mm.at(-1, -32.6, 20),
                               mm.length(14));
  const Field behind = make_half_space(mm.at(0, -40, 0), Vec3(0, -1, 0));
  const Field above_apex = make_half_space(mm.at(0, 0, 7), Vec3(0, 0, -1));
  return intersect(coat, intersect(behind, above_apex, mm.length(3)), 1.5e-3);
}

}  // namespace

Field make_knee_femur(const KneeSize& size) {
  const Millimetres mm = Millimetres::of_scale(size.scale);
  const Field epicondyles = unite(make_ball(mm.at(30, 3, 15), mm.length(6.5)),
                                  make_ball(mm.at(-30, 3, 14), mm.length(6.5)), 0);
  return unite(unite(make_condyles(mm), make_femoral_shaft(mm), mm.length(10)), epicondyles,
               mm.length(8));
}

std::vector<Solid> make_knee_bones(const KneeSize& size) {
  const Millimetres mm = Millimetres::of_scale(size.scale);
  const Field fibula = make_tube({{mm.at(-36, 17, -38), mm.length(8.5)},
                                  {mm.at(-35.5, 17, -56), mm.length(6.5)},
                                  {mm.at(-34, 15, -120), mm.length(6)}});
  const auto plateau_cartilage = [&](double side) {
    return make_ellipsoid(mm.at(side * 20, 3, -18), mm.at(15.5, side > 0 ? 21 : 18, 2.8));
  };
  const Vec3 under = mm.at(19.5, 3, -12.6) - Vec3(0, 0, 0.5 * size.cartilage);
  return {{"femur", make_knee_femur(size), mm.at(0, -4, 60), mm.length(200), 3e-3, 0.1e-3},
          {"tibia", make_tibia(mm), mm.at(0, 0, -50), mm.length(190), 3e-3, 0.1e-3},
          {"fibula", fibula, mm.at(-36, 17, -50), mm.length(140), 3e-3, 0.12e-3},
          {"patella", make_patella(mm), mm.at(0, -43, 20), mm.length(60), 2.2e-3, 0.08e-3},
          {"femoral_cartilage", make_femoral_cartilage(mm, size), under, mm.length(140), 1.9e-3,
           0.08e-3},
          {"patellar_cartilage", make_patellar_cartilage(mm, size), mm.at(-1, -32, 20),
           mm.length(60), 1.6e-3, 0.08e-3},
          {"medial_tibial_cartilage", plateau_cartilage(1), mm.at(20, 3, -17), mm.length(60),
           1.8e-3, 0.08e-3},
          {"lateral_tibial_cartilage", plateau_cartilage(-1), mm.at(-20, 3, -17), mm.length(60),
           1.8e-3, 0.08e-3},
          {"medial_meniscus", make_meniscus(mm, 1, 3.5), mm.at(33.5, 3.5, -11.6), mm.length(80),
           1.8e-3, 0.08e-3},
          {"lateral_meniscus", make_meniscus(mm, -1, 3.5), mm.at(-33.5, 3.5, -11.6), mm.length(80),
           1.8e-3, 0.08e-3}};
}

}  // namespace artus
