// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "artus/core/result.h"

namespace artus {

/// A curve; x and y of one length.
struct PlotSeries {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;
  std::string style = "lines";  ///< a gnuplot plotting style
};

/// One diagram of a column of diagrams.
struct PlotPanel {
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
  bool log_y = false;
};

struct Plot {
  std::string title;
  std::vector<PlotPanel> panels;  ///< drawn under one another
  int width = 1200;               ///< pixels
  int panel_height = 320;         ///< pixels
};

/// y over x of each row.
template <class Row, class X, class Y>
[[nodiscard]] PlotSeries plot_curve(const std::vector<Row>& rows, std::string label, X x, Y y) {
  PlotSeries series;
  series.label = std::move(label);
  series.x.reserve(rows.size());
  series.y.reserve(rows.size());
  for (const Row& row : rows) {
    series.x.push_back(x(row));
    series.y.push_back(y(row));
  }
  return series;
}

/// A value of a trace over its time.
template <class Row, class F>
[[nodiscard]] PlotSeries plot_rows(const std::vector<Row>& rows, std::string label, F value) {
  return plot_curve(
      rows, std::move(label), [](const Row& row) { return row.time; }, value);
}

/// Draws the plot with gnuplot as a child process (script and data in a temporary folder). Errors:
/// not_found (no gnuplot on the path), unreadable, failed.
[[nodiscard]] Result<void> write_plot(const std::filesystem::path& png, const Plot& plot);

}  // namespace artus
