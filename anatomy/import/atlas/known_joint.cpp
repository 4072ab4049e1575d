// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/atlas/known_joint.h"

#include <algorithm>
#include <map>
#include <optional>

#include "artus/detail/anatomy/import/imported_joint.h"
#include "artus/detail/anatomy/import/structure_names.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_table.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kSkinMargin = 60 * kMillimetre;  // beyond the region of interest, of skin plates
constexpr const char* kSources = "sources.toml";

/// As plain_structure_name, without the word "muscle", which atlases add or leave out.
std::string bare_name(std::string_view name) {
  std::string padded = "_" + plain_structure_name(name) + "_";
  constexpr std::string_view kMuscle = "_muscle_";
  for (auto at = padded.find(kMuscle); at != std::string::npos; at = padded.find(kMuscle))
    padded.replace(at, kMuscle.size(), "_");
  return padded.size() > 2 ? padded.substr(1, padded.size() - 2) : std::string();
}

Eigen::AlignedBox3d read_box(TomlTable& toml) {
  Eigen::AlignedBox3d box;
  const toml::array* corners = toml.array("box");
  const auto corner = [&](std::size_t i) -> std::optional<Vec3> {
    const auto* place = corners->get_as<toml::array>(i);
    if (place == nullptr || place->size() != 3) return std::nullopt;
    Vec3 p;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto value = place->get(a)->value<double>();
      if (!value) return std::nullopt;
      p[static_cast<Eigen::Index>(a)] = *value * kMillimetre;
    }
    return p;
  };
  const auto low = corners != nullptr && corners->size() == 2 ? corner(0) : std::nullopt;
  const auto high = low ? corner(1) : std::nullopt;
  if (!high || !((*high - *low).minCoeff() > 0)) {
    toml.problem("box must be two corners, the lower first: [[x, y, z], [x, y, z]]");
    return box;
  }
  box.extend(*low);
  box.extend(*high);
  return box;
}

KnownSurface read_surface_table(const toml::table& table, Problems& problems) {
  KnownSurface surface;
  TomlTable toml(table, "surface", problems);
  surface.file = toml.required_text("file");
  surface.fma = static_cast<int>(toml.number("fma", 1, 1e9).value_or(0));
  surface.names = toml.required_texts("names");
  surface.box = read_box(toml);
  surface.near = toml.number("near", 0.1, 1000, kMillimetre).value_or(surface.near);
  toml.finish();
  return surface;
}

/// Whether "FMA23130" stands in a name, and no longer number.
bool has_number(std::string_view name, int fma) {
  const std::string number = "FMA" + std::to_string(fma);
  const auto at = name.find(number);
  if (fma == 0 || at == std::string_view::npos) return false;
  const std::size_t next = at + number.size();
  return next >= name.size() || name[next] < '0' || name[next] > '9';
}

std::string stem_of(const std::string& file) {
  return std::filesystem::path(file).stem().string();
}

std::string box_text(const Eigen::AlignedBox3d& box) {
  const Vec3 a = box.min() / kMillimetre;
  const Vec3 b = box.max() / kMillimetre;
  return printed("(%.0f, %.0f, %.0f) to (%.0f, %.0f, %.0f) mm", a.x(), a.y(), a.z(), b.x(), b.y(),
                 b.z());
}

Eigen::AlignedBox3d mesh_box(const SurfaceMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.vertices) box.extend(p);
  return box;
}

/// A part of a file that is one of the joint's surfaces.
struct Candidate {
  std::size_t surface = 0;
  std::string source;
  std::string by;
  SurfaceMesh mesh;  // as the file was read
  AtlasFrame frame;
  double apart = 0;  // m, of its corners in that frame
};

/// Takes the files one after the other.
class Finder {
 public:
  Finder(const KnownJoint& joint, double unit) : joint_(joint), unit_(unit) {
    for (const std::string& name : joint.skin_names) skin_names_.push_back(bare_name(name));
    for (const KnownSurface& s : joint.surfaces) {
      names_.emplace_back();
      for (const std::string& name : s.names) names_.back().push_back(bare_name(name));
    }
  }

  /// `must`: what is no surface is an error.
  Result<void> look_into(const std::filesystem::path& file, bool must) {
    const auto bytes = read_bytes(file);
    ARTUS_TRY(bytes);
    auto parts = read_scene_parts(*bytes, file.string(), unit_);
    if (!parts && !must) return {};
    ARTUS_TRY(parts);
    std::vector<Candidate> found;
    std::vector<SurfaceMesh> plates;
    for (ScenePart& part : *parts) {
      const std::string stem = file.stem().string();
      auto known = match(part.name, parts->size() == 1 ? stem : "");
      const std::string source = parts->size() == 1 ? file.filename().string()
                                                    : file.filename().string() + "#" + part.name;
      if (known) {
        known->source = source;
        known->mesh = std::move(part.mesh);
        found.push_back(std::move(*known));
      } else if (std::find(skin_names_.begin(), skin_names_.end(), bare_name(part.name)) !=
                 skin_names_.end()) {
        plates.push_back(std::move(part.mesh));
      } else if (has_number(stem, kSkinNumber) || bare_name(part.name) == "skin" ||
                 stem == stem_of(joint_.skin_file)) {
        skin_ = std::move(part.mesh);
      }
    }
    const AtlasFrame frame = frame_of(found, file);
    for (Candidate& c : found) place(std::move(c), frame);
    for (SurfaceMesh& plate : plates) add_plate(plate, frame);
    return {};
  }

