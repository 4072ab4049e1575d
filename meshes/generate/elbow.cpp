// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/elbow.h"

#include "artus/detail/core/check.h"
#include "artus/detail/meshes/generate/limb.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

const Vec3 kLateral(-1, 0, 0);
const Vec3 kBack(0, 1, 0);
const Vec3 kDown(0, 0, -1);
const Vec3 kForward(0, -1, 0);

// A spool, its groove 18 mm across and its medial lip higher than its lateral one, 22 mm wide
// [Desai2014].
Field make_trochlea(const Millimetres& mm) {
  const Field spool = make_rod(
      mm, {{-5, 0, 0, 9.4}, {-1, 0, 0, 9.6}, {5, 0, 0, 8.8}, {12, 0, 0, 10.4}, {16, 0, 0, 12.3}});
  return intersect(spool, make_half_space(mm.at(20, 0, 0), Vec3(1, 0, 0)), mm.length(2));
}

// Round with a radius of 11.6 mm in the sagittal plane [Sabo2011]; its back is no joint.
Field make_capitellum(const Millimetres& mm) {
  return make_ellipsoid(mm.at(-13, -0.5, 0), mm.at(10, 11.6, 11.6));
}

Field make_articular_end(const Millimetres& mm) {
  return unite(make_trochlea(mm), make_capitellum(mm), mm.length(3));
}

// Two columns around the fossae, 59 mm wide over the epicondyles [DistalHumerus2024]; the shaft's
// axis runs behind the axis of the joint.
Field make_humerus_bone(const Millimetres& mm) {
  const Field shaft =
      make_rod(mm, {{0, 9, 130, 10}, {0, 9, 62, 10}, {0, 8, 44, 9.6}, {0, 7, 32, 8}});
  const Field lateral = make_rod(
      mm,
      {{-3, 8, 44, 8.4}, {-13, 7, 27, 7}, {-21, 5, 12, 6.6}, {-24, 3, 4, 6}, {-24.5, 1.5, 0, 4.5}});
  const Field medial = make_rod(
      mm,
      {{3, 8, 44, 8.4}, {13, 7.5, 27, 6.8}, {22, 7, 12, 6}, {26.5, 6.5, 4, 5}, {26.5, 6, 0, 3.8}});
  const Field web =
      make_plate({{mm.at(0, 7, 46), mm.at(-20, 3, 6), mm.at(20, 4, 6)}}, mm.length(5.2));
  const Field columns =
      unite(unite(lateral, medial, mm.length(4)), unite(shaft, web, mm.length(5)), mm.length(5));
  const Field whole = unite(columns, make_articular_end(mm), mm.length(4));
  const Field olecranon_fossa = make_ellipsoid(mm.at(3.5, 18, 16), mm.at(12.5, 12, 11.5));
  const Field coronoid_fossa = make_ellipsoid(mm.at(3.5, -7.5, 15), mm.at(9, 7.5, 7));
  return subtract(subtract(whole, olecranon_fossa, mm.length(3)), coronoid_fossa, mm.length(2));
}

// What olecranon and coronoid hold between them is the trochlea with cartilage on both.
Field make_ulna(const Millimetres& mm, const ElbowSize& size) {
  const Field olecranon = make_rod(
      mm, {{5, 17, 1, 5}, {5, 18, -6, 8.5}, {5, 13, -16, 9.6}, {5, 2, -20, 8.8}, {4, -14, -20, 8}});
  const Field width = make_strap(mm, Vec3(0, 0.6, -0.8),
                                 {{5, 19, -4, 11, 5}, {5, 13, -15, 11.5, 6}, {5, 3, -20, 10, 6}});
  const Field shaft = make_rod(mm, {{4, -10, -20, 8}, {3, -40, -19, 7}, {2, -100, -17, 6.4}});
  const Field coronoid = make_rod(mm, {{5, -6, -15, 8}, {5, -13, -8, 4.6}, {5, -13.5, -3, 2.8}});
  const Field block = unite(unite(olecranon, width, mm.length(3)),
                            unite(shaft, coronoid, mm.length(4)), mm.length(4));
  return subtract(block, grow(make_articular_end(mm), 2 * size.cartilage), mm.length(1));
}

// A dish of 22 mm on a neck [RadialHead2022], which turns on the capitellum.
Field make_radius(const Millimetres& mm, const ElbowSize& size) {
  const Field head =
      make_strap(mm, kLateral, {{-13, -16, 0, 10.8, 10.8}, {-13, -22, 0, 10.6, 10.6}});
  const Field slab = intersect(head,
                               intersect(make_half_space(mm.at(0, -24.5, 0), kForward),
                                         make_half_space(mm.at(0, -10, 0), kBack), mm.length(2)),
                               mm.length(2));
  const Field neck = make_rod(mm, {{-13, -18, 0, 6.8},
                                   {-12, -32, 0, 6.6},
                                   {-10, -44, -2, 7.6},
                                   {-11, -60, -3, 7},
                                   {-12, -100, -2, 7}});
  return subtract(unite(slab, neck, mm.length(2.5)), grow(make_capitellum(mm), 2 * size.cartilage),
                  mm.length(0.8));
}

