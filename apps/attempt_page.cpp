// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/apps/attempt_page.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "artus/apps/html_page.h"
#include "artus/core/text_cursor.h"
#include "artus/core/text_file.h"
#include "artus/core/units.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"
#include "artus/training/svg_plot.h"

namespace artus {
namespace {

/// The picture that the learner had at a time.
cv::Mat picture_at(Renderer& renderer, const AttemptMeasures& m, const NeedleShape& shape,
                   double time) {
  const auto at = [time](const std::vector<TrackPoint>& track) {
    const auto found = std::lower_bound(track.begin(), track.end(), time,
                                        [](const TrackPoint& p, double t) { return p.time < t; });
    return pose_of(found == track.end() ? track.back() : *found);
  };
  return grey_image(renderer.render(at(m.probe), NeedleView{at(m.needle), shape, Vec3::Zero()}));
}

void add_faults(HtmlPage& page, const Feedback& feedback, const PlayedAttempt& attempt,
                const std::shared_ptr<const Scene>& scene) {
  const SessionParams& params = attempt.recording.head.params;
  Renderer renderer(scene, params.transducer, params.image);
  page.heading(feedback.faults.empty() ? "No fault stood out" : "What went wrong, the worst first");
  for (const Fault& fault : feedback.faults) {
    page.open_card("At " + fixed_number(fault.time, 1) + " s");
    page.paragraph(fault.what + ". Why: " + fault.cause + ".");
    page.point("do", fault.mend);
    if (!attempt.measures.probe.empty())
      page.picture(picture_at(renderer, attempt.measures, params.needle_shape, fault.time + 0.5),
                   "the picture at " + fixed_number(fault.time + 0.5, 1) + " s");
    page.close_card();
  }
}

std::vector<SvgBand> unseen_bands(const AttemptMeasures& m) {
  std::vector<SvgBand> bands;
  for (const Run& run : sum_sight(m.course, m.sights).unseen)
    bands.push_back({run.from, run.to, "#f6d5d0", ""});
  return bands;
}

void add_plots(HtmlPage& page, const Scenario& scenario, const AttemptMeasures& m) {
  page.heading("The way");
  SvgCurve depth{"depth", {}, {}};
  SvgCurve offset{"tip off the plane", {}, {}, "#a8461f"};
  SvgCurve width{"half the slice", {}, {}, "#777"};
  SvgCurve path{"tip", {}, {}};
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
  const SvgCurve goal{
      "target", {target.x() / kMillimetre}, {target.z() / kMillimetre}, "#2a7d3a", true};
  page.drawing(to_svg({"time, s", "depth, mm", {depth}, unseen_bands(m), {}}),
               "depth of the tip; red: advanced without seeing it");
  page.drawing(to_svg({"time, s", "mm", {offset, width}, unseen_bands(m), {}}),
               "how far the tip was beside the picture's plane");
  page.drawing(
      to_svg({"along the probe's face, mm", "depth, mm", {path, goal}, {}, {}, true, true}),
      "the tip's path as the intended picture would show it");
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

void add_numbers(HtmlPage& page, const std::vector<Metric>& metrics) {
  page.heading("All numbers");
  std::vector<std::vector<std::string>> rows;
  for (const Metric& m : metrics)
    if (m.value)
      rows.push_back(
          {m.name, m.role, fixed_number(*m.value, 3), m.unit, m.definition, m.rule.filter});
  page.table(
      {{"metric", ""}, {"of", ""}, {"value", ""}, {"unit", ""}, {"definition", ""}, {"filter", ""}},
      rows);
}

}  // namespace

Result<void> write_attempt_page(const Scenario& scenario, const std::shared_ptr<const Scene>& scene,
                                const PlayedAttempt& attempt, const std::filesystem::path& file,
                                std::vector<PastAttempt> before) {
  const Feedback feedback =
      make_feedback(attempt.measures, attempt.judgement, {scenario.level, std::move(before)});
  HtmlPage page(scenario.title + ": one attempt");
  page.point(attempt.judgement.passed ? "passed" : "failed",
             feedback.verdict + " Score " + fixed_number(attempt.judgement.score, 0) + " of 100, " +
                 fixed_number(attempt.duration, 0) + " s.");
  if (!feedback.good.empty()) page.paragraph("Well done: " + feedback.good);
  page.paragraph("Next: " + feedback.next);
  add_faults(page, feedback, attempt, scene);
  add_plots(page, scenario, attempt.measures);
  add_marks(page, attempt.judgement);
  add_numbers(page, attempt.measures.metrics);
  return write_text(file, page.text());
}

}  // namespace artus
