// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/probe/probe_tangent.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace artus {
namespace {

constexpr double kFarthest = 3e-3;  // m from the packet's pose
constexpr double kMostTurn = 0.1;   // rad

Vec3 limited(const Vec3& v, double most) noexcept {
  const double size = v.norm();
  return size > most ? Vec3(v * (most / size)) : v;
}

}  // namespace

ProbeTangent::ProbeTangent(double tick_rate, double packet_rate)
    : blend_step_(packet_rate / tick_rate) {
  ARTUS_REQUIRE(tick_rate > 0 && packet_rate > 0, "rates above zero");
}

void ProbeTangent::take(const ProbePacket& packet) noexcept {
  const auto finite = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  };
  if (!finite(packet.X_JP) || !finite(packet.wrench) || !finite(packet.stiffness)) return;
  before_ = now_;
  now_.valid = packet.number > 0;
  for (Eigen::Index i = 0; i < 12; ++i)
    now_.X_JP.matrix()(i / 4, i % 4) = packet.X_JP[static_cast<std::size_t>(i)];
  now_.wrench = Eigen::Map<const Vec6>(packet.wrench.data());
  now_.stiffness =
      Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(packet.stiffness.data());
  share_ = packet.share;
  blend_ = 0;
}

ProbeTangent::Vec6 ProbeTangent::answer(const Tangent& tangent, const Pose& X_JP) noexcept {
  Vec6 wrench = Vec6::Zero();
  if (!tangent.valid) return wrench;
  const Pose X_FP = tangent.X_JP.inverse() * X_JP;  // F: the packet's frame
  const Eigen::AngleAxisd turn(X_FP.linear());
  Vec6 motion;
  motion << limited(X_FP.translation(), kFarthest), limited(turn.angle() * turn.axis(), kMostTurn);
  wrench = tangent.wrench - tangent.stiffness * motion;
  if (!(wrench[2] < 0)) wrench.setZero();  // a face does not pull
  wrench.head<3>() = tangent.X_JP.linear() * wrench.head<3>();
  wrench.tail<3>() = tangent.X_JP.linear() * wrench.tail<3>();
  return wrench;
}

const Wrench& ProbeTangent::step(const std::optional<Pose>& X_JP) noexcept {
  blend_ = std::min(1.0, blend_ + blend_step_);
  Vec6 wrench = Vec6::Zero();
  if (X_JP) wrench = (1 - blend_) * answer(before_, *X_JP) + blend_ * answer(now_, *X_JP);
  out_.force = wrench.head<3>();
  out_.torque = wrench.tail<3>();
  return out_;
}

}  // namespace artus
