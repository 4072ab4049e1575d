// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/seated_probe.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "artus/detail/evidence/runs/three_injections_probe.h"
#include "artus/detail/soft/solver/soft_body.h"

namespace artus {
namespace {

NamedMoment meant(const Pose& seat) {
  NamedMoment moment;
  moment.time = std::numeric_limits<double>::infinity();
  moment.X_JP_seat = seat;
  return moment;
}

Vec3 vector_of(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}

}  // namespace

SeatedProbe::SeatedProbe(const ProbeHandParams& params, double rate_hz, std::vector<Pose> seats)
    : seats_(std::move(seats)),
      known_{meant(seats_.front())},
      hand_(params, rate_hz, seats_.front()) {}

Pose SeatedProbe::reach(double time, bool planned) {
  const Pose seat = known_.back().X_JP_seat;
  known_.back().time = time;
  if (planned) ++next_;
  if (next_ < seats_.size()) known_.push_back(meant(seats_[next_]));
  return seat;
}

ProbeIntention SeatedProbe::intend(double t) const {
  return intend_probe(known_, t, SoftBodyParams{}.reach);
}

std::optional<Pose> SeatedProbe::held() const {
  const ProbeIntention now = intend(hand_.time());
  if (now.rise > 0 && now.lift > 0.5) return std::nullopt;
  return hand_.measured();
}

ProbeHandRow SeatedProbe::feel(const DeviceFeedback& feedback) {
  const bool held = this->held().has_value();
  const Wrench felt{vector_of(feedback.probe_force), vector_of(feedback.probe_torque)};
  ProbeHandRow row;
  row.X_JP = hand_.measured();
  row.energy_to_hand = hand_.energy_to_hand();
  const Vec3 beam = row.X_JP.linear().col(2);
  row.normal_force = std::max(0.0, -felt.force.dot(beam));
  // On a slope the tissue pushes along the face, too; what of it is friction is not told.
  row.edge_force = felt.force - felt.force.dot(beam) * beam;
  row.torque = felt.torque;
  row.stiffness = stiffness_;
  row.contact_share = feedback.probe_share;
  row.status = held ? feedback.probe_status : TickStatus::kOk;
  hand_.advance(felt, [this](double t) { return intend(t); });
  return row;
}

void SeatedProbe::take(const TissuePacket& packet) noexcept {
  stiffness_ = force_at_rest(packet.probe, hand_.measured()).stiffness;
}

}  // namespace artus
