// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <set>

#include "artus/detail/anatomy/body/joint_path.h"
#include "artus/detail/anatomy/compile/check/joint_check.h"
#include "artus/detail/anatomy/compile/labels/compile_surfaces.h"
#include "artus/detail/anatomy/surfaces/enclosed_volume.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/reports/joint_report.h"

namespace artus {
namespace {

// A screen has 24 lines.
constexpr std::size_t kMaxToLookAt = 14;
constexpr std::size_t kMaxCrossings = 4;

struct CheckOptions {
  std::filesystem::path path;
  std::filesystem::path surfaces;
  std::optional<std::string> units;
  double thicken_mm = 0;
  std::filesystem::path repaired;
  std::filesystem::path report;
  bool all = false;
  bool json = false;
};

nlohmann::json to_json(const Defect& defect, bool is_refused) {
  return {{"kind", to_string(defect.kind)}, {"verdict", to_string(verdict_of(defect, is_refused))},
          {"structure", defect.structure},  {"count", defect.count},
          {"elements", defect.elements},    {"position_mm", to_json_mm(defect.position)},
          {"message", defect.message}};
}

/// What is there twice counts once.
double volume_of(const RepairOutcome& outcome) {
  return describe_overlap(outcome.mesh).empty() ? outcome.volume : enclosed_volume(outcome.mesh);
}

nlohmann::json to_json(const Result<RepairOutcome>& outcome) {
  if (!outcome) return {{"refused", outcome.error().message}};
  auto actions = nlohmann::json::array();
  for (const auto& action : outcome->actions)
    actions.push_back(
        {{"kind", to_string(action.kind)}, {"count", action.count}, {"message", action.message}});
  return {{"actions", actions},
          {"volume_cm3", volume_of(*outcome) / kCubicCentimetre},
          {"overlap", describe_overlap(outcome->mesh)},
          {"triangles", outcome->mesh.triangles.size()},
          {"self_intersections_left", outcome->self_intersections}};
}

void print(const Result<RepairOutcome>& outcome) {
  if (!outcome) {
    std::printf("refused: %s\n", outcome.error().message.c_str());
    return;
  }
  std::printf("%s: %zu triangles, %.3f cm3\n",
              outcome->actions.empty() ? "accepted unchanged" : "accepted after repair",
              outcome->mesh.triangles.size(), volume_of(*outcome) / kCubicCentimetre);
  if (const std::string overlap = describe_overlap(outcome->mesh); !overlap.empty())
    std::printf("%-7s %-26s %s\n", to_string(Verdict::look), "overlap", overlap.c_str());
  for (const auto& action : outcome->actions) std::printf("repair: %s\n", action.message.c_str());
  if (outcome->self_intersections > 0)
    std::printf("%zu pairs of its faces still cut through each other; compiling tolerates that\n",
                outcome->self_intersections);
}

/// A size that a surface in metres has when it is read as millimetres.
std::string describe_tiny(const SurfaceMesh& mesh, const SurfaceFile& file) {
  constexpr double kTiny = 2.5 * kMillimetre;  // a part of a body of 2.5 m, in metres
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.vertices)
    if (p.allFinite()) box.extend(p);
  if (file.has_own_unit || box.isEmpty() || box.diagonal().norm() >= kTiny) return {};
  return "it measures only " + std::to_string(box.diagonal().norm() / kMillimetre) +
         " mm from corner to corner; if its file is in metres, say so (--units m, or units = \"m\" "
         "in "
         "joint.toml)";
}

ExitCode check_surface(const CheckOptions& options) {
  SurfaceFile file;
  file.unit = length_unit(options.units.value_or("mm"));
  file.has_own_unit = options.units.has_value();
  file.thicken = options.thicken_mm * kMillimetre;
  const auto mesh = read_surface(options.path, file.unit);
  if (!mesh) return report_error(mesh.error(), options.json);
  const auto defects = find_defects(*mesh);
  const auto outcome = repair_as_declared(*mesh, file);
  if (outcome && !options.repaired.empty())
    if (const auto written = write_surface(outcome->mesh, options.repaired, file.unit); !written)
      return report_error(written.error(), options.json);

  if (options.json) {
    auto list = nlohmann::json::array();
    for (const auto& defect : defects) list.push_back(to_json(defect, !outcome));
    std::cout << nlohmann::json{{"file", options.path.string()},
                                {"vertices", mesh->vertices.size()},
                                {"triangles", mesh->triangles.size()},
                                {"defects", list},
                                {"repair", to_json(outcome)},
                                {"unit", describe_tiny(*mesh, file)},
                                {"usable", outcome.has_value()}}
                     .dump(2)
              << '\n';
  } else {
    std::printf("%s: %zu vertices, %zu triangles, %zu kinds of defect\n", options.path.c_str(),
                mesh->vertices.size(), mesh->triangles.size(), defects.size());
    print(outcome);
    if (const std::string tiny = describe_tiny(*mesh, file); outcome && !tiny.empty())
      std::printf("%-7s %-26s %s\n", to_string(Verdict::look), "unit", tiny.c_str());
    for (const auto& defect : defects)
      std::printf("%-7s %-26s %s\n", to_string(verdict_of(defect, !outcome)),
                  to_string(defect.kind), defect.message.c_str());
  }
  return outcome ? ExitCode::ok : ExitCode::defects;
}

void print(const Finding& finding) {
  std::printf("%-7s %s", to_string(finding.verdict), finding.what.c_str());
  if (finding.line > 0) std::printf(" (line %d)", finding.line);
  std::printf(": %s\n", finding.message.c_str());
}

/// Prints up to `most` findings of one verdict and how many there are besides.
void print(const JointCheck& check, Verdict verdict, std::size_t most) {
  std::size_t n = 0;
  for (const Finding& finding : check.findings)
    if (finding.verdict == verdict && n++ < most) print(finding);
  if (n > most) std::printf("        and %zu more (--all)\n", n - most);
}

/// The second name of a pair that crosses, from the message.
std::string other_of(const Defect& crossing) {
  const auto from = crossing.message.find('\'') + 1;
  return crossing.message.substr(from, crossing.message.find('\'', from) - from);
}

void print_crossings(const JointCheck& check, std::size_t most) {
  if (check.crossings.empty()) return;
  std::size_t faces = 0;
  for (const Defect& c : check.crossings) faces += c.count;
  std::printf(
      "%zu pairs of layers cross, in %zu pairs of faces; the one that stands first in joint.toml "
      "keeps the overlap:\n  %-32s %-32s %8s\n",
      check.crossings.size(), faces, "first", "second", "faces");
  for (std::size_t i = 0; i < std::min(most, check.crossings.size()); ++i)
    std::printf("  %-32s %-32s %8zu\n", check.crossings[i].structure.c_str(),
                other_of(check.crossings[i]).c_str(), check.crossings[i].count);
  if (check.crossings.size() > most)
    std::printf("  and %zu more (--all)\n", check.crossings.size() - most);
}

std::size_t count_mended(const JointCheck& check) {
  std::set<std::string> names;
  for (const Finding& finding : check.findings)
    if (finding.verdict == Verdict::mended) names.insert(finding.what);
  return names.size();
}

void print_joint(const JointFile& joint, const JointCheck& check, bool all) {
  const std::size_t everything = check.findings.size() + check.crossings.size();
  print(check, Verdict::refused, everything);
  print(check, Verdict::look, all ? everything : kMaxToLookAt);
  if (all) {
    print(check, Verdict::mended, everything);
    print(check, Verdict::note, everything);
  }
  print_crossings(check, all ? everything : kMaxCrossings);
  std::printf("%zu surfaces are mended, %zu need nothing done%s\n", count_mended(check),
              check.surfaces.size() - std::min(check.surfaces.size(), count_mended(check)),
              all ? "" : "; --all lists what was found and done");
  if (!check.held_by.empty() && check.usable()) std::printf("%s\n", check.held_by.c_str());
  for (const JointVariant& variant : joint.variants)
    if (!variant.chosen)
      std::printf("can have +%s: %s\n", variant.name.c_str(), variant.title.c_str());
  std::printf("%s: %zu structures, %zu refusals, %zu to look at: %s\n", joint.name.c_str(),
              joint.structures.size(), check.count(Verdict::refused), check.count(Verdict::look),
              check.usable() ? "can be compiled" : "cannot be compiled as it is");
}

nlohmann::json to_json(const JointFile& joint, const JointCheck& check) {
  auto findings = nlohmann::json::array();
  for (const Finding& f : check.findings)
    findings.push_back({{"verdict", to_string(f.verdict)},
                        {"kind", f.kind},
                        {"structure", f.what},
                        {"line", f.line},
                        {"message", f.message}});
  auto crossings = nlohmann::json::array();
  for (const Defect& c : check.crossings)
    crossings.push_back({{"first", c.structure}, {"second", other_of(c)}, {"faces", c.count}});
  auto variants = nlohmann::json::array();
  for (const JointVariant& variant : joint.variants)
    variants.push_back(
        {{"name", variant.name}, {"title", variant.title}, {"chosen", variant.chosen}});
  return {{"joint", joint.name},     {"structures", joint.structures.size()},
          {"variants", variants},    {"findings", findings},
          {"crossings", crossings},  {"usable", check.usable()},
          {"held_by", check.held_by}};
}

ExitCode check_folder(const CheckOptions& options) {
  auto read = read_joint(options.path, options.surfaces);
  if (!read) return report_error(read.error(), options.json);
  const JointSources sources(std::move(*read));
  const JointFile& joint = sources.joint();
  const JointCheck check = check_joint(sources, make_progress_printer(options.json));
  if (!options.report.empty()) {
    const auto written = is_page(options.report)
                             ? write_check_page(sources, check, options.report)
                             : write_text(options.report, to_json(joint, check).dump(2) + "\n");
    if (!written) return report_error(written.error(), options.json);
  }
  if (options.json)
    std::cout << to_json(joint, check).dump(2) << '\n';
  else
    print_joint(joint, check, options.all);
  return check.usable() ? ExitCode::ok : ExitCode::defects;
}

}  // namespace

