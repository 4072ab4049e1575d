// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/simulation/simulation.h"

#include <cmath>
#include <utility>

#include "artus/detail/simulation/haptic_core.h"
#include "artus/detail/simulation/image_core.h"

namespace artus {
namespace {

SessionParams params_of(const CompiledJoint& joint, const SimulationOptions& options) {
  SessionParams params;
  const auto device = find_device(options.device);
  ARTUS_REQUIRE(device.has_value(), "unknown device name");
  params.device = *device;
  params.haptic_rate = options.haptic_rate;
  params.image_rate = options.image_rate;
  params.deform = !options.rigid && gives_way(joint);
  ARTUS_REQUIRE(validate(params).has_value(),
                "the haptic rate must be 100 to 20000 Hz, the image rate 1 to 120 Hz");
  return params;
}

Vec3 vector_of(const double (&v)[3]) noexcept {
  return {v[0], v[1], v[2]};
}

std::shared_ptr<const Scene> scene_of(CompiledJoint joint) {
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(joint)));
}

}  // namespace

Simulation::Simulation(CompiledJoint joint, const SimulationOptions& options)
    : scene_(scene_of(std::move(joint))),
      params_(params_of(scene_->joint(), options)),
      extra_scene_holders_(0),
      haptics_(std::make_unique<HapticCore>(scene_, params_)),
      controls_(controls_of(params_)) {}

Simulation::Simulation(std::shared_ptr<const Scene> scene, const SessionParams& params,
                       std::size_t extra_scene_holders, PreparedBody prepared)
    : scene_(std::move(scene)),
      params_(params),
      extra_scene_holders_(extra_scene_holders),
      prepared_(std::move(prepared)),
      haptics_(std::make_unique<HapticCore>(scene_, params_)),
      controls_(controls_of(params_)) {}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

/// Who waits for cages has the first one where the probe is in the first image, unless told where.
ImageCore& Simulation::imaging(const FrameInput* first) {
  if (images_) return *images_;
  std::optional<Pose> X_JP = params_.X_JC;
  if (!X_JP && params_.wait_for_cage && first != nullptr && first->has_probe != 0)
    X_JP = to_pose(first->X_JP);
  images_ = std::make_unique<ImageCore>(scene_, params_, extra_scene_holders_, X_JP, prepared_);
  return *images_;
}

const HapticSnapshot& Simulation::tick(const TickInput& input) noexcept {
  return haptics_->step(input);
}

void Simulation::take(const TissuePacket& packet) noexcept {
  haptics_->take(packet);
}

ImagedBody Simulation::advance(const FrameInput& input) {
  return imaging(&input).advance(input);
}

const Frame& Simulation::render(const FrameInput& input, const ImagedBody& body) {
  return imaging().render(input, body);
}

void Simulation::restart_imaging() noexcept {
  images_.reset();
}

const HapticSnapshot& Simulation::step(const TickInput& input) {
  if (due_) advance();
  ticks_ = input.tick;
  const HapticSnapshot& out = haptics_->step(input);
  const double seconds = static_cast<double>(ticks_ - 1) / params_.haptic_rate;
  if (seconds * params_.image_rate >= static_cast<double>(n_images_))
    due_ = frame_input(out, controls_, ++n_images_);
  return out;
}

const ImagedBody& Simulation::advance() {
  ARTUS_REQUIRE(due_.has_value(), "no image is due");
  shown_ = *std::exchange(due_, std::nullopt);
  if (params_.deform || images_)
    body_ = imaging(&shown_).advance(shown_);
  else
    body_ = {shown_.number, scene_, {}, {}};
  if (body_.packet) haptics_->take(*body_.packet);
  return body_;
}

const Frame& Simulation::render() {
  if (due_) advance();
  ARTUS_REQUIRE(body_.number != 0, "no image was due yet");
  return imaging().render(shown_, body_);
}

TickInput Simulation::next_input(const DeviceSample& device) const noexcept {
  TickInput input;
  input.tick = ticks_ + 1;
  input.device = device;
  input.device.time_ns = std::llround(1e9 * static_cast<double>(input.tick) / params_.haptic_rate);
  return input;
}

const Felt& Simulation::step(const Hands& hands) {
  DeviceSample device;
  device.number = ticks_ + 1;
  device.state = PeerState::alive;
  device.has_needle = hands.X_WN ? 1 : 0;
  device.has_probe = hands.X_WP ? 1 : 0;
  if (hands.X_WN) device.X_WN = to_plain(*hands.X_WN);
  if (hands.X_WP) device.X_WP = to_plain(*hands.X_WP);
  device.plunger = hands.plunger      ? PlungerSign::travel
                   : hands.thumb != 0 ? PlungerSign::force
                                      : PlungerSign::none;
  device.plunger_travel = hands.plunger.value_or(0);
  device.plunger_force = hands.thumb;
  TickInput input = next_input(device);
  input.command = hands.command;
  const HapticSnapshot& out = step(input);
  const DeviceFeedback& feedback = out.feedback;
  felt_ = {vector_of(feedback.force),
           vector_of(feedback.torque),
           vector_of(feedback.probe_force),
           vector_of(feedback.probe_torque),
           feedback.plunger.thumb_force,
           out.status,
           due_.has_value()};
  return felt_;
}

std::vector<std::uint8_t> Simulation::motion() const {
  return images_ ? images_->motion() : std::vector<std::uint8_t>();
}

const std::shared_ptr<const Scene>& Simulation::scene() const noexcept {
  return images_ ? images_->scene() : scene_;
}

const std::shared_ptr<const Scene>& Simulation::drawn_scene() const noexcept {
  return images_ ? images_->drawn_scene() : scene_;
}

DrawnLiquid Simulation::drawn_liquid() const noexcept {
  return images_ ? images_->drawn_liquid() : DrawnLiquid();
}

const Transducer& Simulation::transducer() const noexcept {
  return images_ ? images_->transducer() : params_.transducer;
}

const std::string& Simulation::refusal() const noexcept {
  return images_ ? images_->refusal() : no_refusal_;
}

const SyringeCore& Simulation::syringe() const noexcept {
  return haptics_->syringe();
}

const NeedleModel& Simulation::needle() const noexcept {
  return haptics_->needle();
}

double Simulation::energy_to_hand() const noexcept {
  return haptics_->energy_to_hand();
}

const HapticSnapshot& Simulation::last() const noexcept {
  return haptics_->last();
}

}  // namespace artus
