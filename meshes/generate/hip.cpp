// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/hip.h"

#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "artus/detail/core/check.h"
#include "artus/detail/meshes/generate/millimetres.h"
#include "artus/detail/meshes/generate/sweep.h"

namespace artus {
namespace {

// Out of the socket, along the axis of its rim.
const Vec3 kOut = Vec3(-0.75, -0.3, -0.59).normalized();
constexpr double kRimMm = 3;  // the rim's plane lies so far out of the head's centre

Field tube(const Millimetres& mm, const std::vector<std::array<double, 4>>& stations) {
  std::vector<TubeStation> out;
  for (const auto& s : stations) out.push_back({mm.at(s[0], s[1], s[2]), mm.length(s[3])});
  return make_tube(out);
}

Field make_neck(const Millimetres& mm) {
  return tube(mm, {{0, 0, 0, 17}, {-14, 1, -12, 15}, {-28, 3, -22, 15.5}, {-44, 9, -32, 18}});
}

Field make_femur(const Millimetres& mm) {
  const Field shaft = tube(mm, {{-48, 9, -38, 18}, {-52, 7, -65, 16.5}, {-51, 6, -110, 14.5}});
  const Field greater = tube(mm, {{-52, 14, -30, 15}, {-58, 16, -16, 12}});
  const Field lesser = make_ball(mm.at(-36, 22, -62), mm.length(9));
  const Field upper = unite(make_ball(Vec3::Zero(), mm.length(24)), make_neck(mm), mm.length(5));
  return unite(unite(upper, shaft, mm.length(8)), unite(greater, lesser, 0), mm.length(5));
}

Field make_pelvis(const Millimetres& mm, double joint_radius) {
  const Field cup = intersect(make_ball(mm.at(10, 5, 8), mm.length(33)),
                              make_half_space(mm.length(kRimMm) * kOut, kOut), mm.length(3));
  const Field ilium = tube(mm, {{20, 12, 30, 15}, {16, 14, 60, 11}, {4, 8, 100, 10}});
  const Field pubis = tube(mm, {{28, -12, 4, 11}, {52, -26, -12, 9}, {76, -32, -24, 9}});
  const Field ischium = tube(mm, {{28, 22, -12, 13}, {30, 30, -55, 15}});
  const Field arms = unite(unite(ilium, pubis, mm.length(6)), ischium, mm.length(6));
  return subtract(unite(cup, arms, mm.length(8)), make_ball(Vec3::Zero(), joint_radius),
                  mm.length(1));
}

std::vector<Vec3> rim_of(const Millimetres& mm, double joint_radius) {
  constexpr int kPoints = 18;
  const Vec3 u = kOut.unitOrthogonal();
  const Vec3 v = kOut.cross(u);
  const double height = mm.length(kRimMm);
  const double radius = std::sqrt(joint_radius * joint_radius - height * height);
  std::vector<Vec3> rim;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    rim.emplace_back(height * kOut + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return rim;
}

std::vector<Solid> make_bones(const Millimetres& mm, const HipSize& size) {
  const double head = size.head_radius;
  const double joint_radius = head + 2 * size.cartilage;
  const auto shell = [](double inner, double outer) {
    return subtract(make_ball(Vec3::Zero(), outer), make_ball(Vec3::Zero(), inner), 0.3e-3);
  };
  const Field socket_side = make_half_space(mm.length(kRimMm) * kOut, kOut);
  const auto rim = rim_of(mm, joint_radius);
  return {
      {"femur", make_femur(mm), Vec3::Zero(), mm.length(180), 3e-3, 0.15e-3},
      {"pelvis", make_pelvis(mm, joint_radius), mm.at(20, 12, 30), mm.length(190), 3e-3, 0.15e-3},
      {"femoral_cartilage",
       intersect(shell(head - size.cartilage, head + size.cartilage),
                 make_half_space(mm.length(9) * kOut, kOut), 0.8e-3),
       -(head + 0.3 * size.cartilage) * kOut, mm.length(70), 1.8e-3, 0.08e-3},
      {"acetabular_cartilage",
       intersect(shell(head + 0.8 * size.cartilage, head + 2.8 * size.cartilage), socket_side,
                 0.5e-3),
       -(head + 1.8 * size.cartilage) * kOut, mm.length(70), 1.8e-3, 0.08e-3},
      {"acetabular_labrum", make_ring(rim, mm.length(2.8)), rim.front(), mm.length(80), 1.6e-3,
       0.1e-3}};
}

// Before the neck, one layer on the other: fluid on the bone, capsule on the fluid.
std::vector<Solid> make_joint_layers(const Millimetres& mm, const HipSize& size) {
  const Field bone = make_femur(mm);
  const auto layer = [&](double begin, double end, double radius) {
    const Field coat = subtract(grow(bone, end), grow(bone, begin), 0.3e-3);
    return intersect(coat, make_ball(mm.at(-15, -16, -12), mm.length(radius)), 0.8e-3);
  };
  const double kept = 0.6e-3;  // between bone and fluid: synovium on periosteum
  const auto before_neck = [&](double distance) {
    Vec3 p = mm.at(-14, -10, -12);
    while (bone(p) < distance) p.y() -= 0.05e-3;
    return p;
  };
  return {{"anterior_recess", layer(kept, kept + size.recess, 14),
           before_neck(kept + 0.5 * size.recess), mm.length(60), 1.6e-3, 0.1e-3},
          {"hip_capsule", layer(kept + 0.5 * size.recess, kept + size.recess + size.capsule, 22),
           before_neck(kept + size.recess + 0.5 * size.capsule), mm.length(80), 2e-3, 0.1e-3}};
}

std::vector<Solid> make_muscles(const Millimetres& mm) {
  const double reach = mm.length(240);
  const auto muscle = [&](const char* name, const std::vector<std::array<double, 4>>& stations) {
    const auto& s = stations[1];
    return Solid{name, tube(mm, stations), mm.at(s[0], s[1], s[2]), reach, 3e-3, 0.2e-3};
  };
  return {
      muscle("iliopsoas", {{14, -30, 70, 14},
                           {8, -38, 25, 10},
                           {0, -40, 0, 9},
                           {-8, -32, -30, 8},
                           {-28, 6, -60, 5}}),
      muscle("rectus_femoris",
             {{-12, -34, 50, 6}, {-25, -38, 0, 9}, {-32, -42, -50, 12}, {-36, -40, -100, 14}}),
      muscle("sartorius",
             {{-34, -36, 70, 7}, {-14, -49, 10, 7}, {6, -50, -50, 8}, {22, -44, -100, 8}}),
      muscle("tensor_fasciae_latae", {{-50, -22, 70, 8}, {-58, -22, 10, 9}, {-66, -14, -60, 7}}),
      muscle("gluteus_medius", {{-24, 22, 90, 20}, {-48, 22, 40, 19}, {-60, 18, -2, 9}}),
      muscle("gluteus_maximus", {{14, 50, 60, 14}, {-20, 48, 0, 16}, {-46, 36, -70, 12}}),
      muscle("vastus_lateralis", {{-70, 6, -42, 6}, {-70, 0, -80, 11}, {-66, -4, -100, 13}}),
      muscle("adductor_longus", {{66, -34, -30, 6}, {40, -24, -62, 13}, {10, -14, -105, 16}})};
}

Solid make_line(const char* name, const Millimetres& mm, double x, double y, double radius) {
  const double r = mm.length(radius);
  return {name,
          make_tube({{mm.at(x - 2, y + 3, 55), r},
                     {mm.at(x, y, 10), r},
                     {mm.at(x - 1, y + 2, -30), r},
                     {mm.at(x - 3, y + 8, -80), r}}),
          mm.at(x, y, 10),
          mm.length(140),
          r,
          0.06 * r};
}

}  // namespace

std::vector<Solid> make_hip(const HipSize& size) {
  ARTUS_REQUIRE(size.head_radius > 0 && size.cartilage > 0 && size.recess > 0 && size.capsule > 0,
                "every size must be positive");
  const Millimetres mm(size.head_radius);
  const Field thigh = tube(mm, {{-8, 5, 20, 70}, {-18, 3, -60, 68}, {-20, 2, -140, 64}});
  const Field groin = tube(mm, {{30, 8, 45, 70}, {30, 9, -20, 69}});
  const Field trunk = make_ellipsoid(mm.at(45, 18, 80), mm.at(110, 85, 95));
  std::vector<Solid> solids{{"body",
                             unite(unite(thigh, groin, mm.length(20)), trunk, mm.length(30)),
                             Vec3::Zero(), mm.length(480), 6e-3, 0.25e-3}};
  for (auto parts : {make_bones(mm, size), make_joint_layers(mm, size), make_muscles(mm)})
    solids.insert(solids.end(), std::make_move_iterator(parts.begin()),
                  std::make_move_iterator(parts.end()));
  solids.push_back(make_line("femoral_nerve", mm, 12, -51, 2.2));
  solids.push_back(make_line("femoral_artery", mm, 22, -50, 4.2));
  solids.push_back(make_line("femoral_vein", mm, 33, -48, 4.8));
  return solids;
}

}  // namespace artus
