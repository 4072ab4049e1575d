// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/probe/probe_tangent.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace artus {
namespace {

constexpr double kFarthest = 3e-3;  // m from the packet's pose
constexpr double kMaxTurn = 0.1;    // rad

Vec3 limited(const Vec3& v, double max) noexcept {
  const double size = v.norm();
  return size > max ? Vec3(v * (max / size)) : v;
}

}  // namespace

ProbeTangent::ProbeTangent(double tick_rate, double packet_rate, double friction)
    : blend_step_(packet_rate / tick_rate), friction_(friction) {
  ARTUS_REQUIRE(tick_rate > 0 && packet_rate > 0, "rates above zero");
  ARTUS_REQUIRE(friction >= 0, "a coefficient of friction");
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
  now_.share = packet.share;
  blend_ = 0;
}

/// Adds what a packet says of a pose, as far as it is to count.
void ProbeTangent::add(const Tangent& tangent, const Pose& X_JP, double weight) noexcept {
  if (!tangent.valid) return;
  const Pose X_FP = tangent.X_JP.inverse() * X_JP;  // F: the packet's frame
  const Eigen::AngleAxisd turn(X_FP.linear());
  Vec6 motion;
  motion << limited(X_FP.translation(), kFarthest), limited(turn.angle() * turn.axis(), kMaxTurn);
  const Vec6 wrench = tangent.wrench - tangent.stiffness * motion;
  if (!(wrench[2] < 0)) return;  // a face does not pull
  out_.force += weight * (tangent.X_JP.linear() * wrench.head<3>());
  out_.torque += weight * (tangent.X_JP.linear() * wrench.tail<3>());
  share_ += weight * tangent.share;
}

const Wrench& ProbeTangent::step(const std::optional<Pose>& X_JP) noexcept {
  blend_ = std::min(1.0, blend_ + blend_step_);
  out_ = {};
  share_ = 0;
  if (!X_JP) return out_;
  add(before_, *X_JP, 1 - blend_);
  add(now_, *X_JP, blend_);
  const Vec3 beam = X_JP->linear().col(2);
  const double normal = -out_.force.dot(beam);
  if (!(normal > 0)) {
    out_ = {};
    share_ = 0;
    return out_;
  }
  // A spring that the hand stretches by sliding on between two packets slips as the skin does.
  const Vec3 along = out_.force + normal * beam;
  out_.force = limited(along, friction_ * normal) - normal * beam;
  return out_;
}

}  // namespace artus
