// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/foreign_format.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace artus {
namespace {

bool is_nifti_header(std::string_view bytes) noexcept {
  if (bytes.size() < 348) return false;
  const auto is_size = [&](unsigned a, unsigned b) {
    const auto byte = [&](std::size_t i) {
      return static_cast<unsigned char>(bytes[i]);
    };
    return (byte(0) == a && byte(1) == b && byte(2) == 0 && byte(3) == 0) ||
           (byte(3) == a && byte(2) == b && byte(1) == 0 && byte(0) == 0);
  };
  if (is_size(0x5c, 1)) return bytes.substr(344, 2) == "n+" || bytes.substr(344, 2) == "ni";
  return is_size(0x1c, 2) && (bytes.substr(4, 2) == "n+" || bytes.substr(4, 2) == "ni");
}

/// The word after `key` (Type="PolyData", DATASET POLYDATA), among the first bytes.
std::string_view word_after(std::string_view bytes, std::string_view key) noexcept {
  const std::string_view head = bytes.substr(0, 2048);
  const auto at = head.find(key);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = head.substr(at + key.size());
  return rest.substr(0, rest.find_first_of("\" \t\r\n>"));
}

bool is_grid_of_cells(std::string_view bytes) noexcept {
  return word_after(bytes, "type=\"") == "UnstructuredGrid" ||
         word_after(bytes, "DATASET ") == "UNSTRUCTURED_GRID";
}

}  // namespace

std::string_view foreign_format(std::string_view bytes, std::string_view name) noexcept {
  constexpr std::size_t kPreamble = 128;  // of DICOM
  if (bytes.starts_with("\x1f\x8b"))
    return name.find(".nii") != std::string_view::npos ? "NIfTI" : "gzip";
  if (is_nifti_header(bytes)) return "NIfTI";
  if (bytes.starts_with("NRRD000")) return "NRRD";
  if (bytes.size() >= kPreamble + 4 && bytes.substr(kPreamble, 4) == "DICM") return "DICOM";
  if (bytes.starts_with("glTF") || name.ends_with(".gltf")) return "glTF";
  const std::string_view head = bytes.substr(0, 2048);
  if (head.starts_with("# vtk DataFile")) return "VTK";
  if (head.find("<VTKFile") != std::string_view::npos) return "VTK XML";
  if (head.find("$MeshFormat") != std::string_view::npos || head.starts_with("$NOD")) return "Gmsh";
  if (head.find("<COLLADA") != std::string_view::npos) return "COLLADA";
  if (bytes.starts_with("Kaydara FBX")) return "FBX";
  if (bytes.starts_with("PK\x03\x04") && name.ends_with(".3mf")) return "3MF";
  const bool is_meta = head.starts_with("ObjectType") || head.starts_with("NDims");
  return is_meta ? "MetaImage" : "";
}

std::string advice_for_format(std::string_view bytes, std::string_view name) {
  const std::string_view format = foreign_format(bytes, name);
  constexpr std::array<std::string_view, 4> kVolumes{"NIfTI", "NRRD", "MetaImage", "DICOM"};
  if (std::find(kVolumes.begin(), kVolumes.end(), format) != kVolumes.end())
    return "it is a volume of voxels (" + std::string(format) +
           "), not a surface; where it is a segmentation, `artus import FILE -o DIR` makes a joint "
           "of it";
  if (format == "VTK" && is_grid_of_cells(bytes))
    return "it is a volume mesh (VTK), not a surface; save it as .vtu (ParaView), whose boundary "
           "by "
           "material `artus import FILE --units mm -o DIR` takes, or its surface as STL or PLY";
  if (format == "Gmsh" || is_grid_of_cells(bytes))
    return "it is a volume mesh (" + std::string(format) +
           "), not a surface; `artus import FILE --units mm -o DIR` takes the boundary of each "
           "material (mm, cm or m: the file says none), or save its surface as STL or PLY "
           "(ParaView: Extract Surface)";
  if (format == "VTK XML" || format == "VTK")
    return "it is a file of VTK; `artus import FILE -o DIR` reads its surface, or save it as STL "
           "or PLY (ParaView, 3D Slicer)";
  if (format == "glTF")
    return "glTF is not read here: it is a scene of parts; `artus import FILE -o DIR` makes a "
           "surface of each part, or export each as STL or PLY";
  if (format == "gzip")
    return "it is a compressed file (gzip); unpack it, or name it .nii.gz where it is a NIfTI "
           "volume";
  if (!format.empty())
    return "it is a scene (" + std::string(format) +
           "), which is not read; open it in Blender and export each part as STL, PLY or one .glb";
  return {};
}

}  // namespace artus
