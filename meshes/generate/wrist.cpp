// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/wrist.h"

#include "artus/detail/core/check.h"
#include "artus/detail/meshes/generate/limb.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

const Vec3 kPalm(0, -1, 0);
const Vec3 kBack(0, 1, 0);
const Vec3 kThumb(-1, 0, 0);
const Vec3 kHand(0, 0, -1);

// What scaphoid and lunate turn as in the radius: its socket leans to the little finger.
Field make_condyle(const Millimetres& mm) {
  return make_ellipsoid(mm.at(-5.2, 3, -18), mm.at(20.2, 13, 17));
}

Field make_scaphoid(const Millimetres& mm) {
  return make_rod(mm, {{-12.8, 4, -8.4, 6.3}, {-16.5, 1, -16.5, 5.5}, {-20.5, -4.5, -24, 5.2}});
}

Field make_lunate(const Millimetres& mm) {
  const Field moon = make_ellipsoid(mm.at(0.6, 3, -8.4), mm.at(7.5, 8.8, 7));
  return subtract(moon, make_ball(mm.at(-2, 4, -19.5), mm.length(7.6)), mm.length(1));
}

// Without its socket.
Field make_radius_block(const Millimetres& mm) {
  const Field shaft = make_ribbon({{mm.at(-8, 1, 110), kPalm, mm.length(7), mm.length(6.5)},
                                   {mm.at(-8.5, 1, 45), kPalm, mm.length(8), mm.length(6.5)},
                                   {mm.at(-9.5, 1, 20), kPalm, mm.length(12.5), mm.length(8)},
                                   {mm.at(-10.6, 1.4, 6), kPalm, mm.length(14.1), mm.length(9.6)},
                                   {mm.at(-10.6, 1.6, -2), kPalm, mm.length(14.1), mm.length(9.6)}},
                                  2.4);
  const Field styloid = make_rod(mm, {{-18, 1, 2, 7}, {-22, 1, -6, 4.2}, {-23, 1, -10.5, 2.8}});
  const Field lister =
      make_rod(mm, {{-10.5, 9.6, 14, 1.8}, {-10.5, 10.6, 8, 2.2}, {-10.5, 10.2, 3, 1.8}});
  return unite(unite(shaft, styloid, mm.length(4)), lister, mm.length(2));
}

Field make_radius(const Millimetres& mm, const WristSize& size) {
  const Field sigmoid = make_rod(mm, {{15, 2, 12, 9.4}, {14.6, 2, -4, 9.8}});
  return subtract(
      subtract(make_radius_block(mm), grow(make_condyle(mm), 2 * size.cartilage), mm.length(0.6)),
      sigmoid, mm.length(0.8));
}

Field make_ulna(const Millimetres& mm) {
  const Field head =
      make_rod(mm, {{13, 2, 46, 5.6}, {14, 2, 25, 5.8}, {15, 2, 8, 7.4}, {15, 2, 4, 7.8}});
  return unite(head, make_rod(mm, {{19, 5, 2, 3.2}, {19.6, 5.4, -4, 2}}), mm.length(2));
}

Field make_hamate(const Millimetres& mm) {
  const Field hook =
      make_rod(mm, {{10.5, -1, -28, 3.6}, {9.6, -8, -30, 2.9}, {8.6, -11, -31, 2.5}});
  return unite(make_ellipsoid(mm.at(9.5, 4, -26), mm.at(7, 7.4, 8.6)), hook, mm.length(2));
}

Field make_trapezium(const Millimetres& mm) {
  return unite(make_ellipsoid(mm.at(-21.5, 0, -34), mm.at(6.4, 6.4, 6.4)),
               make_rod(mm, {{-19, -5, -33, 3}, {-18.4, -8.6, -32, 2.4}}), mm.length(2));
}

Field make_metacarpals(const Millimetres& mm) {
  Field all = make_rod(mm, {{-12.5, 4, -42, 6.4}, {-13, 5, -56, 4.6}, {-14.4, 6, -74, 4.4}});
  for (const auto& [x, y, z, r] :
       std::vector<RodStation>{{-2, 5, -45, 6.4}, {7.6, 4.6, -42, 5.6}, {15, 3, -41, 5.2}})
    all = unite(all,
                make_rod(mm, {{x, y, z, r},
                              {1.1 * x, y + 0.6, z - 14, 0.72 * r},
                              {1.3 * x, y + 1, z - 30, 0.7 * r}}),
                mm.length(2));
  return all;
}

