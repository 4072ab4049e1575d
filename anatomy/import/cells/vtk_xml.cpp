// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/anatomy/import/cells/cell_types.h"
#include "artus/detail/anatomy/import/cells/xml_arrays.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

using Numbers = std::vector<double>;

/// Names that programs give to the number of a cell's material.
constexpr std::array<const char*, 12> kMaterialNames{
    "material", "Material",  "MaterialIds", "gmsh:physical", "medit:ref",     "label",
    "labels",   "ModelPart", "region",      "tissue",        "CellEntityIds", "part"};

/// The arrays of one Piece.
struct Piece {
  Numbers points;
  Numbers connectivity, offsets, types;
  std::vector<std::pair<std::string, Numbers>> cell_data;  ///< of one whole number each
};

class VtkXmlReader {
 public:
  VtkXmlReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Result<VolumeMesh> run() {
    ARTUS_TRY(read_head());
    std::string group;  // Points, Cells, Polys, Strips, CellData
    std::size_t at = 0;
    Piece piece;
    while (const auto tag = next_tag(bytes_.substr(0, end_), at)) {
      if (tag->name == "Piece" && !tag->is_empty) {
        if (tag->is_end) ARTUS_TRY(add_piece(piece));
        piece = {};
      } else if (tag->name != "DataArray") {
        group = tag->is_end || tag->is_empty ? std::string() : tag->name;
      } else if (!tag->is_end) {
        ARTUS_TRY(read_array(*tag, group, at, piece));
      }
    }
    if (mesh_.points.empty() || mesh_.cells.empty())
      return fail(ErrorCode::malformed, "it holds no cells; export it again", name_);
    if (mesh_.material_by.empty() && mesh_.has_volume())
      mesh_.notes.push_back("no array of its cells names a material: it is taken as one");
    return std::move(mesh_);
  }

 private:
  /// What kind of file it is, and where its appended data are.
  Result<void> read_head() {
    std::size_t at = 0;
    auto tag = next_tag(bytes_, at);
    if (!tag || tag->name != "VTKFile")
      return fail(ErrorCode::malformed, "it is no file of VTK's XML form", name_);
    const std::string type = tag->attribute("type");
    is_surface_ = type == "PolyData";
    if (!is_surface_ && type != "UnstructuredGrid")
      return fail(
          ErrorCode::unsupported,
          "its data are " + artus::quoted(type) +
              ", not an unstructured grid or a surface; save it as .vtu or .vtp (ParaView), "
              "and a volume of voxels as .mha or .nrrd",
          name_);
    mesh_.format = is_surface_ ? "VTK surface (XML)" : "VTK grid (XML)";
    form_.is_big_endian = tag->attribute("byte_order") == "BigEndian";
    form_.has_long_header = tag->attribute("header_type") == "UInt64";
    const std::string compressor = tag->attribute("compressor");
    form_.is_compressed = !compressor.empty();
    if (form_.is_compressed && compressor != "vtkZLibDataCompressor")
      return fail(ErrorCode::unsupported,
                  "it is compressed by " + artus::quoted(compressor) +
                      "; save it with zlib or without compression (ParaView: Compressor Type)",
                  name_);
    end_ = bytes_.find("<AppendedData");
    if (end_ == std::string_view::npos) {
      end_ = bytes_.size();
      return {};
    }
    at = end_;
    tag = next_tag(bytes_, at);
    const auto mark = bytes_.find('_', at);
    if (tag && mark != std::string_view::npos) {
      form_.appended = bytes_.substr(mark + 1);
      form_.appended_is_raw = tag->attribute("encoding") == "raw";
    }
    return {};
  }

