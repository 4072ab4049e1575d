// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "artus/detail/haptics/plunger/bevel.h"
#include "artus/detail/haptics/plunger/patient.h"
#include "artus/detail/operators/hand_loop.h"
#include "artus/detail/operators/injection_operator.h"
#include "artus/detail/operators/thumb_dose.h"
#include "artus/haptics/needle_renderer.h"

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
constexpr double kBeforeFloor = 0.3e-3;  // m that the tip stays above a floor; assumed
constexpr double kSpare = 5e-3;          // m of shaft that stay outside

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
double beyond(const Scene& scene, const InjectionSpec& spec, const LineLayer& layer,
              const Vec3& direction, const JointSpaces& spaces) {
  const Syringe& syringe = spec.plunger.syringe;
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

std::vector<OperatorPhase> phases_of(const InjectionSpec& spec, const LineLayer& layer,
                                     double target, double through) {
  std::vector<OperatorPhase> phases{named(stay(kReady), "ready")};
  const double time = spec.volume / spec.rate;
  OperatorPhase inject = named(stay(2 * time + 20), "inject");
  inject.thumb_rate = spec.rate;
  inject.until_given = true;
  if (spec.technique == Technique::through_and_back) {
    phases.push_back(named(push_to(through, kSpeed), "through"));
    phases.push_back(named(stay(0.5), "stay"));
    OperatorPhase back = named(pull_to(std::max(0.0, layer.from - kThrough), kBackSpeed), "back");
    back.thumb_force = gentle_force(spec.plunger.syringe);
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
  phases.push_back(named(stay(run_out_time(spec.plunger)), "wait"));
  phases.back().thumb_holds = true;
  // Let go before it comes out: what a tendon's pressure holds in the barrel would go elsewhere.
  phases.push_back(named(pull_to(-kStartOutside, 2 * kSpeed), "withdraw"));
  for (OperatorPhase& phase : phases)
    if (phase.duration == 0) phase.duration = 3 * kSearch / kSpeed;
  return phases;
}

/// Everything that one injection runs on.
class Trial {
 public:
  Trial(const Scene& scene, const InjectionSpec& spec, const DeviceLimits& device,
        JointSpaces spaces, InjectionRun& out)
      : spec_(spec),
        out_(out),
        of_region_(std::move(spaces.of_region)),
        plunger_(spec.plunger, std::move(spaces.spaces), 1 / spec.rate_hz),
        thumb_(spec.thumb),
        dose_(spec.plunger, spec.volume) {
    params_.device = device;
    params_.rate_hz = spec.rate_hz;
    apply(spec.feel, params_.needle);
    apply(spec.feel, params_.passivity);
    params_.needle.contact.needle_length = spec.plunger.needle.length;
    borrowed_ = {std::shared_ptr<const void>(), &scene};
  }

  void run(InjectionOperator& person, const DeviceLimits& device) {
    HandLoop loop({spec_.rate_hz, 20000}, device, spec_.hand, person.start());
    NeedleRenderer renderer(borrowed_, make_layer_table(borrowed_->joint(), spec_.feel), params_);
    while (!person.done()) {
      const double t = loop.time();
      const Pose measured = loop.measured();
      const RenderedNeedle& rendered = renderer.step({measured, t});
      const NeedleContact& contact = renderer.model().contact();
      push(person, contact);
      record(t, measured, rendered, contact, person);
      OperatorView view = view_of(renderer.model());
      view.flows = flows_into_target();
      view.given = dose_.enough();
      person.observe(t, measured, view);
      Wrench motor = rendered.command;
      motor.force += plunger_.state().on_needle * contact.tick().axis;
      loop.advance(motor, [&person](double at) { return person.intention(at); });
    }
  }

  void finish() {
    const auto states = plunger_.states();
    double everywhere = 0;
    for (const SpaceState& s : states) everywhere += s.volume - s.drawn;
    out_.given = given();
    out_.drawn = plunger_.state().drawn;
    out_.unbalanced = spec_.plunger.syringe.filled - plunger_.state().content - everywhere;
    std::vector<std::size_t> order(states.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return states[a].volume > states[b].volume;
    });
    const auto target = std::find(order.begin(), order.end(), target_);
    std::rotate(order.begin(), target, target + 1);
    for (const std::size_t k : order) {
      if (k != target_ && !(states[k].volume > 0)) continue;
      out_.places.push_back(plunger_.spaces()[k].name);
      out_.volumes.push_back(states[k].volume);
      shown_.push_back(k);
    }
    for (std::size_t i = 0; i < out_.rows.size(); ++i) {
      for (const std::size_t k : shown_) out_.rows[i].volumes.push_back(history_[i][k]);
    }
    out_.complete = out_.given >= kNearlyAll * spec_.volume;
  }

  void aim_at(RegionId region) {
    target_ = of_region_[region];
    out_.target = plunger_.spaces()[target_].name;
    out_.target_like = plunger_.spaces()[target_].like;
  }

 private:
  static constexpr double kFlows = ThumbDose::kFlows;
  static constexpr double kNearlyAll = 0.98;

  [[nodiscard]] double given() const {
    double sum = 0;
    for (const SpaceState& s : plunger_.states()) sum += s.volume;
    return sum;
  }

  /// As the picture tells: the two walls of the target come apart.
  [[nodiscard]] bool flows_into_target() {
    const double now = plunger_.states()[target_].volume;
    const double flow = (now - target_volume_) * spec_.rate_hz;
    target_volume_ = now;
    fills_ = flow > kFlows;
    return fills_;
  }

  /// What goes in while the target does not open goes elsewhere: the hand lets go, draws back some
  /// more and tries again.
  void ease(PlungerInput& input, double depth) {
    if (plunger_.state().flow <= kFlows || fills_) {
      strayed_ = 0;
    } else {
      strayed_ += 1 / spec_.rate_hz;
    }
    if (strayed_ > kNotice && !(std::abs(depth - eased_at_) < kEased)) {
      eased_at_ = depth;
      strayed_ = 0;
    }
    if (std::abs(depth - eased_at_) < kEased) input.force = 0;
  }

  void push(const InjectionOperator& person, const NeedleContact& contact) {
    const OperatorPhase* phase = person.present();
    const double dt = 1 / spec_.rate_hz;
    PlungerInput input = thumb_.step(phase, plunger_.state(), spec_.plunger.syringe.area(), dt);
    if (phase != nullptr && phase->until_flow) ease(input, contact.tick().depth);
    input.tip =
        bevel_shares(contact, bevel_length(spec_.plunger.needle.outer_diameter), of_region_);
    input.depth = contact.tick().depth;
    const PlungerState& now = plunger_.step(input);
    const bool pushes = phase != nullptr && phase->until_given &&
                        (now.flow > ThumbDose::kFlows || thumb_.strains());
    dose_.step(pushes, given(), now.pressure, now.tip_pressure, now.flow, dt);
  }

  void record(double t, const Pose& measured, const RenderedNeedle& rendered,
              const NeedleContact& contact, const InjectionOperator& person) {
    InjectionRow& row = out_.rows.emplace_back();
    row.time = t;
    row.depth = contact.inserted() ? contact.tick().depth : 0;
    row.region = contact.inserted() ? contact.region() : kOutside;
    row.axial = rendered.command.force.dot(contact.tick().axis);
    row.plunger = plunger_.state();
    row.thumb = plunger_.state().force;
    if (const OperatorPhase* phase = person.present()) row.phase = label_of(phase->label);
    std::vector<double>& now = history_.emplace_back();
    for (const SpaceState& s : plunger_.states()) now.push_back(s.volume);
    watch(row, measured, contact);
  }

  /// A label that outlives the operator.
  [[nodiscard]] static std::string_view label_of(const std::string& label) {
    for (const std::string_view known : {"ready", "advance", "through", "stay", "back", "aspirate",
                                         "look", "inject", "wait", "withdraw"})
      if (label == known) return known;
    return {};
  }

  void watch(const InjectionRow& row, const Pose& measured, const NeedleContact& contact) {
    out_.status |= row.plunger.status;
    out_.highest_force = std::max(out_.highest_force, row.thumb);
    if (row.plunger.flow > kFlows && row.phase == "inject") {
      out_.highest_pressure = std::max(out_.highest_pressure, row.plunger.tip_pressure);
      min_ = std::min(min_, row.depth);
      max_ = std::max(max_, row.depth);
      out_.tip_walk = max_ - min_;
      out_.X_JN = measured;
      out_.depth = row.depth;
    }
    const auto shares =
        bevel_shares(contact, bevel_length(spec_.plunger.needle.outer_diameter), of_region_);
    const std::size_t tip = shares[0].share >= shares[1].share ? shares[0].space : shares[1].space;
    std::string says = patient_says(plunger_, tip);
    if (!says.empty() && (out_.patient.empty() || out_.patient.back().text != says))
      out_.patient.push_back({row.time, std::move(says)});
  }

  const InjectionSpec& spec_;
  InjectionRun& out_;
  std::vector<std::uint32_t> of_region_;
  Plunger plunger_;
  Thumb thumb_;
  ThumbDose dose_;
  NeedleRendererParams params_;
  std::shared_ptr<const Scene> borrowed_;
  std::size_t target_ = 0;
  std::vector<std::size_t> shown_;
  std::vector<std::vector<double>> history_;
  double target_volume_ = 0;
  bool fills_ = false;
  double strayed_ = 0;   // s of flow elsewhere
  double eased_at_ = 1;  // m, depth at which the hand let go; 1: nowhere
  double min_ = 1;
  double max_ = 0;
};

/// m along the line where the tip stops: the bevel's opening in the middle of a layer, not the tip
/// behind which it lies.
double tip_in_middle(const LineLayer& layer, double opening) {
  const double middle = (layer.from + layer.to) / 2;
  return std::max(std::min(middle + opening / 2, layer.to - kBeforeFloor), middle);
}

/// The same as near to `wanted` in the layer as has the whole opening in it.
double tip_near(const LineLayer& layer, double opening, double wanted) {
  if (wanted < layer.from || wanted > layer.to) return wanted;
  const double first = layer.from + opening;
  const double last = layer.to - kBeforeFloor;
  return first <= last ? std::clamp(wanted, first, last) : tip_in_middle(layer, opening);
}

/// As in three-injections a bursa on the line is what is meant; none when the target is in a cavity
/// already or there is no bursa.
std::optional<RegionId> bursa_on(const Scene& scene, const Vec3& entry, const Vec3& target) {
  const auto spaces = make_joint_spaces(scene.joint());
  if (!spaces) return std::nullopt;
  const auto law = [&](RegionId r) {
    return spaces->spaces[spaces->of_region[r]].law.kind;
  };
  if (law(scene.region_at(target)) == SpaceKind::cavity) return std::nullopt;
  const Vec3 direction = (target - entry).normalized();
  for (const TissueInterval& s :
       tissue_intervals(scene, {entry, target + kStartOutside * direction})) {
    const Tissue& tissue = scene.joint().tissue_of(s.region);
    if (tissue.haptic.hard) break;
    if (tissue.name == "bursa") return s.region;
  }
  return std::nullopt;
}

}  // namespace

