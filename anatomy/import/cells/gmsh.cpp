// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "artus/detail/anatomy/import/cells/cell_types.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

constexpr const char* kOther =
    "save it as text of version 4.1 or 2.2 (gmsh FILE -save -format msh41 -o new.msh)";

/// Sections of a file one after the other, each number by number.
class GmshReader {
 public:
  GmshReader(std::string_view bytes, const std::string& name) : cursor_(bytes, name), name_(name) {}

  Result<VolumeMesh> run() {
    while (true) {
      const std::string_view section = cursor_.next();
      if (section.empty()) break;
      if (section == "$NOD" || section == "$ELM")
        return fail(ErrorCode::unsupported,
                    std::string("it is a mesh of Gmsh's version 1, which is not read; ") + kOther,
                    name_);
      Result<void> read;
      if (section == "$MeshFormat") read = read_format();
      if (section == "$PhysicalNames") read = read_names();
      if (section == "$Entities" && version_ >= 4) read = read_entities();
      if (section == "$Nodes") read = version_ >= 4 ? read_blocks_of_nodes() : read_nodes();
      if (section == "$Elements") read = version_ >= 4 ? read_blocks_of_cells() : read_cells();
      ARTUS_TRY(read);
    }
    if (mesh_.points.empty() || mesh_.cells.empty())
      return fail(ErrorCode::malformed, "it holds no cells, or is cut off; export it again", name_);
    choose_materials();
    return std::move(mesh_);
  }

 private:
  tl::unexpected<Error> broken() const {
    return cursor_.malformed("a number is missing or damaged here; export the mesh again");
  }
  /// The next number; NaN where there is none.
  double number() { return cursor_.next_number().value_or(std::nan("")); }
  /// A count of things that have at least two bytes each. nullopt: it cannot be.
  std::optional<std::size_t> count() {
    const auto n = cursor_.next_integer();
    if (!n || *n < 0 || static_cast<std::size_t>(*n) > cursor_.remaining() / 2 + 1)
      return std::nullopt;
    return static_cast<std::size_t>(*n);
  }

  Result<void> read_format() {
    version_ = number();
    const double is_binary = number();
    mesh_.format = printed("Gmsh %.2g", version_);
    if (is_binary != 0 || !(version_ == 2.2 || version_ == 4.1))
      return fail(ErrorCode::unsupported,
                  printed("it is a mesh of Gmsh's version %.2g%s, which is not read; ", version_,
                          is_binary == 1 ? ", binary" : "") +
                      kOther,
                  name_);
    return {};
  }

  Result<void> read_names() {
    const auto n = count();
    if (!n) return broken();
    for (std::size_t i = 0; i < *n; ++i) {
      const auto dimension = cursor_.next_integer();
      const auto tag = cursor_.next_integer();
      std::string text;
      for (auto word = cursor_.next_in_line(); !word.empty(); word = cursor_.next_in_line())
        text += (text.empty() ? "" : " ") + std::string(word);
      if (!dimension || !tag || text.size() < 2) return broken();
      if (*dimension == 3) mesh_.names[*tag] = text.substr(1, text.size() - 2);
    }
    return {};
  }

