// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/ankle.h"

#include <algorithm>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/detail/core/units.h"
#include "artus/detail/meshes/generate/limb.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

const Vec3 kFront(0, -1, 0);
const Vec3 kBack(0, 1, 0);
const Vec3 kLateral(-1, 0, 0);
const Vec3 kMedial(1, 0, 0);
const Vec3 kUp(0, 0, 1);

// The foot is drawn square to the leg and turned about the dome's axis, toes down, which opens the
// front of the joint as patients are asked to do.
constexpr double kPlantarflexion = 20;  // degrees, assumed

Vec3 turn(const Vec3& p, double share = 1) {
  return Eigen::AngleAxisd(share * kPlantarflexion * kDegree, Vec3::UnitX()) * p;
}

Field turn(Field field) {
  return [field = std::move(field)](const Vec3& p) {
    return field(turn(p, -1));
  };
}

// A station of what runs from leg to foot: the foot's part turns with it.
template <class Station>
Station bend(Station station) {
  const double share = std::clamp((12 - station[2]) / 20, 0.0, 1.0);
  const Vec3 turned =
      turn(Vec3(station[0], station[1], station[2]), share * share * (3 - 2 * share));
  std::copy_n(turned.data(), 3, station.begin());
  return station;
}

Solid make_course(std::string name, const Millimetres& mm, std::vector<RodStation> stations) {
  for (RodStation& s : stations) s = bend(s);
  return make_rod_part(std::move(name), mm, stations);
}

Solid make_course(std::string name, const Millimetres& mm, const Vec3& normal,
                  std::vector<StrapStation> stations) {
  for (StrapStation& s : stations) s = bend(s);
  return make_strap_part(std::move(name), mm, normal, stations);
}

// A drum with a radius of 20.7 mm, 29.9 mm wide in front and 25.2 mm behind [Hayes2006].
Field make_dome(const Millimetres& mm) {
  const Field drum = make_rod(mm, {{-30, 0, 0, 20.7}, {30, 0, 0, 20.7}});
  const Field sides = intersect(make_half_space(mm.at(13.8, 0, 0), Vec3(1, 0.06, 0)),
                                make_half_space(mm.at(-13.8, 0, 0), Vec3(-1, 0.06, 0)), 0);
  return intersect(intersect(drum, sides, mm.length(2)), make_half_space(mm.at(0, 0, 4), -kUp),
                   mm.length(2));
}

Field make_talus(const Millimetres& mm) {
  const Field body = make_ellipsoid(mm.at(0, 3, 1), mm.at(14, 19, 10));
  const Field neck =
      make_rod(mm, {{0, -6, 3, 10}, {3, -20, 0, 8.6}, {5.5, -29, -3, 9.6}, {6.5, -33, -4, 9.6}});
  const Field process = make_rod(mm, {{0, 12, -1, 7}, {-1, 20, -3, 4.5}});
  return turn(unite(unite(make_dome(mm), body, mm.length(4)), unite(neck, process, mm.length(3)),
                    mm.length(4)));
}

// The plafond on the dome with cartilage on both, and the medial malleolus beside it.
Field make_tibia(const Millimetres& mm, const AnkleSize& size) {
  const Field shaft = make_rod(mm, {{4, 5, 130, 12}, {3, 4, 70, 12.5}, {2, 3, 48, 14.5}});
  const Field plafond =
      make_ribbon({{mm.at(2, 3, 48), kFront, mm.length(15), mm.length(14.5)},
                   {mm.at(1.5, 1.5, 34), kFront, mm.length(18.5), mm.length(17.6)},
                   {mm.at(1.5, 1, 24), kFront, mm.length(20), mm.length(18)},
                   {mm.at(1.5, 1, 16), kFront, mm.length(20), mm.length(17)}},
                  2.6);
  const Field malleolus = make_rod(mm, {{17, -1, 26, 8}, {20, -2, 14, 7}, {20.4, -1, 5, 5.4}});
  const Field whole = unite(unite(shaft, plafond, mm.length(5)), malleolus, mm.length(4));
  const Field mortise =
      intersect(grow(make_rod(mm, {{-40, 0, 0, 20.7}, {13, 0, 0, 20.7}}), 2 * size.cartilage),
                make_half_space(mm.at(14.6, 0, 0), kMedial), mm.length(1));
  return subtract(whole, mortise, mm.length(0.8));
}

