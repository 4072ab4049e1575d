// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/attempt_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "artus/detail/core/plot.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/reports/html_page.h"
#include "artus/detail/reports/moment_view.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

/// Where a hand was at a time.
Pose pose_at(const std::vector<TrackPoint>& track, double time) {
  const auto found = std::lower_bound(track.begin(), track.end(), time,
                                      [](const TrackPoint& p, double t) { return p.time < t; });
  return pose_of(found == track.end() ? track.back() : *found);
}

/// An attempt's moments as the learner had them on the screen, with the joint open beside.
class Clips {
 public:
  Clips(const Scenario& scenario, const PlayedAttempt& attempt,
        const std::shared_ptr<const Scene>& scene)
      : measures_(attempt.measures),
        params_(attempt.recording.head.params),
        renderer_(scene, params_.transducer, params_.image),
        joint_(scenario, *scene, params_) {}

  /// Two seconds from half a second before `time` on.
  [[nodiscard]] std::array<cv::Mat, HtmlPage::kClipLength> around(double time) {
    std::array<cv::Mat, HtmlPage::kClipLength> out;
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = at(time - 0.5 + 0.25 * static_cast<double>(i));
    return out;
  }

 private:
  cv::Mat at(double time) {
    const Pose X_JP = pose_at(measures_.probe, time);
    std::optional<Pose> X_JN;
    std::optional<NeedleView> needle;
    if (!measures_.needle.empty()) {
      X_JN = pose_at(measures_.needle, time);
      needle = NeedleView{*X_JN, params_.needle_shape, Vec3::Zero()};
    }
    const cv::Mat grey = grey_image(renderer_.render(X_JP, needle));
    cv::Mat picture;
    const int width = static_cast<int>(std::lround(1.0 * kHeight * grey.cols / grey.rows));
    cv::resize(grey, picture, cv::Size(width, kHeight), 0, 0, cv::INTER_AREA);
    cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
    cv::putText(picture, fixed_number(time, 2) + " s", cv::Point(6, kHeight - 8),
                cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar(90, 220, 255), 1, cv::LINE_AA);
    cv::Mat both;
    cv::hconcat(picture, joint_.draw(X_JP, X_JN, cv::Size(kHeight, kHeight)), both);
    return both;
  }

  static constexpr int kHeight = 300;  // pixels
  const AttemptMeasures& measures_;
  const SessionParams& params_;
  Renderer renderer_;
  MomentView joint_;
};

void add_faults(HtmlPage& page, const Scenario& scenario, const Feedback& feedback,
                const PlayedAttempt& attempt, const std::shared_ptr<const Scene>& scene) {
  page.heading(feedback.faults.empty() ? "No fault stood out" : "What went wrong, the worst first");
  if (feedback.faults.empty()) return;
  Clips clips(scenario, attempt, scene);
  for (const Fault& fault : feedback.faults) {
    page.open_card("At " + fixed_number(fault.time, 1) + " s");
    page.paragraph(fault.what + ". Why: " + fault.cause + ".");
    page.point("do", fault.mend);
    const std::string needle =
        attempt.measures.needle.empty()
            ? ""
            : " with the needle (blue), its tip (orange), the target (green)";
    if (!attempt.measures.probe.empty())
      page.clip(clips.around(fault.time),
                "half as fast as it was: the picture, and the joint cut open at its plane" +
                    needle + (scenario.avoid.empty() ? "" : " and what is to be spared (red)"));
    page.close_card();
  }
}

std::vector<PlotBand> unseen_bands(const AttemptMeasures& m) {
  std::vector<PlotBand> bands;
  for (const Run& run : sum_sight(m.course, m.sights).unseen) bands.push_back({run.from, run.to});
  return bands;
}