std::vector<Solid> make_bones(const Millimetres& mm, const ElbowSize& size) {
  const double reach = mm.length(200);
  const Field end = make_articular_end(mm);
  const Field humerus = make_humerus_bone(mm);
  const Field coat = subtract(grow(end, size.cartilage), grow(end, -1e-3), 0.3e-3);
  const Field joint_side = unite(make_half_space(mm.at(0, 0, 4), Vec3(0, 0.5, 1)),
                                 make_half_space(mm.at(0, -2, 0), kBack), mm.length(2));
  const Field between = intersect(joint_side, make_ball(mm.at(-0.5, 0, 0), mm.length(23)), 1e-3);
  const Field notch = make_layer(grow(end, size.cartilage), 0, 1.3 * size.cartilage,
                                 make_ball(mm.at(6, 1, -9), mm.length(15.5)));
  const Field dish = make_layer(grow(make_capitellum(mm), size.cartilage), 0, 1.3 * size.cartilage,
                                make_ball(mm.at(-13, -18, 0), mm.length(10)));
  return {{"humerus", humerus, mm.at(0, 9, 60), reach, 2e-3, 0.1e-3},
          {"ulna", make_ulna(mm, size), mm.at(4, -20, -20), reach, 2e-3, 0.1e-3},
          {"radius", make_radius(mm, size), mm.at(-12, -32, 0), reach, 2e-3, 0.1e-3},
          {"humeral_cartilage", intersect(coat, between, 0.8e-3),
           mm.at(-13, -12.1, 0) - Vec3(0, 0.5 * size.cartilage, 0), mm.length(60), 1.6e-3, 0.08e-3},
          {"ulnar_cartilage", notch, mm.at(5, 0, -8.8) - Vec3(0, 0, 1.6 * size.cartilage),
           mm.length(50), 1.4e-3, 0.08e-3},
          {"radial_cartilage", dish, mm.at(-13, -12.1, 0) - Vec3(0, 1.6 * size.cartilage, 0),
           mm.length(40), 1.3e-3, 0.08e-3}};
}

// The ulnar nerve in its groove; the brachial artery with the median nerve on its medial side.
// assumed: diameters of 2.6 to 4 mm.
std::vector<Solid> make_lines(const Millimetres& mm) {
  return {make_rod_part("ulnar_nerve", mm,
                        {{22, 20, 70, 1.6},
                         {23, 17.5, 30, 1.6},
                         {22.4, 14.6, 12, 1.7},
                         {21.4, 13.4, 2, 1.7},
                         {19.5, 8, -13, 1.6},
                         {16.5, -4, -23, 1.6},
                         {14.5, -22, -25, 1.6},
                         {14, -60, -21, 1.6}}),
          make_rod_part("median_nerve", mm,
                        {{21, -20, 70, 1.8},
                         {15, -25, 35, 1.8},
                         {11, -28, 16, 1.8},
                         {9, -36, 10, 1.8},
                         {7, -60, 5, 1.8}}),
          make_rod_part("brachial_artery", mm,
                        {{17, -23, 70, 2},
                         {10, -27.5, 35, 2},
                         {5.5, -29, 17, 2},
                         {3, -37, 12, 2},
                         {1, -60, 9, 1.7}}),
          make_rod_part("radial_nerve", mm,
                        {{-20, -8, 60, 1.3},
                         {-17, -15, 34, 1.3},
                         {-15, -19, 18, 1.3},
                         {-17, -27, 13.5, 1.3},
                         {-22, -42, 11, 1.2},
                         {-24, -70, 8, 1.2}})};
}