  Result<void> read_array(const XmlTag& tag, const std::string& group, std::size_t& at,
                          Piece& piece) {
    const auto close = tag.is_empty ? at : bytes_.find("</DataArray", at);
    if (close == std::string_view::npos)
      return fail(ErrorCode::corrupt, "the file is cut off within an array; export it again",
                  name_);
    const std::string_view text = bytes_.substr(at, close - at);
    at = close;
    const std::string array = tag.attribute("Name");
    Numbers* to = nullptr;
    if (group == "Points") to = &piece.points;
    if (group == "Cells" || (is_surface_ && group == "Polys")) {
      if (array == "connectivity") to = &piece.connectivity;
      if (array == "offsets") to = &piece.offsets;
      if (array == "types") to = &piece.types;
    }
    const std::string parts = tag.attribute("NumberOfComponents");
    const bool is_whole = tag.attribute("type").find("Int") != std::string::npos;
    if (group == "CellData" && !is_surface_ && is_whole && (parts.empty() || parts == "1")) {
      piece.cell_data.emplace_back(array, Numbers());
      to = &piece.cell_data.back().second;
    }
    if (group == "Strips" && array == "connectivity") has_strips_ = true;
    if (to == nullptr) return {};
    auto numbers = read_xml_array(tag, text, form_, name_ + ": array '" + array + "'");
    ARTUS_TRY(numbers);
    *to = std::move(*numbers);
    return {};
  }

  /// A number of a cell as a whole one; -1 where it is none that a file would mean.
  static std::int64_t whole(double value) {
    constexpr double kMost = 1e9;
    return std::abs(value) <= kMost ? static_cast<std::int64_t>(value) : -1;
  }

  /// The array that says the material; null when there is none.
  const Numbers* find_material(const Piece& piece) {
    for (const char* known : kMaterialNames)
      for (const auto& [array, numbers] : piece.cell_data)
        if (array == known) {
          mesh_.material_by = array;
          return &numbers;
        }
    if (piece.cell_data.size() != 1) return nullptr;
    mesh_.material_by = piece.cell_data.front().first;
    return &piece.cell_data.front().second;
  }

  Result<void> add_piece(const Piece& piece) {
    const double before = static_cast<double>(mesh_.points.size());
    if (piece.points.size() % 3 != 0)
      return fail(ErrorCode::malformed, "its points are no triples of numbers", name_);
    for (std::size_t i = 0; i < piece.points.size(); i += 3) {
      mesh_.points.emplace_back(piece.points[i], piece.points[i + 1], piece.points[i + 2]);
      if (!mesh_.points.back().allFinite())
        return fail(ErrorCode::malformed, "a point of it is no place", name_);
    }
    const Numbers* material = find_material(piece);
    const std::size_t n = piece.offsets.size();
    if ((!is_surface_ && piece.types.size() != n) || (material != nullptr && material->size() != n))
      return fail(ErrorCode::malformed, "its arrays have different numbers of cells", name_);
    constexpr CellType kPolygon{7, CellShape::polygon, 0, 0};
    double first = 0;
    std::vector<double> points;
    for (std::size_t i = 0; i < n; ++i) {
      const double last = piece.offsets[i];
      if (!(last >= first && last <= static_cast<double>(piece.connectivity.size())))
        return fail(ErrorCode::malformed, "its offsets of cells do not fit", name_);
      points.assign(piece.connectivity.begin() + static_cast<std::ptrdiff_t>(first),
                    piece.connectivity.begin() + static_cast<std::ptrdiff_t>(last));
      for (double& v : points) v += before;
      const auto type =
          is_surface_ ? kPolygon
                      : find_cell_type(vtk_cell_types(), static_cast<int>(whole(piece.types[i])));
      if (!type)
        return fail(ErrorCode::unsupported,
                    printed("it has cells of VTK's type %.0f, which are not read; save it as "
                            "tetrahedra (ParaView: Tetrahedralize)",
                            piece.types[i]),
                    name_);
      const auto of = material != nullptr ? whole((*material)[i]) : 0;
      ARTUS_TRY(add_cell(mesh_, *type, points, of, name_));
      first = last;
    }
    if (has_strips_ && mesh_.cells.empty())
      return fail(ErrorCode::unsupported,
                  "it holds strips of triangles; save it as triangles (ParaView: Triangulate)",
                  name_);
    return {};
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t end_ = 0;
  bool is_surface_ = false;
  bool has_strips_ = false;
  XmlArrayForm form_;
  VolumeMesh mesh_;
};

}  // namespace

Result<VolumeMesh> parse_vtk_xml(std::string_view bytes, const std::string& name) {
  return VtkXmlReader(bytes, name).run();
}

}  // namespace artus
