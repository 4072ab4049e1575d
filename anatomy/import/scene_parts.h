// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/imported_joint.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// A named part of a scene.
struct ScenePart {
  std::string name;
  SurfaceMesh mesh;  ///< LPS, m; the transforms of the scene's nodes are applied
  std::vector<std::string> notes;
};

/// The parts of a surface or scene file: STL, PLY, OFF and VTK's surfaces (.vtk, .vtp) are one
/// part named by the file; OBJ has one for each object, glTF and GLB for each named node with a
/// mesh. glTF is in metres with y up, so that LPS is (x, -z, y); the others in `unit` (m). VTK and
/// STL that say they are RAS are turned. Errors: as read_surface; unsupported (a volume mesh, a
/// scene where the build has no reader of scenes), malformed.
[[nodiscard]] Result<std::vector<ScenePart>> read_scene_parts(std::string_view bytes,
                                                              const std::string& name, double unit);

/// PolyData of a legacy VTK file, ASCII or binary.
/// Polygons become fans, strips triangles. Errors: as read_scene_parts; a volume mesh is named.
[[nodiscard]] Result<ScenePart> parse_vtk(std::string_view bytes, const std::string& name,
                                          double unit);

/// Whether this build reads scenes (libassimp).
[[nodiscard]] bool reads_scenes() noexcept;

/// Makes a joint of surfaces: tissues by name; the outline or skin is the body, and where there is
/// none a hull around all. Parts whose openings are more than a fifth of their area are left out,
/// with what would mend them. Errors: invalid (no part of a known tissue).
[[nodiscard]] Result<ImportedJoint> import_parts(std::vector<ScenePart> parts,
                                                 const ImportOptions& options,
                                                 const std::string& file, const Progress& progress);

}  // namespace artus