/// Where the probe went on the skin, and where it showed what was asked for.
void add_search(HtmlPage& page, const Scenario& scenario, const AttemptMeasures& m) {
  page.heading("What was shown");
  PlotSeries path{"probe", {}, {}};
  const auto put = [&scenario](PlotSeries& curve, const Vec3& p_J) {
    const Vec3 p = scenario.X_JP.inverse() * p_J;
    curve.x.push_back(p.x() / kMillimetre);
    curve.y.push_back(p.y() / kMillimetre);
  };
  for (const TrackPoint& point : m.probe) put(path, point.p);
  std::vector<PlotSeries> curves{path};
  std::vector<std::vector<std::string>> rows;
  for (const Sought& one : m.sought) {
    rows.push_back({one.name, one.found >= 0 ? fixed_number(one.found, 1) : "not shown",
                    fixed_number(one.seen, 1)});
    if (one.found < 0) continue;
    PlotSeries place{one.name, {}, {}, PlotStyle::points};
    put(place, pose_at(m.probe, one.found).translation());
    curves.push_back(std::move(place));
  }
  page.drawing(to_svg(PlotPanel{.x_label = "along the probe's face at the start, mm",
                                .y_label = "across it, mm",
                                .series = curves,
                                .equal = true}),
               "the probe's path on the skin, and where it stood when each was found");
  page.table({{"asked for, in this order", ""},
              {"found", "at s"},
              {"in the picture", "s, while it was asked for"}},
             rows);
}

void add_plots(HtmlPage& page, const Scenario& scenario, const AttemptMeasures& m) {
  page.heading("The path of the tip");
  PlotSeries depth{"depth", {}, {}};
  PlotSeries offset{"tip off the plane", {}, {}};
  PlotSeries width{"half the slice", {}, {}, PlotStyle::line, "#777"};
  PlotSeries path{"tip", {}, {}};
  for (std::size_t i = 0; i < m.course.size(); ++i) {
    depth.x.push_back(m.course[i].time);
    depth.y.push_back(m.course[i].depth / kMillimetre);
    if (!m.course[i].inside()) continue;
    const Vec3 p = scenario.X_JP.inverse() * m.course[i].tip;
    path.x.push_back(p.x() / kMillimetre);
    path.y.push_back(p.z() / kMillimetre);
    if (!m.sights[i]) continue;
    offset.x.push_back(m.course[i].time);
    offset.y.push_back(m.sights[i]->offset / kMillimetre);
    width.x.push_back(m.course[i].time);
    width.y.push_back(m.sights[i]->half_width / kMillimetre);
  }
  const Vec3 target = scenario.X_JP.inverse() * scenario.target.point;
  const PlotSeries goal{"target",
                        {target.x() / kMillimetre},
                        {target.z() / kMillimetre},
                        PlotStyle::points,
                        "#2a7d3a"};
  page.drawing(to_svg(PlotPanel{.x_label = "time, s",
                                .y_label = "depth, mm",
                                .series = {depth},
                                .bands = unseen_bands(m)}),
               "depth of the tip; red: advanced without seeing it");
  page.drawing(to_svg(PlotPanel{.x_label = "time, s",
                                .y_label = "mm",
                                .series = {offset, width},
                                .bands = unseen_bands(m)}),
               "how far the tip was beside the picture's plane");
  page.drawing(to_svg(PlotPanel{.x_label = "along the probe's face, mm",
                                .y_label = "depth, mm",
                                .series = {path, goal},
                                .equal = true,
                                .y_down = true}),
               "the tip's path as the intended picture would show it");
}

/// The largest value of each 20th of a second.
template <class Value>
PlotSeries peaks(const Recording& recording, const char* name, Value value) {
  constexpr double kBin = 0.05;  // s
  PlotSeries curve{name, {}, {}};
  for (const TickRecord& tick : recording.ticks) {
    const double bin = std::floor(
        static_cast<double>(tick.input.tick) / recording.head.params.haptic_rate / kBin + 1e-9);
    const double at = (bin + 0.5) * kBin;
    if (curve.x.empty() || at > curve.x.back()) {
      curve.x.push_back(at);
      curve.y.push_back(value(tick));
    } else {
      curve.y.back() = std::max(curve.y.back(), value(tick));
    }
  }
  return curve;
}

double length_of(const double (&v)[3]) {  // NOLINT(*-avoid-c-arrays)
  return std::hypot(v[0], v[1], v[2]);
}

