// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/compile/labels/compile_report.h"
#include "artus/detail/anatomy/compile/labels/joint_sources.h"
#include "artus/detail/anatomy/compile/labels/part_cache.h"
#include "artus/detail/anatomy/surfaces/distance_tree.h"
#include "artus/detail/anatomy/surfaces/repair.h"

namespace artus {

/// One structure's surface, ready to be resolved.
struct PreparedSurface {
  SurfaceMesh mesh;
  DistanceTree tree{SurfaceMesh{}};
  double thickness = 0;  ///< m, 2 volume / area: of a plate its thickness, of a tube its radius
  std::vector<std::uint8_t> is_cut;   ///< of a body, see find_cut_faces: what is no skin
  std::vector<std::string> warnings;  ///< what its author should look at
};

/// The surfaces of a joint; empty for constructs and refused structures.
struct PreparedSurfaces {
  PreparedSurface body;
  std::vector<std::optional<PreparedSurface>> structures;  ///< (n_structures)
};

/// Repairs a surface as its entry in the joint file asks: closed by the smallest change that does
/// it, wrapped, made a plate, or (repair = "none") left as it is. Errors: those of repair_surface;
/// defective for a size that no part of a body has, unless the file's unit is given, and for a
/// place that no frame of a body has.
[[nodiscard]] Result<RepairOutcome> repair_as_declared(const SurfaceMesh& mesh,
                                                       const SurfaceFile& surface);

/// Reads and repairs one surface, noting repairs and its volume in `report`. Errors: those of
/// reading and of repair_as_declared.
[[nodiscard]] Result<PreparedSurface> prepare_surface(const JointSources& sources,
                                                      const SurfaceFile& surface,
                                                      StructureReport& report,
                                                      const PartCache& parts = {});

/// The same of the body: finds its cuts besides. Errors: also defective for a body of less than 10
/// mm, unless its unit is given.
[[nodiscard]] Result<PreparedSurface> prepare_body(const JointSources& sources,
                                                   StructureReport& report,
                                                   const PartCache& parts = {});

/// What there is to say of closed pieces that lie in each other, counted twice by signed_volume;
/// empty where that is less than 2 % of it.
[[nodiscard]] std::string describe_overlap(const SurfaceMesh& mesh);

/// Reads and repairs all surfaces; notes repairs and refusals in `reports` (n_structures). What is
/// in `parts` is not repaired again.
/// Errors: those of reading; defective when the body is refused.
[[nodiscard]] Result<PreparedSurfaces> prepare_surfaces(const JointSources& sources,
                                                        std::vector<StructureReport>& reports,
                                                        const PartCache& parts = {});

}  // namespace artus