std::vector<Solid> make_bones(const Millimetres& mm, const WristSize& size) {
  const double reach = mm.length(160);
  const auto bone = [&](const char* name, Field field, const Vec3& seed) {
    return Solid{name, std::move(field), seed, reach, 2e-3, 0.12e-3};
  };
  const Field row = unite(make_scaphoid(mm), make_lunate(mm), mm.length(2));
  const Field upper = make_half_space(mm.at(0, 0, -9), kHand);
  const Field socket = grow(make_radius_block(mm), -0.4e-3);
  return {
      bone("radius", make_radius(mm, size), mm.at(-8.5, 1, 40)),
      bone("ulna", make_ulna(mm), mm.at(14, 2, 25)),
      bone("scaphoid", make_scaphoid(mm), mm.at(-16.5, 1, -16.5)),
      bone("lunate", make_lunate(mm), mm.at(0.5, 3, -6)),
      bone("triquetrum", make_ellipsoid(mm.at(13, 4, -14), mm.at(5.8, 6.4, 6.6)),
           mm.at(13, 4, -14)),
      bone("pisiform", make_ellipsoid(mm.at(17, -6.4, -17), mm.at(4.6, 4.8, 6)),
           mm.at(17, -6.4, -17)),
      bone("capitate",
           make_rod(mm, {{-2, 4, -19.5, 6.8}, {-2.4, 5, -27, 6.4}, {-2.6, 5, -34, 7.2}}),
           mm.at(-2.4, 5, -27)),
      bone("hamate", make_hamate(mm), mm.at(9.5, 4, -26)),
      bone("trapezoid", make_ellipsoid(mm.at(-12.6, 5, -31), mm.at(5.2, 6.6, 5.8)),
           mm.at(-12.6, 5, -31)),
      bone("trapezium", make_trapezium(mm), mm.at(-21.5, 0, -34)),
      bone("metacarpals", make_metacarpals(mm), mm.at(-13, 5, -56)),
      {"scapholunate_ligament",
       intersect(unite(make_scaphoid(mm), make_lunate(mm), mm.length(7)),
                 make_ellipsoid(mm.at(-6.6, 4, -8.4), mm.at(3.4, 8, 5)), 0.6e-3),
       mm.at(-6.6, 4, -8), reach, 1.4e-3, 0.07e-3},
      {"carpal_cartilage",
       intersect(
           make_layer(row, -0.4e-3, size.cartilage, make_ball(mm.at(-6, 3, -6), mm.length(15))),
           upper, 0.5e-3),
       find_outside(row, mm.at(0.5, 3, -6), Vec3(0, 0, 1), 0.5 * size.cartilage), reach, 1.4e-3,
       0.07e-3},
      {"radial_cartilage",
       make_layer(make_condyle(mm), size.cartilage, 2.5 * size.cartilage, socket),
       find_outside(make_condyle(mm), mm.at(-8, 3, -6), Vec3(0, 0, 1), 1.7 * size.cartilage), reach,
       1.4e-3, 0.07e-3},
      make_strap_part("triangular_fibrocartilage", mm, kHand,
                      {{6, 2, -2.6, 6, 1.3}, {12, 2.5, -3.8, 5, 1.2}, {18.5, 4.5, -3, 2.4, 1}})};
}

// [Mani2011] the median nerve's section is 7.4 mm2 at the inlet, 2.7 times as wide as thick.
std::vector<Solid> make_lines(const Millimetres& mm) {
  return {make_strap_part("median_nerve", mm, kPalm,
                          {{-4.5, -13.4, 46, 2, 1.6},
                           {-5, -14, 25, 2.2, 1.4},
                           {-5.6, -13.7, 0, 2.6, 1.05},
                           {-5.8, -13.6, -16, 2.75, 0.95},
                           {-5.8, -13.4, -34, 2.75, 0.9},
                           {-5.8, -12.8, -55, 2.4, 0.9}}),
          make_rod_part("ulnar_nerve", mm,
                        {{14, -9.5, 46, 1.4},
                         {15.2, -9.6, 20, 1.4},
                         {14.8, -10.6, -6, 1.4},
                         {13.4, -12, -20, 1.4},
                         {11.8, -14.6, -34, 1.3},
                         {11, -14, -55, 1.2}}),
          make_rod_part("ulnar_artery", mm,
                        {{11.5, -10.5, 46, 1.3},
                         {12.6, -10.8, 20, 1.3},
                         {12.2, -12.2, -6, 1.3},
                         {10.6, -14, -20, 1.3},
                         {8.6, -16, -34, 1.2},
                         {5, -15, -50, 1.1}}),
          make_rod_part("radial_artery", mm,
                        {{-18, -10, 46, 1.4},
                         {-19, -11, 25, 1.4},
                         {-20.5, -9.6, 4, 1.4},
                         {-22.6, -6, -10, 1.3},
                         {-24.4, -0.4, -19, 1.3},
                         {-25, 5, -27, 1.3},
                         {-22, 9, -38, 1.2},
                         {-20, 9, -50, 1.2}}),
          make_rod_part("radial_nerve", mm,
                        {{-25, 0, 46, 0.9},
                         {-28.6, 1, 30, 0.9},
                         {-29.2, 4, 6, 0.8},
                         {-28, 7.5, -16, 0.8},
                         {-24, 11, -40, 0.8}})};
}

