// SPDX-License-Identifier: AGPL-3.0-or-later
// Writes the surfaces of a bundled joint; see meshes/README.md.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "artus/anatomy/surfaces/surface_io.h"
#include "artus/core/units.h"
#include "artus/meshes/generate/shoulder.h"
#include "artus/meshes/generate/simple_shoulder.h"

namespace {

struct Options {
  std::string joint;
  std::filesystem::path out;
  double head_radius_mm = 24;
  std::vector<std::string> only;
};

artus::Result<void> write_solid(const artus::Solid& solid, const std::filesystem::path& folder) {
  return artus::compute_surface(solid).and_then([&](const artus::SurfaceMesh& mesh) {
    std::printf("%-24s %7zu triangles %9.2f cm3\n", solid.name.c_str(), mesh.triangles.size(),
                artus::signed_volume(mesh) * 1e6);
    return artus::write_surface(mesh, folder / (solid.name + ".ply"), artus::kMillimetre);
  });
}

bool is_wanted(const std::vector<std::string>& only, const std::string& name) {
  return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
}

int generate(const Options& options) {
  std::vector<artus::Solid> solids;
  if (options.joint == "shoulder") {
    artus::ShoulderSize size;
    size.head_radius = options.head_radius_mm * artus::kMillimetre;
    solids = artus::make_shoulder(size);
  } else {
    artus::SimpleShoulderSize size;
    size.head_radius = options.head_radius_mm * artus::kMillimetre;
    solids = artus::make_simple_shoulder(size);
  }
  std::filesystem::create_directories(options.out);
  for (const artus::Solid& solid : solids) {
    if (!is_wanted(options.only, solid.name)) continue;
    if (const auto written = write_solid(solid, options.out); !written) {
      std::fprintf(stderr, "%s\n", written.error().to_string().c_str());
      return 1;
    }
  }
  return 0;
}

int run(int argc, char** argv) {
  CLI::App app("Writes the surfaces of a bundled joint as PLY files in millimetres.");
  Options options;
  app.add_option("joint", options.joint, "simple-shoulder or shoulder")
      ->required()
      ->check(CLI::IsMember({"simple-shoulder", "shoulder"}));
  app.add_option("--out", options.out, "folder for the PLY files, made when missing")->required();
  app.add_option("--head-radius", options.head_radius_mm, "radius of the humeral head, mm")
      ->check(CLI::Range(10.0, 40.0))
      ->capture_default_str();
  app.add_option("--only", options.only, "names of the surfaces to write; default all");
  app.footer("Example:\n  artus_generate_meshes shoulder --head-radius 22 --out small-shoulder");
  CLI11_PARSE(app, argc, argv);
  return generate(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "artus_generate_meshes: %s\n", e.what());
    return 1;
  }
}
