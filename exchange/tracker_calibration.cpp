// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/tracker_calibration.h"

#include <optional>

#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_table.h"
#include "artus/detail/exchange/reference_frame.h"

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
  calibration.registered = read_matrix(root, "reference_to_joint", calibration.X_JR);
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
  append_matrix(out, "transducer_to_probe", calibration.X_ProbeP);
  append_matrix(out, "needle_tip_to_needle", calibration.X_NeedleN);
  if (calibration.registered) append_matrix(out, "reference_to_joint", calibration.X_JR);
  return out;
}

}  // namespace artus
