// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/evidence/runs/injection_plan.h"
#include "artus/detail/evidence/runs/injection_view.h"
#include "artus/detail/evidence/runs/seated_probe.h"
#include "artus/detail/haptics/plunger/bevel.h"
#include "artus/detail/haptics/plunger/patient.h"
#include "artus/detail/operators/injection_operator.h"
#include "artus/detail/operators/thumb_dose.h"
#include "artus/detail/session/record/simulation_recorder.h"
#include "artus/detail/simulation/simulated_hands.h"
#include "artus/detail/training/health/simulated_health.h"

namespace artus {
namespace {
using Kind = OperatorPhase::Kind;
constexpr double kSpeed = 0.012;           // m/s of the needle
constexpr double kBackSpeed = 1.5e-3;      // m/s while feeling for the space; assumed
constexpr double kThrough = 2e-3;          // m that the tip goes through a thin space; assumed
constexpr double kFarthestThrough = 6e-3;  // m behind the space, of what resists; assumed
constexpr double kGentle = 3.5;            // N on the plunger meanwhile, 3-5 in practice
constexpr double kLoosens = 1.25;  // of the break-loose force, what moves a stopper that has rested
constexpr double kNotice = 0.2;    // s until it is seen that the target does not fill; assumed
constexpr double kEased = 1e-3;    // m that it goes on without pressing then; assumed
constexpr double kPull = -6;       // N of aspiration; assumed
constexpr double kReady = 0.5;     // s while the guard ramps up
constexpr double kSeated = 1;      // s until the probe is on the skin and presses
constexpr double kImageRate = 20;  // 1/s of the tissue's steps
constexpr double kSpare = 5e-3;    // m of shaft that stay outside

OperatorPhase named(OperatorPhase phase, const char* label) {
  phase.label = label;
  return phase;
}

/// N: at least what moves the stopper, or a wide barrel would never tell where it flows.
double gentle_force(const Syringe& syringe) {
  return std::max(kGentle, kLoosens * syringe.break_loose);
}

/// m along the line to go to before one comes back: through the layer, and into what resists the
/// gentle push when that is near.
double beyond(const Scene& scene, const InjectionRun& run, const LineLayer& layer,
              const Vec3& direction, const JointSpaces& spaces) {
  const InjectionSpec& spec = run.spec;
  const Syringe& syringe = run.plunger.syringe;
  const double gentle = (gentle_force(syringe) - syringe.glide) / syringe.area();
  const Segment path{spec.entry + layer.to * direction,
                     spec.entry + (layer.to + kFarthestThrough) * direction};
  for (const TissueInterval& s : tissue_intervals(scene, path)) {
    const SpaceLaw& law = spaces.spaces[spaces.of_region[s.region]].law;
    if (law.kind == SpaceKind::solid) break;
    if (law.kind != SpaceKind::split || law.opening <= gentle) continue;
    return layer.to + std::min(s.exit, s.entry + kThrough);
  }
  return layer.to + kThrough;
}

/// Where tissue gives way it comes onto a needle that rests: the tip is kept at `target` by the
/// picture once it is there.
void keep_at(double target, std::vector<OperatorPhase>& phases) {
  bool there = false;
  for (OperatorPhase& phase : phases) {
    const bool holds = phase.kind == Kind::hold;
    there = there || (!holds && phase.depth == target);
    if (!holds || !there) continue;
    phase.keeps_depth = true;
    phase.depth = target;
  }
}

std::vector<OperatorPhase> phases_of(const InjectionRun& run, const LineLayer& layer, double target,
                                     double through) {
  const InjectionSpec& spec = run.spec;
  std::vector<OperatorPhase> phases{named(stay(run.gave_way ? kSeated : kReady), "ready")};
  const double time = spec.volume / spec.rate;
  OperatorPhase inject = named(stay(2 * time + 20), "inject");
  inject.thumb_rate = spec.rate;
  inject.until_given = true;
  if (spec.technique == Technique::through_and_back) {
    phases.push_back(named(push_to(through, kSpeed), "through"));
    phases.push_back(named(stay(0.5), "stay"));
    OperatorPhase back = named(pull_to(std::max(0.0, layer.from - kThrough), kBackSpeed), "back");
    back.thumb_force = gentle_force(run.plunger.syringe);
    back.until_flow = true;
    phases.push_back(back);
    // The whole opening of the bevel into the space, before more is given.
    phases.push_back(named(pull_to(target, kBackSpeed), "stay"));
  } else {
    phases.push_back(named(push_to(target, kSpeed), "advance"));
    phases.push_back(named(stay(0.5), "stay"));
    if (spec.aspirate > 0) {
      phases.push_back(named(stay(spec.aspirate), "aspirate"));
      phases.back().thumb_force = kPull;
      phases.push_back(named(stay(0.5), "look"));
    }
  }
  phases.push_back(inject);
  // A tense space would push the plunger back, and with it what was given.
  phases.push_back(named(stay(run_out_time(run.plunger)), "wait"));
  phases.back().thumb_holds = true;
  // Let go before it comes out: what a tendon's pressure holds in the barrel would go elsewhere.
  phases.push_back(named(pull_to(-kStartOutside, 2 * kSpeed), "withdraw"));
  if (run.gave_way) keep_at(target, phases);
  for (OperatorPhase& phase : phases)
    if (phase.duration == 0) phase.duration = 3 * kSearch / kSpeed;
  return phases;
}

/// The phases along a plan's line in the body as it is.
std::vector<OperatorPhase> phases_in(const Scene& scene, const InjectionRun& run,
                                     const LinePlan& plan, const JointSpaces& spaces) {
  return phases_of(run, plan.layer,
                   stop_in(plan, plan.layer, bevel_length(run.plunger.needle.outer_diameter)),
                   beyond(scene, run, plan.layer, plan.direction, spaces));
}

/// Everything that one injection runs on.
class Trial {
 public:
  /// `out`: with spec and plunger. `recording`: or null.
  Trial(const Scene& scene, const SessionParams& params, InjectionRun& out, Recording* recording)
      : spec_(out.spec),
        out_(out),
        simulation_({std::shared_ptr<const void>(), &scene}, params),
        bevel_(bevel_length(out.plunger.needle.outer_diameter)) {
    hands_.set_thumb(DosingThumb(out.plunger, spec_.volume, spec_.rate_hz));
    if (recording != nullptr) recorder_.emplace(simulation_, *recording, RecordedPictures::listed);
    if (!params.deform) return;
    ProbeHandParams probe;
    probe.press_force = spec_.press;
    probe.hand.seed = mix_bits(spec_.hand.seed);
    probe_.emplace(probe, spec_.rate_hz, std::vector<Pose>{out.X_JP});
  }

