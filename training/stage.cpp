// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/stage.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "artus/detail/operators/hand_loop.h"
#include "artus/detail/operators/looking_operator.h"
#include "artus/detail/operators/thumb.h"
#include "artus/detail/operators/thumb_dose.h"
#include "artus/detail/simulation/image_core.h"
#include "artus/detail/training/session_meter.h"

namespace artus {
namespace {

constexpr double kRate = 1000;          // Hz
constexpr std::uint64_t kGlances = 50;  // ticks from one to the next
constexpr double kPhysics = 4000;       // Hz
constexpr double kSeenVolume = 0.3e-6;  // m^3 that split a line visibly; assumed

HandParams hand_of(const OperatorSkill& skill, std::uint64_t seed) {
  HandParams hand;
  hand.tremor_rms = skill.tremor_rms;
  hand.seed = seed;
  return hand;
}

/// m from the entry where the tip comes into the picture on the intended way; 0: nowhere.
double appears_at(const Scenario& scenario, const Scene& scene, const TipSightFinder& finder) {
  constexpr double kStep = 0.5e-3;  // m
  const Vec3 direction = scenario.target.point - scenario.entry.centre;
  for (double along = kStep; along < direction.norm(); along += kStep) {
    const Vec3 tip = scenario.entry.centre + along * direction.normalized();
    if (finder.look(scene, scenario.X_JP, make_pose(tip, direction, Vec3::Zero())).seen()) return along;
  }
  return 0;
}

/// The thumb of a simulated hand.
class SyringeHand {
 public:
  SyringeHand(const PlungerParams& params, const ScenarioSyringe& meant, const OperatorSkill& skill)
      : area_(params.syringe.area()), dose_(params, meant.volume), wanted_(meant.volume > 0) {
    push_.thumb_rate = skill.haste * meant.rate;
    pull_.thumb_force = -kPull;
    draws_ = skill.aspirate;
  }

  /// What the device says of it in the next tick. `gives`: the needle is where it is meant to be.
  void step(bool gives, const Plunger& plunger, double given, double dt, DeviceSample& sample) {
    sample.plunger = wanted_ ? PlungerSign::force : PlungerSign::none;
    const bool pulls = wanted_ && gives && draws_ > 0;
    if (pulls) draws_ -= dt;
    const bool pushes = wanted_ && gives && !pulls;
    const PlungerState& state = plunger.state();
    const OperatorPhase* pressing = pushes ? dose_.present(&push_) : nullptr;
    const PlungerInput thumb = thumb_.step(pulls ? &pull_ : pressing, state, area_, dt);
    sample.plunger_force = thumb.force + thumb.stiffness * (thumb.position - state.travel);
    dose_.step(pushes, given, state.pressure, state.tip_pressure, state.flow, dt);
  }

  /// Nothing is left to give, or nothing goes in.
  [[nodiscard]] bool done() const noexcept { return !wanted_ || dose_.done(); }

 private:
  static constexpr double kMaxForce = 40;  // N; assumed: a strong push
  static constexpr double kPull = 8;        // N; assumed
  double area_;                             // m^2
  ThumbDose dose_;
  bool wanted_;
  OperatorPhase push_;
  OperatorPhase pull_;
  double draws_ = 0;  // s that it still draws back
  Thumb thumb_{{SyringeCore::kCoupling, kMaxForce}};
};

/// The session of an attempt while it is played: what came in and out is measured and recorded.
class PlayedSession {
 public:
  PlayedSession(std::shared_ptr<const Scene> scene, const SessionParams& params,
                const PlayOptions& options)
      : params_(params), options_(options), core_(scene, params) {
    if (options.picture_rate > 0) images_ = std::make_unique<ImageCore>(std::move(scene), params);
  }

  [[nodiscard]] const HapticCore& core() const noexcept { return core_; }
  [[nodiscard]] std::uint64_t tick() const noexcept { return tick_; }
  [[nodiscard]] bool glances() const noexcept { return tick_ % kGlances == 1; }

