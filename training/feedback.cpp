// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/feedback.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/training/metrics/limits.h"

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
constexpr Kind kOffTarget{"distance_mm", 5, kMostOffTargetMm};
constexpr Kind kUnseen{"unseen_mm", 4, kMostUnseenMm};
constexpr Kind kBone{"bone_contacts", 3, 1};
constexpr Kind kDrift{"drift_mm_s", 3, 0.5};
constexpr Kind kPasses{"passes", 3, 2};
constexpr Kind kAngle{"face_angle_median_deg", 2, 50};
constexpr Kind kIdle{"idle_s", 1, 10};
constexpr Kind kMisplaced{"misplaced_ml", 5, kMostMisplacedMl};  // given_ml beside in_target
constexpr Kind kUnaspirated{"aspirated_first", 4, 1};
constexpr Kind kPressure{"pressure_peak_kpa", 4, kMostPressureKpa};
constexpr Kind kFast{"flow_peak_ml_s", 2, 0.3};
constexpr double kLeftIn = 12;    // weight: the worst that a hand can leave behind
constexpr double kLate = 3;       // weight
constexpr double kUnasked = 9;    // weight: it endangers whatever the hands do
constexpr double kNeverIn = 8;    // weight: nothing else was tried
constexpr double kNotFound = 6;   // weight: without a view there is no needle
constexpr double kAgain = 1.5;    // weight of a fault that was in the attempt before
constexpr double kHalfLife = 20;  // weeks
constexpr double kWeak = 0.5;     // share of clean attempts below which a skill is trained
constexpr int kIdleLevel = 5;

double value_of(const AttemptMeasures& m, const char* name) {
  return value_of(m.metrics, name);
}

/// The run with most of it, the way to the picture's edge in the first one aside.
const AttemptEvent* worst_unseen(const AttemptMeasures& m) {
  const AttemptEvent* worst = nullptr;
  double max = 0;
  double entry = value_of(m.metrics, "unseen_entry_mm");
  for (const AttemptEvent& e : m.events) {
    if (e.kind != "unseen") continue;
    if (e.value - entry > max) worst = &e;
    max = std::max(max, e.value - entry);
    entry = 0;
  }
  return worst;
}

double weight_of(const Kind& kind, double value) {
  return kind.severity * std::clamp(value / kind.band, 0.0, 3.0);
}

std::string beside(const char* what, double value, const char* unit, double band) {
  return printed("%s: %.1f %s; should be below %.1f", what, value, unit, band);
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
  if (cause.find("shadow") != std::string::npos) return "Choose a path that bone does not shadow.";
  if (cause.find("touch") != std::string::npos) return "Keep the whole face on the skin.";
  return "Stop when you lose the tip. Find the needle with the beam: move the probe, then advance.";
}

const JudgedMark* mark_of(const Judgement& judgement, const char* metric) {
  for (const JudgedMark& mark : judgement.marks)
    if (mark.mark.metric == metric) return &mark;
  return nullptr;
}
bool missed(const Judgement& judgement, const char* metric) {
  const JudgedMark* mark = mark_of(judgement, metric);
  return mark != nullptr && !mark->held;
}

/// A kind with the band that the task's own mark sets, where it has one.
Kind with_mark(Kind kind, const Judgement& judgement) {
  if (const JudgedMark* mark = mark_of(judgement, kind.metric)) kind.band = mark->mark.bound;
  return kind;
}

/// What the end of the attempt was, where the task asks for another.
void add_end_faults(const AttemptMeasures& m, const Judgement& judgement, std::vector<Fault>& out) {
  if (const AttemptEvent* e = worst_event(m, "left_in");
      e != nullptr && missed(judgement, "withdrawn"))
    out.push_back({"left_in", e->time, kLeftIn, "the needle was left in the patient", e->text,
                   "Withdraw the needle before you end the attempt."});
  if (!(value_of(m, "time_in_tissue_s") > 0) && missed(judgement, kOffTarget.metric))
    out.push_back(
        {"never_in", m.course.empty() ? 0 : m.course.back().time, kNeverIn,
         "the needle was never in the patient", "",
         "Put the tip on the skin beside the probe and advance it in the picture's plane."});
  if (missed(judgement, "asked"))
    out.push_back(
        {"unasked", m.course.empty() ? 0 : m.course.front().time, kUnasked,
         "the patient was not asked all that matters",
         printed("%.0f of 100 of the task's questions were asked", 100 * value_of(m, "asked")),
         "Ask before you begin: side, allergies, blood thinners, infections, consent."});
  const JudgedMark* late = mark_of(judgement, "done_s");
  if (late != nullptr && late->value && !late->held)
    out.push_back({"late", late->mark.bound, kLate,
                   beside("time until the needle was out", *late->value, "s", late->mark.bound),
                   "the time limit was over",
                   "Look and decide before you enter the skin, then go."});
  const JudgedMark* entry = mark_of(judgement, "entry_offset_mm");
  if (const AttemptEvent* e = worst_event(m, "contact");
      e != nullptr && entry != nullptr && entry->value && !entry->held)
    out.push_back(
        {"entry", e->time, kLate,
         beside("distance from the planned entry", *entry->value, "mm", entry->mark.bound),
         "the path was not chosen before the skin", "Choose the path before you enter the skin."});
}

