// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/cage_vtu.h"

#include <numeric>
#include <string>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr std::array<std::size_t, 8> kVtkOrder{0, 1, 3, 2, 4, 5, 7, 6};

void put(std::string& text, double value) {
  const std::string number = printed("%.7g ", value);
  text += number;
}

void put(std::string& text, const Vec3& v) {
  for (int k = 0; k < 3; ++k) put(text, v[k]);
  text += '\n';
}

void open_array(std::string& text, const std::string& name, int components,
                const std::string& type = "Float64") {
  text += "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
          std::to_string(components) + "\" format=\"ascii\">\n";
}

void close_array(std::string& text) {
  text += "\n</DataArray>\n";
}

void put_points(std::string& text, const DeformedBody& body) {
  const BodyMap& map = body.map();
  text += "<PointData Vectors=\"displacement_mm\">\n";
  open_array(text, "displacement_mm", 3);
  for (const Vec3& u : body.node_displacements())
    put(text, Vec3(map.X_JC.linear() * u / kMillimetre));
  close_array(text);
  text += "</PointData>\n<Points>\n";
  open_array(text, "points", 3);
  for (const Vec3& p : map.model->cage().nodes()) put(text, Vec3(map.X_JC * p / kMillimetre));
  close_array(text);
  text += "</Points>\n";
}

void put_cells(std::string& text, const Cage& cage) {
  text += "<Cells>\n";
  open_array(text, "connectivity", 1, "Int64");
  for (const CageCell& cell : cage.cells()) {
    for (const std::size_t a : kVtkOrder) text += std::to_string(cell.nodes[a]) + ' ';
    text += '\n';
  }
  close_array(text);
  open_array(text, "offsets", 1, "Int64");
  for (std::size_t c = 1; c <= cage.cells().size(); ++c) text += std::to_string(8 * c) + ' ';
  close_array(text);
  open_array(text, "types", 1, "UInt8");
  for (std::size_t c = 0; c < cage.cells().size(); ++c) text += "12 ";
  close_array(text);
  text += "</Cells>\n";
}

CellVector displacement_of(const CageCell& cell, std::span<const Vec3> u) {
  CellVector v;
  for (std::size_t a = 0; a < 8; ++a)
    v.segment<3>(static_cast<Eigen::Index>(3 * a)) = u[cell.nodes[a]];
  return v;
}

void put_cell_data(std::string& text, const DeformedBody& body) {
  const SoftModel& model = *body.map().model;
  const Cage& cage = model.cage();
  std::string volume;
  std::string pressure;
  std::string strain;
  std::string shear;
  for (std::size_t c = 0; c < cage.cells().size(); ++c) {
    const CellMaterial& m = model.materials()[c];
    const double edge = cage.edge(cage.cells()[c]);
    const CellVector u = displacement_of(cage.cells()[c], body.node_displacements());
    const double J = cell_dilatation(m, edge, u);
    const Eigen::Matrix3d F = cell_gradient(edge, u);
    const Eigen::Matrix3d R = body.map().X_JC.linear();
    const Eigen::Matrix3d E =
        R * (0.5 * (F.transpose() * F - Eigen::Matrix3d::Identity())) * R.transpose();
    put(volume, J);
    put(pressure, cell_pressure(m, J));
    for (int k = 0; k < 9; ++k) put(strain, E(k / 3, k % 3));
    put(shear, std::accumulate(m.shear.begin(), m.shear.end(), 0.0) / 8);
  }
  text += "<CellData>\n";
  const auto add = [&text](const std::string& name, int components, const std::string& values) {
    open_array(text, name, components);
    text += values;
    close_array(text);
  };
  add("volume_ratio", 1, volume);
  add("pressure_pa", 1, pressure);
  add("green_strain", 9, strain);
  add("shear_modulus_pa", 1, shear);
  text += "</CellData>\n";
}

}  // namespace

Result<void> write_vtu(const DeformedBody& body, const std::filesystem::path& file) {
  const Cage& cage = body.map().model->cage();
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
      std::to_string(cage.nodes().size()) + "\" NumberOfCells=\"" +
      std::to_string(cage.cells().size()) + "\">\n";
  put_points(text, body);
  put_cells(text, cage);
  put_cell_data(text, body);
  text += "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  return write_text(file, text);
}

}  // namespace artus
