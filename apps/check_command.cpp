// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>

#include "artus/anatomy/compile/compile_surfaces.h"
#include "artus/anatomy/compile/joint_defects.h"
#include "artus/anatomy/surfaces/defects.h"
#include "artus/anatomy/surfaces/surface_io.h"
#include "artus/apps/command.h"
#include "artus/core/units.h"

namespace artus {
namespace {

constexpr double kCubicCentimetre = 1e-6;  // m^3

struct CheckOptions {
  std::filesystem::path path;
  std::filesystem::path surfaces;
  std::string units = "mm";
  double thicken_mm = 0;
  std::filesystem::path repaired;
  bool json = false;
};

nlohmann::json to_json(const Defect& defect) {
  return {{"kind", to_string(defect.kind)}, {"severity", to_string(severity_of(defect.kind))},
          {"structure", defect.structure},  {"count", defect.count},
          {"elements", defect.elements},    {"position_mm", to_json_mm(defect.position)},
          {"message", defect.message}};
}

void print(const std::vector<Defect>& defects) {
  for (const auto& defect : defects)
    std::printf("%-10s %-26s %s%s%s\n", to_string(severity_of(defect.kind)), to_string(defect.kind),
                defect.structure.c_str(), defect.structure.empty() ? "" : ": ",
                defect.message.c_str());
}

bool any_fatal(const std::vector<Defect>& defects) {
  return std::any_of(defects.begin(), defects.end(), [](const Defect& defect) {
    return severity_of(defect.kind) == DefectSeverity::fatal;
  });
}

/// What repair says of each surface that it refuses, "name: reason".
std::vector<std::string> find_refused(const JointFile& joint, const Progress& progress) {
  std::vector<std::string> refused;
  for (std::size_t i = 0; i < joint.structures.size(); ++i) {
    const Structure& structure = joint.structures[i];
    if (progress)
      progress("repairing",
               static_cast<double>(i + 1) / static_cast<double>(joint.structures.size()));
    const auto* surface = std::get_if<SurfaceFile>(&structure.shape);
    if (surface == nullptr) continue;
    const auto mesh = read_surface(joint.surface_folder / surface->file, surface->unit);
    if (!mesh) continue;  // already among the defects
    const auto outcome = repair_as_declared(*mesh, *surface);
    if (!outcome) refused.push_back(structure.name + ": " + outcome.error().message);
  }
  return refused;
}

nlohmann::json to_json(const Result<RepairOutcome>& outcome) {
  if (!outcome) return {{"refused", outcome.error().message}};
  auto actions = nlohmann::json::array();
  for (const auto& action : outcome->actions)
    actions.push_back(
        {{"kind", to_string(action.kind)}, {"count", action.count}, {"message", action.message}});
  return {{"actions", actions},
          {"volume_cm3", outcome->volume / kCubicCentimetre},
          {"triangles", outcome->mesh.triangles.size()},
          {"self_intersections_left", outcome->self_intersections}};
}

void print(const Result<RepairOutcome>& outcome) {
  if (!outcome) {
    std::printf("refused: %s\n", outcome.error().message.c_str());
    return;
  }
  for (const auto& action : outcome->actions) std::printf("repair: %s\n", action.message.c_str());
  std::printf("%s: closed, %zu triangles, %.3f cm3\n",
              outcome->actions.empty() ? "accepted unchanged" : "accepted after repair",
              outcome->mesh.triangles.size(), outcome->volume / kCubicCentimetre);
  if (outcome->self_intersections > 0)
    std::printf("%zu pairs of its faces still cut through each other; compiling tolerates that\n",
                outcome->self_intersections);
}

ExitCode check_surface(const CheckOptions& options) {
  const std::map<std::string, double> units{{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}};
  const double unit = units.at(options.units);
  const auto mesh = read_surface(options.path, unit);
  if (!mesh) return report_error(mesh.error(), options.json);
  const auto defects = find_defects(*mesh);
  RepairOptions repair;
  repair.thicken = options.thicken_mm * kMillimetre;
  const auto outcome = repair_surface(*mesh, repair);
  if (outcome && !options.repaired.empty())
    if (const auto written = write_surface(outcome->mesh, options.repaired, unit); !written)
      return report_error(written.error(), options.json);

  if (options.json) {
    auto list = nlohmann::json::array();
    for (const auto& defect : defects) list.push_back(to_json(defect));
    std::cout << nlohmann::json{{"file", options.path.string()},
                                {"vertices", mesh->vertices.size()},
                                {"triangles", mesh->triangles.size()},
                                {"defects", list},
                                {"repair", to_json(outcome)}}
                     .dump(2)
              << '\n';
  } else {
    std::printf("%s: %zu vertices, %zu triangles, %zu kinds of defect\n", options.path.c_str(),
                mesh->vertices.size(), mesh->triangles.size(), defects.size());
    print(defects);
    print(outcome);
  }
  return outcome ? ExitCode::ok : ExitCode::defects;
}

ExitCode check_joint(const CheckOptions& options) {
  const auto joint = read_joint(options.path, options.surfaces);
  if (!joint) return report_error(joint.error(), options.json);
  const Progress progress = make_progress_printer(options.json);
  const auto defects = find_joint_defects(*joint, {}, progress);
  const auto refused = find_refused(*joint, progress);
  const bool fatal = any_fatal(defects) || !refused.empty();
  if (options.json) {
    auto list = nlohmann::json::array();
    for (const auto& defect : defects) list.push_back(to_json(defect));
    std::cout << nlohmann::json{{"joint", joint->name},
                                {"structures", joint->structures.size()},
                                {"defects", list},
                                {"refused", refused},
                                {"usable", !fatal}}
                     .dump(2)
              << '\n';
  } else {
    print(defects);
    for (const auto& reason : refused) std::printf("refused: %s\n", reason.c_str());
    std::printf("%s: %zu structures, %zu findings, %s\n", joint->name.c_str(),
                joint->structures.size(), defects.size(),
                fatal ? "cannot be compiled as it is" : "can be compiled");
  }
  return fatal ? ExitCode::defects : ExitCode::ok;
}

}  // namespace

void add_check_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<CheckOptions>();
  Command* command =
      add_command(app, "check", "Every defect of a surface or a joint, and what repair makes of it",
                  "Exit code 3 when something cannot be repaired.\n"
                  "Examples:\n"
                  "  artus check humerus.stl\n"
                  "  artus check sheet.ply --thicken 1 --repaired plate.ply\n"
                  "  artus check meshes/real-shoulder --surfaces ~/atlas --json");
  command->add_option("path", options->path, "surface file (STL, PLY, OBJ, OFF) or joint folder")
      ->required();
  command->add_option("--surfaces", options->surfaces,
                      "folder of the surface files, when not the joint's own");
  command->add_option("--units", options->units, "unit of a surface file")
      ->one_of({"mm", "cm", "m"})
      ->capture_default_str();
  command
      ->add_option("--thicken", options->thicken_mm,
                   "mm; make an open sheet a plate of this thickness (0: refuse it)")
      ->check(number_in(0, 20))
      ->capture_default_str();
  command->add_option("--repaired", options->repaired, "write the repaired surface");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] {
    return std::filesystem::is_directory(options->path) ? check_joint(*options)
                                                        : check_surface(*options);
  });
}

}  // namespace artus
