// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>

#include "artus/anatomy/compiled_joint.h"
#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/compile/labels/compile_report.h"
#include "artus/detail/anatomy/compile/labels/joint_sources.h"
#include "artus/detail/core/progress.h"

namespace artus {

struct CompileOptions {
  bool skip_refused = false;  ///< compile without the structures whose surfaces are refused
  bool check_plans = false;   ///< refuse poses and injections that cannot be used
  /// Folder where what was made of single structures is kept, and found when they are unchanged:
  /// repaired surfaces and their distances, at most 1 GB. Empty: nothing is kept.
  std::filesystem::path parts;
};

struct CompileOutcome {
  CompiledJoint joint;
  CompileReport report;
};

/// From repaired surfaces to one conforming complex of tetrahedra: reads and repairs the joint's
/// surfaces, resolves overlaps by priority, makes the constructs, meshes, fills, measures. A
/// JointFile will do for `sources`; who reports on the surfaces afterwards keeps them.
/// The joint is the same bytes for the same input at any number of threads.
/// Errors: what reading a surface gives; defective (a surface that cannot be repaired: all of them
/// are named, with reasons, unless `skip_refused`; with `check_plans` also a body in another frame,
/// poses and injections, all at once); failed (nothing inside the region of interest).
/// Cost: a minute on two cores and 1.2 GB for sixty structures in a ball of 14 cm.
[[nodiscard]] Result<CompileOutcome> compile_joint(const JointSources& sources,
                                                   const CompileOptions& options = {},
                                                   const Progress& progress = {});

struct LoadOptions {
  std::filesystem::path surfaces;  ///< replaces the joint file's surface folder when not empty
  std::filesystem::path cache;     ///< folder of compiled joints; default: the user's cache folder
  CompileOptions compile;
};

/// As compile_joint, byte for byte, but a body of the same shape in the cache is not made again:
/// only poses, injections, landmarks and tissues are put on it anew. A damaged or outdated cache
/// file is rebuilt; a cache that cannot be written is no error. Of one joint the last few bodies
/// are kept; of a body that is made anew, the unchanged structures are not repaired and measured
/// again (`parts`, if not given, lies in the cache). Errors: those of compile_joint. Cost: of a
/// kept body, reading it and digesting the surfaces' bytes.
[[nodiscard]] Result<CompileOutcome> compile_or_reuse(const JointSources& sources,
                                                      const LoadOptions& options = {},
                                                      const Progress& progress = {});

/// Loads a joint by any of its names (find_joint): a compiled file, or a folder, whose body is
/// compiled on first use and kept in the cache until what shapes it changes.
/// Errors: those of read_compiled_joint, read_joint and compile_joint.
[[nodiscard]] Result<CompiledJoint> load_joint(const std::filesystem::path& path,
                                               const LoadOptions& options = {},
                                               const Progress& progress = {});

}  // namespace artus
