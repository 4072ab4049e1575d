// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/attempt_events.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/training/metrics/placement.h"

namespace artus {
namespace {

std::size_t index_at(const std::vector<CoursePoint>& course, double time) {
  const auto at = std::lower_bound(course.begin(), course.end(), time,
                                   [](const CoursePoint& p, double t) { return p.time < t; });
  return at == course.end() ? course.size() - 1 : static_cast<std::size_t>(at - course.begin());
}

/// Why the tip was not seen over most of a run.
std::string cause_of(const AttemptView& view, const Run& run) {
  const auto& m = view.measures;
  std::array<int, 6> votes{};
  std::array<const TipSight*, 6> example{};
  for (std::size_t i = index_at(m.course, run.from); i < m.course.size(); ++i) {
    if (m.course[i].time > run.to) break;
    if (!m.sights[i] || m.sights[i]->seen()) continue;
    const auto loss = static_cast<std::size_t>(m.sights[i]->loss);
    ++votes[loss];
    const TipSight*& worst = example[loss];
    if (worst == nullptr || std::abs(m.sights[i]->offset) > std::abs(worst->offset))
      worst = &*m.sights[i];
  }
  const auto max =
      static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
  const TipSight* sight = example[max];
  if (sight == nullptr) return "the tip was not seen";
  switch (sight->loss) {
    case SightLoss::off_plane:
      return printed(sight->offset > 0 ? "the tip was %.1f mm in front of the plane"
                                       : "the tip was %.1f mm behind the plane",
                     std::abs(sight->offset) / kMillimetre);
    case SightLoss::angle:
      return printed(
          "the needle stood at %.0f degrees to the probe's face: %.0f dB lost to the angle",
          sight->face_angle / kDegree, sight->angle_db);
    case SightLoss::shadow:
      return "the tip was in the shadow of " + view.scene.joint().regions[sight->shadow].name;
    case SightLoss::no_contact:
      return "the probe did not touch the skin above the tip";
    case SightLoss::off_sector:
      return "the tip was beside or below the picture";
    case SightLoss::none:
      return "what lay around the tip was as bright as it";
  }
  return "the tip was not seen";
}

/// What the syringe did, at its moments; none where nothing was given.
template <class Put>
void add_syringe_events(const AttemptView& view, const Put& put) {
  constexpr double kNoticed = 0.5e-6;  // m^3 beside the target from which it is one
  const SyringeTotals& sum = view.measures.syringe;
  const auto& doses = view.measures.doses;
  if (doses.empty()) return;
  const auto& regions = view.scene.joint().regions;
  put(doses.front().time, "flow", sum.given / kCubicCentimetre,
      sum.aspirated_first ? "liquid flowed after an aspiration" : "liquid flowed, unaspirated");
  put(sum.peak_flow_time, "fastest", sum.peak_flow / kCubicCentimetre,
      printed("%.2f ml/s at the fastest", sum.peak_flow / kCubicCentimetre));
  put(sum.peak_pressure_time, "pressure", sum.peak_pressure / 1e3,
      printed("%.0f kPa in the barrel", sum.peak_pressure / 1e3));
  const auto& target = view.options.goals.target;
  if (!target || !target->body) return;
  std::vector<double> astray(regions.size());
  double all = 0;
  double noticed = 0;
  for (const Dose& dose : doses) {
    if (dose.region >= astray.size() || distance_to(*target, dose.tip) <= 0) continue;
    if (all < kNoticed) noticed = dose.time;
    all += dose.volume;
    astray[dose.region] += dose.volume;
  }
  if (all < kNoticed) return;
  const auto max = std::max_element(astray.begin(), astray.end());
  put(noticed, "misplaced", all / kCubicCentimetre,
      printed("%.1f ml with the tip in ", *max / kCubicCentimetre) +
          regions[static_cast<std::size_t>(max - astray.begin())].name +
          (sum.pauses > 0 ? "" : ", without a pause to check where the first drops went"));
}

/// What was shown with the probe, and why the first that was not shown was not.
void add_sought_events(const AttemptView& view, std::vector<AttemptEvent>& events) {
  const auto& m = view.measures;
  for (const Sought& one : m.sought) {
    if (one.found >= 0) {
      events.push_back({one.found, "found", one.name, one.found, one.name + " was shown"});
      continue;
    }
    const double end = m.probe.empty() ? 0 : m.probe.back().time;
    events.push_back({end, "not_found", one.name, one.seen,
                      one.seen > 0
                          ? printed("it was in the picture for %.1f s, and not in its middle for "
                                    "%.1f s on end",
                                    one.seen, StructureSearch::kHold)
                          : "it was never in the picture while it was asked for"});
    return;
  }
}

}  // namespace

std::vector<AttemptEvent> find_events(const AttemptView& view) {
  const auto& m = view.measures;
  std::vector<AttemptEvent> events;
  add_sought_events(view, events);
  if (m.course.empty()) return events;
  const auto put = [&](double time, std::string kind, double value, std::string text) {
    const CoursePoint& at = m.course[index_at(m.course, time)];
    const std::string& region = view.scene.joint().regions[at.region].name;
    events.push_back({time, std::move(kind), region, value, std::move(text)});
  };
  const CourseTotals sum = sum_course(m.course);
  if (sum.first_contact)
    put(*sum.first_contact, "contact", 0,
        m.course.front().inside() ? "the needle was inside from the start"
                                  : "the needle went through the skin");
  for (const Run& run : sum_sight(m.course, m.sights).unseen)
    put(run.from, "unseen", run.amount / kMillimetre, cause_of(view, run));
  for (const FeltTouch& touch : m.touches)
    put(touch.time, "bone", touch.peak,
        printed("the tip came onto bone at %.0f mm/s", touch.speed / kMillimetre));
  for (const AvoidZone& zone : view.options.goals.avoid) {
    const Intrusion in = find_intrusion(zone, m.course);
    if (in.first)
      put(*in.first, (zone.fatal ? "fatal:" : "avoid:") + zone.name, in.depth / kMillimetre,
          printed("the tip went %.1f mm into the zone around ", in.depth / kMillimetre) +
              zone.name);
  }
  const auto passes = find_passes(m.course);
  for (std::size_t i = 1; i < passes.size(); ++i)
    put(passes[i], "pass", static_cast<double>(i + 1), "the needle was brought forward again");
  for (const Run& run : find_idle(m.course, m.probe))
    put(run.from, "idle", run.amount, printed("nothing moved for %.1f s", run.amount));
  const auto& goal = view.options.goals.target;
  if (const auto placed = find_placement(m.course, goal ? &*goal : nullptr, m.doses)) {
    const double off = goal ? distance_to(*goal, m.course[*placed].tip) / kMillimetre : 0;
    put(m.course[*placed].time, "placed", off,
        goal ? printed("the needle was placed %.1f mm from the target", off)
             : "the needle was placed");
  }
  if (m.course.back().inside())
    put(m.course.back().time, "left_in", m.course.back().depth / kMillimetre,
        printed("the tip was %.1f mm deep at the end", m.course.back().depth / kMillimetre));
  add_syringe_events(view, put);
  std::stable_sort(events.begin(), events.end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
  return events;
}

}  // namespace artus
