// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "artus/detail/core/markup.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"

namespace artus {
namespace {

constexpr double kLeft = 58;    // pixels, as all lengths here
constexpr double kRight = 14;   //
constexpr double kTop = 26;     // with one row of legend
constexpr double kBottom = 44;  //
constexpr double kRow = 16;     // of legend
constexpr double kLetter = 7;   // mean width
constexpr double kTitle = 26;   //
constexpr double kXTick = 110;  // about, from one to the next
constexpr double kYTick = 48;   //
constexpr std::array<std::string_view, 8> kColours{"#1f5fa8", "#a8461f", "#2a7d3a", "#7a3f9a",
                                                   "#b58900", "#0b7a8a", "#c23b80", "#666666"};

std::string number(double value) {
  return printed("%.5g", value);
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  [[nodiscard]] double span() const { return high - low; }
  void take(double v) {
    if (!std::isfinite(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void settle() {
    if (!(low <= high)) *this = {0, 1};
    const double room = high > low ? 0.04 * (high - low) : 0.5;
    low -= room;
    high += room;
  }
  /// As long, about its middle.
  void widen(double to) {
    const double middle = 0.5 * (low + high);
    *this = {middle - to / 2, middle + to / 2};
  }
};

/// Calls each(v) for round values in the range, about `n`.
template <class Each>
void for_ticks(const Range& range, double n, Each each) {
  const double raw = range.span() / n;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  const double digit = raw / power;
  const double step = power * (digit < 1.5 ? 1 : (digit < 3.5 ? 2 : (digit < 7.5 ? 5 : 10)));
  for (double v = std::ceil(range.low / step) * step; v <= range.high; v += step)
    each(std::abs(v) < 1e-9 * step ? 0 : v);
}

struct LegendPlace {
  double x = 0;  // of its right end
  int row = 0;
};

/// From the right to the left, in as many rows as it takes; the first leaves room for y's label.
std::vector<LegendPlace> place_legend(const PlotPanel& panel, double width) {
  const double right = width - kRight - 4;
  double limit = 20 + kLetter * static_cast<double>(panel.y_label.size());
  std::vector<LegendPlace> places;
  LegendPlace next{right, 0};
  for (const PlotSeries& s : panel.series) {
    const double length = s.label.empty() ? 0 : kLetter * static_cast<double>(s.label.size()) + 16;
    if (next.x < right && next.x - length < limit) {
      next = {right, next.row + 1};
      limit = kLeft;
    }
    places.push_back(next);
    next.x -= length;
  }
  return places;
}

/// From values to pixels of a panel.
class Canvas {
 public:
  Canvas(const PlotPanel& panel, double width, double height, int legend_rows)
      : log_(panel.log_y),
        down_(panel.y_down),
        right_(width - kRight),
        top_(kTop + kRow * std::max(0, legend_rows - 1)),
        bottom_(height - kBottom) {
    for (const PlotSeries& s : panel.series) {
      for (const double v : s.x) x_.take(v);
      for (const double v : s.y) y_.take(scaled(v));
    }
    for (const PlotLevel& l : panel.levels) y_.take(scaled(l.y));
    x_.settle();
    y_.settle();
    if (!panel.equal) return;
    const double unit = std::max(x_.span() / (right_ - kLeft), y_.span() / (bottom_ - top_));
    x_.widen(unit * (right_ - kLeft));
    y_.widen(unit * (bottom_ - top_));
  }
  [[nodiscard]] double at_x(double v) const {
    return kLeft + (v - x_.low) / x_.span() * (right_ - kLeft);
  }
  [[nodiscard]] double at_y(double v) const {
    const double share = (scaled(v) - y_.low) / y_.span();
    return top_ + (down_ ? share : 1 - share) * (bottom_ - top_);
  }
  [[nodiscard]] double top() const { return top_; }
  [[nodiscard]] double right() const { return right_; }
  [[nodiscard]] double bottom() const { return bottom_; }

  template <class Each>
  void for_x_ticks(Each each) const {
    for_ticks(x_, (right_ - kLeft) / kXTick, each);
  }
  template <class Each>
  void for_y_ticks(Each each) const {
    if (!log_) return for_ticks(y_, (bottom_ - top_) / kYTick, each);
    const double n = std::min((bottom_ - top_) / kYTick, std::max(1.0, std::floor(y_.span())));
    for_ticks(y_, n, [&each](double power) { each(std::pow(10, power)); });
  }

 private:
  [[nodiscard]] double scaled(double y) const {
    if (!log_) return y;
    return y > 0 ? std::log10(y) : std::numeric_limits<double>::quiet_NaN();
  }

  Range x_;
  Range y_;
  bool log_;
  bool down_;
  double right_;
  double top_;
  double bottom_;
};

/// A path's text, of points given one after another.
class LinePath {
 public:
  void add(double x, double y) {
    if (count_ > 0 && std::floor(2 * x) != std::floor(2 * x_)) flush();
    if (count_ == 0) {
      x_ = x;
      first_ = low_ = high_ = y;
    }
    low_ = std::min(low_, y);
    high_ = std::max(high_, y);
    last_ = y;
    ++count_;
  }
  void gap() {
    flush();
    pen_down_ = false;
  }
  [[nodiscard]] std::string text() {
    flush();
    return out_;
  }

 private:
  void put(double y) {
    out_ += (pen_down_ ? "L" : "M") + number(x_) + " " + number(y);
    pen_down_ = true;
  }
  void flush() {
    if (count_ == 0) return;
    put(first_);
    if (count_ > 2) {
      put(low_);
      put(high_);
    }
    if (count_ > 1) put(last_);
    count_ = 0;
  }

  std::string out_;
  bool pen_down_ = false;
  std::size_t count_ = 0;  // of points in this half of a pixel's column
  double x_ = 0;
  double first_ = 0;
  double low_ = 0;
  double high_ = 0;
  double last_ = 0;
};

std::string text_at(double x, double y, const std::string& text, const char* anchor,
                    std::string_view more = "fill=\"#444\"") {
  if (text.empty()) return {};
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\" " +
         std::string(more) + ">" + escape_markup(text) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) +
         "\" y2=\"" + number(y2) + "\" " + style + "/>\n";
}

std::string draw_axes(const PlotPanel& panel, const Canvas& canvas) {
  std::string out;
  canvas.for_x_ticks([&](double v) {
    const double x = canvas.at_x(v);
    out += line(x, canvas.top(), x, canvas.bottom(), "stroke=\"#eee\"");
    out += text_at(x, canvas.bottom() + 16, printed("%.4g", v), "middle");
  });
  canvas.for_y_ticks([&](double v) {
    const double y = canvas.at_y(v);
    out += line(kLeft, y, canvas.right(), y, "stroke=\"#eee\"");
    out += text_at(kLeft - 6, y + 4, printed("%.4g", v), "end");
  });
  out += text_at((kLeft + canvas.right()) / 2, canvas.bottom() + 36, panel.x_label, "middle");
  return out + text_at(6, 14, panel.y_label, "start");
}

std::string draw_path(const std::string& path, std::string_view colour, const char* stroke) {
  if (path.empty()) return {};
  return "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + std::string(colour) + "\" " + stroke +
         "/>\n";
}

std::string draw_series(const PlotSeries& series, std::string_view colour, const Canvas& canvas) {
  const bool joined = series.style == PlotStyle::line || series.style == PlotStyle::dashed ||
                      series.style == PlotStyle::line_points;
  LinePath path;
  std::string points;
  const std::size_t n = std::min(series.x.size(), series.y.size());
  for (std::size_t i = 0; i < n; ++i) {
    const double x = canvas.at_x(series.x[i]);
    const double y = canvas.at_y(series.y[i]);
    if (!std::isfinite(x) || !std::isfinite(y)) {
      path.gap();
      continue;
    }
    if (joined) path.add(x, y);
    if (!joined || series.style == PlotStyle::line_points)
      points += "M" + number(x) + " " + number(y) + "h0";  // its round ends are the dot
  }
  return draw_path(path.text(), colour,
                   series.style == PlotStyle::dashed
                       ? "stroke-width=\"1.8\" stroke-dasharray=\"6 4\""
                       : "stroke-width=\"1.8\"") +
         draw_path(points, colour,
                   series.style == PlotStyle::dots ? "stroke-width=\"2\" stroke-linecap=\"round\""
                                                   : "stroke-width=\"8\" stroke-linecap=\"round\"");
}

std::string draw_panel(const PlotPanel& panel, double width, double height) {
  const auto legend = place_legend(panel, width);
  const Canvas canvas(panel, width, height, legend.empty() ? 1 : legend.back().row + 1);
  std::string out;
  for (const PlotBand& b : panel.bands) {
    const double from = std::max(kLeft, canvas.at_x(b.from));
    const double to = std::min(canvas.right(), std::max(from + 1, canvas.at_x(b.to)));
    out += "<rect x=\"" + number(from) + "\" y=\"" + number(canvas.top()) + "\" width=\"" +
           number(std::max(0.0, to - from)) + "\" height=\"" +
           number(canvas.bottom() - canvas.top()) + "\" fill=\"#f6d5d0\"/>\n";
  }
  out += draw_axes(panel, canvas);
  for (const PlotLevel& l : panel.levels) {
    const double y = canvas.at_y(l.y);
    out += line(kLeft, y, canvas.right(), y, "stroke=\"#b26a00\" stroke-dasharray=\"5 4\"");
    out += text_at(canvas.right() - 4, y - 4, l.label, "end", "fill=\"#8a5200\"");
  }
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const PlotSeries& series = panel.series[i];
    const std::string_view colour =
        series.colour.empty() ? kColours.at(i % kColours.size()) : series.colour;
    out += draw_series(series, colour, canvas);
    out += text_at(legend[i].x, 14 + kRow * legend[i].row, series.label, "end",
                   "fill=\"" + std::string(colour) + "\"");
  }
  return out;
}

}  // namespace

std::string to_svg(const Plot& plot) {
  const double above = plot.title.empty() ? 0 : kTitle;
  const double height = above + plot.panel_height * static_cast<double>(plot.panels.size());
  const std::string size = number(plot.width) + "\" height=\"" + number(height);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
                    number(plot.width) + " " + number(height) + "\" width=\"" + size +
                    "\" role=\"img\" style=\"max-width:100%;height:auto\" "
                    "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" "
                    "height=\"100%\" fill=\"#fff\"/>\n";
  out += text_at(plot.width / 2.0, 18, plot.title, "middle", "font-size=\"14\" fill=\"#222\"");
  double top = above;
  for (const PlotPanel& panel : plot.panels) {
    out += "<g transform=\"translate(0 " + number(top) + ")\">\n" +
           draw_panel(panel, plot.width, plot.panel_height) + "</g>\n";
    top += plot.panel_height;
  }
  return out + "</svg>\n";
}

std::string to_svg(const PlotPanel& panel) {
  return to_svg(Plot{"", {panel}, 640, 300});
}

Result<void> write_plot(const std::filesystem::path& svg, const Plot& plot) {
  return write_text(svg, to_svg(plot));
}

}  // namespace artus
