// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/probe/probe_packet.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

/// A place between two heights of a row: the lower one's index and the share of the next.
struct Between {
  std::size_t index = 0;
  double share = 0;
  bool inside = false;  // beyond the grid the skin goes on level
};

Between between(double p, double spacing, std::size_t n) noexcept {
  const double last = static_cast<double>(n - 1);
  const double at = p / spacing + 0.5 * last;
  const double held = std::clamp(at, 0.0, last);
  const auto index = std::min(static_cast<std::size_t>(held), n - 2);
  return {index, held - static_cast<double>(index), held == at};
}

}  // namespace

void FaceDepths::set_face(double length, double width) noexcept {
  for (Eigen::Index i = 0; i < kPoints; ++i) {
    x_[i] = length * ((static_cast<double>(i % kColumns) + 0.5) / kColumns - 0.5);
    y_[i] = width * ((static_cast<double>(i / kColumns) + 0.5) / kRows - 0.5);
  }
}

void FaceDepths::look(const ProbePacket& packet, const Pose& X_JP) noexcept {
  const Pose X_FP = frame_of(packet).inverse() * X_JP;
  const auto& R = X_FP.linear();
  const Vec3& o = X_FP.translation();
  for (Eigen::Index i = 0; i < kPoints; ++i) {
    const double px = R(0, 0) * x_[i] + R(0, 1) * y_[i] + o.x();
    const double py = R(1, 0) * x_[i] + R(1, 1) * y_[i] + o.y();
    const double pz = R(2, 0) * x_[i] + R(2, 1) * y_[i] + o.z();
    const Between u = between(px, packet.spacing_x, ProbePacket::kColumns);
    const Between v = between(py, packet.spacing_y, ProbePacket::kRows);
    const double* low = packet.z.data() + ProbePacket::kColumns * v.index + u.index;
    const double* high = low + ProbePacket::kColumns;
    const double near = low[0] + u.share * (low[1] - low[0]);
    const double far = high[0] + u.share * (high[1] - high[0]);
    depth_[i] = pz - (near + v.share * (far - near));
    slope_x_[i] = u.inside ? ((1 - v.share) * (low[1] - low[0]) + v.share * (high[1] - high[0])) /
                                 packet.spacing_x
                           : 0;
    slope_y_[i] = v.inside ? (far - near) / packet.spacing_y : 0;
  }
}

FaceDepths::Row FaceDepths::shares(const TissueCurve& curve) const noexcept {
  return (1 + curve.slope_x * x_ + curve.slope_y * y_).max(0) / static_cast<double>(kPoints);
}

Pose frame_of(const ProbePacket& packet) noexcept {
  Pose X_JF = Pose::Identity();
  for (Eigen::Index i = 0; i < 12; ++i)
    X_JF.matrix()(i / 4, i % 4) = packet.X_JF[static_cast<std::size_t>(i)];
  return X_JF;
}

bool is_packet(const ProbePacket& packet) noexcept {
  const auto finite = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  };
  const std::array<double, 8> numbers{
      packet.spacing_x,       packet.spacing_y,       packet.length,        packet.width,
      packet.curve.stiffness, packet.curve.hardening, packet.curve.slope_x, packet.curve.slope_y};
  return finite(packet.X_JF) && finite(packet.z) && finite(numbers) && packet.spacing_x >= 0 &&
         packet.spacing_y >= 0 && (packet.spacing_x > 0) == (packet.spacing_y > 0) &&
         packet.curve.stiffness >= 0 && packet.curve.hardening > 0;
}

UnitCurve unit_curve(const FaceDepths::Row& depth, double hardening) noexcept {
  const double b = hardening;
  const FaceDepths::Row bd = b * depth.max(0);
  const FaceDepths::Row bent = bd.min(UnitCurve::kStraight);
  const FaceDepths::Row beyond = bd - bent;
  UnitCurve curve;
  curve.stiffness = bent.exp();
  curve.force = (curve.stiffness * (1 + beyond) - 1) / b;
  curve.energy =
      (curve.stiffness * (1 + beyond + 0.5 * beyond.square()) - 1 - bent - beyond) / (b * b);
  return curve;
}

ForceAtRest force_at_rest(const ProbePacket& packet, const Pose& X_JP) noexcept {
  if (!(packet.spacing_x > 0)) return {};
  FaceDepths face;
  face.set_face(packet.length, packet.width);
  face.look(packet, X_JP);
  const UnitCurve unit = unit_curve(face.depth(), packet.curve.hardening);
  const FaceDepths::Row k = packet.curve.stiffness * face.shares(packet.curve);
  return {(k * unit.force).sum(), (face.depth() > 0).select(k * unit.stiffness, 0).sum()};
}

}  // namespace artus
