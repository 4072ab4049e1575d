// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/shared_memory_device.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace artus {
namespace {

PlainPose plain_pose(const double (&position)[3], const double (&rotation)[4]) noexcept {
  PlainPose pose;
  std::copy(std::begin(position), std::end(position), std::begin(pose.position));
  std::copy(std::begin(rotation), std::end(rotation), std::begin(pose.rotation));
  return pose;
}

constexpr std::uint32_t kPlunger = ARTUS_SHM_PLUNGER_TRAVEL | ARTUS_SHM_PLUNGER_FORCE;
constexpr std::uint32_t kKnownPresence = ARTUS_SHM_NEEDLE | ARTUS_SHM_PROBE | kPlunger;

PlungerSign plunger_sign(std::uint32_t present) noexcept {
  if ((present & ARTUS_SHM_PLUNGER_TRAVEL) != 0) return PlungerSign::travel;
  return (present & ARTUS_SHM_PLUNGER_FORCE) != 0 ? PlungerSign::force : PlungerSign::none;
}

/// Whether the message says what there is and may come from this writer. What cannot be a pose or a
/// plunger the simulation refuses of any device.
bool is_known(const artus_shm_pos& pos, std::uint32_t allowed) noexcept {
  return (pos.present & ~(kKnownPresence & allowed)) == 0 && pos.reserved == 0 &&
         is_hold(pos.hold_ms) && (pos.present & kPlunger) != kPlunger;
}

}  // namespace

void PosReader::take(const artus_shm_pos& pos, std::int64_t now_ns) noexcept {
  const auto age = static_cast<std::int64_t>(static_cast<std::uint64_t>(now_ns) - pos.time_ns);
  DeviceSample sample;
  sample.X_WN = plain_pose(pos.needle_position, pos.needle_rotation);
  sample.X_WP = plain_pose(pos.probe_position, pos.probe_rotation);
  sample.time_ns = static_cast<std::int64_t>(pos.time_ns);
  sample.number = pos.sample;
  sample.buttons = pos.buttons;
  sample.has_needle = (pos.present & ARTUS_SHM_NEEDLE) != 0 ? 1 : 0;
  sample.has_probe = (pos.present & ARTUS_SHM_PROBE) != 0 ? 1 : 0;
  sample.plunger = plunger_sign(pos.present);
  if (sample.plunger == PlungerSign::travel) sample.plunger_travel = pos.plunger_travel;
  if (sample.plunger == PlungerSign::force) sample.plunger_force = pos.plunger_force;
  constexpr std::int64_t kClockSlack = 1'000'000;  // ns between reading the clock here and there
  const bool sound = age > -kClockSlack && is_known(pos, allowed_);
  if (sound) sample.hold_ms = pos.hold_ms;
  sample.state = !sound                  ? PeerState::invalid
                 : age < hold_of(sample) ? PeerState::alive
                                         : PeerState::lost;
  if (sound) number_ = pos.sample;
  if (!sound || sample.has_needle == 0) sample.X_WN = last_.X_WN;
  if (!sound || sample.has_probe == 0) sample.X_WP = last_.X_WP;
  if (!sound) {
    sample.plunger_travel = last_.plunger_travel;
    sample.plunger_force = 0;
  }
  last_ = sample;
  heard_ns_ = now_ns;
}

DeviceSample PosReader::accept(bool whole, const artus_shm_pos& pos, std::int64_t now_ns,
                               std::uint64_t writer) noexcept {
  if (whole && (!started_ || writer != writer_)) {
    started_ = true;
    writer_ = writer;
    seen_ = pos.sample;  // what is there before the first change may be a left-over
    number_ = 0;
    changed_ns_ = now_ns;
  }
  if (whole && pos.sample != seen_) {
    const bool silent = now_ns - changed_ns_ >= kPeerTimeout;
    const bool counts_anew = pos.sample > seen_ && now_ns - heard_ns_ >= kPeerTimeout;
    const bool begins_again = silent || counts_anew;
    seen_ = pos.sample;
    changed_ns_ = now_ns;
    if (pos.sample > number_ || begins_again) {
      take(pos, now_ns);
    } else {
      last_.state = PeerState::invalid;
    }
  }
  if (last_.state != PeerState::absent && now_ns - heard_ns_ >= hold_of(last_)) {
    last_.state = PeerState::lost;
  }
  return last_;
}

DeviceSample join_hands(const DeviceSample& needle, const DeviceSample& probe) noexcept {
  if (probe.state == PeerState::absent) return needle;
  const bool holds_needle = needle.state == PeerState::alive;
  const bool holds_probe = probe.state == PeerState::alive && probe.has_probe != 0;
  if (!holds_needle && probe.state != PeerState::alive)
    return needle.state == PeerState::absent ? probe : needle;
  DeviceSample both = holds_needle ? needle : probe;
  if (holds_probe) {
    both.X_WP = probe.X_WP;
    both.has_probe = 1;
  }
  if (holds_needle) {
    both.buttons |= probe.state == PeerState::alive ? probe.buttons : 0U;
  } else {  // what POS last said of the needle is where it was last seen
    both.X_WN = needle.X_WN;
  }
  return both;
}

