// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/imported_joint.h"

#include <algorithm>
#include <map>
#include <set>

#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr const char* kSurfaces = "surfaces";
constexpr const char* kDermisName = "skin";
constexpr double kFilm = 0.25;  // of a voxel: narrower gaps between neighbours are none
constexpr double kFilmOfCells = 0.02 * kMillimetre;  // where neighbours share their vertices

/// Text in quotes of TOML.
std::string in_quotes(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else
      out += u < 0x20 || u == 0x7f ? ' ' : c;
  }
  return out + "\"";
}

/// A comment in one line.
std::string comment(const std::string& text) {
  std::string out = "# ";
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    out += u < 0x20 || u == 0x7f ? ' ' : c;
  }
  return out + "\n";
}

std::string head_of(const ImportedJoint& joint) {
  std::string out = comment("Made by `artus import` from " + joint.title + " (" + joint.format +
                            "); the report tells the rest.");
  for (const std::string& text : joint.assumed) out += comment("assumed: " + text);
  for (const auto& s : joint.left_out) out += comment("left out: '" + s.source + "': " + s.by);
  out += "format = 1\nname = \"" + joint.name + "\"\ntitle = " + in_quotes(joint.title) + "\n";
  out += "side = \"" + joint.side + "\"\nunits = \"mm\"\naxes = \"LPS\"\nsurfaces = \"";
  out += kSurfaces;
  out += "\"\n\n";
  // Coarser voxels have nothing finer to say.
  const double distance = std::clamp(joint.voxel / 3, 0.15 * kMillimetre, 0.4 * kMillimetre);
  out += printed("[mesh]\nfacet_size = 2.5\nfacet_distance = %.2f\ncell_size = 6.0\n\n",
                 distance / kMillimetre);
  if (joint.is_partition) {
    out += "[partition.labels]  # structures that share their borders\n";
    if (joint.voxel > 0)
      out += printed("film = %.4f  # a quarter of a voxel\n\n", kFilm * joint.voxel / kMillimetre);
    else
      out += printed("film = %.4f\n\n", kFilmOfCells / kMillimetre);
  }
  return out;
}

/// Surfaces of voxels are closed by construction.
bool is_clean(const ImportedJoint& joint) {
  return joint.is_partition && joint.voxel > 0;
}

std::string surface_of(const ImportedJoint& joint, const ImportedStructure& s) {
  std::string out = "\n" + comment(s.source + ": " + s.by);
  out += "[[structure]]\nname = \"" + s.name + "\"\ntissue = \"" + s.tissue + "\"\nfile = \"" +
         s.name + ".ply\"\n";
  if (is_clean(joint) && !s.is_swept) out += "repair = \"none\"\n";
  if (joint.is_partition && !s.is_swept) out += "partition = \"labels\"\n";
  return out;
}

std::string made_of(const ImportedJoint& joint) {
  std::string out;
  for (const AssumedStructure& s : joint.made)
    out += "\n[[structure]]  # assumed\nname = \"" + s.name + "\"\ntissue = \"" + s.tissue +
           "\"\n" + s.shape + "\n";
  return out;
}

std::string place_of(const Vec3& p) {
  return printed("[%.2f, %.2f, %.2f]", p.x() / kMillimetre, p.y() / kMillimetre,
                 p.z() / kMillimetre);
}

}  // namespace

std::string to_joint_toml(const ImportedJoint& joint) {
  std::string out = head_of(joint);
  if (joint.region) {
    out += comment("assumed: " + joint.region->by + "; as large as holds the skin there");
    out += "[region_of_interest]\ncentre = " + place_of(joint.region->centre) +
           printed("\nradius = %.1f\n\n", joint.region->radius / kMillimetre);
  }
  out += comment("outline: " + joint.body_by);
  out += "[body]\nfile = \"body.ply\"\nfiller = \"subcutaneous_fat\"\ntissue = \"fat\"\n";
  if (is_clean(joint)) out += "repair = \"none\"\n";
  if (!joint.cuts.triangles.empty()) out += "cuts = \"body_cuts.ply\"\n";
  if (!joint.has_skin)
    out += std::string("\n[[structure]]  # assumed\nname = \"") + kDermisName +
           "\"\ntissue = \"skin\"\nshell = { thickness = 1.8 }\n";
  for (std::size_t i = 0; i < joint.structures.size(); ++i) {
    if (i == joint.n_before_made) out += made_of(joint);
    out += surface_of(joint, joint.structures[i]);
  }
  if (joint.n_before_made >= joint.structures.size()) out += made_of(joint);
  if (joint.region)
    out += "\n[[landmark]]\nname = \"joint_centre\"\nposition = " + place_of(joint.region->centre) +
           "\n";
  return out;
}

Result<void> may_write_joint(const std::filesystem::path& folder, bool replace) {
  const auto file = folder / "joint.toml";
  std::error_code ignored;
  if (!replace && std::filesystem::exists(file, ignored))
    return fail(ErrorCode::invalid,
                "there is a joint here already; name another folder, or replace it by --replace",
                file.string());
  return {};
}

Result<void> write_imported_joint(const ImportedJoint& joint, const std::filesystem::path& folder,
                                  bool replace) {
  ARTUS_TRY(may_write_joint(folder, replace));
  const auto file = folder / "joint.toml";
  std::error_code ignored;
  ARTUS_TRY(write_text(file, to_joint_toml(joint)));
  const auto surfaces = folder / kSurfaces;
  std::filesystem::create_directories(surfaces, ignored);
  ARTUS_TRY(write_surface(joint.body, surfaces / "body.ply", kMillimetre));
  if (!joint.cuts.triangles.empty())
    ARTUS_TRY(write_surface(joint.cuts, surfaces / "body_cuts.ply", kMillimetre));
  for (const ImportedStructure& s : joint.structures)
    ARTUS_TRY(write_surface(s.mesh, surfaces / (s.name + ".ply"), kMillimetre));
  return {};
}

std::string joint_name_of(const std::filesystem::path& file) {
  std::string stem = file.filename().string();
  stem = stem.substr(0, stem.find('.'));
  std::string name = plain_structure_name(stem);
  std::replace(name.begin(), name.end(), '_', '-');
  return name.empty() ? "joint" : name;
}

void name_structures(ImportedJoint& joint) {
  std::set<std::string> sides;
  std::map<std::string, std::set<std::string>> sides_of;
  for (const ImportedStructure& s : joint.structures) {
    const std::string side = side_of_name(s.source);
    if (side != "none") sides.insert(side);
    sides_of[plain_structure_name(s.source)].insert(side);
  }
  if (joint.side.empty()) {
    joint.side = sides.size() == 1 ? *sides.begin() : "none";
    if (sides.size() > 1)
      joint.notes.push_back(
          "it holds structures of both sides; --side left or right names the one "
          "that is meant");
  }
  std::set<std::string> taken{"outside", "beyond", "body", "subcutaneous_fat"};
  if (!joint.has_skin) taken.insert(kDermisName);
  for (ImportedStructure& s : joint.structures) {
    std::string plain = plain_structure_name(s.source);
    if (const auto side = side_of_name(s.source); sides_of[plain].size() > 1 && side != "none")
      plain += "_" + side;
    if (plain.empty()) plain = printed("label_%.0f", s.value);
    std::string name = plain;
    for (int k = 2; !taken.insert(name).second; ++k) name = plain + "_" + std::to_string(k);
    s.name = std::move(name);
  }
}

}  // namespace artus