// Four superficial and four deep tendons of the fingers, and the thumb's.
std::vector<Solid> make_flexors(const Millimetres& mm) {
  const auto tendon = [&](const char* name, double x, double y, double radius) {
    return make_rod_part(name, mm,
                         {{0.8 * x, y - 1, 46, 0.9 * radius},
                          {0.9 * x, y - 0.6, 25, radius},
                          {x, y, 0, radius},
                          {x, y, -18, radius},
                          {x, y + 0.4, -34, radius},
                          {1.4 * x, y + 1, -56, radius}});
  };
  return {tendon("flexor_superficialis_2", -3.4, -9.8, 1.7),
          tendon("flexor_superficialis_3", -1.2, -12, 1.8),
          tendon("flexor_superficialis_4", 2.8, -11.7, 1.8),
          tendon("flexor_superficialis_5", 6.6, -10.2, 1.5),
          tendon("flexor_profundus_2", -6.4, -6.6, 1.9),
          tendon("flexor_profundus_3", -2.4, -6.2, 2),
          tendon("flexor_profundus_4", 1.8, -6.6, 2),
          tendon("flexor_profundus_5", 5.8, -6.6, 1.8),
          make_rod_part("flexor_pollicis_longus", mm,
                        {{-9, -9.4, 46, 1.7},
                         {-10, -9.6, 25, 1.8},
                         {-10.6, -9.4, 0, 1.8},
                         {-11.4, -9.6, -18, 1.8},
                         {-13, -9.6, -34, 1.8},
                         {-20, -14, -56, 1.8}}),
          make_rod_part("flexor_carpi_radialis", mm,
                        {{-12, -15, 46, 1.9},
                         {-13.5, -15.4, 25, 2.1},
                         {-14.5, -14.4, 0, 2.1},
                         {-15.6, -11.6, -17, 1.9},
                         {-14.4, -5, -31, 1.8},
                         {-13, -1, -40, 1.6}}),
          make_rod_part(
              "flexor_carpi_ulnaris", mm,
              {{18, -10, 46, 2.6}, {18.4, -10.6, 25, 2.4}, {18, -9.6, 0, 2.2}, {17.2, -8, -13, 2}}),
          make_strap_part("palmaris_longus", mm, kPalm,
                          {{-4, -18.2, 46, 1.6, 0.8},
                           {-4.6, -18.6, 25, 1.6, 0.8},
                           {-5, -18.4, 0, 1.9, 0.7},
                           {-5, -18.5, -16, 2.6, 0.6},
                           {-5, -18.8, -34, 3.4, 0.5},
                           {-5, -19, -55, 4, 0.5}})};
}

// From pisiform and hook to scaphoid and trapezium, 1.3 mm thick (assumed); the tunnel under it is
// 10.4 mm deep [Mani2011].
std::vector<Solid> make_tunnel(const Millimetres& mm) {
  const auto across = [&](double x, double y, double wide) {
    return RibbonStation{mm.at(x, y, -23.5), kPalm, mm.length(wide), mm.length(0.65)};
  };
  return {{"flexor_retinaculum",
           make_ribbon({across(17, -10.6, 9), across(9.5, -14.2, 10.5), across(0, -15.6, 11.5),
                        across(-9, -14.9, 11.5), across(-15.5, -12.2, 10), across(-19.4, -8.6, 8)},
                       3),
           mm.at(0, -15.6, -23.5), mm.length(80), 1.8e-3, 0.1e-3},
          make_strap_part("carpal_tunnel", mm, kPalm,
                          {{-1.5, -9.8, 16, 7.5, 3.4},
                           {-1.5, -9.8, 8, 9.8, 4.9},
                           {-1.6, -9.6, -6, 11.2, 5.8},
                           {-2, -9.4, -20, 11.4, 5.9},
                           {-2.4, -9.2, -34, 11.2, 5.8},
                           {-2.6, -9.2, -44, 8.5, 4.4}})};
}

