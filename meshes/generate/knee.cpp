// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/knee.h"

#include <cmath>
#include <iterator>
#include <numbers>

#include "artus/detail/core/check.h"
#include "artus/detail/meshes/generate/millimetres.h"
#include "artus/detail/meshes/generate/sweep.h"

namespace artus {
namespace {

const Vec3 kFront(0, -1, 0);

// Both condyles and the groove for the patella between them.
Field make_condyles(const Millimetres& mm) {
  const Field medial = make_ball(mm.at(23, 6, 8), mm.length(22));
  const Field lateral = make_ball(mm.at(-23, 5, 8), mm.length(21));
  const Field groove = make_tube({{mm.at(15, -12, 14), mm.length(17)},
                                  {mm.at(0, -9, 14), mm.length(17)},
                                  {mm.at(-15, -12, 14), mm.length(18)}});
  return unite(unite(medial, lateral, mm.length(4)), groove, mm.length(8));
}

Field make_femur(const Millimetres& mm) {
  const Field shaft = make_tube({{mm.at(0, -2, 26), mm.length(21)},
                                 {mm.at(0, -3, 45), mm.length(18.5)},
                                 {mm.at(0, -4, 70), mm.length(15)},
                                 {mm.at(0, -4, 120), mm.length(13.5)}});
  return unite(make_condyles(mm), shaft, mm.length(10));
}

Field make_tibia(const Millimetres& mm) {
  const Field plateau =
      make_ribbon({{mm.at(-26, 3, -28), Vec3::UnitZ(), mm.length(22), mm.length(9)},
                   {mm.at(0, 3, -28), Vec3::UnitZ(), mm.length(23), mm.length(9)},
                   {mm.at(26, 3, -28), Vec3::UnitZ(), mm.length(23), mm.length(9)}});
  const Field shaft = make_tube({{mm.at(0, 2, -45), mm.length(23)},
                                 {mm.at(0, -1, -66), mm.length(17)},
                                 {mm.at(0, -3, -110), mm.length(13)}});
  return unite(unite(plateau, shaft, mm.length(8)), make_ball(mm.at(0, -21, -62), mm.length(8)),
               mm.length(5));
}

Field make_patella(const Millimetres& mm) {
  return make_ellipsoid(mm.at(0, -45, 18), mm.at(21, 9.5, 20));
}

// A C around the middle of a plateau, open toward the other.
Field make_meniscus(const Millimetres& mm, double side) {
  std::vector<TubeStation> stations;
  constexpr int kStations = 11;
  for (int i = 0; i < kStations; ++i) {
    const double angle = (-135 + 27.0 * i) * std::numbers::pi / 180;
    stations.push_back({mm.at(side * (21 + 17 * std::cos(angle)), 3 + 18 * std::sin(angle), -14.5),
                        mm.length(3.6)});
  }
  return make_tube(stations);
}

std::vector<Solid> make_bones(const Millimetres& mm, const KneeSize& size) {
  const Field condyles = make_condyles(mm);
  const Field coat = subtract(grow(condyles, size.cartilage), grow(condyles, -1e-3), 0.3e-3);
  const Field below = make_half_space(mm.at(0, -28, 30), Vec3(0, 0.25, 1));
  const Field patella = make_patella(mm);
  const Field behind = make_half_space(mm.at(0, -45, 18), kFront);
  const auto plateau_cartilage = [&](double side) {
    return make_ellipsoid(mm.at(side * 21, 3, -18.5), mm.at(16, 19, 2.6));
  };
  return {
      {"femur", make_femur(mm), mm.at(0, -4, 60), mm.length(200), 3e-3, 0.15e-3},
      {"tibia", make_tibia(mm), mm.at(0, 0, -50), mm.length(160), 3e-3, 0.15e-3},
      {"fibula",
       make_tube({{mm.at(-33, 16, -36), mm.length(9)},
                  {mm.at(-33, 16, -60), mm.length(6.5)},
                  {mm.at(-32, 14, -110), mm.length(6)}}),
       mm.at(-33, 16, -50), mm.length(120), 3e-3, 0.15e-3},
      {"patella", patella, mm.at(0, -45, 18), mm.length(60), 2.5e-3, 0.12e-3},
      {"femoral_cartilage", intersect(coat, below, 0.8e-3),
       mm.at(23, 6, -14) - Vec3(0, 0, 0.5 * size.cartilage), mm.length(140), 2e-3, 0.1e-3},
      {"patellar_cartilage",
       intersect(subtract(grow(patella, size.cartilage), grow(patella, -1e-3), 0.3e-3), behind,
                 0.8e-3),
       mm.at(0, -35.5, 18) + Vec3(0, 0.5 * size.cartilage, 0), mm.length(60), 1.8e-3, 0.1e-3},
      {"medial_tibial_cartilage", plateau_cartilage(1), mm.at(21, 3, -18.5), mm.length(60), 1.8e-3,
       0.08e-3},
      {"lateral_tibial_cartilage", plateau_cartilage(-1), mm.at(-21, 3, -18.5), mm.length(60),
       1.8e-3, 0.08e-3},
      {"medial_meniscus", make_meniscus(mm, 1), mm.at(38, 3, -14.5), mm.length(80), 1.8e-3, 0.1e-3},
      {"lateral_meniscus", make_meniscus(mm, -1), mm.at(-38, 3, -14.5), mm.length(80), 1.8e-3,
       0.1e-3}};
}

std::vector<Solid> make_soft_tissue(const Millimetres& mm, const KneeSize& size) {
  const auto flat = [&](double y, double z, double half_width, double half_thickness) {
    return RibbonStation{mm.at(0, y, z), kFront, mm.length(half_width), half_thickness};
  };
  const double half = size.recess / 2;
  const auto tube = [&](std::vector<std::array<double, 4>> stations) {
    std::vector<TubeStation> out;
    for (const auto& s : stations) out.push_back({mm.at(s[0], s[1], s[2]), mm.length(s[3])});
    return make_tube(out);
  };
  const double reach = mm.length(220);
  return {{"suprapatellar_recess",
           make_ribbon({flat(-33, 34, 22, 0.8 * half), flat(-33, 44, 24, half),
                        flat(-32, 58, 22, half), flat(-30, 72, 16, 0.7 * half)}),
           mm.at(0, -33, 44), mm.length(120), 2e-3, 0.1e-3},
          {"quadriceps_tendon",
           make_ribbon({flat(-47, 32, 15, mm.length(3.5)), flat(-44, 50, 15, mm.length(3.5)),
                        flat(-42, 62, 16, mm.length(3.8)), flat(-41, 74, 17, mm.length(4))}),
           mm.at(0, -44, 50), mm.length(120), 2.2e-3, 0.12e-3},
          {"patellar_tendon",
           make_ribbon({flat(-48, 3, 13, mm.length(2.6)), flat(-45, -20, 14, mm.length(2.6)),
                        flat(-35, -48, 13, mm.length(2.6)), flat(-30, -64, 11, mm.length(2.4))}),
           mm.at(0, -45, -20), mm.length(120), 2.2e-3, 0.12e-3},
          {"medial_collateral_ligament",
           make_ribbon({{mm.at(45, 4, 14), Vec3::UnitX(), mm.length(7), mm.length(1.6)},
                        {mm.at(47, 3, -18), Vec3::UnitX(), mm.length(8), mm.length(1.6)},
                        {mm.at(30, 2, -58), Vec3::UnitX(), mm.length(7), mm.length(1.6)}}),
           mm.at(47, 3, -18), mm.length(120), 2e-3, 0.1e-3},
          {"lateral_collateral_ligament",
           tube({{-44, 6, 12, 2.5}, {-45, 10, -10, 2.5}, {-40, 15, -32, 2.5}}), mm.at(-45, 10, -10),
           mm.length(120), 1.6e-3, 0.1e-3},
          {"rectus_femoris",
           make_ribbon({flat(-42, 66, 15, mm.length(4.5)), flat(-42, 84, 17, mm.length(6)),
                        flat(-44, 104, 20, mm.length(8)), flat(-45, 125, 22, mm.length(10))}),
           mm.at(0, -44, 104), reach, 3e-3, 0.2e-3},
          {"vastus_medialis",
           tube({{29, -26, 42, 8}, {31, -20, 70, 16}, {30, -16, 105, 21}, {29, -14, 125, 22}}),
           mm.at(31, -20, 70), reach, 3e-3, 0.2e-3},
          {"vastus_lateralis", tube({{-30, -26, 62, 8}, {-32, -18, 88, 17}, {-31, -14, 125, 21}}),
           mm.at(-32, -18, 88), reach, 3e-3, 0.2e-3},
          {"medial_gastrocnemius",
           tube({{20, 30, 16, 7}, {20, 33, -20, 12}, {20, 30, -70, 18}, {20, 28, -105, 19}}),
           mm.at(20, 33, -20), reach, 3e-3, 0.2e-3},
          {"lateral_gastrocnemius",
           tube({{-20, 30, 14, 7}, {-20, 33, -20, 11}, {-20, 30, -70, 16}, {-20, 28, -105, 17}}),
           mm.at(-20, 33, -20), reach, 3e-3, 0.2e-3},
          {"semimembranosus", tube({{27, 30, 120, 17}, {28, 33, 50, 12}, {30, 26, -18, 5}}),
           mm.at(28, 33, 50), reach, 3e-3, 0.2e-3},
          {"biceps_femoris", tube({{-28, 30, 120, 16}, {-32, 30, 50, 11}, {-36, 20, -28, 4.5}}),
           mm.at(-32, 30, 50), reach, 3e-3, 0.2e-3}};
}

Solid make_line(std::string name, const Millimetres& mm, double x, double y, double radius) {
  const double r = mm.length(radius);
  return {std::move(name),
          make_tube({{mm.at(x + 3, y - 2, 100), r},
                     {mm.at(x, y, 30), r},
                     {mm.at(x, y - 1, -20), r},
                     {mm.at(x - 2, y - 3, -90), r}}),
          mm.at(x, y, 30),
          mm.length(160),
          r,
          0.06 * r};
}

}  // namespace

std::vector<Solid> make_knee(const KneeSize& size) {
  ARTUS_REQUIRE(size.scale > 0 && size.cartilage > 0 && size.recess > 0,
                "every size must be positive");
  const Millimetres mm(24e-3 * size.scale);
  const Field body = make_tube({{mm.at(0, -2, 150), mm.length(68)},
                                {mm.at(0, -3, 80), mm.length(62)},
                                {mm.at(0, -4, 30), mm.length(57)},
                                {mm.at(0, -4, 0), mm.length(55)},
                                {mm.at(0, 0, -45), mm.length(52)},
                                {mm.at(0, 4, -130), mm.length(54)}});
  std::vector<Solid> solids{{"body", body, Vec3::Zero(), mm.length(420), 6e-3, 0.25e-3}};
  for (auto parts : {make_bones(mm, size), make_soft_tissue(mm, size)})
    solids.insert(solids.end(), std::make_move_iterator(parts.begin()),
                  std::make_move_iterator(parts.end()));
  solids.push_back(make_line("popliteal_artery", mm, 0, 36, 3.2));
  solids.push_back(make_line("popliteal_vein", mm, -3, 43, 3.6));
  solids.push_back(make_line("tibial_nerve", mm, -4, 49, 2.2));
  return solids;
}

}  // namespace artus