Field make_fibula(const Millimetres& mm) {
  const Field shaft = make_rod(mm, {{-23, 10, 130, 6},
                                    {-22.5, 9, 60, 6.2},
                                    {-22, 8, 28, 7.4},
                                    {-22.4, 7, 6, 7.6},
                                    {-22, 7.5, -6, 5.2}});
  return subtract(shaft, grow(make_talus(mm), 1.2e-3), mm.length(0.8));
}

// From the cuboid to a tuberosity whose upper back corner the Achilles tendon passes.
Field make_calcaneus(const Millimetres& mm) {
  const Field length = make_rod(
      mm, {{-9, -27, -22, 9.5}, {-5, -10, -21, 10.5}, {-1, 12, -20, 11.5}, {0, 30, -22, 13}});
  const Field tuberosity = make_ellipsoid(mm.at(0, 32.6, -22.5), mm.at(13.5, 15, 21));
  const Field corner = make_rod(mm, {{-6, 40.3, -7.8, 5.6}, {6, 40.3, -7.8, 5.6}});
  const Field shelf = make_rod(mm, {{2, -2, -15, 6}, {12, -4, -14, 4.6}});
  return turn(unite(unite(length, unite(tuberosity, corner, mm.length(4)), mm.length(6)), shelf,
                    mm.length(4)));
}

std::vector<Solid> make_bones(const Millimetres& mm, const AnkleSize& size) {
  const double reach = mm.length(240);
  const Field drum = make_rod(mm, {{-13.4, 0, 0, 20.7}, {13.4, 0, 0, 20.7}});
  const Field talar = turn(make_layer(drum, -0.6e-3, size.cartilage,
                                      make_ellipsoid(mm.at(0, 0, 17), mm.at(13.6, 19.5, 13))));
  // From within the talar cartilage, which takes its share, so that both meet in one surface.
  const Field tibial = make_layer(drum, 0.6 * size.cartilage, 2.6 * size.cartilage,
                                  grow(make_tibia(mm, size), 2 * size.cartilage));
  const Field roof =
      intersect(tibial, make_ellipsoid(mm.at(0.5, 0, 24), mm.at(14.5, 16.5, 9)), 0.5e-3);
  const double top = mm.length(20.7);
  return {{"tibia", make_tibia(mm, size), mm.at(3, 4, 70), reach, 2.4e-3, 0.12e-3},
          {"fibula", make_fibula(mm), mm.at(-22.5, 9, 60), reach, 2.4e-3, 0.12e-3},
          {"talus", make_talus(mm), mm.at(0, 0, 8), reach, 2e-3, 0.1e-3},
          {"calcaneus", make_calcaneus(mm), turn(mm.at(0, 25, -21)), reach, 2.4e-3, 0.12e-3},
          {"navicular",
           subtract(turn(make_ellipsoid(mm.at(8.5, -43, -6), mm.at(15, 8, 11.5))),
                    grow(make_talus(mm), 1.4e-3), mm.length(1)),
           turn(mm.at(8.5, -48, -6)), reach, 2.4e-3, 0.12e-3},
          {"talar_cartilage", talar, Vec3(0, 0, top + 0.4 * size.cartilage), mm.length(60), 1.6e-3,
           0.08e-3},
          {"tibial_cartilage", roof, Vec3(0, 0, top + 1.8 * size.cartilage), mm.length(60), 1.5e-3,
           0.08e-3}};
}

