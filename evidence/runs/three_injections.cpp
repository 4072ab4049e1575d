// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/three_injections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "artus/detail/core/units.h"
#include "artus/detail/evidence/runs/probe_in_plane.h"
#include "artus/detail/evidence/runs/run_tissue.h"
#include "artus/detail/evidence/runs/target_syringe.h"
#include "artus/detail/evidence/runs/three_injections_analysis.h"
#include "artus/detail/evidence/runs/three_injections_plan.h"
#include "artus/detail/evidence/runs/three_injections_probe.h"
#include "artus/detail/haptics/plunger/bevel.h"
#include "artus/detail/operators/hand_loop.h"
#include "artus/detail/operators/injection_operator.h"

namespace artus {
namespace {

// For what keeps a scene alive: the caller's outlives the run.
std::shared_ptr<const Scene> borrow(const Scene& scene) {
  return {std::shared_ptr<const void>(), &scene};
}

// What a run may have beside the needle.
struct Others {
  std::optional<TargetSyringe> syringe;
  std::optional<RunTissue> tissue;
};

// Runs the passes through one loop and renderer, row by row.
class Recorder {
 public:
  Recorder(const Scene& scene, const ThreeInjectionsOptions& options, const DeviceLimits& device,
           Others others, ThreeInjections& out)
      : scene_(&scene),
        options_(&options),
        device_(&device),
        syringe_(std::move(others.syringe)),
        tissue_(std::move(others.tissue)),
        out_(&out) {}

  /// Whether each phase met its goal in time.
  Result<bool> run(const InjectionPass& pass, int number, double start_time) {
    InjectionOperator person(pass.entry, pass.direction, -kOutsideAtFirst, pass.phases);
    HandParams hand = options_->hand;
    hand.seed = options_->seed + static_cast<std::uint64_t>(number);
    HandLoop loop({options_->rate_hz, 20000}, *device_, hand, person.start());
    NeedleRendererParams params;
    params.device = *device_;
    params.rate_hz = options_->rate_hz;
    apply(options_->feel, params.needle);
    apply(options_->feel, params.passivity);
    params.needle.contact.needle_length = out_->needle_length;
    NeedleRenderer renderer(borrow(*scene_), make_layer_table(scene_->joint(), options_->feel),
                            params);
    if (tissue_) renderer.take(tissue_->packet().needle);
    while (!person.done()) {
      const double t = loop.time();
      const Pose measured = loop.measured();
      const RenderedNeedle& rendered = renderer.step({measured, t});
      NeedleRow row = make_needle_row(start_time + t, measured, rendered, renderer.model());
      row.pass = number;
      row.energy_to_hand = loop.energy_to_hand();
      row.hand = loop.hand_force();
      out_->rows.push_back(row);
      if (tissue_) ARTUS_TRY(give_way(renderer));
      if ((row.events & ContactEvent::kSkinPunctured) != 0) mark(row, "skin punctured", false);
      if ((row.events & ContactEvent::kBoneTouched) != 0) mark(row, "bone touched", false);
      OperatorView view = view_of(renderer.model());
      Wrench motor = rendered.command;
      if (syringe_) motor.force += push(person, renderer.model().contact(), view);
      const OperatorPhase* ended = person.observe(t, measured, view);
      if (ended != nullptr && !ended->label.empty()) mark(row, ended->label, true);
      loop.advance(motor, [&person](double at) { return person.intention(at); });
    }
    return !person.timed_out();
  }

  void finish(std::span<const RegionId> targets) {
    if (syringe_) syringe_->finish(targets, *out_);
  }

 private:
  // N on the needle, of the thumb.
  Vec3 push(const InjectionOperator& person, const NeedleContact& contact, OperatorView& view) {
    const double along = syringe_->step(person.present(), contact);
    out_->syringe.push_back(syringe_->row());
    view.given = syringe_->given();
    return along * contact.tick().axis;
  }

