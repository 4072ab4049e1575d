// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/probe/curve_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace artus {
namespace {

constexpr double kLightest = 0.02;   // N that tell of k
constexpr double kLight = 0.2;       // N that tell of b, and of slopes
constexpr double kShallow = 0.5e-3;  // m the same
constexpr double kMinHardening = 20;
constexpr double kMaxHardening = 400;  // 1/m
constexpr double kMaxLean = 0.8;       // of k, from the face's middle to its rim
constexpr int kFewestPoints = 8;       // pressing, that tell of slopes

/// b at which stiffness over force is the press's. It rises with b.
double fit_hardening(const FaceDepths::Row& depth, double ratio) {
  double low = kMinHardening;
  double high = kMaxHardening;
  for (int i = 0; i < 24; ++i) {
    const double b = 0.5 * (low + high);
    const UnitCurve unit = unit_curve(depth, b);
    const double stiffness = (depth > 0).select(unit.stiffness, 0).sum();
    (stiffness < ratio * unit.force.sum() ? low : high) = b;
  }
  return 0.5 * (low + high);
}

/// k and its slopes from force and torques: sums over points, linear in k (1, x, y).
void fit_slopes(const FaceDepths& face, const UnitCurve& unit, const PressAtRest& press,
                TissueCurve& curve) {
  const FaceDepths::Row f = unit.force / static_cast<double>(FaceDepths::kPoints);
  const auto& x = face.x();
  const auto& y = face.y();
  Eigen::Matrix3d sums;
  sums << f.sum(), (f * x).sum(), (f * y).sum(),            //
      (f * x).sum(), (f * x * x).sum(), (f * x * y).sum(),  //
      (f * y).sum(), (f * x * y).sum(), (f * y * y).sum();
  const Vec3 wanted(-press.force.z(), press.torque.y(), -press.torque.x());
  const Vec3 k = sums.fullPivLu().solve(wanted);
  if (!k.allFinite() || !(k[0] > 0)) return;
  const double half_x = x.abs().maxCoeff();
  const double half_y = y.abs().maxCoeff();
  curve.slope_x = std::clamp(k[1] / k[0], -kMaxLean / half_x, kMaxLean / half_x);
  curve.slope_y = std::clamp(k[2] / k[0], -kMaxLean / half_y, kMaxLean / half_y);
}

}  // namespace

TissueCurve fit_curve(const ProbePacket& packet, const PressAtRest& press,
                      const TissueCurve& before) {
  const double force = -press.force.z();
  if (!(force > kLightest) || !(packet.spacing_x > 0)) return before;
  FaceDepths face;
  face.set_face(packet.length, packet.width);
  face.look(packet, press.X_JP);
  if (!(face.depth() > 0).any()) return before;
  TissueCurve curve = before;
  if (force > kLight && face.depth().maxCoeff() > kShallow) {
    if (press.stiffness > 0) curve.hardening = fit_hardening(face.depth(), press.stiffness / force);
    curve.slope_x = curve.slope_y = 0;
    if ((face.depth() > 0).count() >= kFewestPoints)
      fit_slopes(face, unit_curve(face.depth(), curve.hardening), press, curve);
  }
  const UnitCurve unit = unit_curve(face.depth(), curve.hardening);
  const double by_unit = (face.shares(curve) * unit.force).sum();
  if (by_unit > 0) curve.stiffness = force / by_unit;
  return curve;
}

}  // namespace artus
