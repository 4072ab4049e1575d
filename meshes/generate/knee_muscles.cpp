// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <utility>

#include "artus/detail/meshes/generate/knee.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

/// A muscle's station: x, y, z, half width, half thickness, mm.
using MuscleStation = std::array<double, 5>;

Solid make_muscle(const char* name, const Millimetres& mm, const Vec3& normal,
                  const std::vector<MuscleStation>& stations) {
  std::vector<RibbonStation> ribbon;
  for (const auto& s : stations)
    ribbon.push_back({mm.at(s[0], s[1], s[2]), normal, mm.length(s[3]), mm.length(s[4])});
  const auto& inner = stations.at(stations.size() / 2);
  return {name,   make_ribbon(ribbon), mm.at(inner[0], inner[1], inner[2]), mm.length(240), 3.4e-3,
          0.16e-3};
}

// Fluid that a tract from the joint fills between the head of the gastrocnemius and the tendon of
// the semimembranosus [ESSRknee]; assumed: 4 cm long.
Field make_bakers_cyst(const Millimetres& mm) {
  const Field neck = make_tube({{mm.at(24.5, 25, 3), mm.length(2)},
                                {mm.at(25.5, 31, 2), mm.length(2.2)},
                                {mm.at(24.5, 34.5, -2), mm.length(4)}});
  const Field pouch =
      unite(make_ellipsoid(mm.at(22.5, 36.5, -12), mm.at(9.5, 5.4, 17)),
            make_ellipsoid(mm.at(20.5, 39.5, -26), mm.at(7, 4.2, 11)), mm.length(5));
  return unite(neck, pouch, mm.length(4));
}

// Each muscle ends toward the knee in a thin edge that runs out on its tendon [Gray2020].
std::vector<Solid> make_front_muscles(const Millimetres& mm) {
  const Vec3 front(0, -1, 0);
  const Vec3 medial(0.75, -0.66, 0);
  const Vec3 lateral(-0.75, -0.66, 0);
  return {make_muscle("rectus_femoris", mm, front,
                      {{-1, -46.6, 58, 8, 0.4},
                       {-1, -46.2, 70, 13, 2.6},
                       {-1, -46, 86, 17, 5.4},
                       {-1, -47, 110, 20, 8},
                       {-1, -48, 150, 22, 11}}),
          make_muscle("vastus_intermedius", mm, front,
                      {{-1, -35.5, 58, 12, 0.5},
                       {-1, -34, 68, 20, 4},
                       {-1, -30, 84, 26, 10},
                       {-1, -27, 105, 29, 13},
                       {-1, -26, 150, 30, 14}}),
          make_muscle("vastus_medialis", mm, medial,
                      {{21, -41, 24, 7, 0.5},
                       {27, -36, 36, 14, 4.5},
                       {32, -27, 54, 20, 9.5},
                       {34, -21, 78, 25, 14},
                       {34, -18, 110, 28, 18},
                       {34, -16, 150, 28, 20}}),
          make_muscle("vastus_lateralis", mm, lateral,
                      {{-22, -39, 46, 8, 0.5},
                       {-29, -34, 58, 14, 5},
                       {-34, -26, 76, 21, 10},
                       {-36, -19, 105, 27, 15},
                       {-36, -16, 150, 28, 18}})};
}

std::vector<Solid> make_back_muscles(const Millimetres& mm) {
  const Vec3 back(0, 1, 0);
  return {make_muscle("medial_gastrocnemius", mm, back,
                      {{20, 29, 18, 6, 1.2},
                       {20, 32, 4, 9, 5},
                       {20, 33, -20, 13, 9},
                       {21, 33, -60, 20, 14},
                       {21, 31, -120, 21, 15}}),
          make_muscle("lateral_gastrocnemius", mm, back,
                      {{-21, 29, 16, 6, 1.2},
                       {-21, 32, 2, 8.5, 4.5},
                       {-20, 33, -20, 12, 8},
                       {-19, 33, -60, 17, 12},
                       {-19, 31, -120, 18, 13}}),
          make_muscle("semimembranosus", mm, Vec3(0.5, 0.86, 0),
                      {{30, 30.5, 2, 5, 0.6},
                       {29, 31.5, 16, 9, 4.5},
                       {26, 32, 40, 13, 9.5},
                       {25, 33, 90, 19, 14},
                       {26, 34, 150, 21, 16}}),
          make_muscle("biceps_femoris", mm, Vec3(-0.5, 0.86, 0),
                      {{-38.5, 21, -22, 3, 0.5},
                       {-37, 23.5, -8, 5.5, 3},
                       {-35, 25.5, 8, 8, 5},
                       {-31, 29, 36, 12, 8.5},
                       {-28, 32, 90, 17, 13},
                       {-28, 34, 150, 19, 16}})};
}

// Round, out of the bellies to the back of the tibia and to the head of the fibula.
std::vector<Solid> make_back_tendons(const Millimetres& mm) {
  const auto tendon = [&](const char* name, const std::vector<TubeStation>& course) {
    return Solid{name, make_tube(course), course.at(2).centre, mm.length(120), 1.6e-3, 0.07e-3};
  };
  return {tendon("semimembranosus_tendon", {{mm.at(29, 33, 34), mm.length(0.6)},
                                            {mm.at(30, 33.5, 18), mm.length(2)},
                                            {mm.at(31, 32, 0), mm.length(2.8)},
                                            {mm.at(31, 28.5, -18), mm.length(2.8)},
                                            {mm.at(29.5, 23, -28), mm.length(2)}}),
          tendon("biceps_femoris_tendon", {{mm.at(-37, 29, 30), mm.length(0.6)},
                                           {mm.at(-38.5, 27.5, 10), mm.length(1.8)},
                                           {mm.at(-39.5, 24, -12), mm.length(2.4)},
                                           {mm.at(-39.5, 19.5, -30), mm.length(2.4)},
                                           {mm.at(-38, 18, -38), mm.length(1.6)}})};
}

}  // namespace

std::vector<Solid> make_knee_muscles(const KneeSize& size) {
  const Millimetres mm = Millimetres::of_scale(size.scale);
  std::vector<Solid> solids = make_front_muscles(mm);
  for (auto parts : {make_back_muscles(mm), make_back_tendons(mm)})
    for (Solid& s : parts) solids.push_back(std::move(s));
  return solids;
}

std::vector<Solid> make_knee_variants(const KneeSize& size) {
  const Millimetres mm = Millimetres::of_scale(size.scale);
  return {{"bakers_cyst", make_bakers_cyst(mm), mm.at(22.5, 36.5, -12), mm.length(80), 1.8e-3,
           0.06e-3}};
}

}  // namespace artus
