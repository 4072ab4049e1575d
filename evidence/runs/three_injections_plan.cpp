// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/three_injections_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "artus/detail/core/units.h"
#include "artus/detail/evidence/runs/probe_in_plane.h"
#include "artus/detail/haptics/plunger/bevel.h"

namespace artus {
namespace {

using Kind = OperatorPhase::Kind;
using Goal = OperatorPhase::Goal;

constexpr double kSearch = 0.15;         // m along a line for target and bone
constexpr double kMinRemaining = 0.006;  // m that stay in at a withdrawal
constexpr double kIntoTarget = 0.6e-3;   // m into the target layer at least
constexpr double kBeforeRoof = 0.3e-3;   // m of the target behind the bevel's opening; assumed
constexpr double kBeforeFloor = 0.3e-3;  // m that the tip stays above a floor; assumed
constexpr double kHold = 0.8;            // s at a target; assumed
constexpr double kTurn = 1.2;            // s to re-aim; assumed
constexpr double kPause = 1.0;           // s between injections; assumed
constexpr double kReady = 0.5;           // s before the needle moves, while the guard ramps up

// What a line through the body meets.
struct LinePlan {
  double target = 0;  // m, where the target layer begins
  std::optional<double> bone;
  RegionId region = 0;
};

bool is_tissue(const CompiledJoint& joint, RegionId region, const std::string& name) {
  return joint.tissue_of(region).name == name;
}

// The target layer and the bone on the line from `entry` along `direction`; empty when the line
// meets bone or leaves the body before the target.
std::optional<LinePlan> plan_line(const Scene& scene, const Vec3& entry, const Vec3& direction,
                                  const std::string& target_tissue, RegionId target_region) {
  const CompiledJoint& joint = scene.joint();
  const double before = kOutsideAtFirst;
  std::optional<LinePlan> plan;
  bool entered = false;
  for (const TissueInterval& s :
       tissue_intervals(scene, {entry - before * direction, entry + kSearch * direction})) {
    const double depth = s.entry - before;
    if (s.region == kOutside) {
      if (entered) break;
      continue;
    }
    entered = true;
    if (joint.tissue_of(s.region).haptic.hard) {
      if (plan) plan->bone = depth;
      break;
    }
    const bool wanted = target_region != kOutside ? s.region == target_region
                                                  : is_tissue(joint, s.region, target_tissue);
    if (!plan && wanted && s.exit - s.entry > kIntoTarget) plan = LinePlan{depth, {}, s.region};
  }
  return plan;
}

// The last layer before bone that is thick enough to stop in: what a target in bone means where no
// target layer lies on its line.
std::optional<LinePlan> plan_before_bone(const Scene& scene, const Vec3& entry,
                                         const Vec3& direction) {
  const CompiledJoint& joint = scene.joint();
  std::optional<LinePlan> last;
  for (const TissueInterval& s : tissue_intervals(
           scene, {entry - kOutsideAtFirst * direction, entry + kSearch * direction})) {
    if (s.region < kFirstRegion) continue;
    if (joint.tissue_of(s.region).haptic.hard) {
      if (last) last->bone = s.entry - kOutsideAtFirst;
      return last;
    }
    if (s.exit - s.entry > kIntoTarget) last = LinePlan{s.entry - kOutsideAtFirst, {}, s.region};
  }
  return std::nullopt;
}

// Another line through the same entry to another part of the same target, near the plane that the
// default probe sees, within the cone at the depth where the operator re-aims; with bone behind it
// where there is one.
std::optional<Vec3> find_second_line(const Scene& scene, const Vec3& entry, const Vec3& direction,
                                     const LinePlan& first, const std::string& tissue) {
  Vec3 normal = scene.joint().X_JP_default.linear().col(1);
  normal -= normal.dot(direction) * direction;
  if (normal.norm() < 0.1) normal = direction.unitOrthogonal();
  normal.normalize();
  const Vec3 other = direction.cross(normal);
  std::optional<Vec3> without_bone;
  for (const Vec3& about : {normal, other}) {
    for (const double degrees :
         {8.0, -8.0, 6.0, -6.0, 10.0, -10.0, 5.0, -5.0, 12.0, -12.0, 4.0, -4.0}) {
      const Vec3 turned = Eigen::AngleAxisd(degrees * kDegree, about) * direction;
      const auto plan = plan_line(scene, entry, turned, tissue, first.region);
      if (!plan) continue;
      if (plan->bone) return turned;
      if (!without_bone) without_bone = turned;
    }
  }
  return without_bone;
}

OperatorPhase advance_to(Goal goal, double speed, double limit, std::string label) {
  OperatorPhase phase;
  phase.kind = Kind::advance;
  phase.goal = goal;
  phase.speed = speed;
  phase.duration = 3 * limit / speed + 2;
  phase.label = std::move(label);
  return phase;
}

OperatorPhase wait(Kind kind, double duration, std::string label = {}) {
  OperatorPhase phase;
  phase.kind = kind;
  phase.duration = duration;
  phase.label = std::move(label);
  return phase;
}

OperatorPhase withdraw_to(double depth, double speed, double from, std::string label = {}) {
  OperatorPhase phase;
  phase.kind = Kind::withdraw;
  phase.depth = depth;
  phase.speed = speed;
  phase.duration = 3 * (from - depth) / speed + 3;
  phase.label = std::move(label);
  return phase;
}

OperatorPhase reach_target(const ThreeInjectionsOptions& options, const LinePlan& plan,
                           std::string label) {
  OperatorPhase phase =
      advance_to(Goal::region, options.slow_speed, plan.target + kOutsideAtFirst, std::move(label));
  phase.region = plan.region;
  phase.depth = kIntoTarget;
  const auto bore = bore_of_gauge(options.dose.syringe.gauge, kSearch);
  if (options.dose.volume > 0 && bore) {
    // The bevel's whole opening, or as much of it as there is room for.
    phase.depth = std::max(kIntoTarget, bevel_length(bore->outer_diameter) + kBeforeRoof);
    phase.before_floor = kBeforeFloor;
  }
  return phase;
}

// What is done at a target: a rest, or the thumb gives a dose.
OperatorPhase at_target(const ThreeInjectionsOptions& options, std::string label) {
  if (!(options.dose.volume > 0)) return wait(Kind::hold, kHold);
  constexpr double kSlack = 20;  // s beyond what the rate takes, until the hand gives up
  OperatorPhase phase =
      wait(Kind::hold, 2 * options.dose.volume / options.dose.rate + kSlack, std::move(label));
  phase.thumb_rate = options.dose.rate;
  phase.until_given = true;
  return phase;
}

void add_bone_and_exit(InjectionPass& pass, const ThreeInjectionsOptions& options,
                       const std::optional<double>& bone, double speed) {
  if (bone) {
    pass.phases.push_back(advance_to(Goal::bone, speed, *bone + 0.02, "bone pressed"));
    pass.deepest = std::max(pass.deepest, *bone);
  }
  pass.phases.push_back(wait(Kind::hold, 0.2));
  pass.phases.push_back(withdraw_to(-kOutsideAtFirst, std::max(speed, options.slow_speed * 2),
                                    pass.deepest, "needle out"));
  pass.phases.push_back(wait(Kind::wait, kPause));
}

InjectionPass plan_slow(const Scene& scene, const PlannedInjection& planned, const Vec3& direction,
                        const LinePlan& first, const ThreeInjectionsOptions& options) {
  InjectionPass pass{planned.entry, direction, {wait(Kind::hold, kReady)}, first.target};
  const std::string& target = scene.joint().tissue_of(first.region).name;
  pass.target = first.region;
  pass.phases.push_back(reach_target(options, first, target + " reached"));
  pass.phases.push_back(at_target(options, target + " injected"));
  const double back = std::max(kMinRemaining, first.target - options.withdrawal);
  std::optional<double> bone = first.bone;
  const auto second =
      find_second_line(scene, planned.entry, direction, first, options.target_tissue);
  if (second) {
    pass.phases.push_back(withdraw_to(back, options.slow_speed, first.target, "withdrawn"));
    pass.phases.push_back(wait(Kind::hold, 0.3));
    OperatorPhase turn = wait(Kind::turn, kTurn, "re-aimed");
    turn.direction = *second;
    pass.phases.push_back(turn);
    const auto plan = plan_line(scene, planned.entry, *second, options.target_tissue, first.region);
    pass.phases.push_back(reach_target(options, *plan, "second part of " + target + " reached"));
    pass.phases.push_back(at_target(options, "second part of " + target + " injected"));
    pass.deepest = std::max(pass.deepest, plan->target);
    bone = plan->bone;
  }
  add_bone_and_exit(pass, options, bone, options.slow_speed);
  return pass;
}

}  // namespace

Result<std::array<InjectionPass, 3>> plan_passes(const Scene& scene,
                                                 std::span<const PlannedInjection> injections,
                                                 const ThreeInjectionsOptions& options) {
  if (injections.size() < 3) {
    return fail(ErrorCode::invalid,
                "the test needs three planned injections: three [[injection]] with name, entry and "
                "target in joint.toml",
                scene.joint().name);
  }
  std::array<InjectionPass, 3> passes;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const PlannedInjection& planned = injections[i];
    const Vec3 path = planned.target - planned.entry;
    if (path.norm() < 1e-3) {
      return fail(ErrorCode::invalid, "entry and target are the same point", planned.name);
    }
    const Vec3 direction = path.normalized();
    auto first = plan_line(scene, planned.entry, direction, options.target_tissue, kOutside);
    if (!first) {
      const RegionId region = scene.region_at(planned.target);
      if (region >= kFirstRegion && scene.joint().tissue_of(region).haptic.hard) {
        first = plan_before_bone(scene, planned.entry, direction);
      } else if (region != kOutside) {
        first = plan_line(scene, planned.entry, direction, options.target_tissue, region);
      }
    }
    if (!first) {
      return fail(ErrorCode::invalid,
                  "the line from entry to target reaches neither " + options.target_tissue +
                      " nor the target's own layer before bone",
                  planned.name);
    }
    if (i < 2) {
      passes[i] = plan_slow(scene, planned, direction, *first, options);
    } else {
      passes[i] =
          InjectionPass{planned.entry, direction, {wait(Kind::hold, kReady)}, first->target};
      passes[i].target = first->region;
      if (!first->bone) passes[i].phases.push_back(reach_target(options, *first, "target reached"));
      if (!first->bone && options.dose.volume > 0)
        passes[i].phases.push_back(at_target(options, "target injected"));
      add_bone_and_exit(passes[i], options, first->bone, options.fast_speed);
    }
  }
  return passes;
}

double choose_needle(const std::array<InjectionPass, 3>& passes) {
  double deepest = 0;
  for (const InjectionPass& pass : passes) deepest = std::max(deepest, pass.deepest);
  constexpr double kSpare = 0.003;  // m of shaft that stay outside
  for (const double length : {0.025, 0.035, 0.050}) {
    if (length > deepest + kSpare) return length;
  }
  return 0.090;
}

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

std::size_t count_doses(const std::array<InjectionPass, 3>& passes) {
  std::size_t n = 0;
  for (const InjectionPass& pass : passes)
    n += static_cast<std::size_t>(
        std::count_if(pass.phases.begin(), pass.phases.end(),
                      [](const OperatorPhase& p) { return p.until_given; }));
  return n;
}

}  // namespace artus
