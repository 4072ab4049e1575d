// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/three_injections.h"

#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "artus/detail/core/noise.h"
#include "artus/detail/evidence/runs/probe_in_plane.h"
#include "artus/detail/evidence/runs/run_doses.h"
#include "artus/detail/evidence/runs/seated_probe.h"
#include "artus/detail/evidence/runs/three_injections_analysis.h"
#include "artus/detail/evidence/runs/three_injections_plan.h"
#include "artus/detail/evidence/runs/three_injections_probe.h"
#include "artus/detail/operators/injection_operator.h"
#include "artus/detail/simulation/simulated_hands.h"
#include "artus/simulation/simulation.h"

namespace artus {
namespace {

constexpr double kOverDrawn = 0.4e-6;  // m^3 drawn up beyond the doses; assumed
constexpr double kRigidRate = 1;       // 1/s of images that nobody looks at

// For what keeps a scene alive: the caller's outlives the run.
std::shared_ptr<const Scene> borrow(const Scene& scene) {
  return {std::shared_ptr<const void>(), &scene};
}

// The session that a run is, with `doses` to give.
Result<SessionParams> params_of(const ThreeInjections& run, std::size_t doses,
                                const RunTissueOptions* tissue) {
  const ThreeInjectionsOptions& options = run.options;
  SessionParams params;
  const Result<DeviceLimits> device = find_device(options.device);
  ARTUS_TRY(device);
  params.device = *device;
  params.haptic_rate = options.rate_hz;
  params.feel = options.feel;
  params.feel.needle_length = run.needle_length;
  if (doses > 0) {
    if (!(options.dose.rate > 0))
      return fail(ErrorCode::invalid, "the rate must be above 0", "dose");
    params.syringe = options.dose.syringe;
    params.syringe.filled = options.dose.volume * static_cast<double>(doses) + kOverDrawn;
    params.syringe.seed = options.seed;
  }
  params.image_rate = tissue != nullptr ? tissue->image_rate : kRigidRate;
  if (tissue != nullptr) {
    params.transducer = tissue->transducer;
    params.deform = params.wait_for_cage = true;
  }
  ARTUS_TRY(validate(params));
  return params;
}

std::optional<SeatedProbe> probe_of(const Scene& scene, const std::array<InjectionPass, 3>& passes,
                                    const ThreeInjectionsOptions& options) {
  ProbeHandParams params = options.probe;
  params.hand.seed = mix_bits(options.seed);
  return SeatedProbe(params, options.rate_hz, plan_seats(scene, passes));
}

// Runs the passes through one simulation, row by row.
class Recorder {
 public:
  // `probe`: empty where the body is rigid.
  Recorder(Simulation& simulation, std::optional<SeatedProbe> probe, const RunTissueOptions* tissue,
           ThreeInjections& out)
      : simulation_(&simulation), probe_(std::move(probe)), tissue_(tissue), out_(&out) {
    const Plunger& plunger = simulation.syringe().plunger();
    const ThreeInjectionsOptions& options = out.options;
    if (out.asked > 0)
      hands_.set_thumb(DosingThumb(plunger.params(), options.dose.volume, options.rate_hz));
  }

  // Whether each phase met its goal in time.
  Result<bool> run(const InjectionPass& pass, int number, double start_time) {
    InjectionOperator person(pass.entry, pass.direction, -kOutsideAtFirst, pass.phases);
    HandParams hand = out_->options.hand;
    hand.seed = out_->options.seed + static_cast<std::uint64_t>(number);
    const SessionParams& params = simulation_->params();
    if (number > 1) wait();
    hands_.take_up(HandLoop({params.haptic_rate, 20000}, params.device, hand, person.start()));
    if (number > 1) wait();
    while (!person.done()) ARTUS_TRY(step(person, number, start_time));
    hands_.put_down();
    return !person.timed_out();
  }

 private:
  // A tick between two passes, of no row: the needle is put down, and taken up elsewhere, which the
  // guard takes for a jump.
  void wait() {
    hands_.feel(simulation_->step(simulation_->next_input(hands_.read(nullptr))).feedback);
  }

