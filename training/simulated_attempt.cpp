// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/simulated_attempt.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "artus/detail/operators/looking_operator.h"
#include "artus/detail/operators/thumb_dose.h"
#include "artus/detail/session/record/simulation_recorder.h"
#include "artus/detail/simulation/simulated_hands.h"
#include "artus/detail/training/health/simulated_health.h"
#include "artus/detail/training/metrics/goals.h"
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

/// m from the entry where the tip comes into the picture on the intended path; 0: nowhere.
double appears_at(const Scenario& scenario, const Scene& scene, const TipSightFinder& finder) {
  constexpr double kStep = 0.5e-3;  // m
  const Vec3 direction = scenario.target.point - scenario.entry.centre;
  for (double along = kStep; along < direction.norm(); along += kStep) {
    const Vec3 tip = scenario.entry.centre + along * direction.normalized();
    if (finder.look(scene, scenario.X_JP, make_pose(tip, direction, Vec3::Zero())).seen())
      return along;
  }
  return 0;
}

/// What the thumb of a simulated hand means: to draw back for a while, then to give.
class ThumbPlan {
 public:
  ThumbPlan(const ScenarioSyringe& meant, const OperatorSkill& skill) : draws_(skill.aspirate) {
    push_.thumb_rate = skill.haste * meant.rate;
    push_.until_given = true;
    pull_.thumb_force = -kPull;
  }

  /// In the next tick of `dt` s; null: nothing. `gives`: the needle is where it is meant to be.
  const OperatorPhase* step(bool gives, double dt) noexcept {
    if (!gives) return nullptr;
    if (!(draws_ > 0)) return &push_;
    draws_ -= dt;
    return &pull_;
  }

 private:
  static constexpr double kPull = 8;  // N; assumed
  OperatorPhase push_;
  OperatorPhase pull_;
  double draws_;  // s that it still draws back
};

/// The simulation of an attempt while it is played: what came in and out is measured and recorded.
class PlayedSimulation {
 public:
  PlayedSimulation(std::shared_ptr<const Scene> scene, const SessionParams& params,
                   const PlayOptions& options, Recording& recording)
      : options_(options),
        simulation_(std::move(scene), params, 0, options.prepared),
        recorder_(simulation_, recording,
                  options.picture_rate > 0 ? RecordedPictures::drawn : RecordedPictures::none) {
    recorder_.set_keeping(options.record);
  }

  [[nodiscard]] const Simulation& simulation() const noexcept { return simulation_; }
  [[nodiscard]] std::optional<HealthQuestion> find_body() {
    return draw_health_question(simulation_);
  }
  [[nodiscard]] std::uint64_t tick() const noexcept { return simulation_.ticks(); }
  [[nodiscard]] bool glances() const noexcept { return tick() % kGlances == 1; }

  /// One tick with what the device says.
  const HapticSnapshot& step(DeviceSample device, AttemptMeter& meter) {
    device.state = PeerState::alive;
    device.number = tick() + 1;
    const TickInput input = simulation_.next_input(device);
    const double due = static_cast<double>(input.tick) / kRate * options_.picture_rate;
    recorder_.set_drawing(due >= static_cast<double>(pictures_ + 1));
    const HapticSnapshot& out = recorder_.step(input);
    add_tick(meter, out, 1 / kRate);
    if (const Frame* frame = recorder_.drawn()) {
      ++pictures_;
      add_frame(meter, recorder_.shown(), *frame, static_cast<double>(input.tick) / kRate);
    }
    return out;
  }

 private:
  PlayOptions options_;
  Simulation simulation_;
  SimulationRecorder recorder_;
  std::uint64_t pictures_ = 0;
};

std::uint64_t mix_seed(std::uint64_t a, std::uint64_t b) {
  return a * 1'000'003 + b;
}

/// An attempt with a needle while it is played.
class NeedleAttempt final : public SimulatedAttempt {
 public:
  NeedleAttempt(const Scenario& scenario, std::shared_ptr<const Scene> scene,
                const SessionParams& params, const OperatorSkill& skill, const PlayOptions& options,
                Recording& recording)
      : scene_(std::move(scene)),
        finder_(params.transducer, params.image.depth, params.needle_shape, params.image.look),
        session_(scene_, params, options, recording),
        person_(skill,
                {scenario.entry.centre, scenario.target.point, scenario.X_JP, scenario.time_limit,
                 appears_at(scenario, *scene_, finder_)},
                mix_seed(scenario.seed, options.seed)),
        thumb_(scenario.syringe, skill),
        target_point_(scenario.target.point),
        is_structure_(!scenario.target.structure.empty()) {
    hands_.take_up(HandLoop({kRate, kPhysics}, params.device, hand_of(skill, options.seed),
                            person_.intention(0).X_JN));
    const double volume = scenario.syringe.volume;
    const PlungerParams& plunger = session_.simulation().syringe().plunger().params();
    if (volume > 0) hands_.set_thumb(DosingThumb(plunger, volume, kRate));
    in_target_ = place_of(scenario.target.structure, scene_->joint());
  }

