// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/apps/options/command.h"

namespace artus {

/// --entry and --target: injections given on the command line in place of the joint's.
struct PlanOptions {
  std::vector<std::string> entries;
  std::vector<std::string> targets;
};
/// Both may be given several times: once for each injection, the last for those that follow.
void add_plan_options(Command* command, PlanOptions& options);

/// The joint's injections, or as many as it has (three when it has none) of those on the command
/// line. A flag that is not given takes the joint's value. Errors: malformed (a point); not_found
/// (one flag alone, and the joint plans nothing); invalid (off the skin, bone in the way and so on,
/// with what would do), each with the flag.
[[nodiscard]] Result<std::vector<PlannedInjection>> make_plan(const PlanOptions& options,
                                                              const CompiledJoint& joint);

}  // namespace artus