std::vector<Solid> make_bursae(const Millimetres& mm, const ElbowSize& size) {
  const Field ulna = make_ulna(mm, size);
  const double begin = 0.7e-3;  // periosteum and the tendon's last fibres
  const Field over_olecranon = make_ellipsoid(mm.at(5, 15, -24), mm.at(10.5, 15.5, 15.5));
  const Field back_and_down = make_half_space(mm.at(0, 12, -14), Vec3(0, -0.72, 0.69));
  const Field olecranon =
      make_layer(ulna, begin, begin + size.bursa, intersect(over_olecranon, back_and_down, 1e-3));
  // A lens in the olecranon fossa; bone takes its share.
  const Vec3 lens = mm.at(3.5, 8, 17.5);
  const Field recess =
      make_ellipsoid(lens, Vec3(mm.length(12), mm.length(1) + size.recess, mm.length(11.5)));
  return {{"olecranon_bursa", olecranon,
           find_outside(ulna, mm.at(5, 14, -17), Vec3(0, 0.6, -0.8), begin + 0.5 * size.bursa),
           mm.length(60), 1.2e-3, 0.05e-3},
          {"posterior_recess", recess, lens, mm.length(50), 1.4e-3, 0.07e-3},
          {"posterior_capsule", grow(recess, 1e-3), lens, mm.length(60), 1.5e-3, 0.08e-3},
          {"posterior_fat_pad", make_ellipsoid(mm.at(3.5, 16, 16.5), mm.at(13.5, 6.6, 12)),
           mm.at(3.5, 18, 16), mm.length(60), 1.6e-3, 0.08e-3},
          {"anterior_fat_pad", make_ellipsoid(mm.at(0.5, -8, 15.5), mm.at(17, 6.4, 9.5)),
           mm.at(3.5, -10, 15.5), mm.length(60), 1.6e-3, 0.08e-3},
          make_strap_part("radiohumeral_bursa", mm, kLateral,
                          {{-26.3, -6, 1.5, 3, 0.3},
                           {-26.2, -11, 1.2, 4.5, 0.45},
                           {-26.3, -17, 0.8, 4.8, 0.45},
                           {-26.8, -24, 0, 3.5, 0.3}})};
}

// Under the skin of the lateral side: tendon on bursa [Osgood1922] on ligament. [Ustuner2013] the
// tendon is 4.6 mm thick over the epicondyle, 3.6 over the joint and 3.2 over the radial head.
std::vector<Solid> make_lateral_side(const Millimetres& mm) {
  return {make_strap_part("common_extensor_tendon", mm, kLateral,
                          {{-29.2, 6.5, 4.6, 4, 0.5},
                           {-29.6, 2.5, 4, 5, 1.7},
                           {-29.4, -2, 3.2, 5.5, 2.4},
                           {-28.8, -8, 2.4, 5.5, 2},
                           {-28.2, -13, 1.6, 5.5, 1.75},
                           {-28.2, -20, 0.6, 5.5, 1.6},
                           {-28.7, -30, -1, 5.5, 1.2},
                           {-29.2, -42, -3, 5, 0.6},
                           {-29.6, -52, -5, 4, 0.3}}),
          make_strap_part("radial_collateral_ligament", mm, kLateral,
                          {{-26.4, 0, 0, 4, 1.1},
                           {-25.2, -6, 0, 4.5, 1.2},
                           {-24.9, -13, 0, 6, 1.1},
                           {-24.9, -20, 0, 7.5, 1},
                           {-24.4, -25, 0, 6, 0.6}}),
          make_strap_part(
              "annular_ligament", mm, kLateral,
              {{-24.6, -17.5, -8, 3.4, 1}, {-24.9, -18.5, 0, 4, 1}, {-23.8, -17.5, 8, 3.4, 1}})};
}

std::vector<Solid> make_back(const Millimetres& mm) {
  return {make_strap_part("triceps_tendon", mm, kBack,
                          {{5, 22.6, -9, 8.5, 0.5},
                           {5, 25, -1, 9.5, 1.7},
                           {4, 25.8, 9, 10, 2.1},
                           {3, 25.9, 22, 10, 1.9},
                           {2, 26.6, 38, 9, 1.3},
                           {1, 27.6, 56, 7.5, 0.7},
                           {0, 29, 80, 5, 0.35}}),
          make_strap_part("ulnar_collateral_ligament", mm, Vec3(1, 0, 0),
                          {{26, 3, -3, 3, 1.2}, {23, -4, -8, 4, 1.4}, {16, -11, -14, 4, 1}})};
}

// Behind the joint and on its lateral side.
std::vector<Solid> make_extensors(const Millimetres& mm) {
  return {make_strap_part("triceps", mm, kBack,
                          {{5, 24.4, -2, 10, 0.5},
                           {4, 23.2, 9, 17, 3.6},
                           {3, 21.8, 22, 22, 6.4},
                           {1, 22, 44, 26, 8.4},
                           {0, 24, 75, 30, 10.5},
                           {0, 25, 120, 32, 12}}),
          make_strap_part("anconeus", mm, Vec3(-0.6, 0.45, -0.66),
                          {{-22, 9.5, 1, 3, 1},
                           {-17, 9, -8, 6, 3},
                           {-10, -2, -17, 8, 4},
                           {-6, -20, -22, 6, 3.6},
                           {-3, -42, -23, 3, 1.2}}),
          make_rod_part("extensor_digitorum", mm,
                        {{-30, -4, 2.5, 1.2},
                         {-30.4, -13, 1, 3},
                         {-30.6, -24, -2, 5},
                         {-29.4, -44, -6, 7.8},
                         {-27, -75, -8, 9},
                         {-25, -100, -8, 9}}),
          make_rod_part("extensor_carpi_radialis", mm,
                        {{-18, -2, 46, 4},
                         {-25, -10, 26, 6.4},
                         {-28.5, -22, 14, 7.4},
                         {-31, -44, 8, 7.4},
                         {-31, -75, 5, 7},
                         {-30, -100, 4, 6}}),
          make_rod_part("brachioradialis", mm,
                        {{-18, -7, 66, 6},
                         {-23.5, -19.5, 40, 8.6},
                         {-23.8, -29, 24, 9},
                         {-22, -45, 20, 9},
                         {-20, -75, 17, 8},
                         {-19, -100, 15, 7}})};
}