  Result<void> step(InjectionOperator& person, int number, double start_time) {
    const double t = hands_.needle().time();
    const Pose measured = hands_.needle().measured();
    if (probe_) hands_.hold_probe(probe_->held());
    const HapticSnapshot& tick =
        simulation_->step(simulation_->next_input(hands_.read(person.present())));
    hands_.feel(tick.feedback);
    add_row(tick, start_time + t, measured, number);
    ARTUS_TRY(give_way());
    const NeedleRow row = out_->rows.back();
    if ((row.events & ContactEvent::kSkinPunctured) != 0) mark(row, "skin punctured", false);
    if ((row.events & ContactEvent::kBoneTouched) != 0) mark(row, "bone touched", false);
    OperatorView view = view_of(simulation_->needle());
    view.given = hands_.has_thumb() && hands_.thumb().done();
    const OperatorPhase* ended = person.observe(t, measured, view);
    if (ended != nullptr && hands_.has_thumb()) hands_.thumb().begin();
    if (ended != nullptr && !ended->label.empty()) mark(row, ended->label, true);
    hands_.move(person);
    return {};
  }

  void add_row(const HapticSnapshot& tick, double time, const Pose& measured, int number) {
    const auto& f = tick.force_J;
    const auto& m = tick.torque_J;
    const RenderedNeedle rendered{{Vec3(f[0], f[1], f[2]), Vec3(m[0], m[1], m[2])},
                                  simulation_->needle().forces(),
                                  tick.status,
                                  simulation_->energy_to_hand()};
    NeedleRow row = make_needle_row(time, measured, rendered, simulation_->needle());
    row.pass = number;
    row.energy_to_hand = hands_.needle().energy_to_hand();
    row.hand = hands_.needle().hand_force();
    out_->rows.push_back(row);
    if (hands_.has_thumb()) out_->syringe.push_back(make_syringe_row(tick));
    if (probe_) out_->probe.push_back(probe_->feel(tick.feedback));
  }

  // The tissue's step when this tick is an image's, which both hands feel from the next tick on.
  Result<void> give_way() {
    if (!probe_ || simulation_->due() == nullptr) return {};
    const ImagedBody& body = simulation_->advance();
    if (!body.packet)
      return fail(ErrorCode::invalid, simulation_->refusal(), simulation_->joint().name);
    probe_->take(*body.packet);
    if (tissue_->on_image) tissue_->on_image(*out_, body.scene, body.fluid);
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
    moment.X_JP_seat = probe_ ? probe_->reach(row.time, planned)
                              : probe_in_plane(*simulation_->rest_scene(), row.X_JN);
    if (probe_) moment.X_JP = out_->probe.back().X_JP;
  }

  Simulation* simulation_;
  SimulatedHands hands_;
  std::optional<SeatedProbe> probe_;  // empty: the body is rigid
  const RunTissueOptions* tissue_;    // null: the same
  ThreeInjections* out_;
};

}  // namespace

Result<ThreeInjections> run_three_injections(const Scene& scene,
                                             std::span<const PlannedInjection> injections,
                                             const ThreeInjectionsOptions& options,
                                             const Progress& progress,
                                             const RunTissueOptions* tissue) {
  const auto passes = plan_passes(scene, injections, options);
  ARTUS_TRY(passes);
  ThreeInjections out;
  out.options = options;
  out.needle_length = options.feel.needle_length.value_or(choose_needle(*passes));
  for (const Region& region : scene.joint().regions) out.region_names.push_back(region.name);
  const std::size_t doses = count_doses(*passes);
  const auto params = params_of(out, doses, tissue);
  ARTUS_TRY(params);
  Simulation simulation(borrow(scene), *params);
  if (doses > 0) {
    out.asked = options.dose.volume * static_cast<double>(doses);
    out.liquid = simulation.syringe().plunger().params().liquid;
  }
  std::optional<SeatedProbe> probe;
  if (tissue != nullptr) probe = probe_of(scene, *passes, options);
  Recorder recorder(simulation, std::move(probe), tissue, out);
  bool reached = true;
  for (std::size_t i = 0; i < passes->size(); ++i) {
    if (progress) progress("injection", static_cast<double>(i) / 3);
    const double start = out.rows.empty() ? 0 : out.rows.back().time + 1 / options.rate_hz;
    const auto in_time = recorder.run((*passes)[i], static_cast<int>(i) + 1, start);
    ARTUS_TRY(in_time);
    reached = *in_time && reached;
  }
  if (doses > 0)
    sum_up_doses(simulation,
                 std::array{(*passes)[0].target, (*passes)[1].target, (*passes)[2].target}, out);
  if (progress) progress("injection", 1);
  if (tissue == nullptr && !out.moments.empty()) run_probe_hand(borrow(scene), out);
  analyze(scene.joint(), reached, out);
  if (!out.probe.empty()) claim_probe(out, tissue != nullptr);
  claim_doses(out);
  return out;
}

}  // namespace artus
