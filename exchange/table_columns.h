// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace artus {

/// Which columns of a table are one tool's position and quaternion.
struct ToolColumns {
  std::string tool;  ///< "needle", "a", or empty: the table does not name it
  /// x, y, z, qw, qx, qy, qz: the column's number.
  std::array<std::size_t, 7> at{};
  double unit = 0;                  ///< m; 0: the header does not say
  std::vector<std::size_t> status;  ///< columns of words about this tool
};

/// What a header says about the columns of a table of tracked tools.
struct TableColumns {
  std::vector<ToolColumns> tools;
  std::optional<std::size_t> time;
  double time_unit = 0;  ///< s; 0: the header does not say
  std::optional<std::size_t> hour, minute, second, millisecond;
  std::optional<std::size_t> frame;
  bool of_ndi = false;  ///< as NDI's programs write: millimetres
};

/// Reads the names of a header's cells: NDI's ("Xa, qoa", "Tx, Q0"), ROS' ("pose.position.x"),
/// and "needle_x_mm", "qw" of scripts. No tools: it is no header of such a table.
[[nodiscard]] TableColumns find_columns(const std::vector<std::string>& cells);

}  // namespace artus