  /// One tick with what the device says.
  const HapticSnapshot& step(DeviceSample device, PlayedAttempt& attempt, AttemptMeter& meter) {
    TickInput input;
    input.tick = ++tick_;
    device.time_ns = static_cast<std::int64_t>(tick_) * 1'000'000;
    device.number = tick_;
    device.state = PeerState::alive;
    input.device = device;
    const HapticSnapshot& out = core_.step(input);
    add_tick(meter, out, 1 / kRate);
    if (options_.record) attempt.recording.ticks.push_back(to_record(out));
    if (images_ && static_cast<double>(tick_) * options_.picture_rate >=
                       kRate * static_cast<double>(frames_ + 1))
      draw(out, attempt, meter);
    return out;
  }

 private:
  void draw(const HapticSnapshot& out, PlayedAttempt& attempt, AttemptMeter& meter) {
    const FrameInput input = frame_input(out, controls_of(params_), ++frames_);
    const Frame& frame = images_->render(input);
    add_frame(meter, input, frame, static_cast<double>(tick_) / kRate);
    attempt.recording.frames.push_back(to_record(input, frame, params_.transducer));
  }

  SessionParams params_;
  PlayOptions options_;
  HapticCore core_;
  std::unique_ptr<ImageCore> images_;
  std::uint64_t tick_ = 0;
  std::uint64_t frames_ = 0;
};

std::uint64_t mix_seed(std::uint64_t a, std::uint64_t b) {
  return a * 1'000'003 + b;
}

/// An attempt with a needle while it is played.
class NeedleStage final : public Stage {
 public:
  NeedleStage(const Scenario& scenario, std::shared_ptr<const Scene> scene,
              const SessionParams& params, const OperatorSkill& skill, const PlayOptions& options)
      : scene_(std::move(scene)),
        finder_(params.transducer, params.image.depth, params.needle_shape),
        session_(scene_, params, options),
        hands_(skill,
               {scenario.entry.centre, scenario.target.point, scenario.X_JP, scenario.time_limit,
                appears_at(scenario, *scene_, finder_)},
               mix_seed(scenario.seed, options.seed)),
        thumb_(session_.core().syringe().plunger().params(), scenario.syringe, skill),
        loop_({kRate, kPhysics}, params.device, hand_of(skill, options.seed),
              hands_.intention(0).X_JN) {
    const auto& regions = scene_->joint().regions;
    for (std::size_t i = kFirstRegion; i < regions.size(); ++i)
      if (regions[i].name == scenario.target.structure) target_ = static_cast<RegionId>(i);
  }

  /// One tick. False when the attempt is over.
  bool step(PlayedAttempt& attempt, AttemptMeter& meter) override {
    const double t = loop_.time();
    DeviceSample device;
    device.X_WN = to_plain(loop_.measured());
    device.X_WP = to_plain(hands_.probe(t));
    device.has_needle = device.has_probe = 1;
    thumb_.step(hands_.holds(), session_.core().syringe().plunger(), given_, 1 / kRate, device);
    const HapticSnapshot& out = session_.step(device, attempt, meter);
    given_ = out.feedback.plunger.given;
    if (session_.glances()) glance(t, out);
    const auto& f = out.feedback;
    const Wrench motor{Vec3(f.force[0], f.force[1], f.force[2]),
                       Vec3(f.torque[0], f.torque[1], f.torque[2])};
    loop_.advance(motor, [this](double at) { return hands_.intention(at); });
    return !hands_.done();
  }

  [[nodiscard]] double time() const noexcept override { return loop_.time(); }

 private:
  void glance(double t, const HapticSnapshot& out) {
    const Pose X_JN = to_pose(out.X_JN);
    const TipSight sight = finder_.look(*scene_, to_pose(out.X_JP), X_JN);
    ScanGlance seen;
    seen.visible = sight.seen() && out.feedback.region != kOutside;
    seen.offset = sight.offset;
    seen.depth = out.inserted != 0 ? out.feedback.depth : 0;
    seen.stuck = out.feedback.contact == static_cast<std::uint32_t>(ContactState::bone);
    seen.given = thumb_.done();
    seen.astray = given_ > kSeenVolume && out.feedback.region != target_;
    hands_.look(t, X_JN, seen);
  }

