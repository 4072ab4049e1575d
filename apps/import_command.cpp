// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/anatomy/body/joint_path.h"
#include "artus/detail/anatomy/import/atlas/known_joint.h"
#include "artus/detail/anatomy/import/import_files.h"
#include "artus/detail/apps/commands.h"
#include "artus/detail/apps/options/arguments.h"
#include "artus/detail/core/csv.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/reports/import_page.h"

namespace artus {
namespace {

struct ImportCommandOptions {
  std::vector<std::string> files;
  std::filesystem::path out;
  std::filesystem::path labels;
  std::filesystem::path image;
  std::string as;
  std::string name;
  std::string side;
  std::string units;
  std::vector<std::string> between;
  double threshold = 0.5;
  std::string assume;
  std::vector<std::string> bursa;
  bool whole = false;
  bool replace = false;
  bool json = false;
};

Result<ImportOptions> read_options(const ImportCommandOptions& options) {
  ImportOptions out;
  out.name = options.name;
  out.side = options.side;
  out.between = options.between;
  out.threshold = options.threshold;
  if (!options.units.empty()) out.surface_unit = length_unit(options.units);
  out.whole = options.whole;
  if (!options.assume.empty()) out.assume = csv_cells(options.assume);
  out.bursa = options.bursa;
  if (!options.labels.empty()) {
    auto names = read_structure_names(options.labels);
    ARTUS_TRY(names);
    out.names = std::move(*names);
  }
  if (!options.image.empty()) {
    const auto bytes = read_bytes(options.image);
    ARTUS_TRY(bytes);
    auto image = parse_volume(*bytes, options.image.string());
    ARTUS_TRY(image);
    out.image = std::move(*image);
  }
  if (!out.between.empty() && out.between.size() != 2)
    return fail(ErrorCode::invalid, "needs two structures: --between femur tibia", "--between");
  return out;
}

nlohmann::json to_json(const ImportedStructure& s) {
  return {{"name", s.name},
          {"source", s.source},
          {"tissue", s.tissue},
          {"by", s.by},
          {"label", s.value},
          {"voxels", s.n_voxels},
          {"voxels_cm3", s.volumes.counted / kCubicCentimetre},
          {"surface_cm3", s.volumes.fitted / kCubicCentimetre},
          {"triangles", s.mesh.triangles.size()}};
}

nlohmann::json to_json(const ImportedJoint& joint, const std::filesystem::path& out) {
  nlohmann::json json{{"folder", out.string()},
                      {"name", joint.name},
                      {"format", joint.format},
                      {"side", joint.side},
                      {"body", joint.body_by},
                      {"assumed", joint.assumed},
                      {"notes", joint.notes},
                      {"structures", nlohmann::json::array()},
                      {"left_out", nlohmann::json::array()}};
  for (const auto& s : joint.structures) json["structures"].push_back(to_json(s));
  for (const auto& s : joint.left_out)
    json["left_out"].push_back({{"source", s.source}, {"label", s.value}, {"why", s.by}});
  if (joint.region)
    json["region"] = {{"centre_mm", to_json_mm(joint.region->centre)},
                      {"radius_mm", joint.region->radius / kMillimetre},
                      {"by", joint.region->by}};
  return json;
}

void print(const ImportedJoint& joint, const std::filesystem::path& out) {
  std::printf("%-32s %-10s %8s %10s %10s  %s\n", "structure", "tissue", "label", "voxels cm3",
              "is cm3", "known by");
  for (const auto& s : joint.structures) {
    const bool has_voxels = s.n_voxels > 0;  // surfaces and tubes have none
    std::printf("%-32s %-10s %8s %10s %10.3f  %s\n", s.name.c_str(), s.tissue.c_str(),
                has_voxels ? printed("%.0f", s.value).c_str() : "-",
                has_voxels ? printed("%.3f", s.volumes.counted / kCubicCentimetre).c_str() : "-",
                s.volumes.fitted / kCubicCentimetre, s.by.c_str());
  }
  std::printf("body: by %s\n", joint.body_by.c_str());
  for (const auto& text : joint.assumed) std::printf("assumed: %s\n", text.c_str());
  for (const auto& s : joint.left_out)
    std::printf("left out: '%s': %s\n", s.source.c_str(), s.by.c_str());
  for (const auto& text : joint.notes) std::printf("! %s\n", text.c_str());
  std::printf("%s: %zu structures; look at %s, then: artus compile %s -o %s.artus\n",
              (out / "joint.toml").c_str(), joint.structures.size(), (out / "import.html").c_str(),
              out.c_str(), joint.name.c_str());
}

/// --as: the joint.toml is there, and what the files are called is known.
Result<void> import_known(const ImportCommandOptions& options, const Progress& progress) {
  const auto joint = read_known_joint(find_joint(options.as));
  ARTUS_TRY(joint);
  const std::vector<std::filesystem::path> files(options.files.begin(), options.files.end());
  const auto found = find_known_joint(
      *joint, files, length_unit(options.units.empty() ? "mm" : options.units), progress);
  ARTUS_TRY(found);
  if (progress) progress("writing", 0.95);
  ARTUS_TRY(write_known_joint(*joint, *found, options.out, options.replace));
  if (progress) progress("done", 1);
  if (options.json) {
    nlohmann::json json{{"folder", options.out.string()},
                        {"notes", found->notes},
                        {"credits", joint->credits},
                        {"surfaces", nlohmann::json::array()}};
    for (const FoundSurface& s : found->surfaces)
      json["surfaces"].push_back({{"file", s.file},
                                  {"source", s.source},
                                  {"by", s.by},
                                  {"triangles", s.mesh.triangles.size()}});
    std::cout << json.dump(2) << '\n';
    return {};
  }
  for (const FoundSurface& s : found->surfaces)
    std::printf("%-44s %-28s %s\n", s.file.c_str(), s.by.c_str(), s.source.c_str());
  for (const auto& text : found->notes) std::printf("! %s\n", text.c_str());
  std::printf("%s: %zu surfaces; then: artus compile %s -o %s.artus\n",
              (options.out / "joint.toml").c_str(), found->surfaces.size(), options.out.c_str(),
              options.out.filename().c_str());
  for (const auto& line : joint->credits) std::printf("%s\n", line.c_str());
  return {};
}

ExitCode run_import(const ImportCommandOptions& options) {
  const Progress progress = make_progress_printer(options.json);
  if (!options.as.empty()) {
    const auto done = import_known(options, progress);
    return done ? ExitCode::ok : report_error(done.error(), options.json);
  }
  const auto given = read_options(options);
  if (!given) return report_error(given.error(), options.json);
  const std::vector<std::filesystem::path> files(options.files.begin(), options.files.end());
  const auto joint = import_files(files, *given, progress);
  if (!joint) return report_error(joint.error(), options.json);
  if (progress) progress("writing", 0.95);
  if (const auto written = write_imported_joint(*joint, options.out, options.replace); !written)
    return report_error(written.error(), options.json);
  if (const auto written = write_import_page(*joint, options.out / "import.html"); !written)
    return report_error(written.error(), options.json);
  if (progress) progress("done", 1);
  if (options.json)
    std::cout << to_json(*joint, options.out).dump(2) << '\n';
  else
    print(*joint, options.out);
  return ExitCode::ok;
}

}  // namespace

void add_import_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<ImportCommandOptions>();
  Command* command = add_command(
      app, "import", "Make a joint folder of a segmentation or a scene",
      "Segmentations: NIfTI, NRRD and .seg.nrrd of 3D Slicer, MetaImage, DICOM SEG; or one mask a\n"
      "structure. Scenes: GLB, glTF, VTK, VTP, OBJ of several objects; or surfaces. Volume\n"
      "meshes: VTU, MSH, the boundary of each material.\n"
      "Writes joint.toml, surfaces and import.html, a page with what was made and what was\n"
      "assumed.\n"
      "Examples:\n"
      "  artus import knee.seg.nrrd -o knee\n"
      "  artus import labels.nii.gz --labels names.toml --image scan.nii.gz -o knee\n"
      "  artus import segmentations/*.nii.gz --between humerus_left scapula_left -o shoulder\n"
      "  artus import knee.seg.nrrd --assume cartilage,recess -o knee\n"
      "  artus import atlas.glb -o shoulder\n"
      "  artus import mesh.vtu --units mm --labels names.toml -o knee\n"
      "  artus import --as real-shoulder bodyparts3d/ z-anatomy/ -o real");
  command->add_option("files", options->files, "segmentation, masks, scene or surfaces")
      ->required();
  command->add_option("-o,--out", options->out, "folder to write")->required();
  command->add_option("--as", options->as,
                      "joint whose joint.toml is there and whose surfaces are an atlas's: those "
                      "that it needs are found in files or folders of that atlas as they come");
  command->add_option("--labels", options->labels,
                      "names and tissues of labels: TOML, or a colour table of 3D Slicer or "
                      "ITK-SNAP");
  command->add_option("--image", options->image,
                      "the scan on the same grid: the skin is taken from it");
  command->add_option("--name", options->name, "of the joint (default: the file's)");
  command->add_option("--side", options->side, "left, right or none (default: by the names)")
      ->one_of({"left", "right", "none"});
  command
      ->add_option("--units", options->units,
                   "of surfaces that do not say their own (default: mm) and of volume meshes")
      ->one_of({"mm", "cm", "m"});
  command
      ->add_option("--between", options->between,
                   "two structures where the joint is, for the region of interest")
      ->expected(2);
  command->add_flag("--whole", options->whole, "mesh all of the body: no region of interest");
  command->add_option("--assume", options->assume,
                      "what the segmentation lacks, made and marked, parted by commas: cartilage "
                      "where bones face each other, the recess between them, tendons where muscles "
                      "meet bone");
  command
      ->add_option("--bursa", options->bursa,
                   "two structures between which there is a bursa, made and marked as assumed")
      ->expected(2);
  command
      ->add_option("--threshold", options->threshold,
                   "of a fractional DICOM segmentation, from where on a voxel belongs")
      ->check(number_in(0, 1))
      ->capture_default_str();
  command->add_flag("--replace", options->replace, "write over the joint of an earlier import");
  command->add_flag("--json", options->json, "print what was made as JSON");
  on_run(command, code, [options] { return run_import(*options); });
}

}  // namespace artus
