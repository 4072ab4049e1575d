// SPDX-License-Identifier: AGPL-3.0-or-later
#include <filesystem>
#include <fstream>
#include <string_view>

#include "artus/detail/anatomy/import/label_volume.h"
#include "artus/detail/anatomy/import/scene_parts.h"
#include "artus/detail/anatomy/import/volumes/inflate.h"
#include "tests/anatomy/import/label_samples.h"

/// Starts from a sound file of each kind: random bytes hardly ever get past a header.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  for (int i = 1; i < *argc; ++i) {
    const std::filesystem::path corpus = (*argv)[i];
    if (!std::filesystem::is_directory(corpus)) continue;
    const auto volume =
        artus::test::painted({5, 4, 3}, artus::test::oblique_frame(), {"femur", "tibia"},
                             [](const artus::Vec3& p) { return p.x() < 0 ? 1 : 2; });
    const std::string nifti = artus::test::nifti_of(volume);
    const std::string data(reinterpret_cast<const char*>(volume.labels.data()),
                           2 * volume.labels.size());
    const std::string surface =
        "# vtk DataFile Version 3.0\nSPACE=RAS\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 "
        "0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n";
    int n = 0;
    for (const std::string& bytes :
         {nifti, artus::deflate_gzip(nifti), artus::test::nrrd_of(volume),
          artus::test::nrrd_of(volume, true, artus::deflate_gzip(data), "gzip"),
          artus::test::mha_of(volume), surface})
      std::ofstream(corpus / ("sound" + std::to_string(++n)), std::ios::binary) << bytes;
    break;
  }
  return 0;
}

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
