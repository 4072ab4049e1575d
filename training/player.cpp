// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/training/player.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "artus/anatomy/body/tissue.h"
#include "artus/core/text_file.h"
#include "artus/echo/transducer_file.h"
#include "artus/operators/hand_loop.h"
#include "artus/operators/thumb.h"
#include "artus/operators/thumb_dose.h"
#include "artus/session/image_core.h"
#include "artus/training/session_meter.h"

namespace artus {
namespace {

constexpr double kRate = 1000;          // Hz
constexpr std::uint64_t kGlances = 50;  // ticks from one to the next
constexpr double kPhysics = 4000;       // Hz
constexpr double kGuide = 300;          // N/m of a whole haptic_guide; assumed
constexpr double kWall = 1000;          // N/m of a whole haptic_wall; assumed
constexpr double kSeenVolume = 0.3e-6;  // m^3 that split a line visibly; assumed

Result<RegionId> find_region(const CompiledJoint& joint, const std::string& name) {
  for (std::size_t i = kFirstRegion; i < joint.regions.size(); ++i)
    if (joint.regions[i].name == name) return static_cast<RegionId>(i);
  return fail(ErrorCode::not_found, "the joint has no structure '" + name + "'", joint.name);
}

template <class T>
void put(std::string& out, std::uint32_t kind, const T& record) {
  const RecordStart start{kind, sizeof(T)};
  out.append(reinterpret_cast<const char*>(&start), sizeof start);
  out.append(reinterpret_cast<const char*>(&record), sizeof record);
}

HandParams hand_of(const OperatorSkill& skill, std::uint64_t seed) {
  HandParams hand;
  hand.tremor_rms = skill.tremor_rms;
  hand.seed = seed;
  return hand;
}

/// m from the entry where the tip comes into the picture on the intended way; 0: nowhere.
double appears_at(const Scenario& scenario, const Scene& scene, const TipSightFinder& finder) {
  constexpr double kStep = 0.5e-3;  // m
  const Vec3 way = scenario.target.point - scenario.entry.centre;
  for (double along = kStep; along < way.norm(); along += kStep) {
    const Vec3 tip = scenario.entry.centre + along * way.normalized();
    if (finder.look(scene, scenario.X_JP, make_pose(tip, way, Vec3::Zero())).seen()) return along;
  }
  return 0;
}

/// The thumb of a simulated hand.
class SyringeHand {
 public:
  SyringeHand(const Syringe& syringe, const ScenarioSyringe& meant, const OperatorSkill& skill)
      : area_(syringe.area()), dose_(syringe, meant.volume), wanted_(meant.volume > 0) {
    push_.thumb_rate = skill.haste * meant.rate;
    pull_.thumb_force = -kPull;
    draws_ = skill.aspirate;
  }

  /// What the device says of it in the next tick. `gives`: the needle is where it is meant to be.
  void step(bool gives, const Plunger& plunger, double given, double dt, DeviceSample& sample) {
    sample.plunger = wanted_ ? PlungerSign::force : PlungerSign::none;
    const bool pulls = wanted_ && gives && draws_ > 0;
    if (pulls) draws_ -= dt;
    const bool pushes = wanted_ && gives && !pulls && !dose_.enough();
    const PlungerState& state = plunger.state();
    const PlungerInput thumb = thumb_.step(pulls    ? &pull_
                                           : pushes ? &push_
                                                    : nullptr,
                                           state, area_, dt);
    sample.plunger_force = thumb.force + thumb.stiffness * (thumb.position - state.travel);
    dose_.step(pushes, given, state.pressure, state.tip_pressure, state.flow, dt);
    flows_ = state.flow > ThumbDose::kFlows;
  }

  /// Nothing is left to give, or nothing goes in.
  [[nodiscard]] bool done() const noexcept { return !wanted_ || (dose_.enough() && !flows_); }

