// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/body/holders.h"
#include "artus/detail/anatomy/compile/mesh/isolated.h"
#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/reports/joint_report.h"

namespace artus {
namespace {

struct CompileCommandOptions {
  std::filesystem::path joint;
  std::filesystem::path surfaces;
  std::filesystem::path out;
  std::filesystem::path report;
  std::filesystem::path cache;
  bool fresh = false;
  bool skip_refused = false;
  bool json = false;
};

void print_structures(const CompileReport& report) {
  std::printf("%-42s %-8s %9s %9s %9s %7s %6s %6s %5s\n", "structure", "kind", "input cm3",
              "lost cm3", "is cm3", "error %", "mean", "p95 mm", "parts");
  for (const auto& s : report.structures) {
    if (!s.refused.empty()) {
      std::printf("%-42s refused: %s\n", s.name.c_str(), s.refused.c_str());
      continue;
    }
    std::printf("%-42s %-8s %9.3f %9.3f %9.3f %7.2f %6.3f %6.3f %5zu%s\n", s.name.c_str(),
                s.kind.c_str(), s.region_volume / kCubicCentimetre,
                s.lost_volume / kCubicCentimetre, s.resolved_volume / kCubicCentimetre,
                100 * s.volume_error(), s.distance.mean / kMillimetre,
                s.distance.percentile95 / kMillimetre, s.parts, s.is_changed() ? "  !" : "");
    for (const auto& repair : s.repairs) std::printf("    %s\n", repair.c_str());
    for (const auto& warning : s.warnings) std::printf("    ! %s\n", warning.c_str());
  }
}

void print_histogram(const TetQuality& quality) {
  const auto most = *std::max_element(quality.histogram.begin(), quality.histogram.end());
  std::printf("smallest dihedral angle of each tetrahedron:\n");
  for (std::size_t i = 0; i < quality.histogram.size(); ++i) {
    const auto count = quality.histogram[i];
    if (count == 0) continue;
    const int bar = static_cast<int>(50.0 * static_cast<double>(count) / static_cast<double>(most));
    std::printf("  %3.0f-%-3.0f deg %9zu %s\n", static_cast<double>(i) * TetQuality::kBin,
                static_cast<double>(i + 1) * TetQuality::kBin, count,
                std::string(static_cast<std::size_t>(bar), '#').c_str());
  }
}

Result<CompileOutcome> compile(const JointSources& sources, const CompileCommandOptions& options,
                               const Progress& progress) {
  LoadOptions load;
  load.cache = options.cache;
  load.compile.skip_refused = options.skip_refused;
  load.compile.check_plans = true;
  return options.fresh ? compile_joint(sources, load.compile, progress)
                       : compile_or_reuse(sources, load, progress);
}

/// Refuses to write where the joint itself is.
Result<void> check_target(const JointSources& sources, const std::filesystem::path& file) {
  if (!sources.contains(file)) return {};
  return fail(ErrorCode::invalid,
              "the joint is made from this file, and writing to it would destroy it; name another",
              file.string());
}

ExitCode run_compile(const CompileCommandOptions& options) {
  const Progress progress = make_progress_printer(options.json);
  auto file = read_joint(options.joint, options.surfaces);
  if (!file) return report_error(file.error(), options.json);
  const JointSources sources(std::move(*file));
  const auto out =
      options.out.empty() ? std::filesystem::path(sources.joint().name + ".artus") : options.out;
  for (const auto& target : {out, options.report})
    if (const auto usable = check_target(sources, target); !usable)
      return report_error(usable.error(), options.json);
  auto outcome = compile(sources, options, progress);
  if (!outcome) return report_error(outcome.error(), options.json);
  if (const auto written = write_compiled_joint(outcome->joint, out); !written)
    return report_error(written.error(), options.json);
  outcome->report.peak_memory = peak_memory();  // writing takes memory, too
  const std::string report = to_json(outcome->report);
  if (!options.report.empty()) {
    const auto written = is_page(options.report)
                             ? write_compile_page(sources, *outcome, out, options.report)
                             : write_text(options.report, report + "\n");
    if (!written) return report_error(written.error(), options.json);
  }
  if (options.json) {
    std::cout << report << '\n';
    return ExitCode::ok;
  }
  print_structures(outcome->report);
  for (const auto& note : outcome->report.notes) std::printf("! %s\n", note.c_str());
  if (outcome->report.body_kept)
    std::printf(
        "the body is the one compiled before, since nothing that shapes it has changed; poses, "
        "injections and tissues are new\n");
  if (outcome->report.parts_cached > 0)
    std::printf("%zu repaired surfaces and distances are those of earlier compilations\n",
                outcome->report.parts_cached);
  std::printf("%s\n", describe(find_holders(outcome->joint)).c_str());
  print_histogram(outcome->report.quality);
  std::printf(
      "%s: %zu tetrahedra, %zu interface triangles, %zu vertices; %.3f %% without a dihedral "
      "angle below 8 deg; inverted: %zu\n",
      out.c_str(), outcome->report.tetrahedra, outcome->report.interfaces, outcome->report.vertices,
      outcome->report.quality.above_8_deg_percent(), outcome->report.quality.inverted);
  std::printf("%.1f s, %.0f MB at most\n", outcome->report.seconds,
              outcome->report.peak_memory / 1e6);
  return ExitCode::ok;
}

}  // namespace

void add_compile_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<CompileCommandOptions>();
  Command* command = add_command(
      app, "compile", "Check, resolve and tetrahedralise a joint folder into one file",
      "Prints what became of each structure: repairs, volume lost to others of higher priority,\n"
      "distance of the resolved interfaces to the input surface, quality of the tetrahedra.\n"
      "After an edit of poses, injections, landmarks or tissues alone the body is not made again.\n"
      "Exit code 3 when a surface, pose or injection must be mended first.\n"
      "Examples:\n"
      "  artus compile meshes/simple-shoulder -o simple.artus\n"
      "  artus compile meshes/real-shoulder --surfaces ~/atlas --skip-refused -o real.artus\n"
      "  artus compile my-joint --report report.html");
  command->add_option("joint", options->joint, "folder with joint.toml")->required();
  command->add_option("--surfaces", options->surfaces,
                      "folder of the surface files, when not the joint's own");
  command->add_option("-o,--out", options->out, "compiled file (default: <name>.artus)");
  command->add_option("--report", options->report,
                      "also write the report: a page with pictures (.html), else JSON");
  command->add_option("--cache", options->cache,
                      "folder where bodies are kept for the next time (default: user cache)");
  command->add_flag("--fresh", options->fresh, "make the body anew, and keep it nowhere");
  command->add_flag("--skip-refused", options->skip_refused,
                    "leave out structures that cannot be repaired instead of stopping");
  command->add_flag("--json", options->json, "print the report as JSON");
  on_run(command, code, [options] { return run_compile(*options); });
}

}  // namespace artus