std::vector<Solid> make_flexors(const Millimetres& mm) {
  return {make_strap_part("brachialis", mm, kForward,
                          {{0, -13, 100, 20, 14},
                           {0, -12.5, 50, 18, 12.4},
                           {0, -13, 28, 15, 11.5},
                           {1, -18.4, 14, 13, 8.4},
                           {3, -21, 2, 10, 5.6},
                           {4.5, -21, -12, 4, 2}}),
          make_rod_part("supinator", mm,
                        {{-18, -24, -7, 4.5},
                         {-15.5, -32, -6, 8.5},
                         {-14, -46, -4, 11},
                         {-12, -64, -2, 9.5},
                         {-12, -80, -2, 6}}),
          make_rod_part("flexor_carpi_ulnaris", mm,
                        {{25, 3, -6, 3.5},
                         {22, -10, -17, 7.5},
                         {19, -34, -20, 10},
                         {17, -70, -16, 10},
                         {16, -100, -14, 9}}),
          make_rod_part("flexor_pronator_mass", mm,
                        {{28, 2, 1, 3},
                         {27, -12, -3, 8.5},
                         {23, -34, 0, 13},
                         {15, -70, 3, 15},
                         {12, -100, 4, 14}}),
          make_rod_part("biceps_tendon", mm,
                        {{0, -31, 60, 3.4},
                         {-1.5, -31, 28, 2.8},
                         {-4, -33, 12, 2.5},
                         {-6.5, -40, 4, 2.2},
                         {-6, -44, -1, 2}}),
          make_strap_part("biceps_brachii", mm, kForward,
                          {{0, -31, 110, 20, 8},
                           {0, -31, 70, 17, 7.4},
                           {-0.5, -31.2, 50, 13, 5.8},
                           {-1, -31, 36, 8, 4},
                           {-1.8, -31, 22, 3, 2}})};
}

// Where bone lies under the skin, the skin follows it.
Field make_skin(const Millimetres& mm) {
  const Field arm = make_ribbon({{mm.at(0, -4, 150), kBack, mm.length(46), mm.length(45)},
                                 {mm.at(0, -3, 90), kBack, mm.length(44), mm.length(42)},
                                 {mm.at(0, -3, 45), kBack, mm.length(40), mm.length(37)},
                                 {mm.at(0, -3, 20), kBack, mm.length(37), mm.length(35.5)},
                                 {mm.at(0, -5, 2), kBack, mm.length(29), mm.length(29)}});
  const Field forearm = make_ribbon({{mm.at(0, 2, -2), kDown, mm.length(29), mm.length(26)},
                                     {mm.at(-1, -22, 0), kDown, mm.length(37.5), mm.length(30.5)},
                                     {mm.at(-4, -60, 0), kDown, mm.length(43), mm.length(33)},
                                     {mm.at(-4, -140, 2), kDown, mm.length(38), mm.length(29)}});
  const Field olecranon = make_rod(mm, {{5, 18, -4, 14.5}, {5, 13, -15, 15.2}, {4, -6, -19, 14}});
  const Field epicondyles = make_rod(mm, {{-26, 1.5, 3, 11.5}, {0, 6, 2, 12}, {28, 6, 2, 10.5}});
  const Field corners = unite(olecranon, epicondyles, mm.length(8));
  return unite(unite(arm, forearm, mm.length(14)), corners, mm.length(12));
}

}  // namespace

std::vector<Solid> make_elbow(const ElbowSize& size) {
  ARTUS_REQUIRE(size.scale > 0 && size.cartilage > 0 && size.recess > 0 && size.bursa > 0,
                "every size must be positive");
  const Millimetres mm = Millimetres::of_scale(size.scale);
  std::vector<Solid> solids{{"body", make_skin(mm), Vec3::Zero(), mm.length(420), 5e-3, 0.2e-3}};
  for (auto& parts : {make_bones(mm, size), make_lines(mm), make_bursae(mm, size),
                      make_lateral_side(mm), make_back(mm), make_extensors(mm), make_flexors(mm)})
    append(solids, parts);
  return solids;
}

}  // namespace artus