  Result<void> run(InjectionOperator& person) {
    hands_.take_up(
        HandLoop({spec_.rate_hz, 20000}, simulation_.params().device, spec_.hand, person.start()));
    while (!person.done()) {
      const double t = hands_.needle().time();
      const Pose measured = hands_.needle().measured();
      const HapticSnapshot& tick = step(person);
      hands_.feel(tick.feedback);
      if (probe_) static_cast<void>(probe_->feel(tick.feedback));
      if (!simulation_.refusal().empty())
        return fail(ErrorCode::invalid, simulation_.refusal(), simulation_.joint().name);
      record(t, measured, tick, person);
      const OperatorPhase* ended = person.observe(t, measured, view());
      if (ended != nullptr && ended->label == "ready") aim_again(person);
      hands_.move(person);
    }
    return {};
  }

  void finish() {
    const auto states = plunger().states();
    double everywhere = 0;
    for (const SpaceState& s : states) everywhere += s.volume - s.drawn;
    out_.given = given();
    out_.drawn = plunger().state().drawn;
    out_.unbalanced = out_.plunger.syringe.filled - plunger().state().content - everywhere;
    std::vector<std::size_t> order(states.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return states[a].volume > states[b].volume;
    });
    const auto target = std::find(order.begin(), order.end(), target_);
    std::rotate(order.begin(), target, target + 1);
    for (const std::size_t k : order) {
      if (k != target_ && !(states[k].volume > 0)) continue;
      out_.places.push_back(plunger().spaces()[k].name);
      out_.volumes.push_back(states[k].volume);
      shown_.push_back(k);
    }
    const auto sites = simulation_.syringe().sites();
    out_.sites.assign(sites.begin(), sites.end());
    for (std::size_t i = 0; i < out_.rows.size(); ++i) {
      for (const std::size_t k : shown_) out_.rows[i].volumes.push_back(history_[i][k]);
    }
    out_.complete = out_.given >= kNearlyAll * spec_.volume;
    out_.pressed = draw_health_question(simulation_);
    if (out_.pressed && spec_.press == 0) out_.pressed->X_JP = out_.X_JP;  // a probe that hovers
  }