  /// The tissue and the other hand in this tick.
  Result<void> give_way(NeedleRenderer& renderer) {
    const auto image = tissue_->step(renderer.model().coupling().cube_load(), *out_);
    ARTUS_TRY(image);
    if (*image) renderer.take(tissue_->packet().needle);
    return {};
  }

  void mark(const NeedleRow& row, const std::string& label, bool planned) {
    for (const NamedMoment& m : out_->moments) {
      if (m.pass == row.pass && m.label == label) return;
    }
    NamedMoment& moment = out_->moments.emplace_back();
    moment.time = row.time;
    moment.label = label;
    moment.pass = row.pass;
    moment.X_JN = row.X_JN;
    moment.X_JP_seat =
        tissue_ ? tissue_->reach(row.time, planned) : probe_in_plane(*scene_, row.X_JN);
    if (tissue_) moment.X_JP = out_->probe.back().X_JP;
  }

  const Scene* scene_;
  const ThreeInjectionsOptions* options_;
  const DeviceLimits* device_;
  std::optional<TargetSyringe> syringe_;
  std::optional<RunTissue> tissue_;  // empty: the body is rigid
  ThreeInjections* out_;
};

Result<std::optional<TargetSyringe>> syringe_of(const Scene& scene,
                                                const ThreeInjectionsOptions& options,
                                                const std::array<InjectionPass, 3>& passes,
                                                ThreeInjections& out) {
  const std::size_t doses = count_doses(passes);
  if (doses == 0) return std::optional<TargetSyringe>{};
  if (!(options.dose.rate > 0)) return fail(ErrorCode::invalid, "the rate must be above 0", "dose");
  out.asked = options.dose.volume * static_cast<double>(doses);
  auto made = TargetSyringe::make(scene.joint(), options, out.needle_length, doses);
  ARTUS_TRY(made);
  out.liquid = made->liquid();
  return std::optional<TargetSyringe>(std::move(*made));
}

}  // namespace

Result<ThreeInjections> run_three_injections(const Scene& scene,
                                             std::span<const PlannedInjection> injections,
                                             const ThreeInjectionsOptions& options,
                                             const Progress& progress,
                                             const RunTissueOptions* tissue) {
  const Result<DeviceLimits> device = find_device(options.device);
  ARTUS_TRY(device);
  const auto passes = plan_passes(scene, injections, options);
  ARTUS_TRY(passes);
  ThreeInjections out;
  out.options = options;
  out.needle_length = options.feel.needle_length.value_or(choose_needle(*passes));
  for (const Region& region : scene.joint().regions) out.region_names.push_back(region.name);
  auto syringe = syringe_of(scene, options, *passes, out);
  ARTUS_TRY(syringe);
  Others others{std::move(*syringe), {}};
  if (tissue != nullptr) {
    auto made = RunTissue::make(scene, *passes, options, *tissue);
    ARTUS_TRY(made);
    others.tissue.emplace(std::move(*made));
  }
  Recorder recorder(scene, options, *device, std::move(others), out);
  bool reached = true;
  for (std::size_t i = 0; i < passes->size(); ++i) {
    if (progress) progress("injection", static_cast<double>(i) / 3);
    const double start = out.rows.empty() ? 0 : out.rows.back().time + 1 / options.rate_hz;
    const auto in_time = recorder.run((*passes)[i], static_cast<int>(i) + 1, start);
    ARTUS_TRY(in_time);
    reached = *in_time && reached;
  }
  recorder.finish(std::array{(*passes)[0].target, (*passes)[1].target, (*passes)[2].target});
  if (progress) progress("injection", 1);
  if (tissue == nullptr && !out.moments.empty()) run_probe_hand(borrow(scene), out);
  analyze(scene.joint(), reached, out);
  if (!out.probe.empty()) claim_probe(out, tissue != nullptr);
  claim_doses(out);
  return out;
}

}  // namespace artus
