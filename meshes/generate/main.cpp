// SPDX-License-Identifier: AGPL-3.0-or-later
// Writes the surfaces of a bundled joint; see meshes/README.md.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/meshes/generate/ankle.h"
#include "artus/detail/meshes/generate/elbow.h"
#include "artus/detail/meshes/generate/hip.h"
#include "artus/detail/meshes/generate/knee.h"
#include "artus/detail/meshes/generate/leg_measures.h"
#include "artus/detail/meshes/generate/limb_measures.h"
#include "artus/detail/meshes/generate/person.h"
#include "artus/detail/meshes/generate/shoulder.h"
#include "artus/detail/meshes/generate/shoulder_measures.h"
#include "artus/detail/meshes/generate/simple_shoulder.h"
#include "artus/detail/meshes/generate/wrist.h"

namespace {

constexpr double kUsualHead = 24;  // mm

struct Options {
  std::string joint;
  std::filesystem::path out;
  double head_radius_mm = kUsualHead;
  std::vector<std::string> only;
  std::filesystem::path measures;
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

/// The sizes of a joint that is as large as was asked for.
template <class Size>
Size sized(const Options& options) {
  Size size;
  if constexpr (requires { size.head_radius; })
    size.head_radius = options.head_radius_mm * artus::kMillimetre;
  else
    size.scale = options.head_radius_mm / kUsualHead;
  return size;
}

std::vector<artus::Solid> solids_of(const Options& options) {
  if (options.joint == "shoulder") return make_shoulder(sized<artus::ShoulderSize>(options));
  if (options.joint == "hip") return make_hip(sized<artus::HipSize>(options));
  if (options.joint == "knee") return make_knee(sized<artus::KneeSize>(options));
  if (options.joint == "elbow") return make_elbow(sized<artus::ElbowSize>(options));
  if (options.joint == "wrist") return make_wrist(sized<artus::WristSize>(options));
  if (options.joint == "ankle") return make_ankle(sized<artus::AnkleSize>(options));
  if (options.joint == "person") return artus::make_person();
  return make_simple_shoulder(sized<artus::SimpleShoulderSize>(options));
}

/// Empty: its lengths are not measured.
std::vector<artus::Measure> measures_of(const Options& options) {
  if (options.joint == "shoulder") return measure_shoulder(sized<artus::ShoulderSize>(options));
  if (options.joint == "hip") return measure_hip(sized<artus::HipSize>(options));
  if (options.joint == "knee") return measure_knee(sized<artus::KneeSize>(options));
  if (options.joint == "elbow") return measure_elbow(sized<artus::ElbowSize>(options));
  if (options.joint == "wrist") return measure_wrist(sized<artus::WristSize>(options));
  if (options.joint == "ankle") return measure_ankle(sized<artus::AnkleSize>(options));
  return {};
}

int write_measures(const Options& options) {
  const std::vector<artus::Measure> measures = measures_of(options);
  if (measures.empty()) {
    std::fprintf(stderr, "artus_generate_meshes: %s has no published lengths\n",
                 options.joint.c_str());
    return 1;
  }
  const auto written = artus::write_text(options.measures, to_markdown(options.joint, measures));
  if (!written) std::fprintf(stderr, "%s\n", written.error().to_string().c_str());
  return written ? 0 : 1;
}

int generate(const Options& options) {
  if (!options.measures.empty()) return write_measures(options);
  if (options.out.empty()) {
    std::fprintf(stderr, "artus_generate_meshes: say where to write: --out or --measures\n");
    return 1;
  }
  const std::vector<artus::Solid> solids = solids_of(options);
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
  app.add_option("joint", options.joint,
                 "simple-shoulder, shoulder, elbow, wrist, hip, knee or ankle; person: the skin of "
                 "the person around them")
      ->required()
      ->check(CLI::IsMember(
          {"simple-shoulder", "shoulder", "elbow", "wrist", "hip", "knee", "ankle", "person"}));
  auto* out = app.add_option("--out", options.out, "folder for the PLY files, made when missing");
  auto* measures = app.add_option("--measures", options.measures,
                                  "in place of it: lengths of the joint beside published ones");
  out->excludes(measures);
  app.add_option("--head-radius", options.head_radius_mm,
                 "radius of the humeral or femoral head, mm; the size of other joints follows")
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
