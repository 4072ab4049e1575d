// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/run_tissue.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "artus/detail/core/noise.h"
#include "artus/detail/evidence/runs/probe_in_plane.h"
#include "artus/detail/evidence/runs/three_injections_probe.h"

namespace artus {
namespace {

/// Where the probe belongs at each planned moment, in their order: in the plane of its line.
std::vector<Pose> plan_seats(const Scene& scene, const std::array<InjectionPass, 3>& passes) {
  std::vector<Pose> seats;
  for (const InjectionPass& pass : passes) {
    Vec3 direction = pass.direction;
    for (const OperatorPhase& phase : pass.phases) {
      if (phase.kind == OperatorPhase::Kind::turn) direction = phase.direction;
      if (phase.label.empty()) continue;
      const Vec3 across = direction.unitOrthogonal();
      seats.push_back(probe_in_plane(scene, make_pose(pass.entry, direction, across)));
    }
  }
  return seats;
}

NamedMoment meant(const Pose& seat) {
  NamedMoment moment;
  moment.time = std::numeric_limits<double>::infinity();
  moment.X_JP_seat = seat;
  return moment;
}

ProbeHandParams hand_params(const ThreeInjectionsOptions& options, double image_rate) {
  ProbeHandParams params = options.probe;
  params.hand.seed = mix_bits(options.seed);
  params.packet_rate = image_rate;
  return params;
}

}  // namespace

RunTissue::RunTissue(std::shared_ptr<const Scene> scene, std::vector<Pose> seats,
                     const ThreeInjectionsOptions& options, const RunTissueOptions& tissue,
                     TissueCore core)
    : seats_(std::move(seats)),
      known_{meant(seats_.front())},
      options_(tissue),
      rate_hz_(options.rate_hz),
      core_(std::move(core)),
      hand_(std::move(scene), hand_params(options, tissue.image_rate), options.rate_hz,
            seats_.front()) {}

Result<RunTissue> RunTissue::make(const Scene& scene, const std::array<InjectionPass, 3>& passes,
                                  const ThreeInjectionsOptions& options,
                                  const RunTissueOptions& tissue) {
  std::vector<Pose> seats = plan_seats(scene, passes);
  auto core = TissueCore::make(scene.shared_joint(), seats.front(), tissue.image_rate, tissue.face);
  ARTUS_TRY(core);
  std::shared_ptr<const Scene> borrowed(std::shared_ptr<const void>(), &scene);
  return RunTissue(std::move(borrowed), std::move(seats), options, tissue, std::move(*core));
}

Pose RunTissue::reach(double time, bool planned) {
  const Pose seat = known_.back().X_JP_seat;
  known_.back().time = time;
  if (planned) ++next_;
  if (next_ < seats_.size()) known_.push_back(meant(seats_[next_]));
  return seat;
}

/// A cage of its own where the probe comes down beyond this one's reach.
Result<void> RunTissue::follow(const Pose& X_JP) {
  if (core_.reaches(X_JP)) return {};
  const auto seat = std::find_if(seats_.begin(), seats_.end(), [&X_JP](const Pose& at) {
    return TissueCore::is_within_reach(at, X_JP);
  });
  if (seat == seats_.end()) return {};  // on its way, in the air
  const Scene& before = *core_.scene();
  auto made = TissueCore::make(before.shared_joint(), *seat, options_.image_rate, options_.face,
                               before.tissue().get());
  ARTUS_TRY(made);
  core_ = std::move(*made);
  return {};
}

Result<bool> RunTissue::step(const NeedleLoad& load, ThreeInjections& run) {
  const double ticks = static_cast<double>(run.probe.size());
  const double far = SoftBodyParams{}.reach;
  run.probe.push_back(hand_.step([this, far](double t) { return intend_probe(known_, t, far); }));
  if (ticks * options_.image_rate < static_cast<double>(images_) * rate_hz_) return false;
  ++images_;
  const Pose X_JP = run.probe.back().X_JP;
  ARTUS_TRY(follow(X_JP));
  FluidState fluid;
  std::span<const InjectedSite> sites;
  if (!run.syringe.empty()) {
    if (!fluid_) fluid_.emplace(core_.scene()->shared_joint(), run.liquid, options_.image_rate);
    sites = std::span(run.syringe.back().sites).first(run.syringe.back().n_sites);
    fluid = fluid_->step(sites);
  }
  core_.step(X_JP, NeedleGrip{run.rows.back().X_JN, load}, fluid.rest_of());
  if (fluid_) fluid_->follow(sites, core_.tissue());
  hand_.take(core_.packet().probe);
  if (options_.on_image) options_.on_image(run, core_.scene(), fluid);
  return true;
}

}  // namespace artus
