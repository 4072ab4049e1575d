// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/joint_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <set>

#include "artus/detail/anatomy/body/tissue_toml.h"
#include "artus/detail/anatomy/source/joint_parameter_toml.h"
#include "artus/detail/anatomy/source/joint_pose_toml.h"
#include "artus/detail/anatomy/source/joint_shape.h"
#include "artus/detail/anatomy/source/joint_space_toml.h"
#include "artus/detail/anatomy/source/joint_structure.h"
#include "artus/detail/anatomy/source/joint_variant_toml.h"
#include "artus/detail/anatomy/source/joint_view_toml.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kLargestCoordinate = 1e6;  // units of the file
constexpr double kDefaultFacetSize = 2.0 * kMillimetre;
constexpr double kDefaultFacetDistance = 0.15 * kMillimetre;
constexpr double kDefaultCellSize = 5.0 * kMillimetre;

/// The direction of an axis letter in LPS, +1, +2, +3 or their negatives; 0: no such letter.
int lps_axis(char letter) noexcept {
  switch (letter) {
    case 'L':
      return 1;
    case 'R':
      return -1;
    case 'P':
      return 2;
    case 'A':
      return -2;
    case 'S':
      return 3;
    case 'I':
      return -3;
    default:
      return 0;
  }
}

/// Three letters, one of each pair, that make a right-handed frame.
bool is_right_handed_frame(const std::string& axes) {
  if (axes.size() != 3) return false;
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const int a = lps_axis(axes[static_cast<std::size_t>(k)]);
    if (a == 0) return false;
    m(std::abs(a) - 1, k) = a > 0 ? 1 : -1;
  }
  return m.determinant() > 0.5;
}

int line_of(const toml::table& table) {
  return static_cast<int>(table.source().begin.line);
}

void read_identity(TomlTable& toml, JointFile& joint) {
  if (toml.required_number("format", 1, 1) == 0 && toml.has("format"))
    toml.problem_at("format", "is of another version of artus; this one reads 1");
  joint.name = toml.required_text("name");
  if (!joint.name.empty() && !is_plain_name(joint.name, '-'))
    toml.problem_at("name", "may contain only a-z, 0-9 and -");
  joint.title = toml.text("title").value_or(joint.name);
  joint.side = toml.text("side").value_or("none");
  if (joint.side != "left" && joint.side != "right" && joint.side != "none")
    toml.problem_at("side", "must be \"left\", \"right\" or \"none\"");
  joint.axes = toml.required_text("axes");
  if (!joint.axes.empty() && !is_right_handed_frame(joint.axes))
    toml.problem_at("axes",
                    "must be three letters, one of L/R, P/A and S/I each, of a right-handed frame "
                    "(\"LPS\" or \"RAS\", for example)");
}

void read_mesh_sizes(TomlTable& toml, double unit, JointFile& joint) {
  joint.facet_size = kDefaultFacetSize;
  joint.facet_distance = kDefaultFacetDistance;
  joint.cell_size = kDefaultCellSize;
  const auto* table = toml.table("mesh");
  if (table == nullptr) return;
  TomlTable mesh(*table, "mesh", toml.problems());
  const auto read = [&](const char* key, double& size) {
    const auto value = mesh.number(key, 0, kLargestCoordinate, unit);
    if (value && *value == 0) mesh.problem_at(key, "must be greater than 0");
    size = value.value_or(size);
  };
  read("facet_size", joint.facet_size);
  read("facet_distance", joint.facet_distance);
  read("cell_size", joint.cell_size);
  mesh.finish();
}

void read_region(TomlTable& toml, double unit, JointFile& joint) {
  const auto* table = toml.table("region_of_interest");
  if (table == nullptr) return;
  TomlTable region(*table, "region_of_interest", toml.problems());
  RegionOfInterest roi;
  roi.centre = required_place(region, "centre", unit);
  roi.radius = region.number("radius", 0, kLargestCoordinate, unit).value_or(0);
  roi.half_extent = region.vector("half_extent", unit);
  if (region.has("radius") == region.has("half_extent"))
    region.problem("needs either 'radius' (a ball) or 'half_extent' (a box)");
  else if (region.has("radius") ? !(roi.radius > 0)
                                : roi.half_extent && !(roi.half_extent->minCoeff() > 0))
    region.problem("must have a size greater than 0");
  else if (std::max(roi.radius, roi.half_extent.value_or(Vec3::Zero()).maxCoeff()) > kFarthestPlace)
    region.problem("is larger than 10 m; give its size in the unit of the file, or leave it out");
  region.finish();
  joint.region_of_interest = roi;
}