 private:
  static constexpr double kMostForce = 40;  // N; assumed: a strong push
  static constexpr double kPull = 8;        // N; assumed
  double area_;                             // m^2
  ThumbDose dose_;
  bool wanted_;
  bool flows_ = false;
  OperatorPhase push_;
  OperatorPhase pull_;
  double draws_ = 0;  // s that it still draws back
  Thumb thumb_{{SyringeCore::kCoupling, kMostForce}};
};

/// One attempt while it is played.
class Stage {
 public:
  Stage(const Scenario& scenario, std::shared_ptr<const Scene> scene, const SessionParams& params,
        const OperatorSkill& skill, const PlayOptions& options)
      : scene_(std::move(scene)),
        params_(params),
        options_(options),
        finder_(params.transducer, params.image.depth, params.needle_shape),
        core_(scene_, params),
        hands_(skill,
               {scenario.entry.centre, scenario.target.point, scenario.X_JP, scenario.time_limit,
                appears_at(scenario, *scene_, finder_)},
               mix_seed(scenario.seed, options.seed)),
        thumb_(core_.syringe().plunger().params().syringe, scenario.syringe, skill),
        loop_({kRate, kPhysics}, params.device, hand_of(skill, options.seed),
              hands_.intention(0).X_JN) {
    const auto region = find_region(scene_->joint(), scenario.target.structure);
    if (region) target_ = *region;
    if (options.picture_rate > 0) images_ = std::make_unique<ImageCore>(scene_, params);
  }

  /// One tick. False when the attempt is over.
  bool step(PlayedAttempt& attempt, AttemptMeter& meter) {
    const double t = loop_.time();
    TickInput input;
    input.tick = ++tick_;
    input.device.X_WN = to_plain(loop_.measured());
    input.device.X_WP = to_plain(hands_.probe(t));
    input.device.time_ns = static_cast<std::int64_t>(tick_) * 1'000'000;
    input.device.number = tick_;
    input.device.state = PeerState::alive;
    input.device.has_needle = input.device.has_probe = 1;
    thumb_.step(hands_.holds(), core_.syringe().plunger(), given_, 1 / kRate, input.device);
    const HapticSnapshot& out = core_.step(input);
    given_ = out.feedback.plunger.given;
    add_tick(meter, out, 1 / kRate);
    if (options_.record) attempt.recording.ticks.push_back(to_record(out));
    if (images_ && static_cast<double>(tick_) * options_.picture_rate >=
                       kRate * static_cast<double>(frames_ + 1))
      draw(out, attempt, meter);
    if (tick_ % kGlances == 1) glance(t, out);
    const auto& f = out.feedback;
    const Wrench motor{Vec3(f.force[0], f.force[1], f.force[2]),
                       Vec3(f.torque[0], f.torque[1], f.torque[2])};
    loop_.advance(motor, [this](double at) { return hands_.intention(at); });
    return !hands_.done();
  }

  [[nodiscard]] double time() const noexcept { return loop_.time(); }

 private:
  static std::uint64_t mix_seed(std::uint64_t a, std::uint64_t b) { return a * 1'000'003 + b; }

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

  void draw(const HapticSnapshot& out, PlayedAttempt& attempt, AttemptMeter& meter) {
    const FrameInput input = frame_input(out, controls_of(params_), ++frames_);
    const Frame& frame = images_->render(input);
    add_frame(meter, input, frame, static_cast<double>(tick_) / kRate);
    attempt.recording.frames.push_back({input, digest_of(frame)});
  }

  std::shared_ptr<const Scene> scene_;
  SessionParams params_;
  PlayOptions options_;
  TipSightFinder finder_;
  HapticCore core_;
  ScanningOperator hands_;
  SyringeHand thumb_;
  HandLoop loop_;
  double given_ = 0;  // m^3
  std::uint32_t target_ = kOutside;
  std::unique_ptr<ImageCore> images_;
  std::uint64_t tick_ = 0;
  std::uint64_t frames_ = 0;
};

}  // namespace

Result<std::shared_ptr<const Scene>> make_gel_scene(const GelBlock& gel) {
  const auto tissues = read_bundled_tissues();
  ARTUS_TRY(tissues);
  for (const FlatLayer& layer : gel.layers) {
    const bool known = std::any_of(tissues->begin(), tissues->end(),
                                   [&](const Tissue& t) { return t.name == layer.tissue; });
    if (!known)
      return fail(ErrorCode::not_found, "there is no tissue '" + layer.tissue + "'", "gel");
  }
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(
      make_layered_block(*tissues, gel.layers, gel.width, gel.width)));
}

