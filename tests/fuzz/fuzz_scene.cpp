// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "artus/detail/anatomy/import/scene_reader.h"
#include "tests/anatomy/import/glb_samples.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace {

void check(const artus::Result<std::vector<artus::ScenePart>>& parts) {
  if (!parts) {
    if (parts.error().message.empty() || parts.error().where.empty()) std::abort();
    return;
  }
  for (const artus::ScenePart& part : *parts)
    for (const artus::Triangle& t : part.mesh.triangles)
      for (const auto v : t)
        if (v >= part.mesh.vertices.size()) std::abort();
}

}  // namespace

/// Starts from a sound file of each kind.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  for (int i = 1; i < *argc; ++i) {
    const std::filesystem::path corpus = (*argv)[i];
    if (!std::filesystem::is_directory(corpus)) continue;
    const artus::SurfaceMesh cube = artus::make_cube(artus::Vec3::Zero(), 0.01);
    artus::test::GlbNode root, femur;
    femur.name = "femur";
    femur.mesh = cube;
    std::string obj = "o femur\n";
    for (const artus::Vec3& p : cube.vertices)
      obj += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
             std::to_string(p.z()) + "\n";
    for (const artus::Triangle& t : cube.triangles)
      obj += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
             std::to_string(t[2] + 1) + "\n";
    const artus::ScenePart part{"femur", cube, {}};
    int n = 0;
    for (const std::string& bytes :
         {artus::test::to_glb(root, {femur}, false), artus::test::to_glb(root, {femur}, true), obj,
          artus::pack_parts({part, part})})
      std::ofstream(corpus / ("sound" + std::to_string(++n)), std::ios::binary) << bytes;
    break;
  }
  return 0;
}

/// Scenes in the process that is made for each, and what comes back from it: whatever becomes of
/// that process, this one has parts or a reason. What the library does is not watched.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check(artus::unpack_parts(bytes, "a"));
  const bool is_zip = bytes.starts_with("PK");
  const bool is_text = bytes.find_first_of("vof#") == 0;
  check(artus::read_scene(bytes, is_zip ? "a.3mf" : is_text ? "a.obj" : "a.glb", 1e-3));
  return 0;
}
