// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>

#include "artus/anatomy/compile.h"
#include "artus/core/result.h"
#include "artus/detail/anatomy/compile/check/joint_check.h"

namespace artus {

/// Writes what was found in a joint as one page to look at: what to do, the joint from two sides,
/// each surface as it was read with its defects marked and as repair left it, a table of all, the
/// layers that cross. Errors: unreadable. Cost: finds the defects of all surfaces again.
[[nodiscard]] Result<void> write_check_page(const JointSources& sources, const JointCheck& check,
                                            const std::filesystem::path& page);

/// Writes what became of a joint as one page: the compiled body from two sides, three slices with
/// layers and planned lines, each structure coloured by its distance to the surface it came from, a
/// table of all with what its columns mean, the quality of the tetrahedra, and what to do next with
/// `compiled`, the file that was written. Errors: unreadable.
[[nodiscard]] Result<void> write_compile_page(const JointSources& sources,
                                              const CompileOutcome& outcome,
                                              const std::filesystem::path& compiled,
                                              const std::filesystem::path& page);

/// Whether a report goes to a page: its name ends in .html.
[[nodiscard]] bool is_page(const std::filesystem::path& report);

}  // namespace artus
