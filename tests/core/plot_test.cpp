// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/plot.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

namespace artus {
namespace {

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

/// The text of the first path.
std::string path_of(const std::string& svg) {
  const auto from = svg.find("<path d=\"") + 9;
  return svg.substr(from, svg.find('"', from) - from);
}

TEST(Plot, TextIsEscapedAndElementsAreClosed) {
  PlotPanel panel{"x < 1", "y & z", {{"<script>", {0, 1}, {0, 1}}}};
  panel.bands = {{0.2, 0.4}};
  panel.levels = {{0.5, "\"half\""}};
  const std::string svg = to_svg(Plot{"a > b", {panel, panel}});
  EXPECT_EQ(svg.find("<script>"), std::string::npos);
  EXPECT_NE(svg.find("x &lt; 1"), std::string::npos);
  EXPECT_EQ(count(svg, "<g "), 2U) << "one group for each panel";
  EXPECT_EQ(count(svg, "<g "), count(svg, "</g>"));
  EXPECT_EQ(count(svg, "<text "), count(svg, "</text>"));
}

TEST(Plot, ALineEndsAtAGapAndBeginsAnewBehindIt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string path =
      path_of(to_svg(PlotPanel{"", "", {{"", {0, 1, 2, 3, 4}, {0, 1, nan, 1, 0}}}}));
  EXPECT_EQ(count(path, "M"), 2U);
  EXPECT_EQ(count(path, "L"), 2U);
}

TEST(Plot, ALongTraceKeepsItsPeaksInLittleText) {
  PlotSeries trace;
  for (int i = 0; i < 200000; ++i) {
    trace.x.push_back(i);
    trace.y.push_back(std::sin(i * 1e-3));
  }
  trace.y[123456] = 50;  // one tick's peak
  const std::string path = path_of(to_svg(Plot{"", {{"", "", {trace}}}}));
  EXPECT_LT(path.size(), 120000U);
  EXPECT_GT(count(path, "L"), 1000U);
  // the peak is the highest value: 4 % of the range below the panel's upper edge
  std::istringstream points(path);
  double highest = 1e9;
  for (std::string command; std::getline(points, command, 'L');)
    highest = std::min(highest, std::stod(command.substr(command.find(' '))));
  EXPECT_NEAR(highest, 26 + 0.04 / 1.08 * (320 - 26 - 44), 0.1);
}

TEST(Plot, DepthGrowsDownwardsAndEqualUnitsAreOfOneLength) {
  PlotPanel panel{"", "", {{"", {0, 10}, {0, 10}}}};
  panel.equal = true;
  panel.y_down = true;
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
  ASSERT_EQ(std::sscanf(path_of(to_svg(panel)).c_str(), "M%lf %lfL%lf %lf", &x1, &y1, &x2, &y2), 4);
  EXPECT_GT(y2, y1);
  EXPECT_NEAR(x2 - x1, y2 - y1, 0.1);
}

TEST(Plot, AFactorIsOneStepOnALogarithmicAxis) {
  PlotPanel panel{"", "", {{"", {0, 1, 2, 3}, {0, 1e-3, 1, 1e3}}}};
  panel.log_y = true;
  const std::string svg = to_svg(panel);
  double x[3], y[3];
  ASSERT_EQ(std::sscanf(path_of(svg).c_str(), "M%lf %lfL%lf %lfL%lf %lf", x, y, x + 1, y + 1, x + 2,
                        y + 2),
            6)
      << "0 is a gap";
  EXPECT_NEAR(y[0] - y[1], y[1] - y[2], 0.1);
  EXPECT_NE(svg.find(">100<"), std::string::npos) << "a tick at a power of ten";
}

TEST(Plot, PointsAreDrawnOneByOne) {
  PlotSeries cloud{"cloud", {0, 1, 2}, {1, 2, 1}, PlotStyle::points, "#123456"};
  EXPECT_EQ(count(path_of(to_svg(PlotPanel{"", "", {cloud}})), "h0"), 3U);
  cloud.style = PlotStyle::line_points;
  EXPECT_EQ(count(to_svg(PlotPanel{"", "", {cloud}}), "<path "), 2U);
}

TEST(Plot, ManyNamesTakeRowsOfTheirOwn) {
  PlotPanel panel{"", "what is plotted here", {}};
  for (int i = 0; i < 12; ++i)
    panel.series.push_back({"a rather long name " + std::to_string(i), {0, 1}, {0, 1}});
  const std::string svg = to_svg(panel);
  EXPECT_NE(svg.find("y=\"14\""), std::string::npos);
  EXPECT_NE(svg.find("y=\"30\""), std::string::npos);
  EXPECT_NE(svg.find("y=\"46\""), std::string::npos);
}

TEST(Plot, AFolderThatCannotBeWrittenIsNamed) {
  const auto written = write_plot("/proc/no/plot.svg", {"t", {}});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::unreadable);
  EXPECT_NE(written.error().to_string().find("/proc/no"), std::string::npos);
}

}  // namespace
}  // namespace artus
