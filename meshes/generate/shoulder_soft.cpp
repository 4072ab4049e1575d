// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/check.h"
#include "artus/detail/meshes/generate/millimetres.h"
#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/sweep.h"

namespace artus {
namespace {

constexpr double kBursaBeginsMm = 2.6;  // above the core

// What bursa, deltoid, fat and skin lie around: head, tuberosities and cuff as one smooth bulge
// that runs out into the shaft. The farther out a layer lies, the softer its hollows (`blend`).
Field make_core(const Millimetres& mm, double blend) {
  return unite(make_ball(mm.at(0, 1, 0.5), mm.length(28.5)),
               make_tube({{mm.at(-6, 0, -10), mm.length(22)},
                          {mm.at(-9, 0.3, -26), mm.length(17.5)},
                          {mm.at(-11, 0.5, -40), mm.length(15)},
                          {mm.at(-19, 1.5, -72), mm.length(11.5)},
                          {mm.at(-29, 2, -115), mm.length(10.5)}}),
               mm.length(blend));
}

Field make_layer(const Field& inner, double begin, const Field& outer, double end) {
  return subtract(grow(outer, end), grow(inner, begin), 0.2e-3);
}

// The deltoid rises from clavicle, acromion and spine and runs to the lateral shaft: nothing of it
// is medial of a wedge that opens forward and backward and recedes downward.
Field make_deltoid(const Millimetres& mm, const ShoulderSize& size, double begin) {
  const Field layer = make_layer(make_core(mm, 6), begin, make_core(mm, 20), begin + size.deltoid);
  const Field front = make_half_space(mm.at(8, 0, 0), Vec3(1, 0.4, -0.4));
  const Field back = make_half_space(mm.at(8, 0, 0), Vec3(1, -0.4, -0.4));
  const Field wedge = unite(front, back, mm.length(8));
  const Field under_acromion = make_half_space(mm.at(-2, 0, 36), Vec3(1, 0, 0.9));
  const Field distal = make_half_space(mm.at(-26, 0, -100), Vec3(0.2, 0, -1));
  return intersect(intersect(intersect(layer, wedge, mm.length(6)), under_acromion, mm.length(4)),
                   distal, mm.length(6));
}

Field make_bursa(const Millimetres& mm, const ShoulderSize& size) {
  const double begin = mm.length(kBursaBeginsMm);
  const Field layer = make_layer(make_core(mm, 6), begin, make_core(mm, 6), begin + size.bursa);
  return intersect(layer, make_ball(mm.at(-20, -2, 18), mm.length(33)), 0.5e-3);
}

Field make_supraspinatus(const Millimetres& mm, double half_tendon) {
  const Vec3 up(0, 0, 1);
  return make_ribbon(
      {{mm.at(84, 57, 19), Vec3(-0.5, -0.3, 1), mm.length(8), mm.length(6)},
       {mm.at(64, 41, 19), Vec3(-0.2, -0.2, 1), mm.length(10), mm.length(9)},
       {mm.at(42, 24, 25), up, mm.length(11), mm.length(8)},
       {mm.at(24, 13, 29), Vec3(0.2, 0, 1), mm.length(11), mm.length(5)},
       {mm.at(8, 4, 28.2), Vec3(0.28, 0.1, 1), mm.length(11), half_tendon},
       {mm.at(-7, -1, 27.2), Vec3(-0.3, 0, 1), mm.length(11), half_tendon},
       {mm.at(-18, -4, 18.5), Vec3(-0.7, 0, 0.7), mm.length(10.5), half_tendon},
       {mm.at(-24, -5.5, 10.5), Vec3(-0.9, 0, 0.4), mm.length(9.5), 0.7 * half_tendon}});
}

Field make_infraspinatus(const Millimetres& mm) {
  const Vec3 back = Vec3(-0.64, 0.77, 0);
  return make_ribbon({{mm.at(78, 74, -34), back, mm.length(20), mm.length(6)},
                      {mm.at(54, 54, -24), back, mm.length(21), mm.length(9)},
                      {mm.at(32, 40, -11), Vec3(-0.3, 1, 0.1), mm.length(16), mm.length(8)},
                      {mm.at(10, 30, 1), Vec3(0, 1, 0.1), mm.length(11), mm.length(4)},
                      {mm.at(-8, 25.5, 8), Vec3(-0.3, 1, 0.2), mm.length(9), mm.length(2.7)},
                      {mm.at(-20, 15, 11), Vec3(-0.8, 0.6, 0.3), mm.length(8), mm.length(2.4)}});
}

Field make_teres_minor(const Millimetres& mm) {
  return make_ribbon({{mm.at(58, 54, -66), Vec3(-0.6, 0.8, 0), mm.length(6), mm.length(5)},
                      {mm.at(38, 42, -42), Vec3(-0.5, 0.9, 0), mm.length(8), mm.length(6.5)},
                      {mm.at(12, 30, -21), Vec3(0, 1, 0), mm.length(7), mm.length(4.5)},
                      {mm.at(-8, 25, -9), Vec3(-0.3, 1, 0), mm.length(6), mm.length(2.6)},
                      {mm.at(-19, 18.5, -3), Vec3(-0.6, 0.7, 0), mm.length(5), mm.length(2.2)}});
}

Field make_subscapularis(const Millimetres& mm) {
  return make_ribbon({{mm.at(84, 46, -40), Vec3(0.64, -0.77, 0), mm.length(26), mm.length(5)},
                      {mm.at(62, 21, -24), Vec3(0.64, -0.77, 0), mm.length(25), mm.length(9)},
                      {mm.at(43, -3, -13), Vec3(0.4, -0.9, 0), mm.length(19), mm.length(8)},
                      {mm.at(24, -21, -6), Vec3(0.5, -0.85, 0), mm.length(14), mm.length(4.5)},
                      {mm.at(8, -28.5, -3), Vec3(0.2, -1, 0), mm.length(11), mm.length(2.9)},
                      {mm.at(-4, -28, 0), Vec3(0, -1, 0), mm.length(10), mm.length(2.4)}});
}

std::vector<TubeStation> biceps_course(const Millimetres& mm, double radius) {
  return {{mm.at(29, 10, 17), radius},      {mm.at(20, 3, 22.5), radius},
          {mm.at(6, -10, 26), radius},      {mm.at(-8, -18, 20.5), radius},
          {mm.at(-16, -19.5, 8), radius},   {mm.at(-17, -19.5, -10), radius},
          {mm.at(-18, -18.5, -28), radius}, {mm.at(-20, -17.5, -60), radius}};
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
  const double skin_end =
      mm.length(kBursaBeginsMm) + size.bursa + size.deltoid + size.fat + size.skin;
  return unite(grow(make_core(mm, 24), skin_end), make_trunk(mm), mm.length(30));
}

std::vector<Solid> make_shoulder_soft_tissue(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const double bursa_begin = mm.length(kBursaBeginsMm);
  const double deltoid_begin = bursa_begin + size.bursa;
  const Vec3 core_top = mm.at(0, 1, 29);
  const Vec3 above(0, 0, 1);
  const Vec3 core_side = mm.at(-28.5, 1, 0.5);
  const Field fluid = unite(
      make_ellipsoid(mm.at(13, 4, -23), Vec3(mm.length(10.5), mm.length(9.5), mm.length(7))),
      make_tube({{mm.at(20, -12, -16), mm.length(2.6)}, {mm.at(25, -14, -4), mm.length(2.2)}}),
      mm.length(3));
  return {
      {"body", make_shoulder_body(size), Vec3::Zero(), mm.length(420), 6e-3, 0.25e-3},
      {"deltoid", make_deltoid(mm, size, deltoid_begin),
       core_side - Vec3(deltoid_begin + 0.5 * size.deltoid, 0, 0), mm.length(200), 2.6e-3, 0.15e-3},
      {"subacromial_bursa", make_bursa(mm, size),
       core_top + (bursa_begin + 0.5 * size.bursa) * above, mm.length(100), 1.2e-3, 0.06e-3},
      {"supraspinatus", make_supraspinatus(mm, 0.5 * size.tendon_thickness), mm.at(42, 24, 25),
       mm.length(120), 1.8e-3, 0.1e-3},
      {"infraspinatus", make_infraspinatus(mm), mm.at(32, 40, -11), mm.length(120), 2.2e-3,
       0.12e-3},
      {"teres_minor", make_teres_minor(mm), mm.at(38, 42, -42), mm.length(120), 2e-3, 0.12e-3},
      {"subscapularis", make_subscapularis(mm), mm.at(43, -3, -13), mm.length(120), 2.2e-3,
       0.12e-3},
      {"biceps_long_tendon", make_tube(biceps_course(mm, mm.length(2.5))), mm.at(-17, -19.5, -10),
       mm.length(120), 1.2e-3, 0.08e-3},
      {"biceps_sheath",
       make_tube({{mm.at(-12, -19.5, 15), mm.length(3.6)},
                  {mm.at(-16, -19.5, 8), mm.length(3.8)},
                  {mm.at(-17, -19.5, -10), mm.length(3.8)},
                  {mm.at(-18, -18.5, -26), mm.length(3.4)}}),
       mm.at(-17, -19.5, -10), mm.length(80), 1.3e-3, 0.08e-3},
      {"joint_fluid", fluid, mm.at(13, 4, -23), mm.length(60), 1.5e-3, 0.08e-3},
      {"glenohumeral_capsule", make_capsule(mm, size), mm.at(10, 2, 0), mm.length(80), 1.8e-3,
       0.1e-3}};
}

std::vector<Solid> make_shoulder(const ShoulderSize& size) {
  ARTUS_REQUIRE(size.head_radius > 0 && size.cartilage > 0 && size.tendon_thickness > 0 &&
                    size.bursa > 0 && size.deltoid > 0 && size.fat > 0 && size.skin > 0,
                "every size must be positive");
  std::vector<Solid> solids = make_shoulder_soft_tissue(size);
  for (Solid& s : make_shoulder_bones(size)) solids.push_back(std::move(s));
  for (Solid& s : make_shoulder_vessels(size)) solids.push_back(std::move(s));
  for (Solid& s : make_shoulder_variants(size)) solids.push_back(std::move(s));
  return solids;
}

}  // namespace artus