void add_needle_faults(const AttemptMeasures& m, const Judgement& judgement,
                       std::vector<Fault>& out) {
  if (const AttemptEvent* e = worst_event(m, "fatal:"))
    out.push_back({e->kind, e->time, weight_of(kAvoid, 3 * kAvoid.band),
                   beside("entered a structure that must never be entered", e->value, "mm", 0),
                   e->text,
                   "Find this structure in the picture first. Choose a path that passes it."});
  if (const AttemptEvent* e = worst_event(m, "avoid:"))
    out.push_back({e->kind, e->time, weight_of(kAvoid, std::max(e->value, kAvoid.band)),
                   beside("entered a structure to avoid", e->value, "mm", 0), e->text,
                   "Stop when you lose the tip. Tilt the probe until it is back, then advance."});
  const AttemptEvent* bone = worst_event(m, "bone");
  const double unseen = unseen_mm(m.metrics);
  if (const AttemptEvent* e = worst_unseen(m); e != nullptr && unseen > kUnseen.band) {
    const bool on_bone = bone != nullptr && bone->time >= e->time && bone->time < e->time + 3;
    out.push_back({"unseen", e->time, weight_of(kUnseen, unseen),
                   beside("advanced without seeing the tip", unseen, "mm", kUnseen.band), e->text,
                   mend_of_unseen(e->text)});
    if (on_bone) {
      out.back().what += ", and onto bone";
      bone = nullptr;  // one cause, one fault
    }
  }
  const double contacts = value_of(m, kBone.metric);
  const JudgedMark* allowed = mark_of(judgement, kBone.metric);
  const double most = allowed != nullptr ? allowed->mark.bound : 0;
  if (bone != nullptr && contacts > most)
    out.push_back({"bone", bone->time, weight_of(kBone, contacts),
                   beside("bone contacts", contacts, "", most + 1), bone->text,
                   "Slow down to less than 5 mm/s in the last centimetre."});
  const double off = value_of(m, kOffTarget.metric);
  const Kind place = with_mark(kOffTarget, judgement);
  if (const AttemptEvent* e = worst_event(m, "placed"); e != nullptr && off > place.band)
    out.push_back({"off_target", e->time, weight_of(place, off),
                   beside("distance from the target", off, "mm", place.band), e->text,
                   "Before you stop, look where the tip is, not where it should be."});
}

void add_look_faults(const AttemptMeasures& m, std::vector<Fault>& out) {
  const AttemptEvent* e = worst_event(m, "not_found");
  if (e == nullptr) return;
  out.push_back({"not_found", e->time, kNotFound,
                 printed("shown: %.0f of %.0f; not shown: ", value_of(m, "found"),
                         static_cast<double>(m.sought.size())) +
                     e->region,
                 e->text,
                 "Sweep the whole area slowly. Stop when you see it, bring it to the middle and "
                 "hold still."});
}

/// Whether the needle came where it should.
bool reached(const AttemptMeasures& m, const Judgement& judgement) {
  const Metric* distance = find_metric(m.metrics, kOffTarget.metric);
  if (worst_event(m, "contact") == nullptr || distance == nullptr || !distance->value) return false;
  const JudgedMark* mark = mark_of(judgement, kOffTarget.metric);
  return mark != nullptr ? mark->held : *distance->value <= kOffTarget.band;
}

/// The moment at which the probe was fastest while the tip moved inside, and its speed there.
Run fastest_drift(const AttemptMeasures& m) {
  constexpr double kMoving = 2e-3;  // m/s, as drift_mm_s
  const std::vector<double> speeds = speeds_of(m.probe);
  Run worst;
  for (std::size_t i = 1; i < m.course.size() && i <= speeds.size(); ++i) {
    if (!m.course[i].inside() || m.course[i].step * kTrackRate < kMoving) continue;
    if (speeds[i - 1] > worst.amount)
      worst = {m.course[i - 1].time, m.course[i].time, speeds[i - 1]};
  }
  return worst;
}

