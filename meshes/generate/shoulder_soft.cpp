// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "artus/detail/core/check.h"
#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

constexpr double kDeltoidBeginsMm = 4.1;  // above the core
constexpr double kSeptumMm = 0.9;

// What deltoid, fat and skin lie around: head, tuberosities and cuff as one smooth bulge that runs
// out into the shaft. The farther out a layer lies, the softer its hollows (`blend`).
Field make_core(const Millimetres& mm, double blend) {
  return unite(make_ball(mm.at(0, 1, 0.5), mm.length(28.5)),
               make_tube({{mm.at(-6, 0, -10), mm.length(22)},
                          {mm.at(-9, 0.3, -26), mm.length(17.5)},
                          {mm.at(-11, 0.5, -40), mm.length(15)},
                          {mm.at(-19, 1.5, -72), mm.length(11.5)},
                          {mm.at(-29, 2, -115), mm.length(10.5)}}),
               mm.length(blend));
}

// The side of the deltoid that faces the skin.
Field make_deltoid_side(const Millimetres& mm, const ShoulderSize& size) {
  return grow(make_core(mm, 20), mm.length(kDeltoidBeginsMm) + size.deltoid);
}

// The deltoid rises from clavicle, acromion and spine and runs to the lateral shaft: nothing of it
// is medial of a wedge that opens forward and backward and recedes downward.
Field make_deltoid(const Millimetres& mm, const ShoulderSize& size, const Field& cuff_side) {
  // No film of fat is left between it and the cuff, which the joint file puts first.
  const Field inside = grow(cuff_side, -0.5e-3);
  const Field layer = subtract(make_deltoid_side(mm, size), inside, 0.2e-3);
  const Field front = make_half_space(mm.at(8, 0, 0), Vec3(1, 0.4, -0.4));
  const Field back = make_half_space(mm.at(8, 0, 0), Vec3(1, -0.4, -0.4));
  const Field wedge = unite(front, back, mm.length(8));
  const Field under_acromion = make_half_space(mm.at(-2, 0, 36), Vec3(1, 0, 0.9));
  const Field distal = make_half_space(mm.at(-26, 0, -100), Vec3(0.2, 0, -1));
  return intersect(intersect(intersect(layer, wedge, mm.length(6)), under_acromion, mm.length(4)),
                   distal, mm.length(6));
}

// An intramuscular septum of the deltoid: a lamella that rises gently through the muscle as its
// bundles do, curved as the muscle is and a little wavy, and thins out to nothing all around.
struct SeptumCourse {
  double degrees = 0;  // of its middle, from lateral to the back
  double across = 0;   // by which it rises to its rim, in the deltoid's thicknesses: to the back
  double along = 0;    // and upward
};

// `side`: of the deltoid, toward the skin.
Solid make_septum(const Millimetres& mm, const ShoulderSize& size, const Field& side,
                  const char* name, const SeptumCourse& course) {
  constexpr double kWide = 20 * std::numbers::pi / 180;  // half of it
  const double angle = course.degrees * std::numbers::pi / 180;
  const Vec3 out(-std::cos(angle), std::sin(angle), 0);
  const Vec3 back(std::sin(angle), std::cos(angle), 0);
  const double middle = mm.length(11);
  const double tall = mm.length(22);
  const double half = 0.5 * kSeptumMm * 1e-3;
  const double thick = size.deltoid;
  const auto field = [=](const Vec3& p) {
    const double u = std::atan2(p.dot(back), p.dot(out)) / kWide;
    const double v = (p.z() - middle) / tall;
    const double wave = 0.03 * std::sin(7 * v + 3 * u + angle) + 0.02 * std::sin(9 * u - 4 * v);
    const double depth = thick * (0.5 - course.across * u - course.along * v + wave);
    const double off = (-side(p) - depth) / half;
    const double rim = u * u + v * v;
    return half / 2 * (off * off + rim * rim - 1);
  };
  Vec3 inside = middle * Vec3::UnitZ() + mm.length(20) * out;
  while (field(inside) > -0.3 * half) inside += 0.02e-3 * out;
  return {name, field, inside, mm.length(140), 2.2e-3, 0.2e-3};
}

