// SPDX-License-Identifier: AGPL-3.0-or-later
#include <string_view>

#include "artus/detail/anatomy/import/label_volume.h"
#include "artus/detail/anatomy/import/scene_parts.h"

/// Every reader of volumes, the choice by content, and VTK's surfaces.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  artus::StructureNames names;
  names.labels = {{1, "femur", "bone"}, {2, "tibia", ""}};
  for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.mha"}) {
    const auto labels = artus::parse_volume(bytes, name);
    if (!labels) continue;
    const auto made = artus::make_label_volume(*labels, names, name);
    if (made && made->labels.size() != made->size[0] * made->size[1] * made->size[2])
      __builtin_trap();
  }
  static_cast<void>(artus::parse_vtk(bytes, "a.vtk", 1e-3));
  return 0;
}