  /// What was found, or what was not.
  Result<FoundJoint> finish() {
    std::string missing;
    std::size_t n_missing = 0;
    for (std::size_t i = 0; i < joint_.surfaces.size(); ++i) {
      const KnownSurface& surface = joint_.surfaces[i];
      const auto best = best_.find(i);
      if (best == best_.end()) {
        ++n_missing;
        missing += "\n  " + surface.file + ": " + surface.names.front() +
                   (surface.fma > 0 ? " (FMA" + std::to_string(surface.fma) + ")" : "");
        continue;
      }
      if (best->second.apart > surface.near) return refuse(surface, best->second);
      out_.surfaces.push_back({surface.file, best->second.source, best->second.by,
                               turned(best->second.mesh, best->second.frame)});
    }
    if (!joint_.skin_file.empty() && plates_.triangles.empty() && skin_.triangles.empty()) {
      ++n_missing;
      missing += "\n  " + joint_.skin_file + ": the skin's plates (regions of the body), or a skin";
    }
    if (n_missing > 0)
      return fail(ErrorCode::not_found,
                  printed("%zu of %zu surfaces are in none of the files:", n_missing,
                          joint_.surfaces.size() + (joint_.skin_file.empty() ? 0U : 1U)) +
                      missing,
                  joint_.folder.string());
    if (joint_.skin_file.empty()) return std::move(out_);
    out_.skin_is_plates = skin_.triangles.empty();
    out_.surfaces.push_back({joint_.skin_file, out_.skin_is_plates ? "plates of the skin" : "skin",
                             "name", out_.skin_is_plates ? plates_ : skin_});
    return std::move(out_);
  }

 private:
  static constexpr int kSkinNumber = 7163;  // in the Foundational Model of Anatomy

  [[nodiscard]] std::optional<Candidate> match(const std::string& part,
                                               const std::string& stem) const {
    for (const std::string& name : {part, stem})
      for (std::size_t i = 0; i < names_.size(); ++i)
        if (has_number(name, joint_.surfaces[i].fma))
          return Candidate{i, {}, "FMA" + std::to_string(joint_.surfaces[i].fma), {}, {}, 0};
    for (const std::string& name : {part, stem}) {
      const std::string side = side_of_name(name);
      if (name.empty() || (side != "none" && side != joint_.side)) continue;
      for (std::size_t i = 0; i < names_.size(); ++i)
        if (std::find(names_[i].begin(), names_[i].end(), bare_name(name)) != names_[i].end())
          return Candidate{i, {}, "name '" + bare_name(name) + "'", {}, {}, 0};
    }
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (!stem.empty() && stem == stem_of(joint_.surfaces[i].file))
        return Candidate{i, {}, "the joint's own name", {}, {}, 0};
    return std::nullopt;
  }

  AtlasFrame frame_of(const std::vector<Candidate>& found, const std::filesystem::path& file) {
    std::vector<KnownBox> boxes;
    for (const Candidate& c : found) {
      const KnownSurface& s = joint_.surfaces[c.surface];
      boxes.push_back({s.box, mesh_box(c.mesh), s.near});
    }
    const std::string kind = file.extension().string();
    const auto frame = find_atlas_frame(boxes);
    if (!frame) return frame_of_kind_[kind];
    if (!frame->is_identity())
      out_.notes.push_back(file.filename().string() + ": " + frame->to_string());
    return frame_of_kind_[kind] = *frame;
  }

  void place(Candidate candidate, const AtlasFrame& frame) {
    const KnownSurface& surface = joint_.surfaces[candidate.surface];
    const KnownBox box{surface.box, mesh_box(candidate.mesh), surface.near};
    candidate.frame = frame;
    candidate.apart = corners_apart(frame, box);
    if (candidate.apart > surface.near) {
      if (const auto own = find_atlas_frame({box})) {
        out_.notes.push_back(candidate.source + ": " + own->to_string() + ", unlike its file");
        candidate.frame = *own;
        candidate.apart = corners_apart(*own, box);
      }
    }
    const auto [at, is_new] = best_.try_emplace(candidate.surface, candidate);
    if (is_new) return;
    const bool better = candidate.apart < at->second.apart;
    out_.notes.push_back(
        surface.file + " is there twice: " + (better ? candidate.source : at->second.source) +
        " is taken, " + (better ? at->second.source : candidate.source) + " is not");
    if (better) at->second = std::move(candidate);
  }

  static SurfaceMesh turned(SurfaceMesh mesh, const AtlasFrame& frame) {
    for (Vec3& p : mesh.vertices) p = frame.apply(p);
    return mesh;
  }