  /// `spaces`: of the scene, outlive this.
  void aim_at(const LinePlan& plan, const JointSpaces& spaces) {
    plan_ = plan;
    spaces_ = &spaces;
    target_ = spaces.of_region[plan.region];
    out_.target = plunger().spaces()[target_].name;
    out_.target_like = plunger().spaces()[target_].like;
    out_.holds = plunger().spaces()[target_].law.rupture;
  }

 private:
  static constexpr double kFlows = ThumbDose::kFlows;
  static constexpr double kNearlyAll = 0.98;

  [[nodiscard]] double given() const {
    double sum = 0;
    for (const SpaceState& s : plunger().states()) sum += s.volume;
    return sum;
  }

  /// As the picture tells: the two walls of the target come apart.
  [[nodiscard]] bool flows_into_target() {
    const double now = plunger().states()[target_].volume;
    const double flow = (now - target_volume_) * spec_.rate_hz;
    target_volume_ = now;
    fills_ = flow > kFlows;
    return fills_;
  }

  [[nodiscard]] const Plunger& plunger() const { return simulation_.syringe().plunger(); }
  [[nodiscard]] const NeedleContact& contact() const { return simulation_.needle().contact(); }

  /// A tick, and the tissue's step where it is an image's.
  const HapticSnapshot& step(const InjectionOperator& person) {
    const OperatorPhase* phase = person.present();
    if (phase != nullptr && phase->until_flow && eases(contact().tick().depth)) phase = nullptr;
    if (phase != nullptr && phase->until_given && moves_on()) phase = nullptr;
    if (probe_) hands_.hold_probe(probe_->held());
    const TickInput input = simulation_.next_input(hands_.read(phase));
    return recorder_ ? recorder_->step(input) : simulation_.step(input);
  }

  /// What the hand goes by: the picture, what flows, and the thumb.
  [[nodiscard]] OperatorView view() {
    OperatorView view = view_of(simulation_.needle());
    look();
    if (contact().inserted()) view.depth = contact().tick().depth - deeper_ - nudged_;
    view.flows = flows_into_target();
    view.given = hands_.thumb().enough();
    return view;
  }

  /// A probe that presses may move a thin bursa off the line: the needle is turned to where the
  /// picture shows it before it goes in.
  void aim_again(InjectionOperator& person) {
    if (!probe_) return;
    const Scene& seen = *simulation_.scene();
    const LinePlan plan = plan_again(seen, spec_.entry, out_.X_JP.linear().col(1), plan_);
    if (plan.direction == plan_.direction) return;
    plan_ = plan;
    person.aim_along(plan.direction, phases_in(seen, out_, plan, *spaces_));
  }

  /// Tissue that is pressed or opened has its layers elsewhere: a picture tells by how much deeper
  /// the tip belongs along the needle than it was planned.
  void look() {
    if (body_ == simulation_.scene()) return;
    body_ = simulation_.scene();
    const double middle = (plan_.layer.from + plan_.layer.to) / 2;
    const auto seen = layer_seen(contact(), plan_.region, middle);
    if (!seen) return;
    const auto stop = [&](const LineLayer& layer) {
      return stop_in(plan_, layer, bevel_);
    };
    deeper_ = stop({seen->entry, seen->exit}) - stop(plan_.layer);
  }

