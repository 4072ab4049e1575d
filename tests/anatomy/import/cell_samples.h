// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "artus/core/geometry.h"

namespace artus::test {

/// Cubes in rows, each of its own material or of the one that `material_of` says: (n, 1, 1) of edge
/// 1, as hexahedra of VTK's order.
struct CubeRow {
  std::vector<Vec3> points;
  std::vector<std::array<std::int64_t, 8>> cells;
  std::vector<std::int64_t> materials;
};

/// Cubes beside each other along x with these materials.
inline CubeRow make_cube_row(const std::vector<std::int64_t>& materials) {
  CubeRow row;
  row.materials = materials;
  for (std::size_t i = 0; i <= materials.size(); ++i)
    for (const auto& [y, z] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
      row.points.emplace_back(static_cast<double>(i), y, z);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    std::array<std::int64_t, 8> cell{};
    for (std::size_t k = 0; k < 8; ++k) cell.at(k) = static_cast<std::int64_t>(4 * i + k);
    row.cells.push_back(cell);
  }
  return row;
}

template <class T>
std::string bytes_of_numbers(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)};
}

inline std::string base64_of(const std::string& bytes) {
  constexpr const char* kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t all = 0;
    for (std::size_t k = 0; k < 3; ++k)
      all = all << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kLetters[all >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

inline std::string size_bytes(std::size_t size) {
  return bytes_of_numbers(std::vector<std::uint32_t>{static_cast<std::uint32_t>(size)});
}

enum class VtuForm { text, base64, raw, compressed };

/// How a compressed form packs bytes.
using Pack = std::string (*)(std::string_view);

/// A VTU of a row, in one of VTK's forms.
inline std::string vtu_of(const CubeRow& row, VtuForm form, Pack pack = nullptr) {
  std::string appended;
  const auto array = [&](const std::string& name, const std::string& type, const auto& numbers,
                         int parts = 1) {
    std::string head = "<DataArray type=\"" + type + "\" Name=\"" + name +
                       "\" NumberOfComponents=\"" + std::to_string(parts) + "\" format=\"";
    const std::string bytes = bytes_of_numbers(numbers);
    if (form == VtuForm::text) {
      head += "ascii\">";
      for (const auto v : numbers) head += std::to_string(v) + " ";
      return head + "</DataArray>\n";
    }
    if (form == VtuForm::base64)
      return head + "binary\">\n" + base64_of(size_bytes(bytes.size())) + base64_of(bytes) +
             "\n</DataArray>\n";
    if (form == VtuForm::compressed) {
      const std::string packed = pack(bytes);
      return head + "binary\">" +
             base64_of(size_bytes(1) + size_bytes(1 << 15) + size_bytes(bytes.size()) +
                       size_bytes(packed.size())) +
             base64_of(packed) + "</DataArray>\n";
    }
    head += "appended\" offset=\"" + std::to_string(appended.size()) + "\"/>\n";
    appended += size_bytes(bytes.size()) + bytes;
    return head;
  };
  std::vector<double> points;
  for (const Vec3& p : row.points) points.insert(points.end(), {p.x(), p.y(), p.z()});
  std::vector<std::int64_t> connectivity, offsets;
  for (const auto& cell : row.cells) {
    connectivity.insert(connectivity.end(), cell.begin(), cell.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  const std::vector<std::uint8_t> types(row.cells.size(), 12);
  const std::vector<float> quality(row.cells.size(), 0.5F);
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
      "byte_order=\"LittleEndian\"";
  if (form == VtuForm::compressed) out += " compressor=\"vtkZLibDataCompressor\"";
  out += ">\n<!-- a > in a comment -->\n<UnstructuredGrid><Piece NumberOfPoints=\"" +
         std::to_string(row.points.size()) + "\" NumberOfCells=\"" +
         std::to_string(row.cells.size()) + "\">\n<CellData>" +
         array("quality", "Float32", quality) + array("material", "Int64", row.materials) +
         "</CellData>\n<Points>" + array("Points", "Float64", points, 3) + "</Points>\n<Cells>" +
         array("connectivity", "Int64", connectivity) + array("offsets", "Int64", offsets) +
         array("types", "UInt8", types) + "</Cells></Piece></UnstructuredGrid>\n";
  if (!appended.empty())
    out += "<AppendedData encoding=\"raw\">\n_" + appended + "\n</AppendedData>\n";
  return out + "</VTKFile>\n";
}

/// The same as Gmsh's text, of version 2.2 or 4.1. `names` are of materials 1, 2, ...
inline std::string msh_of(const CubeRow& row, bool is_new, const std::vector<std::string>& names) {
  std::string out = std::string("$MeshFormat\n") + (is_new ? "4.1" : "2.2") + " 0 8\n";
  out += "$EndMeshFormat\n$PhysicalNames\n" + std::to_string(names.size()) + "\n";
  for (std::size_t i = 0; i < names.size(); ++i)
    out += "3 " + std::to_string(i + 1) + " \"" + names[i] + "\"\n";
  out += "$EndPhysicalNames\n";
  const std::string n_points = std::to_string(row.points.size());
  const std::string n_cells = std::to_string(row.cells.size());
  const auto place = [](const Vec3& p) {
    return std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  };
  const auto corners = [&](std::size_t i) {
    std::string text;
    for (const auto v : row.cells[i]) text += " " + std::to_string(v + 1);
    return text + "\n";
  };
  if (!is_new) {
    out += "$Nodes\n" + n_points + "\n";
    for (std::size_t i = 0; i < row.points.size(); ++i)
      out += std::to_string(i + 1) + " " + place(row.points[i]);
    out += "$EndNodes\n$Elements\n" + n_cells + "\n";
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      out += std::to_string(i + 1) + " 5 2 " + std::to_string(row.materials[i]) + " 7" + corners(i);
    return out + "$EndElements\n";
  }
  // A volume for each cube, whose tag is 10 and more.
  out += "$Entities\n0 0 0 " + n_cells + "\n";
  for (std::size_t i = 0; i < row.cells.size(); ++i)
    out += std::to_string(10 + i) + " 0 0 0 1 1 1 1 " + std::to_string(row.materials[i]) + " 0\n";
  out += "$EndEntities\n$Nodes\n1 " + n_points + " 1 " + n_points + "\n3 10 0 " + n_points + "\n";
  for (std::size_t i = 0; i < row.points.size(); ++i) out += std::to_string(i + 1) + "\n";
  for (const Vec3& p : row.points) out += place(p);
  out += "$EndNodes\n$Elements\n" + n_cells + " " + n_cells + " 1 " + n_cells + "\n";
  for (std::size_t i = 0; i < row.cells.size(); ++i)
    out += "3 " + std::to_string(10 + i) + " 5 1\n" + std::to_string(i + 1) + corners(i);
  return out + "$EndElements\n";
}

}  // namespace artus::test