// What lies between two sides, thinning out to nothing towards its rim.
Field make_bursa_layer(const Millimetres& mm, const Field& outer, const Field& inner,
                       double radius) {
  const Field layer = subtract(outer, inner, 0.1e-3);
  return intersect(layer, make_ball(mm.at(-20, -3, 19), mm.length(radius)), mm.length(2));
}

// An oval that lies flat on head and groove, from the upper rim of the glenoid down the arm.
Field make_biceps(const Millimetres& mm) {
  const auto station = [&](double x, double y, double z, double lift) {
    return RibbonStation{mm.at(x, y, z), Vec3(x, y, lift), mm.length(2.7), mm.length(1.8)};
  };
  return make_ribbon({station(29, 10, 17, 17), station(20, 3, 22.5, 22.5), station(6, -10, 26, 26),
                      station(-8, -18, 20.5, 20), station(-16, -19.9, 8, 4),
                      station(-17, -19.7, -10, 0), station(-18, -18.7, -28, 0),
                      station(-20, -17.5, -60, 0)});
}

// A film of fluid around it in the groove, tapered at both ends.
Field make_biceps_sheath(const Millimetres& mm) {
  const auto station = [&](double x, double y, double z, double wide, double thick) {
    return RibbonStation{mm.at(x, y, z), Vec3(x, y, 0), mm.length(wide), mm.length(thick)};
  };
  return make_ribbon({station(-14.6, -19.9, 11, 2.9, 1.9), station(-16.2, -20, 6, 3.5, 2.6),
                      station(-17, -19.9, -6, 3.6, 2.8), station(-17.6, -19.3, -18, 3.4, 2.6),
                      station(-18.4, -18.6, -30, 2.8, 1.9)});
}

// From the coracoid to the tip of the acromion, over the front of the bursa [Gray2020].
Field make_coracoacromial_ligament(const Millimetres& mm) {
  const Vec3 out(-0.25, -0.65, 0.7);
  return make_ribbon({{mm.at(35, -20, 19), out, mm.length(7.5), mm.length(0.9)},
                      {mm.at(25, -18.5, 26), out, mm.length(6.5), mm.length(0.9)},
                      {mm.at(12, -15, 33), out, mm.length(5.5), mm.length(0.9)},
                      {mm.at(1, -9, 37.5), out, mm.length(4.5), mm.length(0.9)}},
                     3);
}

// Capsule as a solid around the head's articular half with the axillary pouch below; bone,
// cartilage, tendons and fluid take their shares first.
Field make_capsule(const Millimetres& mm, const ShoulderSize& size) {
  const Field bag =
      unite(make_ball(Vec3::Zero(), size.head_radius + size.cartilage + 1.6e-3),
            make_ellipsoid(mm.at(13, 4, -22), Vec3(mm.length(13), mm.length(12), mm.length(10))),
            mm.length(6));
  return intersect(bag, make_half_space(mm.at(-5, -1, -3), Vec3(-0.78, -0.15, -0.35)),
                   mm.length(2));
}

// Chest and the slope of the trapezius up to the neck, far enough to hold scapula and clavicle.
Field make_trunk(const Millimetres& mm) {
  return unite(make_ellipsoid(mm.at(120, 14, -44), mm.at(98, 86, 112)),
               make_tube({{mm.at(14, 10, 16), mm.length(34)},
                          {mm.at(60, 16, 24), mm.length(45)},
                          {mm.at(125, 14, 44), mm.length(56)}}),
               mm.length(20));
}

}  // namespace

Field make_shoulder_body(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const double skin_end = mm.length(kDeltoidBeginsMm) + size.deltoid + size.fat + size.skin;
  return unite(grow(make_core(mm, 24), skin_end), make_trunk(mm), mm.length(30));
}