  /// What goes in while the target does not open goes elsewhere: the hand lets go, draws back some
  /// more and tries again.
  [[nodiscard]] bool eases(double depth) {
    if (plunger().state().flow <= kFlows || fills_) {
      strayed_ = 0;
    } else {
      strayed_ += 1 / spec_.rate_hz;
    }
    if (strayed_ > kNotice && !(std::abs(depth - eased_at_) < kEased)) {
      eased_at_ = depth;
      strayed_ = 0;
    }
    return std::abs(depth - eased_at_) < kEased;
  }

  /// What is given and runs beside the target, or is pushed back, is noticed too: the thumb lets
  /// go, and the tip is moved a little toward the target. Whether it does so now.
  [[nodiscard]] bool moves_on() {
    const double period = 1 / spec_.rate_hz;
    if (easing_ > 0) {
      easing_ -= period;
      return true;
    }
    const PlungerState& state = plunger().state();
    const bool strays =
        !fills_ && (state.flow > kFlows || state.tip_pressure > Redirection::kResists);
    strayed_ = strays ? strayed_ + period : 0;
    if (strayed_ < kNotice || nudges_ == Redirection::kMost || !probe_) return false;
    strayed_ = 0;
    ++nudges_;
    easing_ = Redirection::kEase;
    const double middle = (plan_.layer.from + plan_.layer.to) / 2;
    const auto seen = layer_seen(contact(), plan_.region, middle);
    const bool beyond = seen && contact().tick().depth > seen->exit;
    nudged_ += beyond ? -Redirection::kNudge : Redirection::kNudge;
    return true;
  }

  void record(double t, const Pose& measured, const HapticSnapshot& tick,
              const InjectionOperator& person) {
    const NeedleTick& needle = contact().tick();
    InjectionRow& row = out_.rows.emplace_back();
    row.time = t;
    row.depth = contact().inserted() ? needle.depth : 0;
    row.region = contact().inserted() ? contact().region() : kOutside;
    row.axial = -Vec3(tick.force_J[0], tick.force_J[1], tick.force_J[2]).dot(needle.axis);
    row.plunger = plunger().state();
    row.thumb = plunger().state().force;
    if (const OperatorPhase* phase = person.present()) row.phase = label_of(phase->label);
    std::vector<double>& now = history_.emplace_back();
    for (const SpaceState& s : plunger().states()) now.push_back(s.volume);
    watch(row, measured);
  }

  /// A label that outlives the operator.
  [[nodiscard]] static std::string_view label_of(const std::string& label) {
    for (const std::string_view known : {"ready", "advance", "through", "stay", "back", "aspirate",
                                         "look", "inject", "wait", "withdraw"})
      if (label == known) return known;
    return {};
  }

  void watch(const InjectionRow& row, const Pose& measured) {
    out_.status |= row.plunger.status;
    out_.highest_force = std::max(out_.highest_force, row.thumb);
    if (row.plunger.flow > kFlows && row.phase == "inject") {
      out_.highest_pressure = std::max(out_.highest_pressure, row.plunger.tip_pressure);
      min_ = std::min(min_, row.depth);
      max_ = std::max(max_, row.depth);
      out_.tip_walk = max_ - min_;
      out_.X_JN = measured;
      out_.X_JN.translation() = contact().tick().tip;
      out_.depth = row.depth;
    }
    const auto& in = simulation_.syringe().tip();
    const std::size_t tip = in[0].share >= in[1].share ? in[0].space : in[1].space;
    out_.reached =
        out_.reached || (contact().inserted() && (in[0].space == target_ || tip == target_));
    std::string says = patient_says(plunger(), tip);
    if (!says.empty() && (out_.patient.empty() || out_.patient.back().text != says))
      out_.patient.push_back({row.time, std::move(says)});
  }