// In front the artery with the deep peroneal nerve between the toes' extensors; behind the medial
// malleolus the tibial nerve behind its artery; behind the lateral one the sural nerve.
std::vector<Solid> make_lines(const Millimetres& mm) {
  return {make_course("tibial_nerve", mm,
                      {{8, 27, 70, 2},
                       {12, 27.5, 34, 1.95},
                       {16.6, 24.5, 10, 1.9},
                       {17.6, 17.5, -10, 1.8},
                       {16.5, 6, -23, 1.6},
                       {13, -12, -31, 1.5}}),
          make_course("posterior_tibial_artery", mm,
                      {{10.5, 24, 70, 1.5},
                       {14.6, 24, 34, 1.5},
                       {18.8, 20.5, 10, 1.5},
                       {19.4, 13.5, -10, 1.4},
                       {18, 2, -21, 1.3},
                       {14.5, -14, -28, 1.2}}),
          make_course("anterior_tibial_artery", mm,
                      {{-7, -12, 75, 1.4},
                       {-3.4, -18.4, 45, 1.4},
                       {-1.4, -21.6, 26, 1.4},
                       {0, -26.4, 12, 1.3},
                       {1, -31, 6.5, 1.3},
                       {2, -36, 2, 1.3},
                       {3, -41, -6, 1.2},
                       {4, -46, -13, 1.2}}),
          make_course("deep_peroneal_nerve", mm,
                      {{-9.5, -11.4, 75, 1.1},
                       {-6, -18, 45, 1.1},
                       {-4.2, -21.4, 26, 1.1},
                       {-3, -26.4, 12, 1},
                       {-2, -31, 6.5, 1},
                       {-1, -36, 2, 1},
                       {0, -41, -6, 0.9},
                       {1, -46, -13, 0.9}}),
          make_course("sural_nerve", mm,
                      {{-13, 43, 75, 1.1},
                       {-17.5, 38, 38, 1.1},
                       {-22.4, 30, 10, 1.1},
                       {-25, 17, -12, 1},
                       {-26, -4, -24, 1}})};
}

// [Mohammed2023] 4.6 mm thick and 12 mm wide above the heel, 4.4 and 22 mm at its insertion.
std::vector<Solid> make_achilles(const Millimetres& mm, const AnkleSize& size) {
  const double half = 0.5 * size.bursa / mm.length(1);
  const auto turned = [](StrapStation station) {
    const Vec3 p = turn(Vec3(station[0], station[1], station[2]));
    std::copy_n(p.data(), 3, station.begin());
    return station;
  };
  return {make_strap_part(
              "retrocalcaneal_bursa", mm, kBack,
              {turned({0, 47.15, -15.5, 6, 0.7 * half}), turned({0, 46.65, -9, 8.5, 1.1 * half}),
               turned({0, 46.55, -4.5, 8.5, 1.1 * half}), turned({0, 47.65, 0, 6, 0.7 * half})}),
          make_strap_part("achilles_tendon", mm, kBack,
                          {bend(StrapStation{0, 46.6, -37, 9, 0.5}),
                           bend(StrapStation{0, 48.6, -29, 10.9, 1.6}),
                           bend(StrapStation{0, 49.8, -19, 10.6, 2.3}),
                           bend(StrapStation{0, 49.4, -8, 8.6, 2.3}),
                           {0, 47.8, 26, 6.4, 2.3},
                           {0, 47.2, 40, 6.1, 2.3},
                           {0, 46.4, 58, 6.6, 2.2},
                           {0, 45.4, 85, 8, 2}}),
          make_strap_part("kager_fat_pad", mm, kBack,
                          {{0, 34, 6, 9, 4},
                           {0, 36.6, 14, 10, 8},
                           {0, 37.2, 26, 10, 8.4},
                           {0, 38.6, 42, 8, 6.2},
                           {0, 40.4, 62, 5, 2.6},
                           {0, 41.6, 74, 3, 1}})};
}

