// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstring>
#include <filesystem>

#include "artus/detail/anatomy/import/scene_parts.h"
#include "artus/detail/anatomy/import/volumes/image_volume.h"
#include "artus/detail/anatomy/import/volumes/volume_text.h"
#include "artus/detail/anatomy/surfaces/foreign_format.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_lines.h"

namespace artus {
namespace {

/// Numbers and words of a legacy file, whose arrays are text or big-endian binary.
class LegacyReader {
 public:
  LegacyReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Result<SurfaceMesh> run() {
    ARTUS_TRY(read_head());
    while (true) {
      const std::string word = next_word();
      if (word.empty()) break;
      if (word == "POINTS") {
        ARTUS_TRY(read_points());
      } else if (word == "POLYGONS" || word == "TRIANGLE_STRIPS") {
        ARTUS_TRY(read_cells(word == "TRIANGLE_STRIPS"));
      } else if (word == "POINT_DATA" || word == "CELL_DATA") {
        break;
      } else {
        skip_line();
      }
    }
    if (mesh_.vertices.empty() || mesh_.triangles.empty())
      return fail(ErrorCode::malformed, "it holds no polygons; export the surface again", name_);
    return std::move(mesh_);
  }

 private:
  tl::unexpected<Error> broken(const char* what) const {
    return fail(ErrorCode::corrupt,
                std::string("its ") + what + " are not complete or damaged; export it again",
                name_);
  }

  Result<void> read_head() {
    for (int line = 0; line < 2; ++line) skip_line();
    const std::string form = next_word();
    binary_ = form == "BINARY";
    if (!binary_ && form != "ASCII")
      return fail(ErrorCode::malformed, "the third line of a VTK file is ASCII or BINARY", name_);
    if (next_word() != "DATASET" || next_word() != "POLYDATA")
      return fail(ErrorCode::unsupported,
                  "it is no surface (DATASET POLYDATA); export the surface (ParaView: Extract "
                  "Surface)",
                  name_);
    return {};
  }

  std::string next_word() {
    while (at_ < bytes_.size() && static_cast<unsigned char>(bytes_[at_]) <= ' ') ++at_;
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && static_cast<unsigned char>(bytes_[at_]) > ' ') ++at_;
    return std::string(bytes_.substr(begin, std::min(at_ - begin, std::size_t{64})));
  }
  void skip_line() {
    const auto end = bytes_.find('\n', at_);
    at_ = end == std::string_view::npos ? bytes_.size() : end + 1;
  }
  std::size_t next_count() { return whole_of(parse_number(next_word()).value_or(0)); }

  /// `n` numbers of a type by VTK's name. Errors: corrupt, unsupported.
  Result<std::vector<double>> read_array(std::size_t n, const std::string& type) {
    std::vector<double> values;
    if (!binary_) {
      if (n > bytes_.size()) return broken("arrays");
      values.reserve(n);
      for (std::size_t i = 0; i < n; ++i) {
        const auto value = parse_number(next_word());
        if (!value) return broken("arrays");
        values.push_back(*value);
      }
      return values;
    }
    skip_line();
    if (type == "float") return read_binary<float>(n);
    if (type == "double") return read_binary<double>(n);
    if (type == "int") return read_binary<std::int32_t>(n);
    if (type == "vtktypeint64" || type == "long") return read_binary<std::int64_t>(n);
    return fail(ErrorCode::unsupported, "arrays of this type are not read: " + type, name_);
  }
  template <class T>
  Result<std::vector<double>> read_binary(std::size_t n) {
    if (n > (bytes_.size() - at_) / sizeof(T)) return broken("arrays");
    std::string raw(bytes_.substr(at_, n * sizeof(T)));
    at_ += raw.size();
    swap_bytes(raw, sizeof(T));
    std::vector<T> typed(n);
    if (n > 0) std::memcpy(typed.data(), raw.data(), raw.size());
    return std::vector<double>(typed.begin(), typed.end());
  }

