// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "artus/detail/core/check.h"
#include "artus/detail/haptics/wrench.h"

namespace artus {

/// What the tissue under a probe answers around one pose: force and torque there and how they
/// change with the probe's motion. Plain numbers: handed from thread to thread, and recorded.
struct ProbePacket {
  std::uint64_t number = 0;        ///< grows with every packet; 0: there is none
  std::array<double, 12> X_JP{};   ///< first three rows of the pose
  std::array<double, 6> wrench{};  ///< N and N m on the hand about the face's centre, axes of P
  std::array<double, 36>
      stiffness{};   ///< N/m, N, N m: how much less of it per m and rad, row first
  double share = 0;  ///< of the face that presses, 0..1
};

/// The probe's force at the tick's rate between packets that come at the picture's: F0 - K dx,
/// never a pull, along the face no more than Coulomb's friction, blended from one packet to the
/// next over one of their periods so that it has no steps. What is felt is a spring that changes
/// slowly, not a late force: a delay of the packets costs accuracy under fast motion, not
/// stability. One instance per probe; not thread safe; deterministic.
class ProbeTangent {
 public:
  /// Rates in Hz; `friction`: coefficient on the skin. Requires: rates > 0, friction >= 0.
  ProbeTangent(double tick_rate, double packet_rate, double friction);

  /// From the next tick on. A packet with a number that is not finite is left out.
  ARTUS_REALTIME void take(const ProbePacket& packet) noexcept;

  /// Force and torque on the hand at the face's centre, frame J. Without a probe, without a packet
  /// and off the skin: zero. The motion from the packet's pose is followed for 3 mm and 0.1 rad,
  /// and the force held beyond.
  ARTUS_REALTIME const Wrench& step(const std::optional<Pose>& X_JP) noexcept;

  /// Of the face that presses, as last felt; 0 only where no force is.
  [[nodiscard]] double share() const noexcept { return share_; }

 private:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  struct Tangent {
    bool valid = false;
    Pose X_JP = Pose::Identity();
    Vec6 wrench = Vec6::Zero();
    Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
    double share = 0;
  };
  void add(const Tangent& tangent, const Pose& X_JP, double weight) noexcept;

  Tangent before_;
  Tangent now_;
  double blend_step_;  // of a tick
  double friction_;
  double blend_ = 1;
  double share_ = 0;
  Wrench out_;
};

}  // namespace artus
