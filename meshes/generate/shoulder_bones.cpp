// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

// From the centre of the head to the centre of the glenoid, and the glenoid's long axis.
const Vec3 kToGlenoid = Vec3(0.90, 0.40, -0.15).normalized();
const Vec3 kGlenoidUp = (Vec3::UnitZ() - kToGlenoid * kToGlenoid.z()).normalized();
// From the centre of the head through the middle of its articular surface.
const Vec3 kHeadAxis = Vec3(0.64, 0.30, 0.71).normalized();

Field make_glenoid_block(const Millimetres& mm, double joint_radius) {
  Eigen::Matrix3d axes;
  axes << kToGlenoid, kGlenoidUp, kToGlenoid.cross(kGlenoidUp);
  const Field block = make_ellipsoid(kToGlenoid * mm.length(36),
                                     Vec3(mm.length(13), mm.length(19), mm.length(14)), axes);
  return subtract(block, make_ball(Vec3::Zero(), joint_radius), mm.length(1));
}

Field make_scapula(const Millimetres& mm, double joint_radius) {
  const Vec3 neck = mm.at(42, 19, -2);
  const Vec3 superior_angle = mm.at(90, 64, 26);
  const Vec3 inferior_angle = mm.at(76, 70, -112);
  const Vec3 infraglenoid = mm.at(40, 19, -20);
  const Field blade = unite(
      make_plate({{neck, superior_angle, inferior_angle}, {neck, infraglenoid, inferior_angle}},
                 mm.length(2.5)),
      make_tube({{infraglenoid, mm.length(5)}, {inferior_angle, mm.length(4)}}), mm.length(3));
  const Field root = make_tube({{mm.at(36, 16, -5), mm.length(10.5)},
                                {neck, mm.length(9)},
                                {mm.at(54, 30, 0), mm.length(4)}});
  const Field coracoid = make_tube({{mm.at(38, 12, 8), mm.length(7)},
                                    {mm.at(39, -2, 19), mm.length(6.5)},
                                    {mm.at(36, -16, 19), mm.length(6)},
                                    {mm.at(33, -29, 11), mm.length(5.5)}});
  const Field acromion = make_plate({{mm.at(-3, -8, 38.5), mm.at(-4, 24, 37.5), mm.at(13, 34, 36)},
                                     {mm.at(-3, -8, 38.5), mm.at(13, 34, 36), mm.at(10, -6, 39)}},
                                    mm.length(4));
  const Field spine =
      unite(make_plate({{mm.at(14, 34, 35), mm.at(84, 64, 12), mm.at(50, 30, 2)}}, mm.length(2.5)),
            make_tube({{mm.at(13, 32, 36), mm.length(5)},
                       {mm.at(46, 52, 25), mm.length(4.5)},
                       {mm.at(84, 65, 13), mm.length(3.5)}}),
            mm.length(3));
  const Field body =
      unite(unite(make_glenoid_block(mm, joint_radius), root, mm.length(4)), blade, mm.length(4));
  return unite(unite(body, coracoid, mm.length(3)), unite(acromion, spine, mm.length(4)),
               mm.length(3));
}

Field make_clavicle(const Millimetres& mm) {
  return make_tube({{mm.at(22, 6, 40), mm.length(5.5)},
                    {mm.at(34, 4, 43), mm.length(5.5)},
                    {mm.at(60, -12, 46), mm.length(6)},
                    {mm.at(95, -40, 42), mm.length(6.5)}});
}

std::vector<Vec3> glenoid_rim(const Millimetres& mm, double joint_radius) {
  constexpr int kPoints = 16;
  const Vec3 across = kToGlenoid.cross(kGlenoidUp);
  std::vector<Vec3> rim;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    const Vec3 in_plane =
        kGlenoidUp * mm.length(17) * std::cos(angle) + across * mm.length(12.3) * std::sin(angle);
    rim.emplace_back((kToGlenoid * joint_radius + in_plane).normalized() * (joint_radius + 1.2e-3));
  }
  return rim;
}

Field make_glenoid_cartilage(const Millimetres& mm, const ShoulderSize& size) {
  Eigen::Matrix3d axes;
  axes << kToGlenoid, kGlenoidUp, kToGlenoid.cross(kGlenoidUp);
  const Field outline = make_ellipsoid(kToGlenoid * mm.length(30),
                                       Vec3(mm.length(30), mm.length(17), mm.length(12.3)), axes);
  const double inner = size.head_radius + 0.8 * size.cartilage;
  const Field bowl = subtract(make_ball(Vec3::Zero(), inner + 2 * size.cartilage),
                              make_ball(Vec3::Zero(), inner), 0.3e-3);
  return intersect(bowl, intersect(outline, make_half_space(Vec3::Zero(), -kToGlenoid), 0), 0.5e-3);
}

}  // namespace

std::vector<Solid> make_shoulder_bones(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const double joint_radius = size.head_radius + 2 * size.cartilage;
  // Thicker in the middle, thin at the anatomical neck, where it ends before the footprint.
  constexpr double kEndsAt = 0.12;  // of the radius above the middle: 83 degrees from the axis
  const double thins = 0.7e-3;
  const Field outer = make_ball(thins * kHeadAxis, size.head_radius + size.cartilage - thins);
  const Field head_cartilage =
      intersect(subtract(outer, make_ball(Vec3::Zero(), size.head_radius - size.cartilage), 0.3e-3),
                make_half_space(kEndsAt * size.head_radius * kHeadAxis, -kHeadAxis), 1.2e-3);
  const double middle = size.head_radius + 0.3 * size.cartilage;
  const Vec3 rim_seed = glenoid_rim(mm, joint_radius).front();
  return {{"humerus", make_humerus(size), Vec3::Zero(), mm.length(150), 1.8e-3, 0.06e-3},
          {"scapula", make_scapula(mm, joint_radius), mm.at(42, 19, -2), mm.length(180), 2.2e-3,
           0.12e-3},
          {"clavicle", make_clavicle(mm), mm.at(34, 4, 43), mm.length(100), 2.5e-3, 0.12e-3},
          {"humeral_cartilage", head_cartilage, middle * kHeadAxis, mm.length(60), 1.4e-3, 0.06e-3},
          {"glenoid_cartilage", make_glenoid_cartilage(mm, size),
           kToGlenoid * (size.head_radius + 1.8 * size.cartilage), mm.length(60), 1.2e-3, 0.06e-3},
          {"glenoid_labrum", make_ring(glenoid_rim(mm, joint_radius), mm.length(2.4)), rim_seed,
           mm.length(60), 1.2e-3, 0.08e-3}};
}

}  // namespace artus
