// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/anatomy/joint_file.h"
#include "artus/core/result.h"
#include "artus/detail/anatomy/compile/check/plan_ground.h"

namespace artus {

/// The face of the probe that a pose is checked for: the default transducer's length. m
inline constexpr double kPlannedFace = 40e-3;
/// The longest needle: what a planned path through the body may not exceed. m
inline constexpr double kLongestNeedle = 90e-3;

/// What would mend a plan: `key` of its table set to `value`, both as the joint file has them but
/// in metres.
struct PlanMend {
  std::string key;            ///< "entry", "target", "position", "direction", "centre", "radius" ..
  Vec3 value = Vec3::Zero();  ///< the radius in x
};

/// Why a pose or an injection of the joint file cannot be used.
struct PlanProblem {
  std::string plan;  ///< "injection 'first'", "[needle]", "[probe]", "[region_of_interest]"
  int line = 0;      ///< of joint.toml
  std::string message;
  std::vector<PlanMend> mends;  ///< together they do it; empty where none was found
};

/// "injection 'first' (line 12): message".
[[nodiscard]] std::string to_line(const PlanProblem& problem);

/// Nothing, or one error (defective) that lists all lines.
[[nodiscard]] Result<void> refuse_all(const std::vector<std::string>& lines, const JointFile& file);

/// All that is wrong with the region, [probe], [needle] and [[injection]]: the region holds no
/// skin; an entry off the skin (2 mm) or out of the region; a target out of the body or region; a
/// bone in the path (a target in bone is fine: that bone does not count); a path longer than the
/// longest needle; a target in a layer too thin to stop in; a face that does not rest on skin of
/// the region over its whole length, or points away from the body. Each message ends with what
/// would do. Cost: some ms a plan, up to a second where an entry is searched.
[[nodiscard]] std::vector<PlanProblem> find_plan_problems(const JointFile& file,
                                                          const PlanGround& ground);

/// m that the ends of a planned probe's face may lie off the skin.
inline constexpr double kFaceReach = 12e-3;
/// m of it that gel fills in the picture (ImageSettings::gel_limit); beyond, lines are lifted.
inline constexpr double kGelReach = 5e-3;

/// Whether a probe at this pose stands on skin of the region with its whole face, no part of it
/// more than `reach` (m) off it.
[[nodiscard]] bool stands_on_skin(const PlanGround& ground, const Pose& X_JP,
                                  double reach = kFaceReach);

/// The place on the skin nearest to `near` from which a needle reaches `target` past all bone;
/// none when there is none among the nearest few thousand.
[[nodiscard]] std::optional<Vec3> find_entry(const PlanGround& ground, const Vec3& target,
                                             const Vec3& near);

}  // namespace artus