// Over the neck of the talus from the tibia's lip on.
std::vector<Solid> make_front_of_joint(const Millimetres& mm, const AnkleSize& size) {
  // A lens along the front from the tibia's lip to the neck; bone takes its share.
  const Vec3 lens = mm.at(2, -18.6, 12.6);
  Eigen::Matrix3d axes;
  axes << kMedial, Vec3(0, 0.363, 0.932), Vec3(0, -0.932, 0.363);
  const Field recess =
      make_ellipsoid(lens, Vec3(mm.length(14), mm.length(11.5), size.recess), axes);
  return {
      {"anterior_recess", recess, lens - Vec3(0, mm.length(2), 0), mm.length(60), 1.4e-3, 0.07e-3},
      {"anterior_capsule", grow(recess, 1e-3), lens - Vec3(0, mm.length(2), 0), mm.length(60),
       1.5e-3, 0.08e-3},
      make_strap_part(
          "anterior_talofibular_ligament", mm, Vec3(-0.8, -0.6, 0.1),
          {{-24, -1, -1, 3.4, 1.1}, {-19, -7.4, -0.5, 3.8, 1.1}, {-12.5, -13, 0.5, 3.2, 1}}),
      make_strap_part("deltoid_ligament", mm, kMedial,
                      {{20, -1, 6, 6, 2}, {18, 0, -4, 8, 2}, {14.5, -1, -13, 8, 1.4}})};
}

std::vector<Solid> make_front_tendons(const Millimetres& mm) {
  const auto over = [&](double x, double y, const Vec3& normal) {
    return RibbonStation{mm.at(x, y, 34), normal.normalized(), mm.length(7), mm.length(0.55)};
  };
  return {make_course("tibialis_anterior_tendon", mm,
                      {{7, -14, 80, 2.6},
                       {9, -19, 50, 2.6},
                       {10.8, -22.6, 30, 2.6},
                       {12.6, -26.6, 14, 2.6},
                       {15, -35.5, 3, 2.5},
                       {20, -48, -5, 2.4}}),
          make_course("extensor_hallucis_longus", mm,
                      {{-1, -14, 80, 2},
                       {1, -19.4, 50, 2},
                       {2.2, -23, 30, 2},
                       {3, -27.6, 14, 2},
                       {4, -37.5, 8, 1.9},
                       {7, -56, 4, 1.8}}),
          make_course("extensor_digitorum_longus", mm, Vec3(0, -0.9, 0.3),
                      {{-10, -12, 80, 3, 2},
                       {-8.6, -18.6, 50, 4, 1.8},
                       {-8, -22.6, 30, 4.4, 1.7},
                       {-8, -27, 14, 5, 1.6},
                       {-9, -37.5, 7, 7, 1.5},
                       {-10, -56, 3, 9, 1.4}}),
          {"extensor_retinaculum",
           make_ribbon({over(17, -16.4, {0.6, -1, 0}), over(11, -24.6, {0.3, -1, 0}),
                        over(2, -25.6, {0, -1, 0}), over(-8, -24.8, {-0.2, -1, 0}),
                        over(-16.5, -16.8, {-0.7, -0.8, 0})},
                       3),
           mm.at(2, -25.6, 34), mm.length(80), 1.4e-3, 0.07e-3}};
}

std::vector<Solid> make_side_tendons(const Millimetres& mm) {
  return {make_course("tibialis_posterior_tendon", mm,
                      {{10, 19, 70, 2.4},
                       {15.5, 17.5, 34, 2.6},
                       {22, 9.5, 10, 2.6},
                       {23.4, 2, -4, 2.6},
                       {22.5, -14, -12, 2.5},
                       {20, -34, -13, 2.5}}),
          make_course("flexor_digitorum_longus", mm,
                      {{8, 22, 70, 2},
                       {14, 21, 34, 1.9},
                       {21.4, 15, 10, 1.9},
                       {22.6, 7.5, -8, 1.9},
                       {20, -10, -18, 1.9},
                       {14, -30, -24, 1.9}}),
          make_course("flexor_hallucis_longus_tendon", mm,
                      {{-2, 25, 30, 1.6},
                       {1, 24.6, 14, 2.2},
                       {5, 23, -2, 2.3},
                       {10, 12, -14, 2.3},
                       {13, -6, -20, 2.2},
                       {12, -30, -26, 2.2}}),
          make_course("peroneus_longus_tendon", mm,
                      {{-27, 14, 70, 2.6},
                       {-27, 17, 34, 2.5},
                       {-26, 17.6, 8, 2.4},
                       {-25.4, 12, -12, 2.4},
                       {-22, -8, -26, 2.3},
                       {-16, -22, -34, 2.3}}),
          make_course("peroneus_brevis_tendon", mm,
                      {{-23, 17, 70, 2.4},
                       {-23.4, 17.8, 34, 2.1},
                       {-23, 16, 8, 2},
                       {-24, 9, -11, 2},
                       {-24, -12, -19, 2},
                       {-26, -36, -25, 2}})};
}