// Two tendons in one sheath over the styloid under 15 mm of retinaculum [FirstCompartment2024],
// which is as thick as in de Quervain's disease, 0.94 mm [DeQuervainUS].
std::vector<Solid> make_first_compartment(const Millimetres& mm) {
  return {make_strap_part("abductor_pollicis_longus", mm, Vec3(-1, -0.15, 0),
                          {{-14, 9, 46, 2.6, 1.8},
                           {-20.5, 7.4, 32, 2.4, 1.4},
                           {-25.6, 2.4, 12, 1.9, 1.2},
                           {-26.4, -1, 0, 1.8, 1.2},
                           {-26.6, -3.4, -14, 1.8, 1.2},
                           {-26.6, -5.6, -30, 1.7, 1.1},
                           {-26, -7, -44, 1.4, 0.8}}),
          make_strap_part("extensor_pollicis_brevis", mm, Vec3(-1, 0.15, 0),
                          {{-11, 11, 46, 1.8, 1.4},
                           {-19, 10.2, 32, 1.6, 1.1},
                           {-25.4, 5.9, 12, 1.2, 0.9},
                           {-26.4, 2.5, 0, 1.1, 0.9},
                           {-27.2, 0.2, -14, 1.1, 0.9},
                           {-28.6, -2, -30, 1.1, 0.9},
                           {-31, -5, -50, 1, 0.8}}),
          make_strap_part("first_compartment_sheath", mm, kThumb,
                          {{-23.2, 6.4, 22, 4.6, 1.7},
                           {-25.4, 4, 13, 4.6, 1.8},
                           {-26.4, 0.8, 0, 4.4, 1.8},
                           {-26.8, -1, -9, 4.6, 1.9},
                           {-27.1, -2.2, -17, 4.6, 1.7}}),
          make_strap_part("first_compartment_retinaculum", mm, kThumb,
                          {{-26.6, 2.9, 9, 4.8, 1.4},
                           {-27.1, 2, 5, 5.2, 1.75},
                           {-27.2, 0.8, 0, 5.2, 1.75},
                           {-26.9, 0, -4, 4.8, 1.4}})};
}

std::vector<Solid> make_extensors(const Millimetres& mm) {
  const auto over = [&](double x, double y, const Vec3& normal) {
    return RibbonStation{mm.at(x, y, 5), normal.normalized(), mm.length(10), mm.length(0.5)};
  };
  return {make_rod_part("extensor_carpi_radialis_longus", mm,
                        {{-18, 9, 46, 2},
                         {-19, 11, 25, 2},
                         {-19, 11.4, 5, 2},
                         {-17, 12, -18, 1.9},
                         {-14, 11.5, -42, 1.6}}),
          make_rod_part("extensor_carpi_radialis_brevis", mm,
                        {{-13, 11, 46, 2.1},
                         {-14.6, 12, 25, 2.1},
                         {-14.6, 12.6, 5, 2.1},
                         {-11, 12.8, -18, 1.9},
                         {-5, 12.4, -44, 1.6}}),
          make_rod_part("extensor_pollicis_longus", mm,
                        {{-2, 9.6, 46, 1.4},
                         {-6, 11.6, 25, 1.4},
                         {-6.4, 12.8, 6, 1.4},
                         {-10.5, 14.2, -9, 1.3},
                         {-21, 12.4, -27, 1.3},
                         {-29, 2, -50, 1.3}}),
          make_strap_part("extensor_digitorum", mm, kBack,
                          {{3, 10.4, 46, 4.4, 2},
                           {3, 12.4, 25, 4.4, 1.8},
                           {3.6, 13.2, 5, 4.2, 1.5},
                           {4, 13.9, -16, 4.6, 1.3},
                           {4.6, 13.9, -40, 7, 1.1},
                           {5, 13.6, -56, 9, 0.9}}),
          make_rod_part("extensor_digiti_minimi", mm,
                        {{10, 8.6, 46, 1.2},
                         {10.6, 10.8, 25, 1.2},
                         {11, 12.2, 5, 1.2},
                         {12.4, 12.6, -18, 1.2},
                         {17, 10.5, -50, 1.2}}),
          make_rod_part("extensor_carpi_ulnaris", mm,
                        {{17, 8, 46, 2.2},
                         {19.4, 8, 25, 2.1},
                         {20.4, 7.4, 3, 2},
                         {19.8, 6.6, -16, 1.9},
                         {18, 4.6, -40, 1.6}}),
          {"extensor_retinaculum",
           make_ribbon({over(-22.5, 8.8, {-0.8, 0.6, 0}), over(-16.5, 14, {-0.35, 0.95, 0}),
                        over(-7, 15, {0, 1, 0}), over(2, 15.3, {0, 1, 0}),
                        over(10.5, 13.9, {0.3, 1, 0}), over(18.8, 10.2, {0.6, 0.8, 0})},
                       3),
           mm.at(-7, 15, 5), mm.length(80), 1.8e-3, 0.1e-3}};
}

