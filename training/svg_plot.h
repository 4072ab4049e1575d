// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace artus {

/// A curve of a plot.
struct SvgCurve {
  std::string name;  ///< in the legend; empty: none
  std::vector<double> x;
  std::vector<double> y;
  std::string colour = "#1f5fa8";
  bool points = false;  ///< dots instead of a line
};

/// A band behind the curves, from x to x; or a level line across.
struct SvgBand {
  double from = 0;
  double to = 0;
  std::string colour = "#f6d5d0";
  std::string name;
};
struct SvgLevel {
  double y = 0;
  std::string name;
};

/// A plot as vector drawing: scales with its page, prints, needs nothing else.
struct SvgPlot {
  std::string x_label;
  std::string y_label;
  std::vector<SvgCurve> curves;
  std::vector<SvgBand> bands;
  std::vector<SvgLevel> levels;
  bool equal = false;   ///< one unit is as long on both axes
  bool y_down = false;  ///< depth
};

/// The <svg> element; all text escaped. Values that are not finite are left out.
[[nodiscard]] std::string to_svg(const SvgPlot& plot);

}  // namespace artus
