// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/cells/volume_mesh.h"
#include "artus/detail/anatomy/import/imported_joint.h"

namespace artus {

/// VTU, VTP or MSH by its first bytes; nullopt: it is none of them. Errors: those of the parsers.
[[nodiscard]] Result<std::optional<VolumeMesh>> read_cells(std::string_view bytes,
                                                           const std::string& name);

/// Makes a joint of a volume mesh: the boundary of each material is a structure, named by the file
/// or by `options.names.labels`; where a material is skin, fat or body, the outer boundary of all
/// cells is the body. Structures share their borders as the mesh does. Errors: invalid (no unit is
/// said: the mesh has none of its own; materials without a name, which are listed), those of
/// import_parts.
[[nodiscard]] Result<ImportedJoint> import_cells(const VolumeMesh& mesh,
                                                 const ImportOptions& options,
                                                 const std::string& file, const Progress& progress);

}  // namespace artus
