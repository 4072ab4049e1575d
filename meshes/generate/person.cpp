// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/person.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/meshes/generate/ankle.h"
#include "artus/detail/meshes/generate/elbow.h"
#include "artus/detail/meshes/generate/hip.h"
#include "artus/detail/meshes/generate/knee.h"
#include "artus/detail/meshes/generate/limb.h"
#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/solids/sweep.h"
#include "artus/detail/meshes/generate/wrist.h"

namespace artus {
namespace {

const Millimetres kMm = Millimetres::of_scale(1);
const Vec3 kForward(0, -1, 0);
const Vec3 kUp(0, 0, 1);
constexpr double kFlow = 22e-3;  // m over which parts flow together; assumed

// Joints in the frame of a posture. Of a person of 1.7 m [Drillis1966]: upper arm 0.186, forearm
// 0.146, shoulder to hip 0.288, thigh 0.245, shank 0.246, half the width of the shoulders 0.129.
const Vec3 kElbow = kMm.at(-40, 6, -300);
const Vec3 kWrist = kMm.at(-42, -244, -298);
const Vec3 kKnee = kMm.at(3, 0, -415);
const Vec3 kAnkle = kMm.at(4, -5, -833);
constexpr double kMiddleSitting = 165e-3;  // m, x of the body's middle
constexpr double kMiddleLying = 88e-3;     // m
constexpr double kShouldersLying = 452;    // mm above the hip

/// A joint's own skin in the frame of the person, the ball in which nothing else is, and over which
/// distance from it the rest of the person comes back.
struct Own {
  Field skin;
  Vec3 centre;
  double near = 0;    // m, of the ball
  double run = 6e-2;  // m; assumed
};

Field moved(Field field, const Vec3& to) {
  return [field = std::move(field), to](const Vec3& p) {
    return field(p - to);
  };
}

// The wrist's frame has the forearm along z and the palm forward; here it lies with the palm up.
Field with_palm_up(Field field, const Vec3& to) {
  return [field = std::move(field), to](const Vec3& p) {
    const Vec3 q = p - to;
    return field(Vec3(q.x(), -q.z(), q.y()));
  };
}

// `rest` drawn back under the skins near their joints, so that these go on in it without a step.
Field put_together(Field rest, std::vector<Own> joints) {
  constexpr double kBack = 30e-3;  // m
  return [rest = std::move(rest), joints = std::move(joints)](const Vec3& p) {
    double back = 0;
    double skin = 1;
    for (const Own& own : joints) {
      const double beyond = std::clamp(((p - own.centre).norm() - own.near) / own.run, 0.0, 1.0);
      back = std::max(back, kBack * (1 - beyond * beyond * (3 - 2 * beyond)));
      skin = std::min(skin, own.skin(p));
    }
    const double body = rest(p) + back;
    const double h = std::max(kFlow - std::abs(body - skin), 0.0) / kFlow;
    return std::min(body, skin) - 0.25 * kFlow * h * h;
  };
}

Field mirrored(Field right, double middle) {
  return [right = std::move(right), middle](const Vec3& p) {
    return right(Vec3(middle - std::abs(p.x() - middle), p.y(), p.z()));
  };
}

Field flow(std::vector<Field> parts) {
  Field all = std::move(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) all = unite(std::move(all), parts[i], kFlow);
  return all;
}

// Trunk, neck and head: `x` is the middle, heights are from the centre of the shoulder's head.
Field make_trunk_and_head(double x, double shoulder) {
  const auto at = [&](double y, double z, double wide, double thick) {
    return RibbonStation{kMm.at(x, y, z + shoulder), kForward, kMm.length(wide), kMm.length(thick)};
  };
  const auto rod = [&](double y, double z, double r) {
    return RodStation{x, y, z + shoulder, r};
  };
  const Field trunk = make_ribbon(
      {at(24, -475, 152, 76), at(14, -400, 160, 94), at(8, -300, 136, 96), at(10, -200, 138, 102),
       at(14, -100, 144, 104), at(18, -25, 132, 88), at(22, 20, 100, 60)},
      2.3);
  const Field neck = make_rod(kMm, {rod(26, 40, 64), rod(18, 100, 57), rod(6, 150, 57)});
  const Field skull = make_ellipsoid(kMm.at(x, -2, shoulder + 230), kMm.at(75, 95, 102));
  const Field face = make_ellipsoid(kMm.at(x, -38, shoulder + 178), kMm.at(58, 62, 72));
  const Field nose = make_rod(kMm, {rod(-98, 205, 8), rod(-108, 180, 11)});
  const Field ears = make_ellipsoid(kMm.at(x, 4, shoulder + 200), kMm.at(84, 14, 28));
  return unite(unite(flow({trunk, neck, skull, face}), nose, kMm.length(10)), ears, kMm.length(6));
}

// In the wrist's frame.
Field make_fingers() {
  const Field hand =
      flow({make_rod(kMm, {{-28, -3, -96, 10}, {-32, -5, -135, 9}, {-33, -10, -168, 7}}),
            make_rod(kMm, {{-10, -3, -98, 10.5}, {-11, -5, -145, 9}, {-11, -11, -182, 7}})});
  const Field outer =
      flow({make_rod(kMm, {{9, -3, -96, 10}, {11, -5, -138, 8.5}, {12, -11, -172, 7}}),
            make_rod(kMm, {{26, -3, -88, 9}, {31, -5, -122, 7.5}, {33, -10, -148, 6.5}})});
  const Field thumb = make_rod(kMm, {{-30, -8, -34, 15}, {-52, -12, -70, 12}, {-62, -14, -104, 9}});
  return unite(unite(hand, outer, kMm.length(3)), thumb, kMm.length(10));
}

Field make_sitting() {
  const double mid = kMiddleSitting / kMillimetre;
  const Field arm = make_rod(kMm, {{-20, 3, -70, 42}, {-33, 5, -150, 42}, {-40, 4, -230, 39}});
  const Field forearm =
      make_ribbon({{kMm.at(-43, -80, -300), kUp, kMm.length(41), kMm.length(32)},
                   {kMm.at(-43, -150, -299), kUp, kMm.length(35), kMm.length(27)},
                   {kMm.at(-42, -215, -298), kUp, kMm.length(29), kMm.length(20)}});
  const Field hand = with_palm_up(make_fingers(), kWrist);
  // Thigh 0.245, shank 0.246, foot 0.152 of the height [Drillis1966].
  const Field thigh = make_rod(kMm, {{mid - 82, 10, -468, 88},
                                     {mid - 86, -170, -462, 80},
                                     {mid - 90, -330, -458, 64},
                                     {mid - 90, -405, -462, 55}});
  const Field shank = make_rod(kMm, {{mid - 90, -408, -470, 54},
                                     {mid - 90, -395, -580, 55},
                                     {mid - 90, -400, -720, 42},
                                     {mid - 90, -402, -860, 36}});
  const Field foot =
      make_ribbon({{kMm.at(mid - 90, -380, -890), kUp, kMm.length(33), kMm.length(30)},
                   {kMm.at(mid - 92, -470, -898), kUp, kMm.length(40), kMm.length(24)},
                   {kMm.at(mid - 94, -580, -908), kUp, kMm.length(40), kMm.length(14)}});
  const Field trunk = make_trunk_and_head(mid, 0);
  const Field limbs =
      unite(unite(unite(arm, forearm, kFlow), hand, kMm.length(8)), flow({thigh, shank, foot}), 0);
  const std::vector<Own> joints{
      {make_shoulder_body({}), kMm.at(0, 0, 2), 82e-3},
      {make_shoulder_body({}), kMm.at(65, 28, 42), 62e-3},
      {moved(make_elbow({}).front().field, kElbow), kElbow + kMm.at(-8, -8, 0), 76e-3},
      {with_palm_up(make_wrist({}).front().field, kWrist), kWrist + kMm.at(-7, -5, 1), 46e-3,
       18e-3}};
  return mirrored(put_together(unite(trunk, limbs, kFlow), joints), kMiddleSitting);
}

Field make_lying() {
  const double mid = kMiddleLying / kMillimetre;
  const double up = kShouldersLying;
  const Field thigh = make_rod(kMm, {{-8, 6, -60, 74},
                                     {-14, 5, -150, 68},
                                     {-4, 3, -240, 66},
                                     {2, 1, -320, 61},
                                     {3, 1, -380, 53}});
  const Field shank = make_rod(
      kMm,
      {{3, 6, -450, 49}, {3, 12, -540, 52}, {3, 12, -610, 51}, {3, 9, -680, 44}, {3, 8, -760, 36}});
  const Vec3 back_of_foot(0, -0.342, 0.94);
  const Field foot =
      moved(make_ribbon({{kMm.at(2, -90, -68), back_of_foot, kMm.length(41), kMm.length(18)},
                         {kMm.at(6, -130, -88), back_of_foot, kMm.length(40), kMm.length(13)},
                         {kMm.at(8, -165, -103), back_of_foot, kMm.length(33), kMm.length(10)}}),
            kAnkle);
  const Field upper_arm = make_rod(kMm, {{mid - 165, 12, up - 6, 52},
                                         {mid - 195, 16, up - 80, 46},
                                         {mid - 222, 22, up - 200, 42},
                                         {mid - 228, 22, up - 300, 37}});
  const Field forearm = make_rod(kMm, {{mid - 226, 16, up - 300, 36},
                                       {mid - 170, -50, up - 285, 38},
                                       {mid - 90, -98, up - 262, 28},
                                       {mid - 44, -112, up - 248, 25}});
  const Field hand =
      make_ribbon({{kMm.at(mid - 50, -108, up - 250), kForward, kMm.length(30), kMm.length(18)},
                   {kMm.at(mid + 10, -112, up - 232), kForward, kMm.length(38), kMm.length(14)},
                   {kMm.at(mid + 80, -112, up - 212), kForward, kMm.length(32), kMm.length(9)}});
  const Field arm = flow({upper_arm, forearm, hand});
  const Field body = unite(unite(make_trunk_and_head(mid, up), arm, kMm.length(8)),
                           flow({thigh, shank, foot}), kFlow);
  const std::vector<Own> joints{
      {make_hip({}).front().field, kMm.at(-31, -30, -4), 100e-3},
      {moved(make_knee({}).front().field, kKnee), kKnee + kMm.at(0, -4, 18), 92e-3},
      {moved(make_ankle({}).front().field, kAnkle), kAnkle + kMm.at(0, -1, 2), 76e-3}};
  return mirrored(put_together(body, joints), kMiddleLying);
}

}  // namespace

std::vector<Solid> make_person() {
  constexpr double kReach = 1.4;           // m
  constexpr double kFacet = 24e-3;         // m
  constexpr double kFacetDistance = 2e-3;  // m
  return {{"sitting", make_sitting(), kMm.at(165, 10, -200), kReach, kFacet, kFacetDistance},
          {"lying", make_lying(), kMm.at(88, 10, 150), kReach, kFacet, kFacetDistance}};
}

}  // namespace artus