SharedMemoryDevice::SharedMemoryDevice(std::unique_ptr<PosChannel> pos,
                                       std::unique_ptr<PosChannel> probe_pos,
                                       std::unique_ptr<ForceChannel> force,
                                       std::vector<std::string> layer_names)
    : pos_(std::move(pos)),
      probe_pos_(std::move(probe_pos)),
      force_(std::move(force)),
      layer_names_(std::move(layer_names)),
      probe_reader_(ARTUS_SHM_PROBE) {
  write(DeviceFeedback{});  // what an earlier run left behind is no force of ours
}

Result<std::unique_ptr<SharedMemoryDevice>> SharedMemoryDevice::open(
    const std::string& prefix, std::vector<std::string> layer_names) {
  auto force = ForceChannel::open(prefix, kForceLayout, SegmentAccess::owner_writes);
  ARTUS_TRY(force);
  auto pos = PosChannel::open(prefix, kPosLayout, SegmentAccess::owner_reads);
  ARTUS_TRY(pos);
  auto probe_pos = PosChannel::open(prefix, kProbePosLayout, SegmentAccess::owner_reads);
  ARTUS_TRY(probe_pos);
  return std::unique_ptr<SharedMemoryDevice>(new SharedMemoryDevice(
      std::move(*pos), std::move(*probe_pos), std::move(*force), std::move(layer_names)));
}

SharedMemoryDevice::~SharedMemoryDevice() {
  DeviceFeedback last;
  last.status = ARTUS_SHM_STOPPED;
  write(last);
  force_->remove_own();
  pos_->remove_own();
  probe_pos_->remove_own();
}

std::vector<std::string> SharedMemoryDevice::repair_connection() {
  std::vector<std::string> said;
  if (auto line = pos_->repair_connection()) said.push_back(std::move(*line));
  if (auto line = probe_pos_->repair_connection()) said.push_back(std::move(*line));
  if (auto line = force_->repair_connection()) said.push_back(std::move(*line));
  return said;
}

DeviceSample SharedMemoryDevice::read(std::int64_t now_ns) noexcept {
  const auto newest = [now_ns](PosChannel& from, PosReader& reader) {
    artus_shm_pos pos{};
    const auto& channel = from.use();
    const bool whole = channel.read(pos, 8);
    const SharedSegment& segment = channel.segment();
    return reader.accept(whole, pos, now_ns, segment.opened_ns() ^ segment.writer_pid() << 44U);
  };
  needle_ = newest(*pos_, reader_);
  probe_ = newest(*probe_pos_, probe_reader_);
  return join_hands(needle_, probe_);
}

/// What FORCE says of each program apart: the sample that it answers, and whether it was lost.
void SharedMemoryDevice::answer_each(artus_shm_force& out) const noexcept {
  const bool two = probe_.state != PeerState::absent;
  const DeviceSample& probe = two && probe_.has_probe != 0 ? probe_ : needle_;
  out.probe_sample = probe.number;
  out.probe_time_ns = static_cast<std::uint64_t>(probe.time_ns);
  if (!two) return;
  if (probe_.state != PeerState::alive && needle_.has_probe == 0)
    out.probe_status |=
        probe_.state == PeerState::invalid ? ARTUS_SHM_POS_INVALID : ARTUS_SHM_PEER_LOST;
  if (needle_.state == PeerState::alive || (out.status & ARTUS_SHM_STOPPED) != 0) return;
  out.status |= needle_.state == PeerState::invalid ? ARTUS_SHM_POS_INVALID : ARTUS_SHM_PEER_LOST;
  out.pos_sample = needle_.number;
  out.pos_time_ns = static_cast<std::uint64_t>(needle_.time_ns);
}

void SharedMemoryDevice::write(const DeviceFeedback& feedback) noexcept {
  artus_shm_force out{};
  out.tick = feedback.tick;
  out.time_ns = static_cast<std::uint64_t>(feedback.time_ns);
  out.pos_sample = feedback.answers;
  out.pos_time_ns = static_cast<std::uint64_t>(feedback.sample_time_ns);
  std::copy(std::begin(feedback.force), std::end(feedback.force), std::begin(out.force));
  std::copy(std::begin(feedback.torque), std::end(feedback.torque), std::begin(out.torque));
  std::copy(std::begin(feedback.probe_force), std::end(feedback.probe_force),
            std::begin(out.probe_force));
  std::copy(std::begin(feedback.probe_torque), std::end(feedback.probe_torque),
            std::begin(out.probe_torque));
  out.probe_share = feedback.probe_share;
  out.probe_status = feedback.probe_status;
  constexpr double kOldest = 4e3;  // s
  out.tissue_age_us =
      static_cast<std::uint32_t>(1e6 * std::clamp(feedback.tissue_age, 0.0, kOldest));
  const PlungerFeedback& plunger = feedback.plunger;
  out.thumb_force = plunger.thumb_force;
  out.pressure = plunger.pressure;
  out.tip_pressure = plunger.tip_pressure;
  out.flow = plunger.flow;
  out.travel = plunger.travel;
  out.given = plunger.given;
  out.drawn = plunger.drawn;
  out.plunger_status = plunger.status;
  out.stiffness = feedback.stiffness;
  out.cutting_force = feedback.cutting_force;
  out.depth = feedback.depth;
  out.status = feedback.status;
  out.contact = feedback.contact;
  out.layer = feedback.region;
  if (feedback.region < layer_names_.size()) {
    const std::string& name = layer_names_[feedback.region];
    std::memcpy(out.layer_name, name.data(), std::min(name.size(), sizeof(out.layer_name) - 1));
  }
  answer_each(out);
  force_->use().write(out);
}

}  // namespace artus