void add_syringe_faults(const AttemptMeasures& m, const Judgement& judgement,
                        std::vector<Fault>& out) {
  const double astray = misplaced_ml(m.metrics);
  if (const AttemptEvent* e = worst_event(m, "misplaced"); e != nullptr) {
    // Liquid goes where the tip is: one cause, one fault.
    std::erase_if(out, [](const Fault& fault) { return fault.kind == "off_target"; });
    out.push_back({"misplaced", e->time, weight_of(kMisplaced, astray),
                   beside("injected outside the target", astray, "ml", kMisplaced.band), e->text,
                   "Inject half a ml and look: the line must open."});
  }
  if (const AttemptEvent* e = worst_event(m, "flow"); e != nullptr && is_unaspirated(m.metrics))
    out.push_back({"unaspirated", e->time, weight_of(kUnaspirated, 1),
                   printed("%.1f ml injected without aspirating first", e->value),
                   "the plunger was not drawn back for 2 s; the tip was in " + e->region,
                   "Aspirate for 3 s before you inject."});
  const double pressure = value_of(m, kPressure.metric);
  const Kind press = with_mark(kPressure, judgement);
  if (const AttemptEvent* e = worst_event(m, "pressure"); e != nullptr && pressure > press.band)
    out.push_back({"pressure", e->time, weight_of(press, pressure),
                   beside("pressure in the syringe", pressure, "kPa", press.band),
                   "the tip was in " + e->region,
                   "Do not force it: withdraw the needle by a millimetre until it flows."});
  const double flow = value_of(m, kFast.metric);
  const Kind fast = with_mark(kFast, judgement);
  if (const AttemptEvent* e = worst_event(m, "fastest"); e != nullptr && flow > fast.band)
    out.push_back(
        {"fast", e->time, weight_of(fast, flow), beside("fastest flow", flow, "ml/s", fast.band),
         "the thumb pushed with " + printed("%.0f N", value_of(m, "plunger_peak_n")) + " at most",
         "Inject more slowly than 0.3 ml/s, so that you feel the tissue."});
}

void add_idle(const AttemptMeasures& m, std::vector<Fault>& out) {
  // A needle that rests while something is given is where it should be.
  const double idle = value_of(m, kIdle.metric) - value_of(m, "syringe_s");
  const AttemptEvent* e = worst_event(m, "idle");
  if (e == nullptr || idle <= kIdle.band) return;
  out.push_back({"idle", e->time, weight_of(kIdle, idle),
                 beside("needle at rest in the tissue", idle, "s", kIdle.band), e->text,
                 "Look and decide before you enter the skin, then go."});
}

void add_hand_faults(const AttemptMeasures& m, const Judgement& judgement,
                     std::vector<Fault>& out) {
  const double start = m.course.empty() ? 0 : m.course.front().time;
  const AttemptEvent* contact = worst_event(m, "contact");
  const double entry = contact != nullptr ? contact->time : start;
  const double drift = value_of(m, kDrift.metric);
  if (const Run worst = fastest_drift(m); drift > kDrift.band && worst.amount > 0)
    out.push_back({"drift", worst.from, weight_of(kDrift, drift),
                   beside("the probe moved while needling", drift, "mm/s", kDrift.band),
                   printed("both hands moved at once, the probe with %.1f mm/s at the fastest",
                           worst.amount / kMillimetre),
                   "Rest the probe hand on the patient."});
  const double passes = value_of(m, kPasses.metric);
  const Kind again = with_mark(kPasses, judgement);
  const auto e = std::find_if(m.events.begin(), m.events.end(),
                              [](const AttemptEvent& event) { return event.kind == "pass"; });
  if (e != m.events.end() && passes > again.band)
    out.push_back(
        {"passes", e->time, weight_of(again, passes), beside("passes", passes, "", again.band),
         "the path was not chosen before the skin", "Choose the path before you enter the skin."});
  const double angle = value_of(m, kAngle.metric);
  if (angle > kAngle.band)
    out.push_back({"angle", entry, weight_of(kAngle, angle),
                   beside("the needle's angle to the probe's face", angle, "degrees", kAngle.band),
                   "a steep needle sends its echo away",
                   "Hold the needle flatter: enter further from the probe."});
}