  void add_plate(SurfaceMesh plate, const AtlasFrame& frame) {
    plate = turned(std::move(plate), frame);
    if (mesh_box(plate).exteriorDistance(joint_.centre) > joint_.radius + kSkinMargin) return;
    const auto first = static_cast<std::uint32_t>(plates_.vertices.size());
    plates_.vertices.insert(plates_.vertices.end(), plate.vertices.begin(), plate.vertices.end());
    for (const Triangle& t : plate.triangles)
      plates_.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }

  [[nodiscard]] tl::unexpected<Error> refuse(const KnownSurface& surface,
                                             const Candidate& c) const {
    return fail(ErrorCode::invalid,
                "it is at " + box_text(mesh_box(c.mesh)) + ", and '" + surface.names.front() +
                    "' of this joint at " + box_text(surface.box) +
                    "; in no unit and axes is that the same: another body, or another part of it",
                c.source);
  }

  const KnownJoint& joint_;
  double unit_;
  std::vector<std::vector<std::string>> names_;  // of each surface, bare
  std::vector<std::string> skin_names_;
  std::map<std::size_t, Candidate> best_;
  std::map<std::string, AtlasFrame> frame_of_kind_;  // by ending, of files without known boxes
  SurfaceMesh plates_;
  SurfaceMesh skin_;
  FoundJoint out_;
};

}  // namespace

Result<KnownJoint> read_known_joint(const std::filesystem::path& folder) {
  const auto text = read_bytes(folder / kSources);
  if (!text)
    return fail(ErrorCode::not_found,
                "there is no sources.toml, which says what its surfaces are called in an atlas; "
                "real-shoulder has one",
                folder.string());
  const std::string name = (folder / kSources).string();
  const auto document = parse_toml(*text, name);
  ARTUS_TRY(document);
  const auto joint_text = read_bytes(folder / "joint.toml");
  ARTUS_TRY(joint_text);
  const auto joint_document = parse_toml(*joint_text, (folder / "joint.toml").string());
  ARTUS_TRY(joint_document);
  KnownJoint joint;
  joint.folder = folder;
  joint.side = (*joint_document)["side"].value_or(std::string("none"));
  const auto region = (*joint_document)["region_of_interest"];
  for (Eigen::Index a = 0; a < 3; ++a)
    joint.centre[a] = region["centre"][static_cast<std::size_t>(a)].value_or(0.0) * kMillimetre;
  joint.radius = region["radius"].value_or(1e6) * kMillimetre;
  Problems problems;
  TomlTable toml(*document, "file", problems);
  joint.credits = toml.required_texts("credits");
  if (const auto* table = toml.table("skin")) {
    TomlTable skin(*table, "skin", problems);
    joint.skin_file = skin.required_text("file");
    joint.skin_names = skin.required_texts("names");
    skin.finish();
  }
  for (const auto* table : toml.tables("surface"))
    joint.surfaces.push_back(read_surface_table(*table, problems));
  toml.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
  return joint;
}

Result<FoundJoint> find_known_joint(const KnownJoint& joint,
                                    const std::vector<std::filesystem::path>& files, double unit,
                                    const Progress& progress) {
  std::vector<std::pair<std::filesystem::path, bool>> all;
  for (const auto& file : files) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(file, ignored)) {
      all.emplace_back(file, true);
      continue;
    }
    std::vector<std::filesystem::path> in;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(file, ignored))
      if (entry.is_regular_file(ignored)) in.push_back(entry.path());
    std::sort(in.begin(), in.end());
    for (auto& path : in) all.emplace_back(std::move(path), false);
  }
  if (all.empty()) return fail(ErrorCode::invalid, "no file is named");
  Finder finder(joint, unit);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (progress)
      progress("looking into " + all[i].first.filename().string(),
               static_cast<double>(i) / static_cast<double>(all.size()));
    ARTUS_TRY(finder.look_into(all[i].first, all[i].second));
  }
  return finder.finish();
}

Result<void> write_known_joint(const KnownJoint& joint, const FoundJoint& found,
                               const std::filesystem::path& folder, bool replace) {
  ARTUS_TRY(may_write_joint(folder, replace));
  const auto file = folder / "joint.toml";
  std::error_code ignored;
  const auto text = read_bytes(joint.folder / "joint.toml");
  ARTUS_TRY(text);
  std::string toml = *text;
  if (found.skin_is_plates) {
    const std::string skin = "file = \"" + joint.skin_file + "\"";
    const auto at = toml.find(skin);
    if (at != std::string::npos) toml.insert(at + skin.size(), "\nrepair = \"wrap\"");
  }
  ARTUS_TRY(write_text(file, toml));
  std::string credits;
  for (const std::string& line : joint.credits) credits += line + "\n";
  ARTUS_TRY(write_text(folder / "CREDITS.txt", credits));
  std::filesystem::create_directories(folder / "surfaces", ignored);
  for (const FoundSurface& s : found.surfaces)
    ARTUS_TRY(write_surface(s.mesh, folder / "surfaces" / s.file, kMillimetre));
  return {};
}

}  // namespace artus
