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
#include "artus/detail/reports/feedback_words.h"
#include "artus/detail/reports/html_page.h"
#include "artus/detail/reports/mark_words.h"
#include "artus/detail/reports/moment_view.h"
#include "artus/detail/reports/number_words.h"
#include "artus/detail/viewer/words/anatomy_names.h"
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

void add_faults(HtmlPage& page, const AttemptReport& report) {
  const Language language = page.language();
  const std::vector<Fault>& faults = report.feedback.faults;
  page.heading(faults.empty() ? translate(page, "No fault stood out")
                              : translate(page, "What went wrong, the worst first"));
  if (faults.empty()) return;
  Clips clips(report.scenario, report.attempt, report.scene);
  for (const Fault& fault : faults) {
    page.open_card(fill(translate(page, "At {} s"), {number(language, fault.time, 1)}));
    page.paragraph(fill(translate(page, "{}. Why: {}."), {feedback_words(language, fault.what),
                                                          feedback_words(language, fault.cause)}));
    page.point(msgid("do"), feedback_words(language, fault.mend));
    std::string caption =
        translate(page, "at half speed: the picture, and the joint cut open at its plane");
    if (!report.attempt.measures.needle.empty())
      caption += translate(page, "; needle blue, its tip orange, the target green");
    if (!report.scenario.avoid.empty()) caption += translate(page, "; structures to avoid red");
    if (!report.attempt.measures.probe.empty()) page.clip(clips.around(fault.time), caption);
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
  page.heading(translate(page, "What was shown"));
  PlotSeries path{translate(page, "probe"), {}, {}};
  const auto put = [&scenario](PlotSeries& curve, const Vec3& p_J) {
    const Vec3 p = scenario.X_JP.inverse() * p_J;
    curve.x.push_back(p.x() / kMillimetre);
    curve.y.push_back(p.y() / kMillimetre);
  };
  for (const TrackPoint& point : m.probe) put(path, point.p);
  std::vector<PlotSeries> curves{path};
  std::vector<std::vector<std::string>> rows;
  for (const Sought& one : m.sought) {
    const std::string name = clinical_name(page.language(), one.name);
    rows.push_back(
        {name,
         one.found >= 0 ? number(page.language(), one.found, 1) : translate(page, "not shown"),
         number(page.language(), one.seen, 1)});
    if (one.found < 0) continue;
    PlotSeries place{name, {}, {}, PlotStyle::points};
    put(place, pose_at(m.probe, one.found).translation());
    curves.push_back(std::move(place));
  }
  page.drawing(
      to_svg(PlotPanel{.x_label = translate(page, "along the probe's face at the start, mm"),
                       .y_label = translate(page, "across it, mm"),
                       .series = curves,
                       .equal = true}),
      translate(page, "the probe's path on the skin, and where it stood when each was found"));
  page.table({{translate(page, "asked for, in this order"), ""},
              {translate(page, "found"), translate(page, "at s")},
              {translate(page, "in the picture"), translate(page, "s, while it was asked for")}},
             rows);
}

void add_plots(HtmlPage& page, const Scenario& scenario, const AttemptMeasures& m) {
  page.heading(translate(page, "The path of the tip"));
  PlotSeries depth{translate(page, "depth"), {}, {}};
  PlotSeries offset{translate(page, "tip off the plane"), {}, {}};
  PlotSeries width{translate(page, "half the slice"), {}, {}, PlotStyle::line, "#777"};
  PlotSeries path{translate(page, "tip"), {}, {}};
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
  const PlotSeries goal{translate(page, "target"),
                        {target.x() / kMillimetre},
                        {target.z() / kMillimetre},
                        PlotStyle::points,
                        "#2a7d3a"};
  page.drawing(to_svg(PlotPanel{.x_label = translate(page, "time, s"),
                                .y_label = translate(page, "depth, mm"),
                                .series = {depth},
                                .bands = unseen_bands(m)}),
               translate(page, "depth of the tip; red: advanced without seeing it"));
  page.drawing(to_svg(PlotPanel{.x_label = translate(page, "time, s"),
                                .y_label = "mm",
                                .series = {offset, width},
                                .bands = unseen_bands(m)}),
               translate(page, "how far the tip was beside the picture's plane"));
  page.drawing(to_svg(PlotPanel{.x_label = translate(page, "along the probe's face, mm"),
                                .y_label = translate(page, "depth, mm"),
                                .series = {path, goal},
                                .equal = true,
                                .y_down = true}),
               translate(page, "the tip's path as the intended picture would show it"));
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
  page.heading(translate(page, "What the hands felt"));
  const PlotSeries needle = peaks(recording, translate(page, "needle"),
                                  [](const TickRecord& t) { return length_of(t.force); });
  const PlotSeries probe = peaks(recording, translate(page, "probe"),
                                 [](const TickRecord& t) { return length_of(t.probe_force); });
  page.drawing(
      to_svg(PlotPanel{translate(page, "time, s"), translate(page, "force, N"), {needle, probe}}),
      translate(page, "force on the needle's and on the probe's hand, the largest of each 50 ms"));
  const bool injects = std::any_of(
      recording.ticks.begin(), recording.ticks.end(),
      [](const TickRecord& t) { return t.plunger.thumb_force != 0 || t.plunger.given > 0; });
  if (!injects) return;
  const PlotSeries thumb = peaks(recording, translate(page, "thumb, N"), [](const TickRecord& t) {
    return std::abs(t.plunger.thumb_force);
  });
  const PlotSeries pressure =
      peaks(recording, translate(page, "at the tip, 10 kPa"),
            [](const TickRecord& t) { return 1e-4 * t.plunger.tip_pressure; });
  const PlotSeries given =
      peaks(recording, translate(page, "injected, ml"),
            [](const TickRecord& t) { return t.plunger.given / kCubicCentimetre; });
  page.drawing(
      to_svg(PlotPanel{translate(page, "time, s"), "N, 10 kPa, ml", {thumb, pressure, given}}),
      translate(page, "the syringe: force on the thumb, pressure at the tip, injected volume"));
}

void add_marks(HtmlPage& page, const Judgement& judgement) {
  const Language language = page.language();
  page.heading(translate(page, "Marks"));
  std::vector<std::vector<std::string>> rows;
  for (const JudgedMark& m : judgement.marks)
    rows.push_back({metric_words(language, m.mark.metric), bound_words(language, m.mark),
                    m.value ? number(language, *m.value, 2) : translate(page, "not known"),
                    m.held ? translate(page, "met") : translate(page, "missed"),
                    number(language, 100 * m.part, 0), number(language, m.weight, 1)});
  page.table(
      {{translate(page, "mark"), ""},
       {translate(page, "limit"), ""},
       {translate(page, "value"), ""},
       {"", ""},
       {translate(page, "part"),
        translate(page, "of 100, for the score; falls from the mark to twice as far as allowed")},
       {translate(page, "weight"), translate(page, "in the score")}},
      rows);
}

/// Between what most experts stay; empty where nobody knows.
std::string band_of(std::span<const Norm> norms, const Metric& metric, Language language) {
  for (const Norm& n : norms)
    if (n.metric == metric.name && n.role == metric.role)
      return fill(translate(language, "{} to {}"),
                  {number(language, n.p10, 3), number(language, n.p90, 3)});
  return "";
}

void add_numbers(HtmlPage& page, const std::vector<Metric>& metrics, std::span<const Norm> norms) {
  const Language language = page.language();
  page.heading(translate(page, "All numbers"));
  std::vector<std::vector<std::string>> rows;
  for (const Metric& m : metrics)
    if (m.value)
      rows.push_back({metric_words(language, m.name), number_words(language, m.role),
                      number(language, *m.value, 3), band_of(norms, m, language),
                      number_words(language, m.definition), number_words(language, m.rule.filter)});
  const std::string experts =
      norms.empty() ? std::string(translate(page, "no attempt yet"))
                    : fill(translate_count(language, "of {} attempt", "of {} attempts",
                                           static_cast<long>(norms.front().n)),
                           {std::to_string(norms.front().n)});
  page.table({{translate(page, "metric"), ""},
              {translate(page, "of"), ""},
              {translate(page, "value"), ""},
              {translate(page, "experts, 10 to 90 %"), experts},
              {translate(page, "definition"), "", true},
              {translate(page, "filter"), "", true}},
             rows);
}

}  // namespace

