// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/scapular_frame.h"
#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

constexpr double kBand = 2.2;  // the power of a tendon's section: it thins out to its edges

// A tendon that thins to its footprint like a bird's beak, and medially to slips between the
// bundles of its muscle; the muscle runs out over it. The joint file puts the tendon first.
struct CuffMuscle {
  Field tendon;
  Field belly;
};

// Its footprint reaches from the groove backward over some 23 mm, and 16 mm from the edge of the
// cartilage to the edge of the facet [Curtis2006].
CuffMuscle make_supraspinatus(const ShoulderSize& size) {
  const ScapularFrame frame(size.head_radius);
  const double mm = size.head_radius / 24;
  // Thickness in place of the 5.8 mm of the reference, from bone or cartilage to the bursal side.
  const double more = size.tendon_thickness - 5.6e-3;
  const auto over = [&](double degrees, double top, double half, double width, double v) {
    const double grown = more * half / 3;
    return RibbonStation{
        frame.on_circle(top - half, degrees, v) + 0.5 * grown * ScapularFrame::outward(degrees),
        ScapularFrame::outward(degrees), width * mm, half * mm + 0.5 * grown};
  };
  const auto flat = [&](double u, double v, double z, double half, double width, double tilt) {
    return RibbonStation{frame.at(u, v, z), ScapularFrame::direction(tilt, 0, 1), width * mm,
                         half * mm};
  };
  // Its deep side is bone and cartilage, which take their share.
  const Field main = make_ribbon(
      {over(66.5, 29.8, 0.45, 12, 1), over(61, 30.3, 1.8, 13.5, 1.5), over(53, 30.7, 3.4, 15, 2.2),
       over(42, 31, 4.4, 15.5, 2.8), over(28, 31.2, 4.6, 15.5, 3), over(12, 31.2, 4.6, 15, 3),
       over(-2, 31.2, 4, 13.5, 3), flat(8, 2.6, 28.2, 2.8, 11, 0.1), flat(16, 2.4, 28.6, 2, 9, 0),
       flat(26, 2.6, 28.2, 1.3, 6.5, 0), flat(38, 3.6, 26.5, 0.8, 4.5, -0.1),
       flat(50, 5, 24.5, 0.35, 3, -0.1)},
      kBand);
  // Over the head it is as round across as the head is.
  const Field medial = make_half_space(frame.at(5, 0, 0), ScapularFrame::direction(-1, 0, 0));
  const auto round = [&](double radius) {
    return unite(make_ball(frame.at(0, 2, 0), radius * mm + more), medial, 3 * mm);
  };
  const Field upper = make_ribbon({flat(2, 2, 30.3, 0.6, 9, 0.1), flat(12, 2, 31.1, 0.55, 8, 0),
                                   flat(22, 2, 31.6, 0.45, 6, 0), flat(33, 3, 31.2, 0.25, 4, 0)},
                                  kBand);
  const Field lower = make_ribbon({flat(4, 2, 26.6, 0.7, 8, 0.1), flat(14, 2, 26.1, 0.55, 7, 0),
                                   flat(25, 2.4, 24.9, 0.25, 5, 0)},
                                  kBand);
  const Field belly = make_ribbon({flat(100, 17, 19, 6, 8, -0.5), flat(75, 11, 19, 9, 10, -0.2),
                                   flat(48, 4.6, 25, 8, 11, 0), flat(28, 2.4, 28.2, 5.4, 11, 0),
                                   flat(15, 2, 28.8, 3.7, 10.5, 0), flat(6, 2, 29.6, 2.2, 10, 0.1),
                                   over(3, 31.9, 0.9, 9.5, 2), over(16, 31.6, 0.3, 9, 2)});
  return {intersect(unite(main, unite(upper, lower, 0), 0.4e-3), round(31), 0.8e-3),
          intersect(belly, round(32), 0.8e-3)};
}

CuffMuscle make_infraspinatus(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const auto at = [&](const Vec3& p, const Vec3& normal, double half, double width) {
    return RibbonStation{mm.at(p.x(), p.y(), p.z()), normal, mm.length(width), mm.length(half)};
  };
  const Vec3 back(-0.64, 0.77, 0);
  const Field tendon = make_ribbon(
      {at({-24.2, 9.2, 8.6}, {-0.75, 0.45, 0.48}, 0.45, 11),
       at({-20.8, 14.2, 10}, {-0.6, 0.62, 0.5}, 1.9, 11.5),
       at({-15.2, 19.8, 10.4}, {-0.45, 0.78, 0.4}, 3.1, 12),
       at({-7, 25, 7.6}, {-0.25, 1, 0.25}, 3.2, 11), at({2, 27.6, 4.8}, {-0.05, 1, 0.15}, 3, 10.5),
       at({11, 30.2, 1.2}, {0, 1, 0.1}, 2, 8.5), at({21, 34, -4}, {-0.2, 1, 0.1}, 1.1, 6),
       at({34, 42, -12}, {-0.3, 1, 0.1}, 0.4, 4)},
      kBand);
  const Field belly = make_ribbon(
      {at({78, 74, -34}, back, 6, 20), at({54, 54, -24}, back, 9, 21),
       at({32, 38.5, -11}, {-0.3, 1, 0.1}, 8.5, 16), at({18, 31.6, -2.6}, {0, 1, 0.1}, 6.6, 13),
       at({9, 29.6, 2}, {0, 1, 0.1}, 4.6, 11.5), at({1, 30, 5}, {-0.1, 1, 0.15}, 1.8, 10),
       at({-8, 28.4, 8}, {-0.25, 1, 0.2}, 0.35, 8.5)});
  return {tendon, belly};
}

