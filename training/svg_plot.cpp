// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "artus/detail/core/markup.h"
#include "artus/detail/core/printed.h"

namespace artus {
namespace {

constexpr double kWidth = 640;
constexpr double kHeight = 300;
constexpr double kLeft = 58;
constexpr double kRight = 14;
constexpr double kTop = 26;
constexpr double kBottom = 44;

std::string number(double value) {
  return printed("%.4g", value);
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
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
};

/// A round step that gives some five ticks.
double step_of(double span) {
  const double raw = span / 5;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  const double digit = raw / power;
  return power * (digit < 1.5 ? 1 : (digit < 3.5 ? 2 : (digit < 7.5 ? 5 : 10)));
}

class Canvas {
 public:
  explicit Canvas(const SvgPlot& plot) : down_(plot.y_down) {
    for (const SvgCurve& c : plot.curves) {
      for (const double v : c.x) x_.take(v);
      for (const double v : c.y) y_.take(v);
    }
    for (const SvgLevel& l : plot.levels) y_.take(l.y);
    x_.settle();
    y_.settle();
    if (plot.equal) equalise();
  }
  [[nodiscard]] double at_x(double v) const {
    return kLeft + (v - x_.low) / (x_.high - x_.low) * (kWidth - kLeft - kRight);
  }
  [[nodiscard]] double at_y(double v) const {
    const double share = (v - y_.low) / (y_.high - y_.low);
    return kTop + (down_ ? share : 1 - share) * (kHeight - kTop - kBottom);
  }
  [[nodiscard]] const Range& x() const { return x_; }
  [[nodiscard]] const Range& y() const { return y_; }

 private:
  void equalise() {
    const double unit = std::max((x_.high - x_.low) / (kWidth - kLeft - kRight),
                                 (y_.high - y_.low) / (kHeight - kTop - kBottom));
    const auto widen = [](Range& r, double span) {
      const double middle = 0.5 * (r.low + r.high);
      r = {middle - span / 2, middle + span / 2};
    };
    widen(x_, unit * (kWidth - kLeft - kRight));
    widen(y_, unit * (kHeight - kTop - kBottom));
  }
  Range x_;
  Range y_;
  bool down_;
};

std::string text_at(double x, double y, const std::string& text, const char* anchor,
                    const char* colour = "#444") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor +
         "\" fill=\"" + colour + "\">" + escape_markup(text) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) +
         "\" y2=\"" + number(y2) + "\" " + style + "/>\n";
}

std::string axes(const SvgPlot& plot, const Canvas& canvas) {
  std::string out;
  const auto ticks = [](const Range& r, const auto& each) {
    const double step = step_of(r.high - r.low);
    for (double v = std::ceil(r.low / step) * step; v <= r.high; v += step)
      each(std::abs(v) < 1e-9 * step ? 0 : v);
  };
  ticks(canvas.x(), [&](double v) {
    out += line(canvas.at_x(v), kTop, canvas.at_x(v), kHeight - kBottom, "stroke=\"#eee\"");
    out += text_at(canvas.at_x(v), kHeight - kBottom + 16, number(v), "middle");
  });
  ticks(canvas.y(), [&](double v) {
    out += line(kLeft, canvas.at_y(v), kWidth - kRight, canvas.at_y(v), "stroke=\"#eee\"");
    out += text_at(kLeft - 6, canvas.at_y(v) + 4, number(v), "end");
  });
  out += text_at((kLeft + kWidth) / 2, kHeight - 8, plot.x_label, "middle");
  return out + text_at(6, 14, plot.y_label, "start");
}

std::string draw(const SvgCurve& curve, const Canvas& canvas) {
  std::string out;
  std::string displacement;
  const std::size_t n = std::min(curve.x.size(), curve.y.size());
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) continue;
    const std::string x = number(canvas.at_x(curve.x[i]));
    const std::string y = number(canvas.at_y(curve.y[i]));
    if (curve.points)
      out += "<circle cx=\"" + x + "\" cy=\"" + y + "\" r=\"4\" fill=\"" + curve.colour + "\"/>\n";
    else
      displacement += (displacement.empty() ? "M" : "L") + x + " " + y;
  }
  if (!displacement.empty())
    out += "<path d=\"" + displacement + "\" fill=\"none\" stroke=\"" + curve.colour +
           "\" stroke-width=\"1.8\"/>\n";
  return out;
}

}  // namespace

std::string to_svg(const SvgPlot& plot) {
  const Canvas canvas(plot);
  std::string out = "<svg viewBox=\"0 0 " + number(kWidth) + " " + number(kHeight) +
                    "\" role=\"img\" style=\"width:100%;max-width:640px\" "
                    "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" "
                    "height=\"100%\" fill=\"#fff\"/>\n";
  for (const SvgBand& b : plot.bands) {
    const double from = std::max(kLeft, canvas.at_x(b.from));
    const double to = std::min(kWidth - kRight, std::max(from + 1, canvas.at_x(b.to)));
    out += "<rect x=\"" + number(from) + "\" y=\"" + number(kTop) + "\" width=\"" +
           number(std::max(0.0, to - from)) + "\" height=\"" + number(kHeight - kTop - kBottom) +
           "\" fill=\"" + b.colour + "\"/>\n";
  }
  out += axes(plot, canvas);
  for (const SvgLevel& l : plot.levels) {
    out += line(kLeft, canvas.at_y(l.y), kWidth - kRight, canvas.at_y(l.y),
                "stroke=\"#b26a00\" stroke-dasharray=\"5 4\"");
    out += text_at(kWidth - kRight - 4, canvas.at_y(l.y) - 4, l.name, "end", "#8a5200");
  }
  double legend = kWidth - kRight - 4;
  for (const SvgCurve& c : plot.curves) {
    out += draw(c, canvas);
    if (c.name.empty()) continue;
    out += text_at(legend, 14, c.name, "end", c.colour.c_str());
    legend -= 7.0 * static_cast<double>(c.name.size()) + 16;
  }
  return out + "</svg>\n";
}

}  // namespace artus
