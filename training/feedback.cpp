// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/training/feedback.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace artus {
namespace {

/// What a fault is worth and where its band ends. Severities after the kinds' order of harm; bands
/// assumed but for the drift and the distance of trained people.
struct Kind {
  const char* metric;
  double severity;
  double band;
};
constexpr Kind kAvoid{"avoid_depth_mm", 5, 0.5};
constexpr Kind kOffTarget{"distance_mm", 5, 1.5};
constexpr Kind kUnseen{"unseen_mm", 4, 1};
constexpr Kind kBone{"bone_contacts", 3, 1};
constexpr Kind kDrift{"drift_mm_s", 3, 0.5};
constexpr Kind kPasses{"passes", 3, 2};
constexpr Kind kAngle{"face_angle_median_deg", 2, 50};

double value_of(const AttemptMeasures& m, const char* name) {
  const Metric* metric = find_metric(m.metrics, name);
  return metric != nullptr ? metric->value.value_or(0) : 0;
}

double weight_of(const Kind& kind, double value) {
  return kind.severity * std::clamp(value / kind.band, 0.0, 3.0);
}

std::string beside(const char* what, double value, const char* unit, double band) {
  std::array<char, 200> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), "%s: %.1f %s; asked for: below %.1f",
                                  what, value, unit, band));
  return text.data();
}

const AttemptEvent* worst_event(const AttemptMeasures& m, const std::string& kind) {
  const AttemptEvent* worst = nullptr;
  for (const AttemptEvent& e : m.events)
    if (e.kind.rfind(kind, 0) == 0 && (worst == nullptr || e.value > worst->value)) worst = &e;
  return worst;
}

std::string mend_of_unseen(const std::string& cause) {
  if (cause.find("degrees") != std::string::npos)
    return "Enter further from the probe, so that the needle lies flatter.";
  if (cause.find("shadow") != std::string::npos) return "Choose a way that bone does not cover.";
  if (cause.find("touch") != std::string::npos) return "Keep the whole face on the skin.";
  return "Stop when you lose the tip. Find the needle with the beam: move the probe, then advance.";
}

void add_needle_faults(const AttemptMeasures& m, std::vector<Fault>& out) {
  if (const AttemptEvent* e = worst_event(m, "avoid:"))
    out.push_back({e->kind, e->time, weight_of(kAvoid, std::max(e->value, kAvoid.band)),
                   beside("into what must be spared", e->value, "mm", 0), e->text,
                   "Stop when you lose the tip. Tilt the probe until it is back, then advance."});
  const AttemptEvent* bone = worst_event(m, "bone");
  const double unseen = value_of(m, kUnseen.metric);
  if (const AttemptEvent* e = worst_event(m, "unseen")) {
    const bool on_bone = bone != nullptr && bone->time >= e->time && bone->time < e->time + 3;
    Fault fault{"unseen",
                e->time,
                weight_of(kUnseen, unseen),
                beside("advanced without seeing the tip", unseen, "mm", kUnseen.band),
                e->text,
                mend_of_unseen(e->text)};
    if (on_bone) {
      fault.what += ", and onto bone";
      bone = nullptr;  // one cause, one fault
    }
    out.push_back(std::move(fault));
  }
  if (bone != nullptr)
    out.push_back({"bone", bone->time, weight_of(kBone, value_of(m, kBone.metric)),
                   beside("touches of bone", value_of(m, kBone.metric), "", kBone.band), bone->text,
                   "Slow below 5 mm/s in the last centimetre."});
  const double off = value_of(m, kOffTarget.metric);
  if (const AttemptEvent* e = worst_event(m, "placed"); e != nullptr && off > kOffTarget.band)
    out.push_back({"off_target", e->time, weight_of(kOffTarget, off),
                   beside("away from the target", off, "mm", kOffTarget.band), e->text,
                   "Before you stop, look where the tip is, not where it should be."});
}

void add_hand_faults(const AttemptMeasures& m, std::vector<Fault>& out) {
  const double start = m.course.empty() ? 0 : m.course.front().time;
  const AttemptEvent* contact = worst_event(m, "contact");
  const double entry = contact != nullptr ? contact->time : start;
  const double drift = value_of(m, kDrift.metric);
  if (drift > kDrift.band)
    out.push_back({"drift", entry, weight_of(kDrift, drift),
                   beside("the probe moved while needling", drift, "mm/s", kDrift.band),
                   "both hands moved at once", "Rest the probe hand on the patient."});
  const double passes = value_of(m, kPasses.metric);
  const auto e = std::find_if(m.events.begin(), m.events.end(),
                              [](const AttemptEvent& event) { return event.kind == "pass"; });
  if (e != m.events.end() && passes > kPasses.band)
    out.push_back({"passes", e->time, weight_of(kPasses, passes),
                   beside("passes", passes, "", kPasses.band),
                   "the way was not chosen before the skin", "Choose the line before the skin."});
  const double angle = value_of(m, kAngle.metric);
  if (angle > kAngle.band)
    out.push_back({"angle", entry, weight_of(kAngle, angle),
                   beside("the needle's angle to the probe's face", angle, "degrees", kAngle.band),
                   "a steep needle sends its echo away", "Flatter: enter further from the probe."});
}

std::string praise(const AttemptMeasures& m) {
  const Metric* seen = find_metric(m.metrics, "tip_seen");
  const Metric* plane = find_metric(m.metrics, "in_plane_fraction");
  if (seen != nullptr && seen->value && *seen->value >= 0.9)
    return "You kept the tip in sight nearly all the time.";
  if (plane != nullptr && plane->value && *plane->value >= 0.9)
    return "You kept the needle in the plane while you advanced.";
  if (worst_event(m, "contact") != nullptr && value_of(m, "passes") == 1)
    return "You came there in a single pass.";
  if (value_of(m, "drift_mm_s") < kDrift.band && !m.probe.empty())
    return "Your probe hand was quiet.";
  return "";
}

std::string next_task(const Judgement& judgement, const std::vector<Fault>& faults) {
  if (judgement.with_aids) return "The same once more with the aids off: only that counts.";
  if (judgement.passed) return "Once more to make sure, then the next level.";
  if (faults.empty()) return "The same task once more.";
  const std::string& kind = faults.front().kind;
  if (kind == "unseen" || kind == "drift" || kind == "angle")
    return "Hold the needle in the plane on the gel block (gel-hold).";
  if (kind == "off_target") return "Touch the point at 20 mm on the gel block (gel-align).";
  return "The same task once more, slower in the last centimetre.";
}

}  // namespace

Feedback make_feedback(const AttemptMeasures& measures, const Judgement& judgement) {
  constexpr std::size_t kMost = 3;
  Feedback out;
  out.verdict = judgement.passed ? "Passed." : "Not passed";
  if (!judgement.passed) {
    std::string missed;
    for (const JudgedMark& m : judgement.marks)
      if (!m.held)
        missed += (missed.empty() ? ": " : ", ") + m.mark.metric + " should be " + m.mark.text;
    out.verdict += missed.empty() && judgement.with_aids ? ": aids were on." : missed + ".";
  }
  add_needle_faults(measures, out.faults);
  add_hand_faults(measures, out.faults);
  std::stable_sort(out.faults.begin(), out.faults.end(),
                   [](const Fault& a, const Fault& b) { return a.weight > b.weight; });
  out.next = next_task(judgement, out.faults);
  if (out.faults.size() > kMost) out.faults.resize(kMost);
  out.good = praise(measures);
  return out;
}

}  // namespace artus