const InjectionRow& row_of(const InjectionRun& run, double time) {
  const auto row = std::lower_bound(run.rows.begin(), run.rows.end(), time,
                                    [](const InjectionRow& r, double t) { return r.time < t; });
  return row == run.rows.end() ? run.rows.back() : *row;
}

Result<InjectionRun> run_injection(const Scene& scene, const InjectionSpec& spec) {
  const auto device = find_device(spec.device);
  ARTUS_TRY(device);
  if (!(spec.volume > 0) || !(spec.rate > 0))
    return fail(ErrorCode::invalid, "volume and rate must be above 0", spec.name);
  const Vec3 path = spec.target - spec.entry;
  if (!(path.norm() > 1e-6))
    return fail(ErrorCode::invalid, "entry and target are the same point", spec.name);
  const Vec3 direction = path.normalized();
  const std::optional<RegionId> into =
      spec.into ? spec.into : bursa_on(scene, spec.entry, spec.target);
  const RegionId region = into.value_or(scene.region_at(spec.target));
  if (region < kFirstRegion)
    return fail(ErrorCode::invalid, "the target lies outside of the meshed body", spec.name);
  const auto layer = find_layer(scene, spec.entry, direction, region);
  if (!layer)
    return fail(ErrorCode::invalid,
                "the line does not meet '" + scene.joint().regions[region].name + "'", spec.name);
  auto spaces = make_joint_spaces(scene.joint());
  ARTUS_TRY(spaces);
  InjectionRun out;
  out.spec = spec;
  for (const Region& r : scene.joint().regions) out.regions.push_back(r.name);
  const bool solid = spaces->spaces[spaces->of_region[region]].law.kind == SpaceKind::solid;
  const double opening = bevel_length(spec.plunger.needle.outer_diameter);
  const double target = into    ? tip_in_middle(*layer, opening)
                        : solid ? path.norm()
                                : tip_near(*layer, opening, path.norm());
  out.spec.plunger.needle.length =
      std::max(spec.plunger.needle.length, layer->to + kFarthestThrough + kSpare);
  const double through = beyond(scene, out.spec, *layer, direction, *spaces);
  Trial trial(scene, out.spec, *device, std::move(*spaces), out);
  trial.aim_at(region);
  InjectionOperator person(spec.entry, direction, -kStartOutside,
                           phases_of(spec, *layer, target, through));
  trial.run(person, *device);
  trial.finish();
  out.reached = std::any_of(out.rows.begin(), out.rows.end(),
                            [&](const InjectionRow& row) { return row.region == region; });
  return out;
}

}  // namespace artus