CuffMuscle make_subscapularis(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const auto at = [&](const Vec3& p, const Vec3& normal, double half, double width) {
    return RibbonStation{mm.at(p.x(), p.y(), p.z()), normal, mm.length(width), mm.length(half)};
  };
  const Vec3 front(0.64, -0.77, 0);
  const Field main = make_ribbon(
      {at({-9.6, -26.2, 0}, {-0.35, -0.93, 0}, 0.4, 10),
       at({-4.4, -27, -0.4}, {-0.1, -1, 0}, 1.8, 10.5),
       at({2, -26.8, -1.6}, {0.05, -1, 0}, 2.9, 11),
       at({10, -25.6, -3.4}, {0.25, -0.95, 0}, 3.2, 11.5),
       at({18, -22.8, -5}, {0.4, -0.9, 0}, 2.6, 12), at({26, -18.6, -7}, {0.5, -0.87, 0}, 1.3, 11),
       at({37, -9, -11}, {0.5, -0.87, 0}, 0.5, 9)},
      kBand);
  // Slips between the muscle's bundles, seen beside each other across the tendon.
  Field tendon = main;
  for (const double z : {-12.0, -4.5, 3.0}) {
    const Field slip = make_ribbon({at({16, -25.2, z - 2}, {0.4, -0.9, 0}, 0.9, 2.2),
                                    at({27, -19, z - 6}, {0.5, -0.87, 0}, 0.7, 1.8),
                                    at({40, -8, z - 11}, {0.5, -0.87, 0}, 0.35, 1.2)});
    tendon = unite(tendon, slip, 0.4e-3);
  }
  const Field belly = make_ribbon(
      {at({84, 46, -40}, front, 5, 26), at({62, 21, -24}, front, 9, 25),
       at({43, -3, -13}, {0.4, -0.9, 0}, 8, 19), at({26, -19, -7}, {0.5, -0.87, 0}, 5.4, 15),
       at({16, -25.6, -4.6}, {0.4, -0.9, 0}, 3.2, 13), at({8, -29, -3}, {0.2, -1, 0}, 1.3, 11.5),
       at({0, -30.2, -1}, {0, -1, 0}, 0.35, 10)});
  return {tendon, belly};
}

CuffMuscle make_teres_minor(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const auto at = [&](const Vec3& p, const Vec3& normal, double half, double width) {
    return RibbonStation{mm.at(p.x(), p.y(), p.z()), normal, mm.length(width), mm.length(half)};
  };
  const Field tendon = make_ribbon(
      {at({-20.5, 16.6, -2.6}, {-0.7, 0.7, 0}, 0.4, 4.5),
       at({-16, 20.6, -4}, {-0.5, 0.85, 0}, 1.4, 5), at({-9, 24.4, -7.6}, {-0.3, 1, 0}, 1.8, 5.4),
       at({0, 27.2, -13}, {-0.1, 1, 0}, 1.3, 4.5), at({11, 30, -20}, {0, 1, 0}, 0.4, 3)},
      kBand);
  const Field belly = make_ribbon(
      {at({58, 54, -66}, {-0.6, 0.8, 0}, 5, 6), at({38, 42, -42}, {-0.5, 0.9, 0}, 6.5, 8),
       at({12, 30, -21}, {0, 1, 0}, 4.5, 7), at({0, 28, -13.4}, {-0.1, 1, 0}, 2.4, 6.5),
       at({-9, 26.6, -8}, {-0.3, 1, 0}, 0.4, 5.5)});
  return {tendon, belly};
}

}  // namespace

std::vector<Solid> make_shoulder_cuff(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const double reach = mm.length(120);
  const CuffMuscle supraspinatus = make_supraspinatus(size);
  const CuffMuscle infraspinatus = make_infraspinatus(size);
  const CuffMuscle subscapularis = make_subscapularis(size);
  const CuffMuscle teres_minor = make_teres_minor(size);
  const Vec3 top(0, 0, mm.length(28));
  return {
      {"supraspinatus_tendon", supraspinatus.tendon, top, reach, 1.1e-3, 0.05e-3},
      {"infraspinatus_tendon", infraspinatus.tendon, mm.at(-7, 25.8, 7.6), reach, 1.1e-3, 0.05e-3},
      {"subscapularis_tendon", subscapularis.tendon, mm.at(10, -26.4, -3.4), reach, 1.1e-3,
       0.05e-3},
      {"teres_minor_tendon", teres_minor.tendon, mm.at(-9, 24.4, -7.6), reach, 1.1e-3, 0.05e-3},
      {"supraspinatus", supraspinatus.belly, mm.at(42, 24, 25), reach, 1.6e-3, 0.08e-3},
      {"infraspinatus", infraspinatus.belly, mm.at(32, 40, -11), reach, 1.8e-3, 0.1e-3},
      {"subscapularis", subscapularis.belly, mm.at(43, -3, -13), reach, 1.8e-3, 0.1e-3},
      {"teres_minor", teres_minor.belly, mm.at(38, 42, -42), reach, 1.8e-3, 0.1e-3}};
}

Field make_shoulder_cuff_side(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const Field groove = make_tube({{mm.at(-13, -20, 12), mm.length(4)},
                                  {mm.at(-16.6, -20, -8), mm.length(4)},
                                  {mm.at(-18, -18, -30), mm.length(3.6)}});
  // Between the tendons the capsule and its ligaments fill the intervals.
  const Field intervals = unite(make_ball(mm.at(0, 0, 0), mm.length(29)), groove, mm.length(4));
  Field side = unite(make_humerus(size), intervals, mm.length(3));
  for (const CuffMuscle& muscle : {make_supraspinatus(size), make_infraspinatus(size),
                                   make_subscapularis(size), make_teres_minor(size)})
    side = unite(side, unite(muscle.tendon, muscle.belly, 1e-3), mm.length(6));
  return side;
}

}  // namespace artus