// Fluid on the lunate and scaphoid under the dorsal capsule, from the radius' lip on.
std::vector<Solid> make_recess(const Millimetres& mm, const WristSize& size) {
  const Field row = unite(unite(make_scaphoid(mm), make_lunate(mm), mm.length(7)),
                          make_radius(mm, size), mm.length(4));
  const Field outline = make_ellipsoid(mm.at(-4.5, 10, -6.5), mm.at(10.5, 7, 7.5));
  const Vec3 middle = mm.at(-3.2, 6, -7);
  return {{"radiocarpal_recess", make_layer(row, -0.8e-3, size.recess, outline),
           find_outside(row, middle, kBack, 0.5 * size.recess), mm.length(50), 1.4e-3, 0.07e-3},
          {"dorsal_capsule", make_layer(row, -0.8e-3, size.recess + 1e-3, grow(outline, 1.8e-3)),
           find_outside(row, middle, kBack, size.recess + 0.5e-3), mm.length(60), 1.4e-3, 0.07e-3}};
}

std::vector<Solid> make_muscles(const Millimetres& mm) {
  return {make_strap_part("pronator_quadratus", mm, kPalm,
                          {{-3, -8.2, 46, 12, 2.4},
                           {-3, -8, 34, 14, 2.8},
                           {-3, -8.2, 18, 13, 2.4},
                           {-3, -8.6, 8, 9, 1}}),
          make_rod_part(
              "thenar_muscles", mm,
              {{-18, -12.4, -29, 3}, {-20, -14, -40, 8}, {-24, -17, -58, 9.5}, {-28, -18, -75, 8}}),
          make_rod_part(
              "hypothenar_muscles", mm,
              {{16.5, -9.5, -23, 3}, {17, -9.5, -34, 7}, {18, -8, -56, 9}, {18, -7, -75, 8}})};
}

Field make_skin(const Millimetres& mm) {
  const auto at = [&](double x, double y, double z, double wide, double thick) {
    return RibbonStation{mm.at(x, y, z), kPalm, mm.length(wide), mm.length(thick)};
  };
  return make_ribbon({at(0, -2, 110, 34, 27), at(-1, -2, 46, 31, 23), at(-3, -1.6, 25, 29.4, 20.2),
                      at(-3.6, -1.6, 4, 30, 19.8), at(-4.4, -2, -16, 30.5, 19.6),
                      at(-4.6, -3, -38, 36, 20), at(-5, -3, -56, 42, 20), at(-5, -2, -110, 42, 17)},
                     2.5);
}

}  // namespace

std::vector<Solid> make_wrist(const WristSize& size) {
  ARTUS_REQUIRE(size.scale > 0 && size.cartilage > 0 && size.recess > 0,
                "every size must be positive");
  const Millimetres mm = Millimetres::of_scale(size.scale);
  std::vector<Solid> solids{{"body", make_skin(mm), Vec3::Zero(), mm.length(360), 4e-3, 0.16e-3}};
  for (auto& parts :
       {make_bones(mm, size), make_lines(mm), make_flexors(mm), make_tunnel(mm),
        make_first_compartment(mm), make_recess(mm, size), make_extensors(mm), make_muscles(mm)})
    append(solids, parts);
  return solids;
}

}  // namespace artus
