// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <span>

#include "artus/detail/haptics/needle/laws/clamping.h"
#include "artus/detail/haptics/needle/needle_coupling.h"
#include "artus/detail/haptics/needle/needle_packet.h"
#include "artus/detail/haptics/needle/needle_params.h"

namespace artus {

/// The components of one tick, apart. Axial values are along the insertion axis, N, positive into
/// the body (a force against insertion is negative).
struct NeedleForces {
  double prepuncture = 0;
  double cutting = 0;    ///< of the selected cutting law, also on bone
  double attracted = 0;  ///< the wall's resistance to withdrawal, >= 0
  double friction = 0;
  double hard = 0;                ///< the tap on bone
  Vec3 clamping = Vec3::Zero();   ///< N, frame J
  Vec3 surface = Vec3::Zero();    ///< N, frame J, of the god-object on the skin
  Vec3 workspace = Vec3::Zero();  ///< N, frame J, of the hemisphere
  Vec3 torque = Vec3::Zero();     ///< N m, frame J
  Wrench total;                   ///< sum of the above, before any device limit
};

/// Everything the needle makes the hand feel: contact state and force laws, summed as eq. 1.1 of
/// [Alamilla2020] with the hard tap added to the soft forces (see HardContact). Needs no scene: the
/// caller queries it for query_segment() and passes the intervals. One needle, one insertion at a
/// time; not for several threads at once. Tissue is rigid until take() says how it gives way.
class NeedleModel {
 public:
  /// Requires: dt > 0 s; table outlives the model.
  NeedleModel(const NeedleParams& params, const LayerTable& table, double dt) noexcept;

  ARTUS_REALTIME void reset() noexcept;
  /// The line to look for layers on: where the needle is in the material.
  [[nodiscard]] ARTUS_REALTIME Segment query_segment(const Pose& X_JN) noexcept {
    in_material_ = material(X_JN);
    return contact_.query_segment(in_material_);
  }
  /// Tissue that gives way to the needle from now on: layers are then met where the tip is in the
  /// material, the laws go on by the hand's depth, at which their constants were measured, and the
  /// shaft's friction is that of tissue which it drags. Without: the rigid body. Where others
  /// (a probe) carry the tissue, it is followed with the coupling's relaxation time. To a needle
  /// that is in the body already rigid tissue stays rigid until it is out again: its forces would
  /// jump. What is not a number is left out.
  ARTUS_REALTIME void take(const NeedlePacket& packet) noexcept;
  /// A tick in which nothing is known: the forces stay.
  ARTUS_REALTIME void hold() noexcept { contact_.hold(); }
  /// Requires: a finite, rigid pose; the intervals of query_segment(X_JN).
  ARTUS_REALTIME const NeedleForces& step(const Pose& X_JN,
                                          std::span<const TissueInterval> intervals) noexcept;

  [[nodiscard]] const NeedleForces& forces() const noexcept { return forces_; }
  [[nodiscard]] const NeedleContact& contact() const noexcept { return contact_; }
  [[nodiscard]] const TrackingWall& wall() const noexcept { return wall_; }
  [[nodiscard]] const NeedleCoupling& coupling() const noexcept { return coupling_; }
  [[nodiscard]] const HardContact& hard_contact() const noexcept { return hard_; }

 private:
  [[nodiscard]] Pose material(const Pose& X_JN) const noexcept;
  /// m along the axis, of the tissue at the tip by the needle.
  [[nodiscard]] double pushed() const noexcept {
    return compliance_scale_ * coupling_.tip_displacement();
  }
  void to_hand_depth() noexcept;
  void couple(const Pose& X_JN) noexcept;
  void sum_up(const NeedleTick& tick) noexcept;
  void start_laws() noexcept;
  void take_line() noexcept;
  double cutting_force(const NeedleTick& tick) noexcept;

  NeedleParams params_;
  NeedleContact contact_;
  TrackingWall wall_;
  DirectCutting direct_;
  SpringCutting spring_;
  VoigtCutting voigt_;
  Prepuncture prepuncture_;
  LugreFriction friction_;
  HardContact hard_;
  Clamping clamping_;
  OrientationTorque orientation_;
  PlasticityFixture plasticity_;
  GodObject god_object_;
  HemisphereWorkspace workspace_;
  NeedleCoupling coupling_;
  Vec3 carried_ = Vec3::Zero();     // m, frame J, of the tissue at the tip
  Vec3 carried_to_ = Vec3::Zero();  // by the newest packet
  double compliance_scale_ = 1;     // NeedlePacket::give, followed as carried_ is
  double compliance_scale_to_ = 1;
  double follow_;    // share of the displacement in a tick
  NeedleTick felt_;  // the contact's tick, with tip and depth as the hand has them
  double grip_ = 0;  // friction's level g(v), followed within its relaxation time
  Vec3 last_tip_ = Vec3::Zero();
  Pose in_material_ = Pose::Identity();  // of this tick's needle
  NeedleForces forces_;
};

}  // namespace artus