/// What both hands and the thumb felt.
void add_felt(HtmlPage& page, const Recording& recording) {
  const auto felt = [](const TickRecord& t) {
    return length_of(t.force) > 0 || length_of(t.probe_force) > 0;
  };
  if (std::none_of(recording.ticks.begin(), recording.ticks.end(), felt)) return;
  page.heading("What the hands felt");
  const PlotSeries needle =
      peaks(recording, "needle", [](const TickRecord& t) { return length_of(t.force); });
  const PlotSeries probe =
      peaks(recording, "probe", [](const TickRecord& t) { return length_of(t.probe_force); });
  page.drawing(to_svg(PlotPanel{"time, s", "force, N", {needle, probe}}),
               "force on the needle's and on the probe's hand, the largest of each 50 ms");
  const bool injects = std::any_of(
      recording.ticks.begin(), recording.ticks.end(),
      [](const TickRecord& t) { return t.plunger.thumb_force != 0 || t.plunger.given > 0; });
  if (!injects) return;
  const PlotSeries thumb = peaks(
      recording, "thumb, N", [](const TickRecord& t) { return std::abs(t.plunger.thumb_force); });
  const PlotSeries pressure = peaks(recording, "at the tip, 10 kPa", [](const TickRecord& t) {
    return 1e-4 * t.plunger.tip_pressure;
  });
  const PlotSeries given = peaks(recording, "given, ml", [](const TickRecord& t) {
    return t.plunger.given / kCubicCentimetre;
  });
  page.drawing(to_svg(PlotPanel{"time, s", "N, 10 kPa, ml", {thumb, pressure, given}}),
               "the syringe: force on the thumb, pressure at the tip and what was given");
}

void add_marks(HtmlPage& page, const Judgement& judgement) {
  page.heading("Marks");
  std::vector<std::vector<std::string>> rows;
  for (const JudgedMark& m : judgement.marks)
    rows.push_back({m.mark.metric, m.mark.text, m.value ? fixed_number(*m.value, 2) : "not known",
                    m.held ? "held" : "missed", fixed_number(100 * m.part, 0),
                    fixed_number(m.weight, 1)});
  page.table({{"mark", ""},
              {"asked", ""},
              {"value", ""},
              {"", ""},
              {"part", "of 100, for the score; falls from the mark to twice as far as allowed"},
              {"weight", "in the score"}},
             rows);
}

/// Between what most experts stay; empty where nobody knows.
std::string band_of(std::span<const Norm> norms, const Metric& metric) {
  for (const Norm& n : norms)
    if (n.metric == metric.name && n.role == metric.role)
      return fixed_number(n.p10, 3) + " to " + fixed_number(n.p90, 3);
  return "";
}

void add_numbers(HtmlPage& page, const std::vector<Metric>& metrics, std::span<const Norm> norms) {
  page.heading("All numbers");
  std::vector<std::vector<std::string>> rows;
  for (const Metric& m : metrics)
    if (m.value)
      rows.push_back({m.name, m.role, fixed_number(*m.value, 3), band_of(norms, m), m.unit,
                      m.definition, m.rule.filter});
  const std::string experts =
      norms.empty() ? "nobody's yet" : "of " + std::to_string(norms.front().n) + " attempts";
  page.table({{"metric", ""},
              {"of", ""},
              {"value", ""},
              {"experts, 10 to 90 %", experts},
              {"unit", ""},
              {"definition", "", true},
              {"filter", "", true}},
             rows);
}

}  // namespace

Result<void> write_attempt_page(const Scenario& scenario, const std::shared_ptr<const Scene>& scene,
                                const PlayedAttempt& attempt, const Feedback& feedback,
                                std::span<const Norm> norms, const std::filesystem::path& file) {
  HtmlPage page(scenario.title + ": one attempt");
  page.point(attempt.judgement.passed ? "passed" : "failed",
             feedback.verdict + " Score " + std::to_string(whole_points(attempt.judgement.score)) +
                 " of 100, " + fixed_number(attempt.duration, 0) + " s.");
  if (!feedback.good.empty()) page.paragraph("Well done: " + feedback.good);
  page.paragraph("Next: " + feedback.next);
  add_faults(page, scenario, feedback, attempt, scene);
  if (scenario.find.empty())
    add_plots(page, scenario, attempt.measures);
  else
    add_search(page, scenario, attempt.measures);
  add_felt(page, attempt.recording);
  add_marks(page, attempt.judgement);
  add_numbers(page, attempt.measures.metrics, norms);
  return write_text(file, page.text());
}

}  // namespace artus