Result<void> write_attempt_page(const AttemptReport& report, const std::filesystem::path& file) {
  const Language language = report.language;
  const Judgement& judgement = report.attempt.judgement;
  const Feedback& feedback = report.feedback;
  HtmlPage page(
      fill(translate(language, "{}: one attempt"), {title_words(language, report.scenario)}),
      language);
  std::string missed;
  for (const JudgedMark& m : judgement.marks)
    if (!m.held) missed += (missed.empty() ? "" : "; ") + mark_words(language, m.mark);
  page.point(judgement.passed ? msgid("passed") : msgid("failed"),
             fill(translate(page, "Score {} of 100, {} s"),
                  {std::to_string(whole_points(judgement.score)),
                   number(language, report.attempt.duration, 0)}) +
                 (missed.empty() ? "" : ". " + fill(translate(page, "Missed: {}"), {missed})) +
                 (judgement.with_aids ? translate(page, ". Aids were on") : "") + ".");
  if (!feedback.good.empty())
    page.paragraph(
        fill(translate(page, "Well done: {}"), {feedback_words(language, feedback.good)}));
  page.paragraph(fill(translate(page, "Next: {}"), {feedback_words(language, feedback.next)}));
  add_faults(page, report);
  if (report.scenario.find.empty())
    add_plots(page, report.scenario, report.attempt.measures);
  else
    add_search(page, report.scenario, report.attempt.measures);
  add_felt(page, report.attempt.recording);
  add_marks(page, judgement);
  add_numbers(page, report.attempt.measures.metrics, report.norms);
  return write_text(file, page.text());
}

}  // namespace artus
