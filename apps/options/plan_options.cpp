// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/plan_options.h"

#include <algorithm>

#include "artus/detail/anatomy/compile/check/plan_check.h"
#include "artus/detail/apps/options/arguments.h"

namespace artus {
namespace {

constexpr std::size_t kPasses = 3;  // of a joint that plans none

/// Sets `member` of each injection to the points of a flag, the last for those that follow.
Result<void> take(const std::vector<std::string>& points, const char* flag,
                  Vec3 PlannedInjection::*member, std::vector<PlannedInjection>& plan) {
  for (std::size_t i = 0; i < plan.size() && !points.empty(); ++i) {
    const auto p = parse_point_mm(points[std::min(i, points.size() - 1)], flag);
    ARTUS_TRY(p);
    plan[i].*member = *p;
  }
  return {};
}

}  // namespace

void add_plan_options(Command* command, PlanOptions& options) {
  command->add_option("--entry", options.entries,
                      "x,y,z in mm, on the skin; in place of the joint's, once for each injection");
  command->add_option("--target", options.targets, "x,y,z in mm, likewise");
}

Result<std::vector<PlannedInjection>> make_plan(const PlanOptions& options,
                                                const CompiledJoint& joint) {
  std::vector<PlannedInjection> plan = joint.injections;
  if (options.entries.empty() && options.targets.empty()) return plan;
  if (plan.empty()) {
    if (options.entries.empty() || options.targets.empty())
      return fail(ErrorCode::not_found, "the joint plans no injection: give both",
                  "--entry, --target");
    for (std::size_t i = 0; i < kPasses; ++i)
      plan.push_back({"line " + std::to_string(i + 1), Vec3::Zero(), Vec3::Zero()});
  }
  ARTUS_TRY(take(options.entries, "--entry", &PlannedInjection::entry, plan));
  ARTUS_TRY(take(options.targets, "--target", &PlannedInjection::target, plan));
  JointFile planned;
  planned.injections = plan;
  const auto problems = find_plan_problems(planned, make_ground(joint, std::nullopt));
  if (!problems.empty())
    return fail(ErrorCode::invalid, to_line(problems.front()), "--entry, --target");
  return plan;
}

}  // namespace artus