  const InjectionSpec& spec_;
  InjectionRun& out_;
  Simulation simulation_;
  std::optional<SimulationRecorder> recorder_;  // empty: nobody wants it
  SimulatedHands hands_;
  std::optional<SeatedProbe> probe_;  // empty: the body is rigid
  double bevel_;                      // m
  const JointSpaces* spaces_ = nullptr;
  std::size_t target_ = 0;
  LinePlan plan_;
  std::shared_ptr<const Scene> body_;  // last looked at
  double deeper_ = 0;                  // m along the needle, the target there
  std::vector<std::size_t> shown_;
  std::vector<std::vector<double>> history_;
  double target_volume_ = 0;
  bool fills_ = false;
  double strayed_ = 0;  // s of flow elsewhere
  double easing_ = 0;   // s without the thumb that are left
  int nudges_ = 0;
  double nudged_ = 0;    // m that the tip was moved on
  double eased_at_ = 1;  // m, depth at which the hand let go; 1: nowhere
  double min_ = 1;
  double max_ = 0;
};

/// The session that an injection is, its needle `needle_length` m long.
Result<SessionParams> params_of(const InjectionSpec& spec, const CompiledJoint& joint,
                                double needle_length) {
  SessionParams params;
  const auto device = find_device(spec.device);
  ARTUS_TRY(device);
  params.device = *device;
  params.haptic_rate = spec.rate_hz;
  params.image_rate = kImageRate;
  params.feel = spec.feel;
  params.feel.needle_length = needle_length;
  params.syringe = spec.syringe;
  params.transducer = spec.transducer;
  params.needle_shape = needle_of_gauge(spec.syringe.gauge).value_or(NeedleShape{});
  params.deform = params.wait_for_cage = !spec.rigid && gives_way(joint);
  ARTUS_TRY(validate(params));
  return params;
}

}  // namespace

const InjectionRow& row_of(const InjectionRun& run, double time) {
  const auto row = std::lower_bound(run.rows.begin(), run.rows.end(), time,
                                    [](const InjectionRow& r, double t) { return r.time < t; });
  return row == run.rows.end() ? run.rows.back() : *row;
}

Result<InjectionRun> run_injection(const Scene& scene, const InjectionSpec& spec,
                                   Recording* recording) {
  const auto plan = plan_line(scene, spec);
  ARTUS_TRY(plan);
  auto spaces = make_joint_spaces(scene.joint());
  ARTUS_TRY(spaces);
  const double needed = plan->layer.to + kFarthestThrough + kSpare;
  if (spec.feel.needle_length && *spec.feel.needle_length < needed)
    return fail(ErrorCode::invalid,
                printed("a needle of %.1f mm is too short for this line: it needs %.1f mm or more, "
                        "to go through the target and be held",
                        *spec.feel.needle_length / kMillimetre, needed / kMillimetre),
                "--needle-length-mm");
  const double length = std::max(spec.needle_length, needed);
  const auto params = params_of(spec, scene.joint(), length);
  ARTUS_TRY(params);
  auto plunger = make_plunger_params(params->syringe, length);
  ARTUS_TRY(plunger);
  InjectionRun out;
  out.spec = spec;
  out.plunger = std::move(*plunger);
  out.gave_way = params->deform;
  for (const Region& r : scene.joint().regions) out.regions.push_back(r.name);
  const double opening = bevel_length(out.plunger.needle.outer_diameter);
  const double target = stop_in(*plan, plan->layer, opening);
  const Vec3& direction = plan->direction;
  const Pose X_JN = make_pose(spec.entry + target * direction, direction, Vec3::Zero());
  out.X_JP = find_view_of(scene, X_JN, spec.transducer.width).X_JP;
  InjectionOperator person(spec.entry, direction, -kStartOutside,
                           phases_in(scene, out, *plan, *spaces));
  Trial trial(scene, *params, out, recording);
  trial.aim_at(*plan, *spaces);
  ARTUS_TRY(trial.run(person));
  trial.finish();
  return out;
}

}  // namespace artus
