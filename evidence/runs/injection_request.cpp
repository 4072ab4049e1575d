// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_request.h"

#include <tuple>

#include "artus/detail/anatomy/body/find_region.h"
#include "artus/detail/core/known_names.h"

namespace artus {
namespace {

constexpr double kOverfill = 0.4e-6;  // m^3 that is drawn up beyond what is meant to be given

/// As much is drawn up as is meant to be given, and what stays in the barrel.
SyringeChoice syringe_of(const InjectionRequest& request) {
  SyringeChoice choice;
  choice.gauge = request.gauge;
  choice.filled = request.volume + kOverfill;
  choice.barrel = request.syringe;
  choice.air = request.air;
  choice.liquid = request.liquid;
  choice.seed = request.seed;
  return choice;
}

/// Name, entry and target: the request's own line, or a planned one.
Result<PlannedInjection> line_of(const InjectionRequest& request, const CompiledJoint& joint) {
  PlannedInjection line;
  if (request.line) {
    line.name = "line";
    std::tie(line.entry, line.target) = *request.line;
    return line;
  }
  if (joint.injections.empty())
    return fail(ErrorCode::not_found, "the joint plans none; give entry and target", "injection");
  if (request.injection.empty()) return joint.injections.front();
  const auto at = find_name(item_names(joint.injections), request.injection, "planned injection");
  ARTUS_TRY(at);
  return joint.injections[*at];
}

/// What the line is meant for: as asked, or the structure that the plan has its name from;
/// kOutside: what is at the target.
Result<RegionId> region_of(const InjectionRequest& request, const PlannedInjection& line,
                           const CompiledJoint& joint) {
  if (!request.into.empty()) return find_region(joint, request.into);
  const auto named = find_region(joint, line.name);
  return named ? *named : kOutside;
}

}  // namespace

Result<InjectionRun> run_injection(const Scene& scene, const InjectionRequest& request) {
  InjectionSpec spec;
  spec.syringe = syringe_of(request);
  spec.needle_length = request.needle_length;
  spec.transducer = request.transducer;
  spec.rigid = request.rigid;
  spec.press = request.press;
  spec.volume = request.volume;
  spec.rate = request.rate;
  spec.aspirate = request.aspirate;
  spec.rate_hz = request.rate_hz;
  spec.device = request.device;
  spec.hand.seed = request.seed;
  spec.technique = request.technique;
  spec.feel = request.feel;
  const auto line = line_of(request, scene.joint());
  ARTUS_TRY(line);
  spec.name = line->name;
  spec.entry = line->entry;
  spec.target = line->target;
  const auto into = region_of(request, *line, scene.joint());
  ARTUS_TRY(into);
  if (*into == kOutside) return run_injection(scene, spec);
  spec.into = *into;
  if (!find_layer(scene, spec.entry, (spec.target - spec.entry).normalized(), *spec.into)) {
    const auto found = find_line_into(scene, *spec.into);
    ARTUS_TRY(found);
    spec.name = "line into " + scene.joint().regions[*into].name;
    std::tie(spec.entry, spec.target) = *found;
  }
  return run_injection(scene, spec);
}

}  // namespace artus