void read_landmarks(TomlTable& toml, double unit, JointFile& joint) {
  for (const auto* table : toml.tables("landmark")) {
    TomlTable landmark(*table, "landmark", toml.problems());
    Landmark out;
    out.name = landmark.required_text("name");
    out.position = required_place(landmark, "position", unit);
    landmark.finish();
    const bool is_taken = std::any_of(joint.landmarks.begin(), joint.landmarks.end(),
                                      [&](const Landmark& l) { return l.name == out.name; });
    if (is_taken && !out.name.empty()) landmark.problem_at("name", "is already used");
    joint.landmarks.push_back(std::move(out));
  }
}

void read_probe(TomlTable& toml, double unit, JointFile& joint) {
  const auto* table = toml.table("probe");
  if (table == nullptr) return;
  TomlTable probe(*table, "probe", toml.problems());
  joint.probe_line = line_of(*table);
  joint.X_JP_default = read_probe_pose(probe, unit);
}

/// Entry and target of a needle pass, which must be two points.
void read_pass(TomlTable& pass, double unit, Vec3& entry, Vec3& target) {
  entry = required_place(pass, "entry", unit);
  target = required_place(pass, "target", unit);
  if (pass.has("entry") && pass.has("target") && (target - entry).norm() < 1e-9)
    pass.problem("'entry' and 'target' must not be the same point");
}

void read_needles(TomlTable& toml, double unit, JointFile& joint) {
  if (const auto* table = toml.table("needle")) {
    TomlTable needle(*table, "needle", toml.problems());
    PlannedInjection pass;
    pass.line = line_of(*table);
    read_pass(needle, unit, pass.entry, pass.target);
    needle.finish();
    const Vec3 displacement = pass.target - pass.entry;
    if (displacement.norm() > 0)
      joint.X_JN_default = make_pose(pass.target, displacement, Vec3::Zero());
    joint.needle = std::move(pass);
  }
  for (const auto* table : toml.tables("injection")) {
    TomlTable toml_pass(*table, "injection", toml.problems());
    PlannedInjection pass;
    pass.line = line_of(*table);
    pass.name = toml_pass.required_text("name");
    read_pass(toml_pass, unit, pass.entry, pass.target);
    const bool is_taken =
        std::any_of(joint.injections.begin(), joint.injections.end(),
                    [&](const PlannedInjection& other) { return other.name == pass.name; });
    if (is_taken && !pass.name.empty()) toml_pass.problem_at("name", "is already used");
    toml_pass.finish();
    joint.injections.push_back(std::move(pass));
  }
}

void read_structures(TomlTable& toml, double unit, JointFile& joint) {
  if (const auto* body = toml.table("body"))
    joint.body = read_body(*body, unit, joint.filler_name, toml.problems());
  else
    toml.problem("[body] is missing: every joint needs the closed outer skin");
  std::vector<toml::source_region> places;
  for (const auto* table : toml.tables("structure")) {
    joint.structures.push_back(
        read_structure(*table, joint.structures.size() + 1, unit, toml.problems()));
    places.push_back(table->source());
  }
  joint.partitions = read_partitions(toml, unit);
  if (joint.structures.empty()) toml.problem("there is no [[structure]]");
  check_structures(joint, places, toml.problems());
}

/// The library's tissues with the joint's own on top; a missing library is an error at once.
Result<void> read_joint_tissues(TomlTable& toml, JointFile& joint) {
  const auto library = toml.text("tissue_library");
  if (library) joint.tissue_library = joint.folder / *library;
  auto tissues = library ? read_tissues(joint.tissue_library) : read_bundled_tissues();
  ARTUS_TRY(tissues);
  joint.tissues = std::move(*tissues);
  if (const auto* table = toml.table("tissue"))
    merge_tissues(*table, "joint file of " + joint.name, joint.tissues, toml.problems());
  return {};
}

std::set<std::string, std::less<>> region_names(const JointFile& joint) {
  std::set<std::string, std::less<>> names{joint.filler_name};
  for (const Structure& s : joint.structures) names.insert(s.name);
  return names;
}

/// ARTUS_SURFACES_<NAME>, NAME in capitals with '-' as '_', without variants and patient.
std::string surfaces_variable(const std::string& joint_name) {
  std::string variable = "ARTUS_SURFACES_";
  for (const char c : joint_name.substr(0, joint_name.find_first_of("+@")))
    variable += c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return variable;
}

