// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/session_core.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "artus/detail/core/noise.h"
#include "artus/detail/operators/probe_hand.h"

namespace artus {
namespace {

void copy(const Vec3& from, double (&to)[3]) noexcept {
  to[0] = from.x();
  to[1] = from.y();
  to[2] = from.z();
}

/// A pose that the input guard refuses, so that the tick renders nothing and the model rests.
Pose no_pose() noexcept {
  Pose pose = Pose::Identity();
  pose.translation().setConstant(std::numeric_limits<double>::quiet_NaN());
  return pose;
}

LayerTable make_table(const std::shared_ptr<const Scene>& scene, const SessionParams& params) {
  ARTUS_REQUIRE(scene != nullptr, "there must be a scene");
  return make_layer_table(scene->joint(), params.feel);
}

NeedleRendererParams renderer_params(const SessionParams& params) {
  NeedleRendererParams out{params.needle, params.guard, params.passivity, params.device,
                           params.haptic_rate};
  apply(params.feel, out.needle);
  apply(params.feel, out.passivity);
  return out;
}

}  // namespace

HapticCore::HapticCore(std::shared_ptr<const Scene> scene, const SessionParams& params)
    : scene_(std::move(scene)),
      needle_(scene_, make_table(scene_, params), renderer_params(params)),
      gesture_(params.gesture, params.X_WJ),
      probe_(params.haptic_rate, params.image_rate, ProbeContactParams{}.gel_friction),
      probe_guard_(params.guard, ProbeHandParams{}.device, 1 / params.haptic_rate),
      syringe_(scene_->joint(), params),
      aid_(scene_->joint(), params.aids, 1 / params.haptic_rate),
      device_(params.device) {}

void HapticCore::step_needle(const DeviceSample& device, std::uint32_t command) noexcept {
  std::uint32_t why = 0;
  if (device.state == PeerState::absent || device.state == PeerState::lost)
    why |= SessionStatus::kPeerLost;
  if (device.state == PeerState::invalid) why |= SessionStatus::kPeerInvalid;
  if ((command & SessionCommand::kPause) != 0) why |= SessionStatus::kPaused;
  if ((command & SessionCommand::kLate) != 0) why |= TickStatus::kLate;
  if (why == 0 && device.has_needle == 0) why |= SessionStatus::kNoNeedle;
  const bool rest = why != 0 || (command & SessionCommand::kReset) != 0;
  TimedPose pose;
  pose.time = 1e-9 * static_cast<double>(device.time_ns);
  pose.X_JN = rest ? no_pose() : Pose(gesture_.X_WJ().inverse() * to_pose(device.X_WN));
  const RenderedNeedle& rendered = needle_.step(pose);
  out_.status = rest ? why : rendered.status;
  const Eigen::Matrix3d R_WJ = gesture_.X_WJ().linear();
  copy(R_WJ * rendered.command.force, out_.feedback.force);
  copy(R_WJ * rendered.command.torque, out_.feedback.torque);
  copy(rendered.command.force, out_.force_J);
  copy(rendered.command.torque, out_.torque_J);
  const NeedleForces& f = rendered.forces;
  const double axial[5] = {f.prepuncture, f.cutting, f.attracted, f.friction, f.hard};
  std::copy(std::begin(axial), std::end(axial), std::begin(out_.axial));
  out_.clamping = f.clamping.norm();
  copy(f.clamping, out_.clamping_J);
  copy(f.surface, out_.surface_J);
  copy(f.workspace, out_.workspace_J);
  if (!rest) out_.X_JN = to_plain(pose.X_JN);
}

/// The probe's hand feels the tissue while its pose is known and nobody paused.
void HapticCore::step_probe(bool felt, const std::optional<Pose>& X_WP) noexcept {
  std::optional<Pose> X_JP;
  if (felt && X_WP) X_JP = gesture_.X_WJ().inverse() * *X_WP;
  std::uint32_t status = 0;
  const Wrench wrench =
      probe_guard_.apply(probe_.step(X_JP), X_JP ? TickStatus::kOk : TickStatus::kStale, status);
  const Eigen::Matrix3d R_WJ = gesture_.X_WJ().linear();
  copy(R_WJ * wrench.force, out_.feedback.probe_force);
  copy(R_WJ * wrench.torque, out_.feedback.probe_torque);
  out_.feedback.probe_status = status;
  out_.feedback.probe_share = X_JP ? probe_.share() : 0;
}

/// The syringe after the needle, whose tip it needs; what of the thumb's force the fingers do not
/// carry pushes the needle on, within the device's limits.
void HapticCore::step_syringe(bool runs) noexcept {
  const NeedleContact& contact = needle_.model().contact();
  if (runs)
    syringe_.step(out_.input.device, contact);
  else
    syringe_.rest();
  out_.feedback.plunger = syringe_.feedback();
  const auto sites = syringe_.sites();
  std::copy(sites.begin(), sites.end(), std::begin(out_.sites));
  out_.n_sites = static_cast<std::uint32_t>(sites.size());
  add_force(syringe_.on_needle() * contact.tick().axis, runs);
}

bool HapticCore::is_sound(bool runs) const noexcept {
  return runs && (out_.status & (TickStatus::kFaults | SessionStatus::kNoNeedle)) == 0;
}

/// More force on the needle's hand, N, within the device's limits; none while something is wrong.
void HapticCore::add_force(const Vec3& more_J, bool runs) noexcept {
  if (!is_sound(runs) || more_J.isZero(0)) return;
  const Vec3 force = Vec3(out_.force_J[0], out_.force_J[1], out_.force_J[2]) + more_J;
  const Wrench limited = saturate(device_, {force, Vec3::Zero()});
  copy(limited.force, out_.force_J);
  copy(gesture_.X_WJ().linear() * limited.force, out_.feedback.force);
}

void HapticCore::describe() noexcept {
  const NeedleContact& contact = needle_.model().contact();
  const NeedleTick& tick = contact.tick();
  DeviceFeedback& feedback = out_.feedback;
  const Haptic& tissue = needle_.table()[contact.region()].tissue;
  feedback.stiffness = tissue.wall_stiffness;
  feedback.cutting_force = tissue.cutting_force;
  feedback.depth = tick.depth;
  feedback.region = contact.region();
  feedback.contact = static_cast<std::uint32_t>(contact.state());
  feedback.status = out_.status;
  feedback.tick = out_.input.tick;
  feedback.answers = out_.input.device.number;
  feedback.sample_time_ns = out_.input.device.time_ns;
  out_.inserted = contact.inserted() ? 1 : 0;
  out_.cone = contact.cone();
  out_.load = needle_.model().coupling().cube_load();
  out_.events = contact.events();
  copy(tick.entry, out_.entry_J);
}

/// What cannot be a pose goes no further: not into the snapshot, an image or a recording.
void HapticCore::take(const TickInput& input) noexcept {
  const DeviceSample before = out_.input.device;
  out_.input = input;
  DeviceSample& device = out_.input.device;
  const bool needle = is_pose(device.X_WN);
  const bool probe = is_pose(device.X_WP);
  const bool wrong = (!needle && device.has_needle != 0) || (!probe && device.has_probe != 0);
  if (wrong && device.state == PeerState::alive) device.state = PeerState::invalid;
  if (!needle) device.X_WN = before.X_WN;
  if (!probe) device.X_WP = before.X_WP;
  if (is_plunger(device) && device.reserved == 0) return;
  if (device.state == PeerState::alive) device.state = PeerState::invalid;
  device.plunger = PlungerSign::none;
  device.plunger_travel = device.plunger_force = 0;
  device.reserved = 0;
}

const HapticSnapshot& HapticCore::step(const TickInput& input) noexcept {
  take(input);
  const DeviceSample& device = out_.input.device;
  const bool alive = device.state == PeerState::alive;
  const bool paused = (input.command & SessionCommand::kPause) != 0;
  std::optional<Pose> X_WP;
  if (alive && device.has_probe != 0) X_WP = to_pose(device.X_WP);
  if ((input.command & SessionCommand::kReset) != 0) {
    gesture_.reset();
    syringe_.reset();
  }
  // No entry is chosen while the needle is in the body.
  const std::optional<Pose> choosing = out_.inserted == 0 ? X_WP : std::nullopt;
  if (alive && !paused) gesture_.step(*scene_, device.buttons, choosing);
  out_.phase = gesture_.phase();
  out_.X_WJ = to_plain(gesture_.X_WJ());
  if (X_WP) out_.X_JP = to_plain(gesture_.X_WJ().inverse() * *X_WP);
  step_needle(device, input.command);
  const bool runs =
      alive && (input.command & (SessionCommand::kPause | SessionCommand::kLate)) == 0;
  step_syringe(runs);
  add_force(aid_.step(needle_.model().contact(), to_pose(out_.X_JN).translation(), is_sound(runs)),
            runs);
  step_probe(runs, X_WP);
  describe();
  return out_;
}

ImageControls controls_of(const SessionParams& params) noexcept {
  return {params.image.depth,          params.image.gain_db,
          params.image.tgc_db_cm_mhz,  params.image.dynamic_range_db,
          params.transducer.frequency, params.transducer.elevation_focus};
}

FrameInput frame_input(const HapticSnapshot& snapshot, const ImageControls& controls,
                       std::uint64_t number) noexcept {
  FrameInput input;
  input.X_JP = snapshot.X_JP;
  input.X_JN = snapshot.X_JN;
  input.controls = controls;
  input.sample_time_ns = snapshot.input.device.time_ns;
  input.number = number;
  input.has_needle = snapshot.input.device.has_needle;
  input.has_probe = snapshot.input.device.has_probe;
  input.load = snapshot.load;
  input.n_sites = snapshot.n_sites;
  std::copy_n(std::begin(snapshot.sites), snapshot.n_sites, std::begin(input.sites));
  return input;
}

std::uint64_t digest_of(const TissuePacket& packet) noexcept {
  const ProbePacket& probe = packet.probe;
  std::uint64_t digest = mix_bits(probe.number);
  const auto add = [&digest](double value) {
    digest = mix_bits(digest ^ std::bit_cast<std::uint64_t>(value));
  };
  const auto add_all = [&add](const auto& values) {
    std::for_each(values.begin(), values.end(), add);
  };
  add_all(probe.X_JP);
  add_all(probe.wrench);
  add_all(probe.stiffness);
  add(probe.share);
  const NeedlePacket& needle = packet.needle;
  add_all(needle.carried);
  add(static_cast<double>(needle.compliance.points));
  add(needle.compliance.spacing);
  for (const auto& column : needle.compliance.by_load) add_all(column);
  add_all(needle.compliance.near_field);
  add(needle.compliance_scale);
  return digest;
}

std::uint64_t digest_of(const Frame& frame) noexcept {
  std::uint64_t digest = mix_bits(static_cast<std::uint64_t>(frame.width) << 32U |
                                  static_cast<std::uint64_t>(frame.height));
  for (std::size_t i = 0; i < frame.image.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, frame.image.data() + i, std::min<std::size_t>(8, frame.image.size() - i));
    digest = mix_bits(digest ^ word);
  }
  return digest;
}

}  // namespace artus