/// One thing done well that no harm, mark or fault contradicts.
std::string praise(const AttemptMeasures& m, const Judgement& judgement,
                   const std::vector<Fault>& faults) {
  for (const JudgedMark& mark : judgement.marks)
    if (!mark.held && kind_of_mark(mark.mark.metric) >= MarkKind::danger) return "";
  const auto faulty = [&](const char* kind) {
    return std::any_of(faults.begin(), faults.end(),
                       [&](const Fault& fault) { return fault.kind == kind; });
  };
  if (std::any_of(faults.begin(), faults.end(), [](const Fault& fault) {
        return severity_of_fault(fault.kind) >= FaultSeverity::harm;
      }))
    return "";
  const bool blind = faulty("unseen") || missed(judgement, "unseen_advances") ||
                     missed(judgement, "unseen_mm") || missed(judgement, "tip_seen");
  const Metric* seen = find_metric(m.metrics, "tip_seen");
  if (const std::size_t n = m.sought.size();
      n > 0 && value_of(m, "found") == static_cast<double>(n))
    return "You found all that was asked for.";
  const Metric* plane = find_metric(m.metrics, "in_plane_fraction");
  if (!blind && seen != nullptr && seen->value && *seen->value >= 0.9)
    return "You kept the tip in sight nearly all the time.";
  if (!blind && plane != nullptr && plane->value && *plane->value >= 0.9 &&
      !missed(judgement, "plane_offset_p90_mm"))
    return "You kept the needle in the plane while you advanced.";
  if (reached(m, judgement) && value_of(m, "passes") == 1 && !faulty("off_target"))
    return "You reached the target in a single pass.";
  if (m.sought.empty() && worst_event(m, "contact") != nullptr && !blind && !m.probe.empty() &&
      value_of(m, "drift_mm_s") < kDrift.band && !missed(judgement, "drift_mm_s"))
    return "Your probe hand was steady.";
  return "";
}

/// Which skill is the weakest, by this attempt and those before.
std::optional<Skill> weakest_skill(const PastAttempt& now, const FeedbackContext& context) {
  constexpr std::size_t kSkills = 5;
  std::array<double, kSkills> clean{}, count{};
  const auto add = [&](const PastAttempt& attempt) {
    std::array<bool, kSkills> faulty{};
    for (const std::string& kind : attempt.kinds)
      faulty[static_cast<std::size_t>(skill_of_fault(kind))] = true;
    for (std::size_t k = 0; k < faulty.size(); ++k) {
      if (attempt.looked != (static_cast<Skill>(k) == Skill::look)) continue;
      if (static_cast<Skill>(k) == Skill::inject && !attempt.injected) continue;
      count[k] += 1;
      if (!faulty[k]) clean[k] += std::exp2(-attempt.weeks / kHalfLife);
    }
  };
  for (const PastAttempt& attempt : context.before) add(attempt);
  add(now);
  std::optional<Skill> weakest;
  double min = kWeak;
  for (std::size_t k = 0; k < clean.size(); ++k) {
    if (count[k] == 0 || clean[k] / count[k] >= min) continue;
    min = clean[k] / count[k];
    weakest = static_cast<Skill>(k);
  }
  return weakest;
}

struct SkillTask {
  const char* what;
  const char* scenario;
};
/// A skill's task: what to do, and the scenario for it.
SkillTask task_of(Skill skill) {
  constexpr std::array<SkillTask, 5> kTasks{
      {{"Find the structures in the gel block with the probe.", "gel-look"},
       {"Follow the tip to a shallow point on the gel block.", "gel-find"},
       {"Hold the needle in the plane on the gel block.", "gel-hold"},
       {"Touch the point at 20 mm on the gel block.", "gel-align"},
       {"Repeat this task: aspirate, inject half a ml, look, then inject the rest.", ""}}};
  return kTasks.at(static_cast<std::size_t>(skill));
}

SkillTask next_task(const Judgement& judgement, const std::optional<Skill>& weakest) {
  const bool all_held = std::all_of(judgement.marks.begin(), judgement.marks.end(),
                                    [](const JudgedMark& mark) { return mark.held; });
  if (judgement.with_aids && !all_held)
    return {"Repeat this task with the aids until all marks hold.", ""};
  if (judgement.with_aids) return {"Do the same task again without aids: only that counts.", ""};
  if (weakest) return task_of(*weakest);
  if (judgement.passed) return {"Repeat it once to make sure, then go to the next level.", ""};
  return {"Repeat this task.", ""};
}

}  // namespace