std::vector<Solid> make_shoulder_soft_tissue(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const Field cuff_side = make_shoulder_cuff_side(size);
  const double bursa_begin = size.peribursal_fat;
  const double bursa_end = bursa_begin + size.bursa;
  const Field deltoid_side = make_deltoid_side(mm, size);
  const Field deltoid = make_deltoid(mm, size, cuff_side);
  // The first point straight above the head that lies `distance` outside of the cuff's side.
  const auto above_cuff = [&](double distance) {
    Vec3 p = mm.at(-8, 0, 26);
    while (cuff_side(p) < distance) p.z() += 0.02e-3;
    return p;
  };
  const Vec3 core_side = mm.at(-28.5, 1, 0.5);
  const Field fluid = unite(
      make_ellipsoid(mm.at(13, 4, -23), Vec3(mm.length(10.5), mm.length(9.5), mm.length(7))),
      make_tube({{mm.at(20, -12, -16), mm.length(2.6)}, {mm.at(25, -14, -4), mm.length(2.2)}}),
      mm.length(3));
  return {
      {"body", make_shoulder_body(size), Vec3::Zero(), mm.length(420), 6e-3, 0.25e-3},
      {"deltoid", deltoid, core_side - Vec3(mm.length(kDeltoidBeginsMm) + 0.5 * size.deltoid, 0, 0),
       mm.length(200), 2.6e-3, 0.14e-3},
      {"subacromial_bursa",
       make_bursa_layer(mm, grow(cuff_side, bursa_end), grow(cuff_side, bursa_begin), 28),
       above_cuff(0.5 * (bursa_begin + bursa_end)), mm.length(100), 1.1e-3, 0.04e-3},
      {"peribursal_fat",
       make_bursa_layer(mm, grow(cuff_side, bursa_end + size.peribursal_fat),
                        grow(make_core(mm, 6), mm.length(-2.5)), 30),
       above_cuff(0.5 * (bursa_begin + bursa_end)), mm.length(100), 1.3e-3, 0.05e-3},
      {"biceps_long_tendon", make_biceps(mm), mm.at(-17, -19.7, -10), mm.length(120), 1.2e-3,
       0.06e-3},
      {"coracoacromial_ligament", make_coracoacromial_ligament(mm), mm.at(12, -15, 33),
       mm.length(60), 1.2e-3, 0.06e-3},
      make_septum(mm, size, deltoid_side, "deltoid_septum_1", {-46, 0.22, 0.1}),
      make_septum(mm, size, deltoid_side, "deltoid_septum_2", {-6, 0.2, -0.12}),
      {"biceps_sheath", make_biceps_sheath(mm), mm.at(-17, -19.7, -10), mm.length(80), 1.2e-3,
       0.05e-3},
      {"joint_fluid", fluid, mm.at(13, 4, -23), mm.length(60), 1.5e-3, 0.08e-3},
      {"glenohumeral_capsule", make_capsule(mm, size), mm.at(10, 2, 0), mm.length(80), 1.8e-3,
       0.1e-3}};
}

std::vector<Solid> make_shoulder(const ShoulderSize& size) {
  ARTUS_REQUIRE(size.head_radius > 0 && size.cartilage > 0 && size.tendon_thickness > 0 &&
                    size.bursa > 0 && size.deltoid > 0 && size.fat > 0 && size.skin > 0,
                "every size must be positive");
  std::vector<Solid> solids = make_shoulder_soft_tissue(size);
  for (Solid& s : make_shoulder_cuff(size)) solids.push_back(std::move(s));
  for (Solid& s : make_shoulder_bones(size)) solids.push_back(std::move(s));
  for (Solid& s : make_shoulder_vessels(size)) solids.push_back(std::move(s));
  for (Solid& s : make_shoulder_variants(size)) solids.push_back(std::move(s));
  return solids;
}

}  // namespace artus
