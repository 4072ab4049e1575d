// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cmath>

#include "artus/detail/meshes/generate/scapular_frame.h"
#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

// The supraspinatus tendon where it bends over the head: its middle, its own directions (toward the
// insertion, across, out of the head).
const Vec3 kAlongTendon = Vec3(-0.767, -0.21, -0.607).normalized();
const Vec3 kOutOfTendon = Vec3(-0.62, -0.12, 0.775).normalized();

Field make_in_tendon(const Vec3& centre, const Vec3& half_axes) {
  const Vec3 out = (kOutOfTendon - kAlongTendon * kAlongTendon.dot(kOutOfTendon)).normalized();
  Eigen::Matrix3d axes;
  axes << kAlongTendon, out.cross(kAlongTendon), out;
  return make_ellipsoid(centre, half_axes, axes);
}

// Flat along the fibres, of lumps that run together.
Field make_deposit(const Millimetres& mm, const Vec3& centre) {
  const Vec3 across = kOutOfTendon.cross(kAlongTendon).normalized();
  const auto lump = [&](double along, double side, const Vec3& half_axes) {
    return make_in_tendon(
        centre + mm.length(along) * kAlongTendon + mm.length(side) * across,
        Vec3(mm.length(half_axes.x()), mm.length(half_axes.y()), mm.length(half_axes.z())));
  };
  const Field ends = unite(lump(3.2, 1.2, {3.2, 2.6, 1.3}), lump(-3, -1.6, {3.4, 2.4, 1.1}), 0);
  return unite(lump(0, 0, {4.6, 3.8, 1.7}), ends, mm.length(1));
}

// A wave in three directions, for edges that are torn and bone that is rough. No unit, -1 to 1.
double roughness(const Vec3& p, double length) {
  const Vec3 q = p / length;
  return (std::sin(q.x() + 1.7 * std::sin(0.8 * q.y())) + std::sin(1.1 * q.y() + 0.9 * q.z()) +
          std::sin(1.3 * q.z() - 0.7 * q.x() + 1)) /
         3;
}

// The tendon is off its footprint over 17 mm and drawn back as far [Kim2010]; what lies between is
// fluid up to the bursa, and the bone under it is pitted [Wohlwend1998].
Field make_tear(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const ScapularFrame frame(size.head_radius);
  const Field bone = make_humerus(size);
  const double wave = mm.length(0.9);
  const Field off_bone = [bone, wave](const Vec3& p) {
    return -bone(p) - 0.45e-3 - 0.55e-3 * roughness(p, wave);
  };
  // The stump is blunt: its bursal and its articular side slant to an edge between them.
  const Vec3 edge = frame.on_circle(28, 29, 2);
  const Field stump_sides =
      unite(make_half_space(edge, ScapularFrame::direction(0.55, 0.1, 0.83)),
            make_half_space(edge, ScapularFrame::direction(0.97, -0.1, -0.2)), mm.length(1.5));
  const Field stump = [stump_sides, wave](const Vec3& p) {
    return stump_sides(p) + 0.9e-3 * roughness(p, 0.9 * wave);
  };
  const Field under_bursa = make_ball(frame.at(0, 2, 0), mm.length(32.1));
  const Field oval =
      make_ellipsoid(frame.at(-19, 2.5, 18), mm.at(20, 9.5, 15), ScapularFrame::axes());
  // Frayed sides that lean together toward the bursa.
  const Vec3 middle = frame.at(0, 2, 0);
  const double deep = mm.length(27);
  const Field width = [oval, wave, middle, deep](const Vec3& p) {
    return oval(p) + 0.45 * ((p - middle).norm() - deep) + 1.2e-3 * roughness(p, 1.3 * wave) +
           1.3e-3 * roughness(p, 3.1 * wave);
  };
  const Field gap =
      intersect(intersect(under_bursa, off_bone, mm.length(0.6)), stump, mm.length(0.8));
  const Field end =
      make_half_space(frame.at(-27, 0, 10.5), ScapularFrame::direction(-0.85, 0, -0.5));
  return intersect(intersect(gap, width, mm.length(1)), end, mm.length(2));
}

