// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/structure_names.h"
#include "artus/detail/anatomy/import/volumes/image_volume.h"

namespace artus {

/// One segment of a label volume.
struct LabelSegment {
  std::string name;
  double value = 0;  ///< in the file
  std::string code;
  std::size_t n_voxels = 0;  ///< that it has here
  std::size_t n_lost = 0;    ///< that it had, too, and an earlier segment of another layer has here
};

/// A label for every voxel: 0 is nothing, i + 1 is segments[i].
struct LabelVolume {
  std::string format;
  std::array<std::size_t, 3> size{0, 0, 0};
  IndexFrame X_LI = IndexFrame::Identity();  ///< index to LPS, m
  std::vector<std::uint16_t> labels;         ///< (size[2], size[1], size[0]), x fastest
  std::vector<LabelSegment> segments;
  std::vector<std::string> notes;

  /// Volume of a voxel, m^3, and the edge of a cube of that volume, m.
  [[nodiscard]] double voxel_volume() const noexcept;
  [[nodiscard]] double voxel_edge() const noexcept;
};

/// Labels of a volume whose samples are whole numbers. Names are the file's own; `names.labels`
/// replace and add to them. Where layers overlap, the segment that stands first has the voxel and
/// the others count what they lost. Segments without voxels (one voxel is 3D Slicer's way to write
/// none) are left out and noted. Errors: invalid (samples that are no whole numbers from 0 to
/// 65535, all 0, labels without a name: the message lists them and what to write).
[[nodiscard]] Result<LabelVolume> make_label_volume(const ImageVolume& volume,
                                                    const StructureNames& names,
                                                    const std::string& name);

/// The labels of any segmentation that is read: NIfTI, NRRD, MetaImage, and DICOM where the build
/// has it. Errors: those of the parsers and make_label_volume.
[[nodiscard]] Result<LabelVolume> read_labels(std::string_view bytes, const std::string& name,
                                              const StructureNames& names, double threshold = 0.5);

/// The kind of file that the first bytes are of.
enum class SourceKind { nifti, nrrd, metaimage, dicom, gltf, vtk_legacy, vtk_xml, gmsh, other };
[[nodiscard]] SourceKind kind_of_source(std::string_view bytes, const std::string& name);

/// Whether a file is a volume of samples, by its first bytes.
[[nodiscard]] bool is_volume(SourceKind kind) noexcept;

/// NIfTI, NRRD or MetaImage, by its first bytes. Errors: those of the parsers; unsupported, saying
/// what it is and how to get what is read.
[[nodiscard]] Result<ImageVolume> parse_volume(std::string_view bytes, const std::string& name);

}  // namespace artus
