// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace artus {

/// The format of a file that is none of STL, PLY, OBJ and OFF, by its first bytes (and its name
/// where those leave it open): "NIfTI", "NRRD", "MetaImage", "DICOM", "glTF", "VTK", "VTK XML",
/// "Gmsh", "3MF", "FBX", "COLLADA", "gzip"; empty: not known. Errors: none. Cost: none.
[[nodiscard]] std::string_view foreign_format(std::string_view bytes,
                                              std::string_view name) noexcept;

/// What such a file is and how to get what artus reads of it, as the end of a refusal; empty: not
/// known. A volume mesh is named as such.
[[nodiscard]] std::string advice_for_format(std::string_view bytes, std::string_view name);

}  // namespace artus
