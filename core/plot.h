// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "artus/core/result.h"

namespace artus {

enum class PlotStyle { line, dashed, points, line_points, dots };

/// A curve; x and y of one length. A value that is not finite is a gap.
struct PlotSeries {
  std::string label;  ///< in the legend; empty: none
  std::vector<double> x;
  std::vector<double> y;
  PlotStyle style = PlotStyle::line;
  std::string_view colour = {};  ///< a literal as in CSS; empty: one of eight, by place
};

/// A band behind the curves, from x to x.
struct PlotBand {
  double from = 0;
  double to = 0;
};
/// A dashed line across.
struct PlotLevel {
  double y = 0;
  std::string label;
};

/// One diagram.
struct PlotPanel {
  std::string x_label;
  std::string y_label;
  std::vector<PlotSeries> series;
  bool log_y = false;  ///< values of 0 and below are gaps
  std::vector<PlotBand> bands = {};
  std::vector<PlotLevel> levels = {};
  bool equal = false;   ///< one unit is as long on both axes
  bool y_down = false;  ///< as depth
};

/// A column of diagrams.
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

/// The plot as an <svg> element, which is also a file of its own: it scales with its page, prints
/// and needs nothing else. All text is escaped. What lies closer than half a pixel is drawn as its
/// extremes, so that a long trace stays small.
[[nodiscard]] std::string to_svg(const Plot& plot);
/// One diagram in a page's text.
[[nodiscard]] std::string to_svg(const PlotPanel& panel);

/// Writes to_svg(plot). Errors: unreadable.
[[nodiscard]] Result<void> write_plot(const std::filesystem::path& svg, const Plot& plot);

}  // namespace artus