  Result<void> read_points() {
    const std::size_t n = next_count();
    const auto values = read_array(3 * n, to_lower(next_word()));
    ARTUS_TRY(values);
    for (std::size_t i = 0; i < n; ++i)
      mesh_.vertices.emplace_back((*values)[3 * i], (*values)[3 * i + 1], (*values)[3 * i + 2]);
    return {};
  }

  /// Up to version 4 "n size" and counts among indices; from 5 on offsets and connectivity.
  Result<void> read_cells(bool strips) {
    const std::size_t n = next_count();
    const std::size_t size = next_count();
    const std::size_t here = at_;
    if (next_word() == "OFFSETS") {
      const auto offsets = read_array(n, to_lower(next_word()));
      ARTUS_TRY(offsets);
      if (next_word() != "CONNECTIVITY") return broken("polygons");
      const auto indices = read_array(size, to_lower(next_word()));
      ARTUS_TRY(indices);
      for (std::size_t i = 0; i + 1 < offsets->size(); ++i)
        ARTUS_TRY(add_cell(*indices, (*offsets)[i], (*offsets)[i + 1], strips));
      return {};
    }
    at_ = here;
    const auto all = read_array(size, "int");
    ARTUS_TRY(all);
    std::size_t at = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (at >= all->size()) return broken("polygons");
      const double count = (*all)[at];
      const auto first = static_cast<double>(at + 1);
      ARTUS_TRY(add_cell(*all, first, first + count, strips));
      at += 1 + static_cast<std::size_t>(count);
    }
    return {};
  }

  Result<void> add_cell(const std::vector<double>& indices, double first, double last,
                        bool strips) {
    if (!(first >= 0 && last >= first && last <= static_cast<double>(indices.size())))
      return broken("polygons");
    std::vector<std::uint32_t> cell;
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
      const double v = indices[i];
      if (!(v >= 0 && v < static_cast<double>(mesh_.vertices.size()))) return broken("polygons");
      cell.push_back(static_cast<std::uint32_t>(v));
    }
    for (std::size_t i = 0; i + 2 < cell.size(); ++i) {
      if (!strips)
        mesh_.triangles.push_back({cell[0], cell[i + 1], cell[i + 2]});
      else if (i % 2 == 0)
        mesh_.triangles.push_back({cell[i], cell[i + 1], cell[i + 2]});
      else
        mesh_.triangles.push_back({cell[i + 1], cell[i], cell[i + 2]});
    }
    return {};
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  bool binary_ = false;
  SurfaceMesh mesh_;
};

}  // namespace

Result<ScenePart> parse_vtk(std::string_view bytes, const std::string& name, double unit) {
  const std::string advice = advice_for_format(bytes, name);
  if (advice.find("volume mesh") != std::string::npos)
    return fail(ErrorCode::unsupported, advice, name);
  if (foreign_format(bytes, name) != "VTK")
    return fail(ErrorCode::unsupported, "it is no legacy file of VTK (# vtk DataFile)", name);
  auto mesh = LegacyReader(bytes, name).run();
  ARTUS_TRY(mesh);
  const std::string_view head = bytes.substr(0, 512);
  const bool is_ras = head.find("SPACE=RAS") != std::string_view::npos;
  const bool is_lps = head.find("SPACE=LPS") != std::string_view::npos;
  const double turn = is_ras ? -1 : 1;
  for (Vec3& p : mesh->vertices) p = unit * Vec3(turn * p.x(), turn * p.y(), p.z());
  ScenePart part{std::filesystem::path(name).stem().string(), std::move(*mesh), {}};
  if (is_ras) part.notes.push_back("its header says SPACE=RAS: turned to LPS");
  if (!is_ras && !is_lps) part.notes.push_back("its header names no frame: taken for LPS");
  return part;
}

}  // namespace artus
