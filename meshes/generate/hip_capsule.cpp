// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>

#include "artus/detail/meshes/generate/hip.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

constexpr double kSynovium = 0.6e-3;  // m between bone and fluid. assumed

// Along the neck toward the head, across it, forward.
Eigen::Matrix3d along_neck() {
  const Vec3 forward = Vec3(0.12, -0.985, -0.12).normalized();
  const Vec3 along = (Vec3(0.8, 0, 0.6) - forward * forward.dot(Vec3(0.8, 0, 0.6))).normalized();
  Eigen::Matrix3d axes;
  axes << along, forward.cross(along), forward;
  return axes;
}

// The first point before the neck that is well inside a layer.
Vec3 find_seed(const Millimetres& mm, const Field& layer, const Vec3& from) {
  Vec3 p = from;
  while (layer(p) > -0.5e-3 && p.y() > mm.at(0, -80, 0).y()) p.y() -= 0.05e-3;
  return p;
}

}  // namespace

std::vector<Solid> make_hip_capsule(const HipSize& size) {
  const Millimetres mm(size.head_radius);
  const Field bone = make_hip_femur(size);
  const double half = 0.5 * size.recess;
  const Eigen::Matrix3d axes = along_neck();
  // Fluid in the hollow before the neck, thinning out over the head and at the trochanters.
  const Field recess = make_cushion(bone, kSynovium + half, mm.at(-17, -14, -13.5),
                                    Vec3(mm.length(18), mm.length(13), half), axes);
  // The capsule stretches from rim to trochanters over fluid, head and neck; it is thickest in
  // the iliofemoral ligament.
  const Field front = make_front_of_hip(size);
  const double bulge = 0.3 * size.recess;  // what of the recess stands out of that front
  const Vec3 over = mm.at(-17, -17, -13.5);
  const double reach = mm.length(15);
  const Field inner = [=](const Vec3& p) {
    return front(p) - bulge * std::exp(-(p - over).squaredNorm() / (reach * reach));
  };
  const double half_capsule = 0.5 * size.capsule;
  const Field capsule = make_cushion(inner, half_capsule, mm.at(-14, -22, -8),
                                     Vec3(mm.length(42), mm.length(34), half_capsule), axes);
  return {{"anterior_recess", recess, find_seed(mm, recess, mm.at(-17, -10, -13.5)), mm.length(60),
           1.5e-3, 0.05e-3},
          {"hip_capsule", capsule, find_seed(mm, capsule, mm.at(-14, -10, -8)), mm.length(100),
           2.4e-3, 0.08e-3}};
}

std::vector<Solid> make_hip_variants(const HipSize& size) {
  const Millimetres mm(size.head_radius);
  const Eigen::Matrix3d axes = along_neck();
  // Between capsule and tendon of the iliopsoas, medial of the recess; assumed: 9 mm thick.
  const Field bursa = make_cushion(make_front_of_hip(size), size.capsule + mm.length(3.2),
                                   mm.at(10, -32, 6), mm.at(17, 13, 4.5), axes);
  return {{"iliopsoas_bursa", bursa, find_seed(mm, bursa, mm.at(10, -26, 6)), mm.length(60), 1.8e-3,
           0.06e-3}};
}

}  // namespace artus