void add_check_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<CheckOptions>();
  Command* command = add_command(
      app, "check", "Every defect of a surface or a joint, and what repair makes of it",
      "Each finding is refused (mend it: nothing is compiled until then), look (compiled "
      "as it is; is\n"
      "it meant?), mended (repair saw to it) or note. Exit code 3 when something is "
      "refused.\n"
      "Examples:\n"
      "  artus check humerus.stl\n"
      "  artus check sheet.ply --thicken 1 --repaired plate.ply\n"
      "  artus check meshes/real-shoulder --surfaces ~/atlas --all");
  command->add_option("path", options->path, "surface file (STL, PLY, OBJ, OFF) or joint folder")
      ->required();
  command->add_option("--surfaces", options->surfaces,
                      "folder of the surface files, when not the joint's own");
  command
      ->add_option("--units", options->units,
                   "unit of a surface file (default: mm); given, an odd size is taken as meant")
      ->one_of({"mm", "cm", "m"});
  command
      ->add_option("--thicken", options->thicken_mm,
                   "mm; make an open sheet a plate of this thickness (0: refuse it)")
      ->check(number_in(0, 20))
      ->capture_default_str();
  command->add_option("--repaired", options->repaired, "write the repaired surface");
  command->add_option("--report", options->report,
                      "of a joint: also write a page with pictures (.html), or JSON");
  command->add_flag("--all", options->all, "of a joint: also what was mended and needs nothing");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] {
    return is_joint_folder(options->path) ? check_folder(*options) : check_surface(*options);
  });
}

}  // namespace artus
