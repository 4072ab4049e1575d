// SPDX-License-Identifier: AGPL-3.0-or-later
#include <filesystem>
#include <fstream>
#include <string_view>

#include "artus/detail/anatomy/import/cells/volume_mesh.h"
#include "artus/detail/anatomy/import/volumes/inflate.h"
#include "tests/anatomy/import/cell_samples.h"

/// Starts from a sound file of each form.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  for (int i = 1; i < *argc; ++i) {
    const std::filesystem::path corpus = (*argv)[i];
    if (!std::filesystem::is_directory(corpus)) continue;
    using artus::test::VtuForm;
    const auto row = artus::test::make_cube_row({2, 1});
    int n = 0;
    for (const std::string& bytes :
         {artus::test::vtu_of(row, VtuForm::text), artus::test::vtu_of(row, VtuForm::base64),
          artus::test::vtu_of(row, VtuForm::raw),
          artus::test::vtu_of(row, VtuForm::compressed, artus::deflate_gzip),
          artus::test::msh_of(row, false, {"femur"}), artus::test::msh_of(row, true, {"femur"})})
      std::ofstream(corpus / ("sound" + std::to_string(++n)), std::ios::binary) << bytes;
    break;
  }
  return 0;
}

/// Both readers of volume meshes, and their boundaries.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const bool is_gmsh : {false, true}) {
    const auto mesh = is_gmsh ? artus::parse_gmsh(bytes, "a") : artus::parse_vtk_xml(bytes, "a");
    if (!mesh) continue;
    const auto surfaces = artus::find_boundaries(*mesh, "a");
    const auto outer = artus::find_outer_boundary(*mesh, "a");
    if (surfaces && outer && !surfaces->empty() && outer->vertices.size() > mesh->points.size())
      __builtin_trap();
  }
  return 0;
}