  /// Which physical group a volume is of.
  Result<void> read_entities() {
    std::array<std::size_t, 4> n{};
    for (auto& of : n) {
      const auto read = count();
      if (!read) return broken();
      of = *read;
    }
    for (std::size_t dimension = 0; dimension < 4; ++dimension)
      for (std::size_t i = 0; i < n.at(dimension); ++i) {
        const auto tag = cursor_.next_integer();
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) number();
        const auto n_groups = count();
        if (!tag || !n_groups) return broken();
        for (std::size_t k = 0; k < *n_groups; ++k) {
          const auto group = cursor_.next_integer();
          if (!group) return broken();
          if (dimension == 3 && k == 0) group_of_[*tag] = *group;
        }
        if (dimension == 0) continue;
        const auto n_around = count();
        if (!n_around) return broken();
        for (std::size_t k = 0; k < *n_around; ++k) number();
      }
    return {};
  }

  Result<void> add_point(std::int64_t tag) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = number();
    if (!p.allFinite()) return broken();
    place_of_[tag] = static_cast<double>(mesh_.points.size());
    mesh_.points.push_back(p);
    return {};
  }

  Result<void> read_nodes() {
    const auto n = count();
    if (!n) return broken();
    for (std::size_t i = 0; i < *n; ++i) {
      const auto tag = cursor_.next_integer();
      if (!tag) return broken();
      ARTUS_TRY(add_point(*tag));
    }
    return {};
  }

  Result<void> read_blocks_of_nodes() {
    const auto n_blocks = count();
    for (int k = 0; k < 3; ++k) number();
    if (!n_blocks) return broken();
    for (std::size_t b = 0; b < *n_blocks; ++b) {
      const auto dimension = cursor_.next_integer();
      number();
      const auto has_more = cursor_.next_integer();
      const auto n = count();
      if (!dimension || !has_more || !n) return broken();
      std::vector<std::int64_t> tags;
      for (std::size_t i = 0; i < *n; ++i) {
        const auto tag = cursor_.next_integer();
        if (!tag) return broken();
        tags.push_back(*tag);
      }
      for (const std::int64_t tag : tags) {
        ARTUS_TRY(add_point(tag));
        for (std::int64_t k = 0; *has_more == 1 && k < std::min<std::int64_t>(3, *dimension); ++k)
          number();
      }
    }
    return {};
  }

  /// The points of a cell, and the cell.
  Result<void> take_cell(int number_of_type, std::int64_t group, std::int64_t entity) {
    const auto type = find_cell_type(gmsh_cell_types(), number_of_type);
    if (!type)
      return cursor_.malformed(
          printed("elements of Gmsh's type %d are not read; save the mesh with order 1 or 2",
                  number_of_type));
    std::vector<double> points;
    for (std::uint32_t k = 0; k < type->n_points; ++k) {
      const auto tag = cursor_.next_integer();
      const auto at = tag ? place_of_.find(*tag) : place_of_.end();
      if (at == place_of_.end())
        return cursor_.malformed("an element names a node that the file does not have");
      points.push_back(at->second);
    }
    const std::size_t before = mesh_.cells.size();
    ARTUS_TRY(add_cell(mesh_, *type, points, group, cursor_.where()));
    if (mesh_.cells.size() > before) entities_.push_back(entity);
    return {};
  }

  Result<void> read_cells() {
    const auto n = count();
    if (!n) return broken();
    for (std::size_t i = 0; i < *n; ++i) {
      cursor_.next_integer();
      const auto type = cursor_.next_integer();
      const auto n_tags = count();
      if (!type || !n_tags) return broken();
      std::array<std::int64_t, 2> tags{0, 0};
      for (std::size_t k = 0; k < *n_tags; ++k) {
        const auto tag = cursor_.next_integer();
        if (!tag) return broken();
        if (k < 2) tags.at(k) = *tag;
      }
      ARTUS_TRY(take_cell(small(*type), tags[0], tags[1]));
    }
    return {};
  }

  Result<void> read_blocks_of_cells() {
    const auto n_blocks = count();
    for (int k = 0; k < 3; ++k) number();
    if (!n_blocks) return broken();
    for (std::size_t b = 0; b < *n_blocks; ++b) {
      const auto dimension = cursor_.next_integer();
      const auto entity = cursor_.next_integer();
      const auto type = cursor_.next_integer();
      const auto n = count();
      if (!dimension || !entity || !type || !n) return broken();
      const auto at = group_of_.find(*entity);
      const std::int64_t group = *dimension == 3 && at != group_of_.end() ? at->second : 0;
      for (std::size_t i = 0; i < *n; ++i) {
        cursor_.next_integer();
        ARTUS_TRY(take_cell(small(*type), group, *entity));
      }
    }
    return {};
  }

  static int small(std::int64_t type) {
    return type >= 0 && type < 1000 ? static_cast<int>(type) : -1;
  }

  /// Physical groups, or where there are none the volumes themselves.
  void choose_materials() {
    const bool has_groups =
        std::any_of(mesh_.cells.begin(), mesh_.cells.end(), [](const VolumeMesh::Cell& cell) {
          return cell.shape != CellShape::polygon && cell.material != 0;
        });
    mesh_.material_by = has_groups ? "physical groups" : "volumes";
    if (has_groups) return;
    for (std::size_t i = 0; i < mesh_.cells.size(); ++i) mesh_.cells[i].material = entities_[i];
  }

  TextCursor cursor_;
  const std::string& name_;
  double version_ = 0;
  VolumeMesh mesh_;
  std::unordered_map<std::int64_t, double> place_of_;  // of a node's tag
  std::unordered_map<std::int64_t, std::int64_t> group_of_;
  std::vector<std::int64_t> entities_;
};

}  // namespace

Result<VolumeMesh> parse_gmsh(std::string_view bytes, const std::string& name) {
  return GmshReader(bytes, name).run();
}

}  // namespace artus