// Fibres torn off the upper or the lower side of the tendon near its footprint: a frayed hollow
// with fluid, a little more than half of its thickness deep. The upper one opens to the bursa;
// under the lower one, which opens to the joint, the bone is pitted.
Field make_frayed_hollow(const ShoulderSize& size, double radius, double degrees, double depth) {
  const Millimetres mm(size.head_radius);
  const ScapularFrame frame(size.head_radius);
  const Vec3 middle = frame.on_circle(radius, degrees, 2.4);
  const Vec3 out = ScapularFrame::outward(degrees);
  const Vec3 across = ScapularFrame::direction(0, 1, 0);
  Eigen::Matrix3d axes;
  axes << across.cross(out), across, out;
  const Field oval = make_ellipsoid(middle, mm.at(6, 6.5, depth), axes);
  const double wave = mm.length(0.9);
  return [oval, wave](const Vec3& p) {
    return oval(p) + 0.5e-3 * roughness(p, 0.8 * wave) + 0.5e-3 * roughness(p, 2 * wave);
  };
}

Field make_bursal_tear(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const Field under_bursa = make_ball(ScapularFrame(size.head_radius).at(0, 2, 0), mm.length(31.9));
  return intersect(make_frayed_hollow(size, 31.4, 44, 3.4), under_bursa, mm.length(0.5));
}

Field make_articular_tear(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const Field bone = make_humerus(size);
  const double wave = mm.length(0.9);
  const Field off_bone = [bone, wave](const Vec3& p) {
    return -bone(p) - 0.3e-3 - 0.5e-3 * roughness(p, wave);
  };
  const Field off_cartilage =
      subtract(make_frayed_hollow(size, 25.8, 53, 2.9),
               make_ball(Vec3::Zero(), size.head_radius + size.cartilage), mm.length(0.4));
  return intersect(off_cartilage, off_bone, mm.length(0.5));
}

// Swollen folds of synovium on the floor of the bursa, 0.2 to 1.3 mm high: for a bursa that is
// thicker than they are.
Field make_bursal_synovium(const Millimetres& mm, const ShoulderSize& size) {
  const Field floor = grow(make_shoulder_cuff_side(size), size.peribursal_fat);
  const double wave = mm.length(0.85);
  const Field folds = [floor, wave](const Vec3& p) {
    return floor(p) - 0.75e-3 - 0.6e-3 * roughness(p, wave);
  };
  const Field layer = subtract(folds, floor, 0.1e-3);
  return intersect(layer, make_ball(mm.at(-18, -4, 24), mm.length(14)), mm.length(1));
}

// Between head and capsule, under the tendons as far as the cartilage goes; its pouch lies beside
// the posterior labrum.
Field make_posterior_recess(const Millimetres& mm, const ShoulderSize& size) {
  const double cartilage = size.head_radius + size.cartilage;
  const Field inside = make_ball(Vec3::Zero(), cartilage - 0.8e-3);
  const auto film = [&](double thickness) {
    return subtract(make_ball(Vec3::Zero(), cartilage + thickness), inside, 0.2e-3);
  };
  const Field on_cartilage = make_half_space(mm.at(-2, -1, -3), Vec3(-0.78, -0.15, -0.35));
  const Field behind = make_half_space(mm.at(0, -4, 0), Vec3(0, -1, 0.2));
  const Field wide = intersect(intersect(film(0.6e-3), behind, mm.length(2)), on_cartilage, 0.4e-3);
  return unite(wide, intersect(film(1.5e-3), make_ball(mm.at(13, 24.5, -2), mm.length(9)), 0.4e-3),
               mm.length(1));
}

// The cleft between both bones and the recess above it, under the capsule.
Field make_acromioclavicular_cavity(const Millimetres& mm, const Vec3& middle) {
  return unite(make_ellipsoid(middle, mm.at(3, 6, 4.5)),
               make_ellipsoid(middle + mm.at(0, 0, 2.8), mm.at(11, 10, 1.6)), mm.length(2));
}

// From the base of the coracoid over the biceps tendon to both tubercles.
Field make_coracohumeral_ligament(const Millimetres& mm, double thickness) {
  const std::vector<std::array<Vec3, 2>> edges{{mm.at(33, -2, 23), mm.at(31, -12, 18)},
                                               {mm.at(20, -7, 28), mm.at(19, -18, 23)},
                                               {mm.at(6, -11, 29.5), mm.at(5, -22, 23)},
                                               {mm.at(-5, -17, 25.5), mm.at(-7, -24, 18)}};
  std::vector<std::array<Vec3, 3>> triangles;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    triangles.push_back({edges[i][0], edges[i][1], edges[i + 1][0]});
    triangles.push_back({edges[i][1], edges[i + 1][1], edges[i + 1][0]});
  }
  return make_plate(triangles, 0.5 * thickness);
}