HandAids aids_of(const Scenario& scenario) {
  HandAids aids;
  aids.entry = scenario.entry.centre;
  aids.target = scenario.target.point;
  for (const Aid& aid : scenario.aids) {
    if (aid.name == "haptic_guide") aids.guide = kGuide * aid.value;
    if (aid.name == "haptic_wall") aids.wall = kWall * aid.value;
  }
  for (const ScenarioAvoid& avoid : scenario.avoid)
    aids.keep_out += (aids.keep_out.empty() ? "" : "\n") + avoid.structure;
  return aids;
}

Result<SessionParams> make_session_params(const Scenario& scenario) {
  SessionParams params;
  const auto device = find_device("virtuose_6d_desktop");
  ARTUS_TRY(device);
  params.device = *device;
  const auto transducer = find_transducer(scenario.transducer);
  ARTUS_TRY(transducer);
  params.transducer = transducer->transducer;
  params.image.depth = scenario.depth;
  params.image.seed = scenario.seed;
  params.needle_shape = needle_of_gauge(scenario.gauge).value_or(NeedleShape{});
  params.feel.needle_length = scenario.needle_length;
  params.syringe = syringe_of(scenario);
  params.aids = aids_of(scenario);
  ARTUS_TRY(validate(params));
  return params;
}

Result<MeterOptions> make_meter_options(const Scenario& scenario, const CompiledJoint& joint,
                                        const SessionParams& params) {
  MeterOptions options;
  options.transducer = params.transducer;
  options.image_depth = params.image.depth;
  options.needle = params.needle_shape;
  options.longest = 2 * scenario.time_limit + 60;
  Target target{scenario.target.structure, std::nullopt, nullptr};
  if (scenario.target.structure.empty()) {
    target = {"the target", scenario.target.point, nullptr};
  } else {
    const auto region = find_region(joint, scenario.target.structure);
    ARTUS_TRY(region);
    target.body = make_region_body(joint, *region);
  }
  options.goals.target = target;
  options.goals.entry = scenario.entry.centre;
  for (const ScenarioAvoid& avoid : scenario.avoid) {
    const auto region = find_region(joint, avoid.structure);
    ARTUS_TRY(region);
    options.goals.avoid.push_back(
        {avoid.structure, make_region_body(joint, *region), avoid.margin, avoid.fatal});
  }
  return options;
}

Result<PlayedAttempt> play(const Scenario& scenario, const std::shared_ptr<const Scene>& scene,
                           const OperatorSkill& skill, const PlayOptions& options) {
  const auto params = make_session_params(scenario);
  ARTUS_TRY(params);
  auto meter_options = make_meter_options(scenario, scene->joint(), *params);
  ARTUS_TRY(meter_options);
  PlayedAttempt attempt;
  attempt.recording.head = make_head(scene->joint(), *params);
  attempt.recording.complete = true;
  AttemptMeter meter(scene, std::move(*meter_options));
  Stage stage(scenario, scene, *params, skill, options);
  const double longest = scenario.time_limit + 30;
  while (stage.time() < longest && stage.step(attempt, meter)) {
  }
  attempt.duration = stage.time();
  attempt.measures = meter.measure();
  attempt.judgement =
      judge(attempt.measures.metrics, scenario.pass, scenario.score, scenario.aided());
  return attempt;
}

Result<void> write_recording(const Recording& recording, const std::filesystem::path& file) {
  std::string out = to_line(recording.head) + "\n";
  std::size_t k = 0;
  for (const TickRecord& tick : recording.ticks) {
    put(out, RecordStart::kTick, tick);
    while (k < recording.frames.size() &&
           recording.frames[k].input.sample_time_ns <= tick.input.device.time_ns)
      put(out, RecordStart::kFrame, recording.frames[k++]);
  }
  put(out, RecordStart::kEnd, recording.dropped);
  return write_text(file, out);
}

}  // namespace artus
