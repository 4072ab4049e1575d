// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/still.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/haptics/needle/needle_model.h"
#include "artus/simulation/simulation.h"

namespace artus {
namespace {

constexpr double kSpeed = 10e-3;     // m/s of the needle: that of the haptic laws' levels
constexpr double kLowering = 10e-3;  // m/s of the probe
constexpr double kAbove = 2e-3;      // m over its place where the probe begins
constexpr double kApproach = 8e-3;   // m before the skin where the needle begins
constexpr double kOvershoot = 5e-3;  // m that it goes on before it comes back
constexpr double kRest = 1.0;        // s until the pressed tissue rests
constexpr double kReady = 0.3;       // s until the guard has let the force in
constexpr double kImageRate = 30;    // Hz
constexpr double kSettled = 1e-6;    // m between two images
constexpr int kMaxImages = 120;      // that the tissue comes to rest in

SessionParams params_of(const Transducer& transducer, const NeedleView& needle) {
  SessionParams params;
  params.device = find_device("ideal").value_or(DeviceLimits{});
  params.image_rate = kImageRate;
  params.transducer = transducer;
  params.needle_shape = needle.shape;
  params.feel.needle_length = needle.shape.length;
  params.deform = true;
  return params;
}

/// Both hands in a simulation, led by one motion after the other.
class Led {
 public:
  Led(std::shared_ptr<const CompiledJoint> joint, const SessionParams& params)
      : simulation_(std::make_shared<const Scene>(std::move(joint)), params) {}

  /// `along` m of the last axis, from `from` to `to`, at `speed`.
  template <class Place>
  void move(double from, double to, double speed, const Place& place) {
    const double ticks = std::ceil(std::abs(to - from) / speed * simulation_.params().haptic_rate);
    for (double k = 1; k <= ticks; ++k) {
      place(from + (to - from) * k / ticks);
      step();
    }
  }
  void hold(double seconds) {
    for (double k = seconds * simulation_.params().haptic_rate; k > 0; --k) step();
  }
  Hands& hands() noexcept { return hands_; }
  [[nodiscard]] Simulation& simulation() noexcept { return simulation_; }

 private:
  void step() { static_cast<void>(simulation_.step(hands_)); }

  Simulation simulation_;
  Hands hands_;
};

/// m from the tip back along the needle to the first skin that its line meets; 0: none.
double depth_of(const Scene& scene, const Pose& X_JN, double length) {
  const Vec3 tip = X_JN.translation();
  const Vec3 axis = X_JN.linear().col(2);
  std::array<TissueInterval, 128> met;
  const QueryCount count = scene.find_intervals({tip - length * axis, tip}, met);
  for (std::size_t i = 0; i < count.size; ++i)
    if (met[i].region >= kFirstRegion) return length - met[i].entry;
  return 0;
}

/// The layer next before a tip that stands in the material at `tip`.
RegionId next_layer(const Scene& rest, const Vec3& tip, const Vec3& axis) {
  constexpr double kLook = 5e-3;  // m
  std::array<TissueInterval, 32> met;
  const QueryCount count = rest.find_intervals({tip, tip + kLook * axis}, met);
  const RegionId here = count.size > 0 ? met[0].region : kOutside;
  for (std::size_t i = 0; i < count.size; ++i)
    if (met[i].region >= kFirstRegion && met[i].region != here) return met[i].region;
  return kOutside;
}

double displacement_along(const Scene& scene, const Vec3& p_rest, const Vec3& axis) {
  return scene.tissue() ? scene.tissue()->displacement(p_rest).dot(axis) : 0;
}

/// The tissue at rest under what the last tick loads it with.
std::shared_ptr<const Scene> come_to_rest(Simulation& simulation, const Vec3& p_rest) {
  if (simulation.due() != nullptr) simulation.advance();
  FrameInput input = frame_input(simulation.last(), controls_of(simulation.params()), 0);
  double before = -1;
  for (int k = 0; k < kMaxImages; ++k) {
    input.number = static_cast<std::uint64_t>(k) + 1;
    const ImagedBody body = simulation.advance(input);
    const double now = body.scene->tissue()->displacement(p_rest).norm();
    if (std::abs(now - before) < kSettled) break;
    before = now;
  }
  return simulation.scene();
}

}  // namespace

Result<Still> lead_to(const std::shared_ptr<const CompiledJoint>& joint, const Press& press,
                      const Transducer& transducer, const NeedleView& needle,
                      NeedleDirection direction) {
  const SessionParams params = params_of(transducer, needle);
  ARTUS_TRY(validate(params));
  Led led(joint, params);
  Simulation& simulation = led.simulation();
  simulation.prepare_imaging();
  if (!simulation.refusal().empty()) return fail(ErrorCode::failed, simulation.refusal(), "tissue");
  const auto probe_at = [&](double z) {
    led.hands().X_WP = press.X_JP * Eigen::Translation3d(0, 0, z);
  };
  led.move(-kAbove - press.depth, 0, kLowering, probe_at);
  led.hold(kRest);
  const auto pressed = simulation.scene();
  const Vec3 axis = needle.X_JN.linear().col(2);
  const double depth = depth_of(*pressed, needle.X_JN, needle.shape.length);
  const auto needle_at = [&](double z) {
    led.hands().X_WN = needle.X_JN * Eigen::Translation3d(0, 0, z);
  };
  const double start = -depth - kApproach;
  needle_at(start);
  led.hold(kReady);
  const double turn = direction == NeedleDirection::out ? kOvershoot : 0;
  led.move(start, turn, kSpeed, needle_at);
  if (turn > 0) led.move(turn, 0, kSpeed, needle_at);
  // What a membrane holds stays, and others' motion is followed; what slides is of its passing.
  if (simulation.needle().contact().tick().dimple > 0) led.hold(kRest);

  const HapticSnapshot tick = simulation.last();
  const NeedleTick& contact = simulation.needle().contact().tick();
  Still out;
  out.probe_force = -Vec3(tick.feedback.probe_force[0], tick.feedback.probe_force[1],
                          tick.feedback.probe_force[2])
                         .dot(press.X_JP.linear().col(2));
  out.share = tick.feedback.probe_share;
  out.needle.force = -Vec3(tick.force_J[0], tick.force_J[1], tick.force_J[2]).dot(axis);
  out.needle.tip_force = tick.load.tip;
  out.needle.region = static_cast<RegionId>(tick.feedback.region);
  if (contact.dimple > 0)
    out.needle.tented = next_layer(*simulation.rest_scene(), contact.tip, axis);
  const Vec3 p_rest = contact.tip;
  out.scene = come_to_rest(simulation, p_rest);
  out.needle.tissue_moved =
      displacement_along(*out.scene, p_rest, axis) - displacement_along(*pressed, p_rest, axis);
  return out;
}

}  // namespace artus