FaultSeverity severity_of_fault(const std::string& kind) noexcept {
  if (kind.rfind("fatal:", 0) == 0) return FaultSeverity::fatal;
  constexpr std::array<const char*, 6> kHarms{"left_in",     "unasked",  "misplaced",
                                              "unaspirated", "pressure", "bone"};
  if (kind.rfind("avoid:", 0) == 0 || std::find(kHarms.begin(), kHarms.end(), kind) != kHarms.end())
    return FaultSeverity::harm;
  const bool purpose =
      kind == "off_target" || kind == "never_in" || kind == "unseen" || kind == "not_found";
  return purpose ? FaultSeverity::purpose : FaultSeverity::style;
}

Skill skill_of_fault(const std::string& kind) noexcept {
  if (kind == "not_found") return Skill::look;
  if (kind == "unseen" || kind == "angle") return Skill::view;
  if (kind == "drift" || kind == "passes" || kind == "entry") return Skill::align;
  if (kind == "misplaced" || kind == "unaspirated" || kind == "pressure" || kind == "fast")
    return Skill::inject;
  return Skill::steer;
}

PastAttempt past_attempt(double weeks, std::span<const Metric> metrics) {
  PastAttempt out;
  out.weeks = weeks;
  out.injected = value_of(metrics, "given_ml") > kGivenMl;
  out.looked = find_metric(metrics, "found") != nullptr;
  if (const Metric* time = find_metric(metrics, "find_s"); time != nullptr && !time->value)
    out.kinds.emplace_back("not_found");
  for (const auto& [kind, name] :
       {std::pair{&kOffTarget, "off_target"}, std::pair{&kDrift, "drift"},
        std::pair{&kPasses, "passes"}, std::pair{&kAngle, "angle"},
        std::pair{&kPressure, "pressure"}, std::pair{&kFast, "fast"}, std::pair{&kIdle, "idle"}})
    if (value_of(metrics, kind->metric) > kind->band) out.kinds.emplace_back(name);
  if (unseen_mm(metrics) > kUnseen.band) out.kinds.emplace_back("unseen");
  if (value_of(metrics, kBone.metric) >= kBone.band) out.kinds.emplace_back("bone");
  if (misplaced_ml(metrics) > kMisplaced.band) out.kinds.emplace_back("misplaced");
  if (is_unaspirated(metrics)) out.kinds.emplace_back("unaspirated");
  for (const Metric& m : metrics)
    if (m.name.rfind("avoid_depth_mm:", 0) == 0 && m.value.value_or(0) > 0)
      out.kinds.push_back("avoid:" + m.name.substr(m.name.find(':') + 1));
  return out;
}

Feedback make_feedback(const AttemptMeasures& measures, const Judgement& judgement,
                       const FeedbackContext& context) {
  constexpr std::size_t kMax = 3;
  Feedback out;
  out.verdict = judgement.passed ? "Passed." : "Not passed";
  if (!judgement.passed) {
    std::string missed;
    for (const JudgedMark& m : judgement.marks)
      if (!m.held)
        missed += (missed.empty() ? ": " : ", ") + m.mark.metric + " should be " + m.mark.text;
    out.verdict += missed.empty() && judgement.with_aids ? ": aids were on." : missed + ".";
  }
  add_end_faults(measures, judgement, out.faults);
  add_look_faults(measures, out.faults);
  add_needle_faults(measures, judgement, out.faults);
  add_hand_faults(measures, judgement, out.faults);
  add_syringe_faults(measures, judgement, out.faults);
  if (context.level >= kIdleLevel) add_idle(measures, out.faults);
  PastAttempt now;
  now.injected = value_of(measures, "given_ml") > kGivenMl;
  now.looked = !measures.sought.empty();
  for (Fault& fault : out.faults) {
    if (fault.kind != "unasked") now.kinds.push_back(fault.kind);  // no skill of the hands
    if (context.before.empty()) continue;
    const auto& last = context.before.back().kinds;
    const std::string kind =
        fault.kind.rfind("fatal:", 0) == 0 ? "avoid" + fault.kind.substr(5) : fault.kind;
    if (std::find(last.begin(), last.end(), kind) != last.end()) fault.weight *= kAgain;
  }
  std::stable_sort(out.faults.begin(), out.faults.end(), [](const Fault& a, const Fault& b) {
    return std::pair(severity_of_fault(a.kind), a.weight) >
           std::pair(severity_of_fault(b.kind), b.weight);
  });
  const SkillTask next = next_task(judgement, weakest_skill(now, context));
  out.next = next.what;
  out.next_scenario = next.scenario;
  out.good = praise(measures, judgement, out.faults);
  if (out.faults.size() > kMax) out.faults.resize(kMax);
  return out;
}

}  // namespace artus