std::vector<Solid> make_muscles(const Millimetres& mm) {
  return {
      make_rod_part("flexor_hallucis_longus", mm,
                    {{-9, 22, 100, 11},
                     {-9, 24, 60, 10},
                     {-6, 25, 34, 7.6},
                     {-2, 25.4, 18, 4},
                     {0, 25, 8, 2}}),
      make_rod_part("anterior_muscles", mm,
                    {{2, -12, 130, 13}, {1, -12.6, 96, 10}, {0, -14.6, 70, 5}, {0, -18, 48, 1.6}}),
      make_rod_part("peroneal_muscles", mm,
                    {{-26, 14, 120, 9},
                     {-25, 17, 80, 8},
                     {-23, 20, 52, 5.5},
                     {-21.5, 21, 36, 4},
                     {-21, 20.5, 22, 2.4}})};
}

// Where bone or tendon lies under the skin, the skin follows it.
Field make_skin(const Millimetres& mm) {
  const auto leg_at = [&](double y, double z, double wide, double thick) {
    return RibbonStation{mm.at(-1, y, z), kBack, mm.length(wide), mm.length(thick)};
  };
  const auto foot_at = [&](double x, double y, double z, double wide, double thick) {
    return RibbonStation{mm.at(x, y, z), kUp, mm.length(wide), mm.length(thick)};
  };
  const Field leg =
      make_ribbon({leg_at(14, 160, 44, 46), leg_at(14, 100, 38, 40), leg_at(12, 55, 32.5, 38.4),
                   leg_at(8, 28, 31, 39.6), leg_at(7, 2, 29, 39)});
  const Field foot = turn(make_ribbon(
      {foot_at(0, 18, -22, 26, 27), foot_at(0, -6, -18, 29, 33), foot_at(1, -32, -20, 34, 33),
       foot_at(2, -66, -25, 39, 27), foot_at(0, -130, -34, 42, 18)},
      2.3));
  const Field malleoli = unite(
      make_rod(mm, {{17.5, -1, 30, 11.5}, {20, -2, 14, 11}, {20.4, 0, 4, 9.6}}),
      make_rod(mm, {{-22, 9, 40, 10.5}, {-22, 8, 24, 11.4}, {-22.4, 7, 2, 11.2}, {-21, 8, -10, 8}}),
      0);
  const Field heel = make_rod(mm, {bend(RodStation{0, 29, -30, 25}),
                                   bend(RodStation{0, 34, -18, 20}),
                                   bend(RodStation{0, 41, -6, 15}),
                                   {0, 42.6, 26, 11.4},
                                   {0, 41.4, 44, 11.6},
                                   {0, 36, 80, 17}});
  const Field limb = unite(leg, foot, mm.length(24));
  return unite(unite(limb, heel, mm.length(10)), malleoli, mm.length(12));
}

}  // namespace

std::vector<Solid> make_ankle(const AnkleSize& size) {
  ARTUS_REQUIRE(size.scale > 0 && size.cartilage > 0 && size.recess > 0 && size.bursa > 0,
                "every size must be positive");
  const Millimetres mm = Millimetres::of_scale(size.scale);
  std::vector<Solid> solids{{"body", make_skin(mm), Vec3::Zero(), mm.length(440), 5e-3, 0.2e-3}};
  for (auto& parts :
       {make_bones(mm, size), make_lines(mm), make_front_of_joint(mm, size), make_front_tendons(mm),
        make_side_tendons(mm), make_achilles(mm, size), make_muscles(mm)})
    append(solids, parts);
  return solids;
}

}  // namespace artus