  /// One tick. False when the attempt is over.
  bool step(AttemptMeter& meter) override {
    const double t = hands_.needle().time();
    hands_.hold_probe(person_.probe(t));
    const OperatorPhase* pressing = thumb_.step(person_.holds() && !person_.eases(t), 1 / kRate);
    const HapticSnapshot& out = session_.step(hands_.read(pressing), meter);
    hands_.feel(out.feedback);
    if (session_.glances()) glance(t, out);
    hands_.move(person_);
    return !person_.done();
  }

  [[nodiscard]] double time() const noexcept override { return hands_.needle().time(); }
  [[nodiscard]] std::optional<HealthQuestion> find_body() override { return session_.find_body(); }

 private:
  void glance(double t, const HapticSnapshot& out) {
    const Pose X_JN = to_pose(out.X_JN);
    const TipSight sight = finder_.look(*session_.simulation().scene(), to_pose(out.X_JP), X_JN);
    ScanGlance seen;
    seen.visible = sight.seen() && out.feedback.region != kOutside;
    seen.offset = sight.offset;
    // A target without a structure is a place in space, which no tissue carries along.
    const auto& tissue = session_.simulation().scene()->tissue();
    if (tissue && is_structure_) {
      seen.moved = tissue->displacement(target_point_);
      seen.tents = out.feedback.contact == static_cast<std::uint32_t>(ContactState::touching) &&
                   !is_target(out.feedback.region);
    }
    seen.depth = out.inserted != 0 ? out.feedback.depth : 0;
    seen.stuck = out.feedback.contact == static_cast<std::uint32_t>(ContactState::bone);
    seen.given = !hands_.has_thumb() || hands_.thumb().done();
    seen.resists = out.feedback.plunger.tip_pressure > Redirection::kResists;
    seen.astray = out.feedback.plunger.given > kSeenVolume && !fills_target(out);
    person_.look(t, X_JN, seen);
  }

  /// As the picture tells: at least half of what was given went into the target's place.
  [[nodiscard]] bool fills_target(const HapticSnapshot& out) const {
    double there = 0;
    for (std::size_t k = 0; k < std::min<std::size_t>(out.n_sites, kMaxSites); ++k)
      if (is_target(out.sites[k].region)) there += out.sites[k].volume;
    return 2 * there >= out.feedback.plunger.given;
  }

  [[nodiscard]] bool is_target(std::uint32_t region) const {
    return region < in_target_.size() && in_target_[region];
  }

  std::shared_ptr<const Scene> scene_;
  TipSightFinder finder_;
  PlayedSimulation session_;
  ScanningOperator person_;
  ThumbPlan thumb_;
  SimulatedHands hands_;
  Vec3 target_point_;
  bool is_structure_;
  std::vector<bool> in_target_;  // by region: its place is the target's
};

/// An attempt with the probe alone while it is played: the hand slides over the skin.
class LookAttempt final : public SimulatedAttempt {
 public:
  LookAttempt(const Scenario& scenario, std::shared_ptr<const Scene> scene,
              const SessionParams& params, const OperatorSkill& skill, const PlayOptions& options,
              Recording& recording)
      : scene_(std::move(scene)),
        X_JP_(scenario.X_JP),
        transducer_(params.transducer),
        depth_(params.image.depth),
        search_(scene_->joint(), scenario.find, params.transducer, params.image.depth,
                StructureSearch::kTold),
        session_(scene_, params, options, recording),
        hand_(skill, plan_of(scenario), mix_seed(scenario.seed, options.seed)) {}

  bool step(AttemptMeter& meter) override {
    DeviceSample device;
    const Pose X_JP = pose_at(hand_.x(), hand_.y());
    device.X_WP = to_plain(X_JP);
    device.has_probe = 1;
    session_.step(device, meter);
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
    const Scene& scene = *session_.simulation().scene();
    search_.look(scene, time(), X_JP);
    seen.asked = search_.found();
    for (const Sought& one : search_.sought()) {
      const StructureSight sight = see_structure(scene, transducer_, depth_, X_JP, one.region);
      seen.x.push_back(sight.in_picture ? std::optional(sight.x) : std::nullopt);
    }
    hand_.look(time(), seen);
  }

  std::shared_ptr<const Scene> scene_;
  Pose X_JP_;
  Transducer transducer_;
  double depth_;
  StructureSearch search_;
  PlayedSimulation session_;
  LookingOperator hand_;
};

}  // namespace

std::unique_ptr<SimulatedAttempt> make_simulated_attempt(
    const Scenario& scenario, std::shared_ptr<const Scene> scene, const SessionParams& params,
    const OperatorSkill& skill, const PlayOptions& options, Recording& recording) {
  if (scenario.find.empty())
    return std::make_unique<NeedleAttempt>(scenario, std::move(scene), params, skill, options,
                                           recording);
  return std::make_unique<LookAttempt>(scenario, std::move(scene), params, skill, options,
                                       recording);
}

}  // namespace artus
