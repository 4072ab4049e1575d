// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/haptic_core.h"

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

LayerTable make_table(const std::shared_ptr<const Scene>& scene, const SessionParams& params) {
  ARTUS_REQUIRE(scene != nullptr, "there must be a scene");
  return make_layer_table(scene->joint(), params.feel);
}

bool is_in_box(const PlainPose& X_W, const Vec3& centre, const Vec3& half) noexcept {
  const Vec3 off = (to_pose(X_W).translation() - centre).cwiseAbs();
  return (off.array() <= half.array()).all();
}

/// s after which a pose that does not change is stale: its device's hold and a tick's delay.
double held_for(const DeviceSample& device) noexcept {
  constexpr double kMargin = 5e-3;  // s
  return device.hold_ms == 0 ? 0 : 1e-9 * static_cast<double>(hold_of(device)) + kMargin;
}

/// The probe's hand: moving mass and damping as assumed, the limits of the device that holds it.
DeviceLimits probe_limits(const DeviceLimits& device) {
  DeviceLimits probe = ProbeHandParams{}.device;
  probe.force = device.probe_force;
  probe.torque = device.probe_torque;
  return probe;
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
      probe_(SkinContactParams{.tick_rate = params.haptic_rate,
                               .friction = ProbeContactParams{}.gel_friction}),
      probe_account_(kProbePassivity, 1 / params.haptic_rate, kProbeDampingForce),
      probe_guard_(params.guard, probe_limits(params.device), 1 / params.haptic_rate),
      syringe_(scene_->joint(), params),
      aid_(scene_->joint(), params.aids, 1 / params.haptic_rate),
      limits_(params.device) {}

/// Contact and laws of this tick's needle. False: it feels nothing.
bool HapticCore::feel_needle(const DeviceSample& device, std::uint32_t command) noexcept {
  std::uint32_t why = 0;
  if (device.state == PeerState::absent || device.state == PeerState::lost)
    why |= SessionStatus::kPeerLost;
  if (device.state == PeerState::invalid) why |= SessionStatus::kPeerInvalid;
  if ((command & SessionCommand::kPause) != 0) why |= SessionStatus::kPaused;
  if ((command & SessionCommand::kLate) != 0) why |= TickStatus::kLate;
  if (why == 0 && device.has_needle == 0) why |= SessionStatus::kNoNeedle;
  if (why == 0 && !is_in_box(device.X_WN, limits_.needle_centre, limits_.needle_half))
    why |= TickStatus::kOutOfWorkspace;
  const bool rest = why != 0 || (command & SessionCommand::kReset) != 0;
  TimedPose pose;
  pose.time = 1e-9 * static_cast<double>(device.time_ns);
  pose.hold = held_for(device);
  pose.check = rest ? TimedPose::Check::absent : TimedPose::Check::done;
  if (!rest) pose.X_JN = gesture_.X_WJ().inverse() * to_pose(device.X_WN);
  rests_ = why;
  if (!rest) out_.X_JN = to_plain(pose.X_JN);
  const bool felt = needle_.feel(pose);
  return felt && !rest;
}

/// What the needle's hand gets: the laws' force and `more_J`, N, through the guard.
void HapticCore::command_needle(const Vec3& more_J) noexcept {
  const RenderedNeedle& rendered = needle_.command(more_J);
  const bool rest = rests_ != 0 || (out_.input.command & SessionCommand::kReset) != 0;
  out_.status = rest ? rests_ : rendered.status;
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
}

/// The probe's hand feels the tissue while its pose is known and nobody paused.
void HapticCore::step_probe(bool felt, const std::optional<Pose>& X_WP) noexcept {
  std::optional<Pose> X_JP;
  std::uint32_t faults = TickStatus::kStale;
  if (felt && X_WP) {
    const PlainPose& plain = out_.input.device.X_WP;
    faults = is_in_box(plain, limits_.probe_centre, limits_.probe_half)
                 ? TickStatus::kOk
                 : TickStatus::kOutOfWorkspace;
    if (faults == TickStatus::kOk) X_JP = gesture_.X_WJ().inverse() * *X_WP;
  }
  std::uint32_t status = 0;
  Wrench wanted = probe_.step(X_JP, out_.input.tick);
  if (X_JP)
    wanted.force = probe_account_.step(X_JP->translation(), wanted.force);
  else
    probe_account_.pause();
  if (probe_.share() == 0) wanted = {};  // no damping off the skin
  const Wrench wrench = probe_guard_.apply(wanted, faults, status);
  probe_account_.observe(wrench.force);
  const Eigen::Matrix3d R_WJ = gesture_.X_WJ().linear();
  copy(R_WJ * wrench.force, out_.feedback.probe_force);
  copy(R_WJ * wrench.torque, out_.feedback.probe_torque);
  out_.feedback.probe_status = status;
  out_.feedback.probe_share = X_JP ? probe_.share() : 0;
}

/// The syringe after the needle's contact, whose tip it needs. Returns what of the thumb's force
/// the fingers do not carry and pushes the needle on, N along its axis.
double HapticCore::step_syringe(bool runs) noexcept {
  if (runs)
    syringe_.step(out_.input.device, needle_.model().contact());
  else
    syringe_.rest();
  out_.feedback.plunger = syringe_.feedback();
  const auto sites = syringe_.sites();
  std::copy(sites.begin(), sites.end(), std::begin(out_.sites));
  out_.n_sites = static_cast<std::uint32_t>(sites.size());
  return syringe_.on_needle();
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
  feedback.tissue_age = probe_.age();
  if (probe_.late()) out_.status |= SessionStatus::kTissueLate;
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
  if (is_plunger(device) && is_hold(device.hold_ms)) return;
  if (device.state == PeerState::alive) device.state = PeerState::invalid;
  device.plunger = PlungerSign::none;
  device.plunger_travel = device.plunger_force = 0;
  device.hold_ms = 0;
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
  const bool runs =
      alive && (input.command & (SessionCommand::kPause | SessionCommand::kLate)) == 0;
  const bool felt = feel_needle(device, input.command) && runs;
  const NeedleContact& contact = needle_.model().contact();
  const double pushed = step_syringe(runs);
  Vec3 more = aid_.step(contact, to_pose(out_.X_JN).translation(), felt);
  if (felt) more += pushed * contact.tick().axis;
  command_needle(more);
  step_probe(runs, X_WP);
  describe();
  return out_;
}

}  // namespace artus