  std::shared_ptr<const Scene> scene_;
  TipSightFinder finder_;
  PlayedSession session_;
  ScanningOperator hands_;
  SyringeHand thumb_;
  HandLoop loop_;
  double given_ = 0;  // m^3
  std::uint32_t target_ = kOutside;
};

/// An attempt with the probe alone while it is played: the hand slides over the skin.
class LookStage final : public Stage {
 public:
  LookStage(const Scenario& scenario, std::shared_ptr<const Scene> scene,
            const SessionParams& params, const OperatorSkill& skill, const PlayOptions& options)
      : scene_(std::move(scene)),
        X_JP_(scenario.X_JP),
        transducer_(params.transducer),
        depth_(params.image.depth),
        search_(scene_->joint(), scenario.find, params.transducer, params.image.depth,
                StructureSearch::kTold),
        session_(scene_, params, options),
        hand_(skill, plan_of(scenario), mix_seed(scenario.seed, options.seed)) {}

  bool step(PlayedAttempt& attempt, AttemptMeter& meter) override {
    DeviceSample device;
    const Pose X_JP = pose_at(hand_.x(), hand_.y());
    device.X_WP = to_plain(X_JP);
    device.has_probe = 1;
    session_.step(device, attempt, meter);
    if (session_.glances()) glance(X_JP);
    return !hand_.done();
  }

  [[nodiscard]] double time() const noexcept override {
    return static_cast<double>(session_.tick()) / kRate;
  }

 private:
  static LookPlan plan_of(const Scenario& scenario) {
    constexpr double kReach = 30e-3;  // m to either side on a joint's skin; assumed
    LookPlan plan;
    const double half = scenario.gel ? 0.5 * scenario.gel->width : kReach;
    plan.half_x = plan.half_y = half;
    plan.n = scenario.find.size();
    return plan;
  }

  /// The face on the skin, as it lies along the beam's axis.
  [[nodiscard]] Pose pose_at(double x, double y) const {
    constexpr double kReach = 40e-3;  // m
    Pose X = X_JP_ * Eigen::Translation3d(x, y, 0);
    const Vec3 beam = X.linear().col(2);
    const Vec3 from = X.translation() - kReach * beam;
    std::array<TissueInterval, 64> layers;
    const QueryCount count =
        scene_->find_intervals({from, X.translation() + kReach * beam}, layers);
    for (std::size_t i = 0; i < count.size; ++i) {
      if (layers[i].region < kFirstRegion) continue;
      X.translation() = from + layers[i].entry * beam;
      break;
    }
    return X;
  }

  void glance(const Pose& X_JP) {
    LookGlance seen;
    search_.look(*scene_, time(), X_JP);
    seen.asked = search_.found();
    for (const Sought& one : search_.sought()) {
      const StructureSight sight = see_structure(*scene_, transducer_, depth_, X_JP, one.region);
      seen.x.push_back(sight.in_picture ? std::optional(sight.x) : std::nullopt);
    }
    hand_.look(time(), seen);
  }

  std::shared_ptr<const Scene> scene_;
  Pose X_JP_;
  Transducer transducer_;
  double depth_;
  StructureSearch search_;
  PlayedSession session_;
  LookingOperator hand_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const Scenario& scenario, std::shared_ptr<const Scene> scene,
                                  const SessionParams& params, const OperatorSkill& skill,
                                  const PlayOptions& options) {
  if (scenario.find.empty())
    return std::make_unique<NeedleStage>(scenario, std::move(scene), params, skill, options);
  return std::make_unique<LookStage>(scenario, std::move(scene), params, skill, options);
}

}  // namespace artus
