// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/tracker_calibration.h"

#include <optional>

#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_table.h"
#include "artus/detail/core/units.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/simulation/plain_pose.h"

namespace artus {
namespace {

/// Four rows of four numbers, the last 0 0 0 1; nullopt when it is anything else.
std::optional<igtl::Matrix> matrix_of(const toml::array* rows) {
  igtl::Matrix matrix;
  if (rows == nullptr || rows->size() != 4) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i) {
    const toml::array* row = (*rows)[i].as_array();
    if (row == nullptr || row->size() != 4) return std::nullopt;
    for (std::size_t j = 0; j < 4; ++j) {
      const std::optional<double> number = (*row)[j].value<double>();
      if (!number) return std::nullopt;
      if (i < 3)
        matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = *number;
      else if (*number != (j == 3 ? 1 : 0))
        return std::nullopt;
    }
  }
  return matrix;
}

/// Reads the table `key` into `pose`; whether it is there.
bool read_matrix(TomlTable& root, std::string_view key, Pose& pose) {
  const toml::table* found = root.table(key);
  if (found == nullptr) return false;
  for (const auto& [name, node] : *found)
    if (name.str() != "matrix")
      root.problem_at(key, "unknown key '" + std::string(name.str()) + "'; it has 'matrix' alone");
  const auto matrix = matrix_of((*found)["matrix"].as_array());
  if (!matrix) {
    root.problem_at(key, "'matrix' must be four rows of four numbers, the last 0, 0, 0, 1");
    return true;
  }
  const auto rigid = rigid_from(*matrix);
  if (!rigid)
    root.problem_at(key, rigid.error().message);
  else
    pose = *rigid;
  return true;
}

/// The table insertion_point; nullopt without it.
std::optional<GestureParams> read_insertion(TomlTable& root, Problems& problems) {
  const toml::table* found = root.table("insertion_point");
  if (found == nullptr) return std::nullopt;
  constexpr double kFarthest = 100;  // mm beside the probe
  constexpr double kSteepest = 89;   // degrees
  TomlTable table(*found, "insertion_point", problems);
  GestureParams gesture;
  gesture.p_W = table.required_vector("point_mm", kMillimetre);
  const Vec3 axis = table.required_vector("axis");
  gesture.beside_probe =
      table.number("beside_probe_mm", 0, kFarthest, kMillimetre).value_or(gesture.beside_probe);
  gesture.steepness =
      table.number("steepness_deg", 1, kSteepest, kDegree).value_or(gesture.steepness);
  table.finish();
  if (!(axis.norm() > 1e-9) || !(gesture.p_W.norm() < kDeviceReach))
    table.problem("'axis' must be a direction, and 'point_mm' within 10 m");
  else
    gesture.axis_W = axis.normalized();
  return gesture;
}

std::string vector_text(const Vec3& v) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < 3; ++i) {
    std::string number;
    append_number(number, v[i]);
    text += (i == 0 ? "" : ", ") + number;
  }
  return text + "]";
}

void append_insertion(std::string& out, const GestureParams& gesture) {
  std::string beside;
  std::string steepness;
  append_number(beside, gesture.beside_probe / kMillimetre);
  append_number(steepness, gesture.steepness / kDegree);
  out += "\n[insertion_point]\npoint_mm = " + vector_text(gesture.p_W / kMillimetre) +
         "\naxis = " + vector_text(gesture.axis_W) + "\nbeside_probe_mm = " + beside +
         "\nsteepness_deg = " + steepness + "\n";
}

void append_matrix(std::string& out, const char* key, const Pose& pose) {
  const igtl::Matrix matrix = millimetres_of(pose);
  out += std::string("\n[") + key + "]\nmatrix = [\n";
  for (Eigen::Index i = 0; i < 3; ++i) {
    out += "  [";
    for (Eigen::Index j = 0; j < 4; ++j) {
      std::string number;
      append_number(number, matrix(i, j));
      out += (j == 0 ? "" : ", ") + number;
    }
    out += "],\n";
  }
  out += "  [0, 0, 0, 1],\n]\n";
}

}  // namespace

TrackerCalibration::TrackerCalibration() : X_JR(ReferenceFrame().X_JR()) {}

Result<TrackerCalibration> parse_tracker_calibration(std::string_view text,
                                                     const std::string& name) {
  const auto parsed = parse_toml(text, name);
  ARTUS_TRY(parsed);
  Problems problems;
  TomlTable root(*parsed, "calibration", problems);
  TrackerCalibration calibration;
  read_matrix(root, "transducer_to_probe", calibration.X_ProbeP);
  read_matrix(root, "needle_tip_to_needle", calibration.X_NeedleN);
  calibration.scale = root.number("scale", 0.5, 2).value_or(1);
  calibration.registered = read_matrix(root, "reference_to_joint", calibration.X_JR);
  calibration.insertion = read_insertion(root, problems);
  root.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
  return calibration;
}

Result<TrackerCalibration> read_tracker_calibration(const std::filesystem::path& file) {
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  return parse_tracker_calibration(*text, file.string());
}

std::string to_toml(const TrackerCalibration& calibration) {
  std::string out =
      "# How a tracker's sensors sit on probe, needle and joint; millimetres, rows of each "
      "matrix.\n";
  if (calibration.scale != 1) {
    out += "scale = ";
    append_number(out, calibration.scale);
    out += "\n";
  }
  append_matrix(out, "transducer_to_probe", calibration.X_ProbeP);
  append_matrix(out, "needle_tip_to_needle", calibration.X_NeedleN);
  if (calibration.registered) append_matrix(out, "reference_to_joint", calibration.X_JR);
  if (calibration.insertion) append_insertion(out, *calibration.insertion);
  return out;
}

}  // namespace artus
