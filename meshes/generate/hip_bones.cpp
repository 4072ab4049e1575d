// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>
#include <numbers>

#include "artus/detail/meshes/generate/hip.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

// Out of the socket, along the axis of its rim.
const Vec3 kOutOfSocket = Vec3(-0.75, -0.3, -0.59).normalized();
constexpr double kRimMm = 3;     // the rim's plane lies so far out of the head's centre
constexpr double kLabrumMm = 5;  // [Labrum2001] 5.3 wide

Field make_bone_tube(const Millimetres& mm, const std::vector<std::array<double, 4>>& stations) {
  std::vector<TubeStation> out;
  for (const auto& s : stations) out.push_back({mm.at(s[0], s[1], s[2]), mm.length(s[3])});
  return make_tube(out);
}

// The neck leaves the shaft at 127 degrees and 10 degrees before the frontal plane [Toogood2009].
Field make_neck(const Millimetres& mm) {
  return make_bone_tube(
      mm, {{0, 0, 0, 16.5}, {-14, 2, -11, 15}, {-28, 5, -21, 15.5}, {-44, 9.5, -32, 18}});
}

// Socket, the iliac bone with both anterior spines, the pubic ramus with the iliopubic eminence,
// and the ischium. Its rim is rounded: nothing of it is an edge.
Field make_pelvis(const Millimetres& mm, double joint_radius) {
  const Field cup = intersect(make_ball(mm.at(9, 5, 7), mm.length(34)),
                              make_half_space(mm.length(kRimMm - 0.5) * kOutOfSocket, kOutOfSocket),
                              mm.length(5));
  const Field ilium = make_bone_tube(mm, {{18, 12, 28, 15}, {14, 13, 56, 11}, {2, 6, 110, 10}});
  const Field wing =
      make_plate({{mm.at(14, 14, 40), mm.at(-26, -30, 96), mm.at(20, 40, 110)}}, mm.length(4));
  const Field lower_spine =
      make_bone_tube(mm, {{10, -2, 28, 11}, {3, -15, 36, 8}, {-1, -22, 40, 6}});
  const Field upper_spine =
      make_bone_tube(mm, {{8, -2, 60, 6}, {-10, -18, 78, 6}, {-27, -34, 94, 7}});
  const Field pubis = make_bone_tube(
      mm, {{24, -10, 10, 12}, {33, -16, 9, 10}, {54, -27, -8, 8.5}, {80, -33, -24, 9}});
  const Field ischium =
      make_bone_tube(mm, {{26, 20, -8, 14}, {30, 28, -34, 12}, {28, 34, -60, 15}});
  const Field spines = unite(lower_spine, upper_spine, mm.length(5));
  const Field arms = unite(unite(unite(ilium, wing, mm.length(8)), spines, mm.length(6)),
                           unite(pubis, ischium, mm.length(6)), mm.length(6));
  return subtract(unite(cup, arms, mm.length(10)), make_ball(Vec3::Zero(), joint_radius),
                  mm.length(2));
}

// A wedge around the socket's rim that runs out over the head's cartilage; head and cartilage take
// their share of it.
Field make_labrum(const Millimetres& mm, double joint_radius) {
  constexpr int kPoints = 18;
  const Vec3 u = kOutOfSocket.unitOrthogonal();
  const Vec3 v = kOutOfSocket.cross(u);
  const auto ring = [&](double height_mm, double outside, double thickness) {
    const double height = mm.length(height_mm);
    const double radius = std::sqrt(joint_radius * joint_radius - height * height) + outside;
    std::vector<Vec3> points;
    for (int i = 0; i < kPoints; ++i) {
      const double angle = 2 * std::numbers::pi * i / kPoints;
      points.emplace_back(height * kOutOfSocket +
                          radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
    return make_ring(points, thickness);
  };
  const Field base = ring(kRimMm - 1, 0.9e-3, mm.length(2.9));
  const Field edge = ring(kRimMm + 0.6 * kLabrumMm, 0, mm.length(1.7));
  return unite(base, edge, mm.length(3));
}

}  // namespace

Field make_hip_femur(const HipSize& size) {
  const Millimetres mm(size.head_radius);
  const Field shaft =
      make_bone_tube(mm, {{-48, 9, -38, 18}, {-52, 7, -65, 16.5}, {-51, 6, -130, 14.5}});
  const Field greater =
      make_bone_tube(mm, {{-53, 12, -34, 15}, {-58, 14, -18, 12}, {-59, 17, -5, 8}});
  const Field lesser = make_bone_tube(mm, {{-42, 16, -60, 10}, {-36, 22, -62, 8.5}});
  const Field upper = unite(make_ball(Vec3::Zero(), size.head_radius), make_neck(mm), mm.length(6));
  return unite(unite(upper, shaft, mm.length(10)), unite(greater, lesser, 0), mm.length(7));
}

Field make_front_of_hip(const HipSize& size) {
  const Millimetres mm(size.head_radius);
  return unite(make_ball(Vec3::Zero(), size.head_radius + 1.2 * size.cartilage),
               make_bone_tube(mm, {{-14, 2, -11, 15}, {-28, 5, -21, 16}, {-46, 9.5, -33, 19}}),
               mm.length(14));
}

std::vector<Solid> make_hip_bones(const HipSize& size) {
  const Millimetres mm(size.head_radius);
  const double head = size.head_radius;
  const double joint_radius = head + 2 * size.cartilage;
  const auto shell = [](double inner, double outer) {
    return subtract(make_ball(Vec3::Zero(), outer), make_ball(Vec3::Zero(), inner), 0.3e-3);
  };
  // Thickest at the top of the dome; it thins out before the neck.
  const Vec3 dome = -kOutOfSocket;
  const double thins = 0.5e-3;
  const Field coat = subtract(make_ball(thins * dome, head + size.cartilage - thins),
                              make_ball(Vec3::Zero(), head - size.cartilage), 0.3e-3);
  const Field articular = make_half_space(mm.length(13) * kOutOfSocket, kOutOfSocket);
  const Field socket_side = make_half_space(mm.length(kRimMm) * kOutOfSocket, kOutOfSocket);
  const Vec3 on_rim = mm.length(kRimMm - 1) * kOutOfSocket +
                      (joint_radius + 0.9e-3) * kOutOfSocket.unitOrthogonal();
  return {
      {"femur", make_hip_femur(size), Vec3::Zero(), mm.length(200), 3e-3, 0.1e-3},
      {"pelvis", make_pelvis(mm, joint_radius), mm.at(18, 12, 30), mm.length(210), 3.6e-3, 0.15e-3},
      {"femoral_cartilage", intersect(coat, articular, 1.4e-3),
       (head + 0.3 * size.cartilage) * dome, mm.length(70), 1.8e-3, 0.07e-3},
      {"acetabular_cartilage",
       intersect(shell(head + 0.8 * size.cartilage, head + 2.8 * size.cartilage), socket_side,
                 0.8e-3),
       (head + 1.8 * size.cartilage) * dome, mm.length(70), 1.8e-3, 0.08e-3},
      {"acetabular_labrum", make_labrum(mm, joint_radius), on_rim, mm.length(80), 1.8e-3, 0.09e-3}};
}

}  // namespace artus