// Under the skin above the fossa, from the acromion to the neck.
Field make_trapezius(const Millimetres& mm, const ShoulderSize& size) {
  const Field body = make_shoulder_body(size);
  const Field layer = subtract(grow(body, -7e-3), grow(body, -19e-3), 0.2e-3);
  return intersect(layer, make_ball(mm.at(64, 26, 60), mm.length(46)), mm.length(3));
}

std::vector<TubeStation> make_course(const std::vector<Vec3>& points, double radius) {
  std::vector<TubeStation> stations;
  for (const Vec3& p : points) stations.push_back({p, radius});
  return stations;
}

}  // namespace

std::vector<Solid> make_shoulder_variants(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const Vec3 deposit = mm.at(-12.9, -3.5, 24.2);
  const Vec3 tear = ScapularFrame(size.head_radius).on_circle(28.4, 42, 2);
  const ScapularFrame frame(size.head_radius);
  const Vec3 bursal = frame.on_circle(30, 44, 2.4);
  const Vec3 articular = frame.on_circle(27.2, 52, 2.4);
  const Field synovium = make_bursal_synovium(mm, size);
  Vec3 fold = mm.at(-14, -4, 22);
  while (synovium(fold) >= 0 && fold.norm() < mm.length(60)) fold += 0.02e-3 * Vec3(-0.5, 0, 1);
  const Vec3 ac = mm.at(15.8, 7, 41);
  const Vec3 recess =
      Vec3(13, 24.5, -2).normalized() * (size.head_radius + size.cartilage + 0.6e-3);
  return {
      {"calcific_deposit", make_deposit(mm, deposit), deposit, mm.length(40), 0.8e-3, 0.04e-3},
      {"supraspinatus_tear", make_tear(size), tear, mm.length(50), 0.8e-3, 0.05e-3},
      {"bursal_tear", make_bursal_tear(size), bursal, mm.length(40), 0.8e-3, 0.05e-3},
      {"articular_tear", make_articular_tear(size), articular, mm.length(40), 0.8e-3, 0.05e-3},
      {"bursal_synovium", synovium, fold, mm.length(60), 1.2e-3, 0.08e-3},
      {"posterior_recess", make_posterior_recess(mm, size), recess, mm.length(50), 1e-3, 0.05e-3},
      {"coracohumeral_ligament", make_coracohumeral_ligament(mm, 1.6e-3), mm.at(6, -11, 29.5),
       mm.length(80), 1e-3, 0.06e-3},
      {"coracohumeral_ligament_thick", make_coracohumeral_ligament(mm, 3e-3), mm.at(6, -11, 29.5),
       mm.length(80), 1e-3, 0.06e-3},
      {"acromioclavicular_cavity", make_acromioclavicular_cavity(mm, ac), ac, mm.length(30), 0.9e-3,
       0.05e-3},
      {"acromioclavicular_capsule", make_ellipsoid(ac, mm.at(12.5, 12, 7)), ac, mm.length(40),
       1.3e-3, 0.06e-3},
      {"suprascapular_artery",
       make_tube(make_course({mm.at(63, -2, 42), mm.at(60.5, 12, 31.5), mm.at(60, 24, 19),
                              mm.at(56.5, 34, 12.5), mm.at(52, 40.5, -1)},
                             mm.length(1.3))),
       mm.at(60.5, 12, 31.5), mm.length(120), 1.2e-3, 0.06e-3},
      {"transverse_scapular_ligament",
       make_tube(make_course({mm.at(43, 11, 19), mm.at(54, 13, 25.7), mm.at(65, 22, 25)},
                             mm.length(1.3))),
       mm.at(54, 13, 25.7), mm.length(60), 1.2e-3, 0.06e-3},
      {"suprascapular_canal",
       make_tube(make_course(
           {mm.at(58, 2, 29), mm.at(54, 12, 21.5), mm.at(51, 24, 11.8), mm.at(48, 33, 7)},
           mm.length(4.2))),
       mm.at(54, 12, 21.5), mm.length(80), 1.5e-3, 0.08e-3},
      {"trapezius", make_trapezius(mm, size), mm.at(64, 26, 58), mm.length(120), 2.6e-3, 0.15e-3}};
}

}  // namespace artus
