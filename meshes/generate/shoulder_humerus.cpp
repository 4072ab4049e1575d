// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/scapular_frame.h"
#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/solids/millimetres.h"
#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

// A half-space whose face holds (u, v, z) and faces outward, both in the scapula's plane.
Field make_facet(const ScapularFrame& frame, const Vec3& through, const Vec3& outward) {
  return make_half_space(frame.at(through.x(), through.y(), through.z()),
                         ScapularFrame::direction(outward.x(), outward.y(), outward.z()));
}

// The three facets on which supraspinatus, infraspinatus and teres minor insert [Minagawa1998],
// the lateral face, and the wall of the bicipital groove.
Field make_greater_tuberosity(const Millimetres& mm, const ScapularFrame& frame) {
  const Field superior = make_facet(frame, {-15, 2, 18.4}, {-0.43, 0, 0.9});
  const Field middle = make_facet(frame, {-20, 12, 12.4}, {-0.5, 0.62, 0.6});
  const Field inferior = make_facet(frame, {-14, 21, -2}, {-0.35, 0.93, -0.1});
  const Field lateral = make_facet(frame, {-29.6, 0, 8}, {-1, 0, -0.2});
  const Field front = make_facet(frame, {-26.8, -12.4, 5}, {-0.88, -0.45, -0.15});
  const Field wall = make_facet(frame, {-25.2, -8.2, 0}, {0.3, -0.95, 0});
  const Field medial = make_facet(frame, {-9, 0, 0}, {1, 0, 0});
  const Field distal = make_facet(frame, {0, 0, -30}, {0.3, 0, -1});
  const Field top = intersect(intersect(superior, middle, mm.length(3)), inferior, mm.length(5));
  const Field sides = intersect(intersect(lateral, front, mm.length(5)), wall, mm.length(1.5));
  const Field ends = intersect(medial, distal, mm.length(6));
  return intersect(intersect(top, sides, mm.length(5)), ends, mm.length(3));
}

// Its front takes the subscapularis; its lateral side is the other wall of the groove.
Field make_lesser_tuberosity(const Millimetres& mm) {
  return make_tube(
      {{mm.at(-6.6, -18.8, 2), mm.length(8.4)}, {mm.at(-10, -14, -26), mm.length(6.5)}});
}

// 5 mm deep between the tuberosities [Groove2024]; assumed: 9 mm wide, shallower down the shaft.
Field make_bicipital_groove(const Millimetres& mm) {
  const auto station = [&](double x, double y, double z, double width, double depth) {
    return RibbonStation{mm.at(x, y, z), Vec3(x, y, 0), mm.length(width), mm.length(depth)};
  };
  return make_ribbon({station(-17.3, -20.6, 24, 4.5, 3.2), station(-17.3, -20.2, 8, 4.4, 3.0),
                      station(-17.4, -20.2, -8, 4.2, 2.9), station(-18, -18.8, -28, 3.6, 2.6),
                      station(-20, -17.2, -60, 3, 2)});
}

}  // namespace

Field make_humerus(const ShoulderSize& size) {
  const Millimetres mm(size.head_radius);
  const ScapularFrame frame(size.head_radius);
  const Field head = make_ball(Vec3::Zero(), size.head_radius);
  const Field shaft = make_tube({{mm.at(-4, 0, -8), mm.length(19)},
                                 {mm.at(-8, 0, -24), mm.length(16.5)},
                                 {mm.at(-13, 1, -44), mm.length(13.5)},
                                 {mm.at(-20, 2, -75), mm.length(11.5)},
                                 {mm.at(-29, 2, -115), mm.length(11)}});
  const Field core =
      unite(unite(head, shaft, mm.length(5)), make_greater_tuberosity(mm, frame), mm.length(1.5));
  return subtract(unite(core, make_lesser_tuberosity(mm), mm.length(2.5)),
                  make_bicipital_groove(mm), mm.length(2));
}

}  // namespace artus
