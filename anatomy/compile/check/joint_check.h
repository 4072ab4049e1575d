// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/compile/labels/compile_surfaces.h"
#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/core/progress.h"

namespace artus {

/// What a finding asks of the joint's author.
enum class Verdict {
  refused,  ///< nothing is compiled until it is mended
  look,     ///< compiled as it is; is it meant?
  mended,   ///< repair saw to it
  note      ///< nothing
};
[[nodiscard]] const char* to_string(Verdict verdict) noexcept;

/// What a defect of a surface asks for when repair has had its say.
[[nodiscard]] Verdict verdict_of(const Defect& defect, bool is_refused) noexcept;

/// One thing found in a joint; its message ends with what would do, where something should be done.
struct Finding {
  Verdict verdict = Verdict::note;
  std::string kind;  ///< of a defect or a repair, "refused_surface", "surface", "plan",
                     ///< "misplaced", "lost", "frame", "other_frame", "pose", "mirrored", "unheld"
  std::string what;  ///< the structure or plan
  int line = 0;      ///< of joint.toml; 0: of no line
  std::string message;
};

/// What became of one surface, for whoever shows it.
struct CheckedSurface {
  std::string name;
  double volume = 0;  ///< m^3, repaired; 0 when refused
  std::vector<std::string> repairs;
  std::string refused;
};

struct JointCheck {
  std::vector<Finding> findings;         ///< the worst first, in the order of the file
  std::vector<Defect> crossings;         ///< layers that cut through each other, most faces first
  std::vector<CheckedSurface> surfaces;  ///< body first, then structures with a file
  PreparedSurfaces prepared;             ///< the repaired ones
  std::string held_by;                   ///< what will hold the tissue; empty: the body is refused

  [[nodiscard]] std::size_t count(Verdict verdict) const noexcept;
  /// Whether the joint can be compiled as it is.
  [[nodiscard]] bool usable() const noexcept { return count(Verdict::refused) == 0; }
};

/// Everything that can be said of a joint before it is compiled: defects of each surface and what
/// repair makes of them, places, sides, region, poses and injections. A refusal here is a refusal
/// of compile, and the other way round. Errors: none; a file that cannot be read is a finding.
/// Cost: as reading and repairing all surfaces.
[[nodiscard]] JointCheck check_joint(const JointSources& sources, const Progress& progress = {});

}  // namespace artus
