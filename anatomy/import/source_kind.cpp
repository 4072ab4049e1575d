// SPDX-License-Identifier: AGPL-3.0-or-later
#include <filesystem>

#include "artus/detail/anatomy/import/dicom_seg.h"
#include "artus/detail/anatomy/import/label_volume.h"
#include "artus/detail/anatomy/surfaces/foreign_format.h"

namespace artus {

SourceKind kind_of_source(std::string_view bytes, const std::string& name) {
  const std::string_view format = foreign_format(bytes, name);
  if (format == "NIfTI") return SourceKind::nifti;
  if (format == "NRRD") return SourceKind::nrrd;
  if (format == "MetaImage") return SourceKind::metaimage;
  if (format == "DICOM") return SourceKind::dicom;
  if (format == "glTF") return SourceKind::gltf;
  if (format == "VTK") return SourceKind::vtk_legacy;
  if (format == "VTK XML") return SourceKind::vtk_xml;
  if (format == "Gmsh") return SourceKind::gmsh;
  return SourceKind::other;
}

bool is_volume(SourceKind kind) noexcept {
  return kind == SourceKind::nifti || kind == SourceKind::nrrd || kind == SourceKind::metaimage ||
         kind == SourceKind::dicom;
}

Result<LabelVolume> read_labels(std::string_view bytes, const std::string& name,
                                const StructureNames& names, double threshold) {
  if (kind_of_source(bytes, name) == SourceKind::dicom)
    return parse_dicom_seg(bytes, name, names, threshold);
  const auto volume = parse_volume(bytes, name);
  ARTUS_TRY(volume);
  return make_label_volume(*volume, names, name);
}

Result<ImageVolume> parse_volume(std::string_view bytes, const std::string& name) {
  switch (kind_of_source(bytes, name)) {
    case SourceKind::nifti:
      return parse_nifti(bytes, name);
    case SourceKind::nrrd:
      return parse_nrrd(bytes, name);
    case SourceKind::metaimage:
      return parse_metaimage(bytes, name);
    default:
      break;
  }
  const std::string advice = advice_for_format(bytes, name);
  return fail(ErrorCode::unsupported,
              advice.empty() ? "it is no NIfTI, NRRD or MetaImage volume; save the segmentation as "
                               ".nii.gz, .nrrd or .seg.nrrd"
                             : advice,
              name);
}

}  // namespace artus
