// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/body.h"

#include <cmath>

namespace artus::kit {
namespace {

constexpr double kTip = 90e-3;                // m from the prism's middle to the needle's tip
constexpr double kBarrel = -12e-3;            // m, y of the barrel's axis
constexpr double kFaceDepth = -15e-3;         // m, y of the probe's middle
constexpr double kHandle = 60e-3;             // m from the prism to the probe's face
constexpr double kTurn = 0.4363323129985824;  // rad: the mock's markers look past the needle's hand

MarkerBody make_prism(const char* name, const PrismSize& size, int first_id, double scale) {
  MarkerBody body{name, {}};
  const double half = size.face / 2;
  for (int row = 0; row < 2; ++row)
    for (int k = -1; k <= 1; ++k) {
      const double turn = k * kFaceTurn;
      const Vec3 right(std::cos(turn), -std::sin(turn), 0);
      const Vec3 edge(k * half, 0, (row == 0 ? -half : half));
      const Vec3 centre = edge + k * half * right;
      body.markers.push_back(
          make_marker(first_id + 3 * row + k + 1, scale * size.side, centre, right, Vec3::UnitZ()));
    }
  return body;
}

}  // namespace

Vec3 Marker::normal() const {
  return (corners[3] - corners[0]).cross(corners[1] - corners[0]).normalized();
}

Marker make_marker(int id, double side, const Vec3& centre, const Vec3& right, const Vec3& down) {
  const Vec3 x = side / 2 * right.normalized();
  const Vec3 y = side / 2 * down.normalized();
  return {id, side, {centre - x - y, centre + x - y, centre + x + y, centre - x + y}};
}

Pose pose_of_marker(const Marker& marker) {
  return make_pose(marker.centre(), marker.normal(), marker.corners[1] - marker.corners[0]);
}

MarkerBody make_probe_body(double scale) {
  return make_prism("probe", kProbePrism, kProbeId, scale);
}

MarkerBody make_syringe_body(double scale) {
  return make_prism("syringe", kSyringePrism, kSyringeId, scale);
}

MarkerBody make_sheet_body(double scale) {
  constexpr std::array<double, 4> kColumns{-112e-3, -37e-3, 37e-3, 112e-3};  // m
  constexpr double kRow = 78e-3;                                             // m
  MarkerBody body{"sheet", {}};
  int id = kSheetId;
  for (const double y : {kRow, -kRow})
    for (const double x : kColumns)
      body.markers.push_back(make_marker(id++, scale * kSheetSide, scale * Vec3(x, y, 0),
                                         Vec3::UnitX(), -Vec3::UnitY()));
  return body;
}

Marker make_plunger_marker(Hand hand, double scale) {
  constexpr double kBeside = 22e-3;  // m
  constexpr double kBehind = 85e-3;  // m behind the prism's middle
  const double x = hand == Hand::right ? kBeside : -kBeside;
  return make_marker(kPlungerId, scale * kPlungerSide, Vec3(x, kBarrel, -kBehind), Vec3::UnitX(),
                     Vec3::UnitZ());
}

Pose nominal_needle() {
  return make_pose(Vec3(0, kBarrel, kTip), Vec3::UnitZ(), Vec3::UnitX());
}

Pose nominal_face(Hand hand) {
  const double turn = hand == Hand::right ? kTurn : -kTurn;
  return make_pose(Vec3(0, kFaceDepth, kProbePrism.length / 2 + kHandle), Vec3::UnitZ(),
                   Vec3(std::cos(turn), std::sin(turn), 0));
}

}  // namespace artus::kit