/// What the environment says there; empty when unset.
std::filesystem::path surfaces_of_environment(const std::string& joint_name) {
  const char* value = std::getenv(
      surfaces_variable(joint_name).c_str());  // NOLINT(concurrency-mt-unsafe): read at start
  return value == nullptr ? std::filesystem::path{} : std::filesystem::path{value};
}

void check_file(const JointFile& joint, const Structure& structure, Problems& problems) {
  const auto* surface = std::get_if<SurfaceFile>(&structure.shape);
  std::error_code ignored;
  if (surface != nullptr && !surface->file.empty() &&
      !std::filesystem::is_regular_file(joint.surface_folder / surface->file, ignored))
    problems.add(toml::source_region{}, "structure '" + structure.name + "': there is no file '" +
                                            surface->file.string() + "' in " +
                                            joint.surface_folder.string());
  if (surface != nullptr && !surface->cuts.empty() &&
      !std::filesystem::is_regular_file(joint.surface_folder / surface->cuts, ignored))
    problems.add(toml::source_region{}, "body: there is no file '" + surface->cuts.string() +
                                            "' of its cuts in " + joint.surface_folder.string());
}

Result<void> check_files(const JointFile& joint, const std::string& where) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(joint.surface_folder, ignored))
    return fail(ErrorCode::not_found,
                "the surface folder " + joint.surface_folder.string() +
                    " does not exist; name it with --surfaces DIR or " +
                    surfaces_variable(joint.name),
                where);
  Problems problems;
  check_file(joint, joint.body, problems);
  for (const auto& s : joint.structures) check_file(joint, s, problems);
  if (!problems.empty()) return problems.refusal(ErrorCode::not_found, where);
  return {};
}

}  // namespace

Result<JointFile> parse_joint(std::string_view text, const std::filesystem::path& path,
                              const std::filesystem::path& surface_folder) {
  const JointChoice choice = split_variants(path);
  const std::string where = (choice.folder / "joint.toml").string();
  auto document = parse_toml(text, where);
  ARTUS_TRY(document);
  Problems problems;
  JointFile joint;
  joint.folder = choice.folder;
  joint.parameters = read_parameters(*document, problems);
  auto patient = resolve_patient(choice.patient, joint.parameters);
  if (!patient) return fail(patient.error().code, patient.error().message, where);
  joint.patient = std::move(*patient);
  const std::vector<std::string> variants =
      apply_patient(*document, joint.patient, choice.variants, problems);
  joint.variants = choose_variants(*document, variants, choice.variants, problems);
  joint.shape = to_joint_shape(*document);
  TomlTable toml(*document, "joint", problems);
  read_identity(toml, joint);
  for (const std::string& variant : choice.variants) joint.name += "+" + variant;
  if (!joint.patient.empty()) joint.name += "@" + to_text(joint.patient);
  const double unit = length_unit(toml, "units", kMillimetre);
  if (!toml.has("units")) toml.problem("'units' is missing (\"mm\", \"cm\" or \"m\")");
  const auto surfaces = toml.text("surfaces").value_or(".");
  joint.surface_folder = surface_folder.empty() ? joint.folder / surfaces : surface_folder;
  ARTUS_TRY(read_joint_tissues(toml, joint));
  read_mesh_sizes(toml, unit, joint);
  read_region(toml, unit, joint);
  read_structures(toml, unit, joint);
  read_landmarks(toml, unit, joint);
  read_probe(toml, unit, joint);
  read_needles(toml, unit, joint);
  joint.poses = read_poses(toml, unit, joint);
  joint.views = read_views(toml, unit, joint);
  auto spaces = read_spaces(toml, region_names(joint));
  ARTUS_TRY(spaces);
  joint.spaces = std::move(*spaces);
  toml.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, where);
  return joint;
}

Result<JointFile> read_joint(const std::filesystem::path& joint_name,
                             const std::filesystem::path& surface_folder) {
  const std::filesystem::path path = find_joint(joint_name);
  const auto file = split_variants(path).folder / "joint.toml";
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  auto joint = parse_joint(*bytes, path, surface_folder);
  ARTUS_TRY(joint);
  if (surface_folder.empty())
    if (auto from_environment = surfaces_of_environment(joint->name); !from_environment.empty())
      joint->surface_folder = std::move(from_environment);
  ARTUS_TRY(check_files(*joint, file.string()));
  return joint;
}

}  // namespace artus
