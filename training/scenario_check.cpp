// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/scenario_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kOnSkin = 5e-3;      // m
constexpr double kInTarget = 0.5e-3;  // m
constexpr double kOffPlane = 5 * kDegree;

std::string off_skin(const std::string& what, double distance) {
  return what + printed(" %.1f mm off the skin", std::abs(distance) / kMillimetre);
}

/// Collects what the line from entry to target meets.
void check_path(const Scenario& s, const Scene& scene, std::vector<std::string>& out) {
  const Vec3 direction = s.target.point - s.entry.centre;
  if (direction.norm() > s.needle_length)
    out.push_back(printed("the target is %.1f mm from the entry, the needle %.1f mm long",
                          direction.norm() / kMillimetre, s.needle_length / kMillimetre));
  std::array<TissueInterval, 128> layers;
  const QueryCount count = scene.find_intervals({s.entry.centre, s.target.point}, layers);
  for (std::size_t i = 0; i < count.size; ++i) {
    const TissueInterval& layer = layers[i];
    if (layer.region < kFirstRegion || !scene.joint().tissue_of(layer.region).haptic.hard) continue;
    out.push_back(
        "bone lies between entry and target: " + scene.joint().regions[layer.region].name +
        printed(" at %.1f mm", layer.entry / kMillimetre));
    break;
  }
  const Vec3 axis = s.X_JP.linear().transpose() * direction.normalized();
  const double face = std::asin(std::min(1.0, std::abs(axis.z())));
  if (face < s.entry.min_angle || face > s.entry.max_angle)
    out.push_back(
        printed("the line from entry to target is at %.1f degrees to the probe's face, outside "
                "angle_from to "
                "angle_to",
                face / kDegree));
  if (s.entry.plane == "in" && std::abs(std::asin(std::clamp(axis.y(), -1.0, 1.0))) > kOffPlane)
    out.push_back(
        printed("the line from entry to target leaves the picture's plane by %.1f degrees",
                std::asin(axis.y()) / kDegree));
  const Vec3 target_P = s.X_JP.inverse() * s.target.point;
  if (s.entry.plane == "in" && std::abs(target_P.y()) > 1e-3)
    out.push_back(printed("the target lies %.1f mm beside the picture's plane",
                          std::abs(target_P.y()) / kMillimetre));
}

/// Into which zones the planned line goes, as the metrics look at an attempt.
void check_zones(const Scenario& s, const Goals& goals, std::vector<std::string>& out) {
  std::vector<CoursePoint> line(2);
  line[0].tip = s.entry.centre;
  line[1].tip = s.target.point;
  line[1].region = kFirstRegion;
  line[1].step = (s.target.point - s.entry.centre).norm();
  line[1].time = 1;
  for (const AvoidZone& zone : goals.avoid) {
    const Intrusion in = find_intrusion(zone, line);
    if (in.entries > 0)
      out.push_back(printed("the line from entry to target goes %.1f mm into the zone around ",
                            in.depth / kMillimetre) +
                    zone.name + (zone.fatal ? ", which must never be entered" : ""));
  }
}

/// Whether this probe shows the tip at the target.
void check_sight(const Scenario& s, const Scene& scene, const MeterOptions& options,
                 std::vector<std::string>& out) {
  if (s.entry.plane != "in") return;
  const TipSightFinder finder(options.transducer, options.image_depth, options.needle,
                              options.look);
  const TipSight sight = finder.look(
      scene, s.X_JP, make_pose(s.target.point, s.target.point - s.entry.centre, Vec3::Zero()));
  if (!sight.in_picture)
    out.push_back("the target is beside or below the picture of " + s.transducer +
                  printed(" at a depth of %.0f mm", s.depth / kMillimetre));
}

}  // namespace

std::vector<std::string> find_problems(const Scenario& s,
                                       const std::shared_ptr<const Scene>& scene) {
  std::vector<std::string> out;
  const auto params = make_session_params(s);
  if (!params) return {params.error().to_string()};
  const auto options = make_meter_options(s, scene->joint(), *params);
  if (!options) return {options.error().to_string()};
  if (!s.find.empty()) {
    const double face = scene->signed_distance_to_skin(s.X_JP.translation(), 0.2);
    if (!(std::abs(face) <= kOnSkin)) out.push_back(off_skin("the probe's face is", face));
    return out;
  }
  const Goals& goals = options->goals;
  const double off = distance_to(*goals.target, s.target.point);
  if (off > kInTarget)
    out.push_back(
        printed("the target's point lies %.1f mm outside its structure", off / kMillimetre));
  for (const AvoidZone& zone : goals.avoid)
    if (zone.body->signed_distance_to_skin(s.target.point, 0.2) < zone.margin)
      out.push_back("the zone around " + zone.name + " contains the target");
  const double skin = scene->signed_distance_to_skin(s.entry.centre, 0.2);
  if (!(std::abs(skin) <= kOnSkin)) out.push_back(off_skin("the entry is", skin));
  const double face = scene->signed_distance_to_skin(s.X_JP.translation(), 0.2);
  if (!(std::abs(face) <= kOnSkin)) out.push_back(off_skin("the probe's face is", face));
  check_path(s, *scene, out);
  check_zones(s, goals, out);
  check_sight(s, *scene, *options, out);
  return out;
}

namespace {

constexpr double kTissueRate = 10;  // Hz, enough for hands that only glance

/// What counts of an attempt.
struct Played {
  Judgement judgement;
  std::string breakage;  // of the body; empty: it is whole
};
using Verdicts = std::vector<Played>;

Played what_counts(PlayedAttempt attempt) {
  const bool broken = attempt.health && !attempt.health->sound();
  return {std::move(attempt.judgement), broken ? to_text(*attempt.health) : std::string()};
}

/// Plays a scenario again and again, in rigid tissue or in tissue that gives way.
class Players {
 public:
  Players(const Scenario& scenario, std::shared_ptr<const Scene> scene, bool rigid)
      : scenario_(scenario), scene_(std::move(scene)) {
    options_.record = false;
    options_.rigid = rigid;
    options_.tissue_rate = kTissueRate;
    if (!rigid) options_.prepared = make_played_body(scenario, *scene_);
  }

  /// The next `count` seeds of one operator, after those that are in `out`.
  Result<void> play_on(const OperatorSkill& skill, std::size_t count, Verdicts& out) const {
    std::vector<Result<Played>> played(count, fail(ErrorCode::failed, "not played"));
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      PlayOptions options = options_;
      options.seed = 1 + out.size() + i;
      auto attempt = play(scenario_, scene_, skill, options);
      if (attempt)
        played[i] = what_counts(std::move(*attempt));
      else
        played[i] = tl::unexpected<Error>(attempt.error());
    });
    for (auto& one : played) {
      ARTUS_TRY(one);
      out.push_back(std::move(*one));
    }
    return {};
  }

 private:
  const Scenario& scenario_;
  std::shared_ptr<const Scene> scene_;
  PlayOptions options_;
};

std::size_t passes_of(const Verdicts& verdicts) {
  return static_cast<std::size_t>(std::count_if(verdicts.begin(), verdicts.end(),
                                                [](const auto& v) { return v.judgement.passed; }));
}

/// Novices until so many have failed that the others cannot pass too often.
Result<Verdicts> play_novices(const Players& players, std::size_t tries) {
  const auto enough = static_cast<std::size_t>(deciding_failures(static_cast<int>(tries)));
  Verdicts out;
  while (out.size() < tries) {
    const std::size_t failed = out.size() - passes_of(out);
    if (failed >= enough) break;
    ARTUS_TRY(players.play_on(novice_skill(), std::min(enough - failed, tries - out.size()), out));
  }
  return out;
}

/// Each mark that some missed, with how many and the figure of the first.
std::vector<std::string> missed_marks(const Verdicts& verdicts) {
  std::vector<std::string> out;
  if (verdicts.empty()) return out;
  for (std::size_t k = 0; k < verdicts.front().judgement.marks.size(); ++k) {
    int missed = 0;
    std::string figure;
    for (const Played& one : verdicts) {
      const JudgedMark& mark = one.judgement.marks[k];
      if (mark.held || missed++ > 0) continue;
      figure = mark.value ? printed("%.2f", *mark.value) : "not known";
    }
    const Mark& mark = verdicts.front().judgement.marks[k].mark;
    if (missed > 0)
      out.push_back(mark.metric + " should be " + mark.text +
                    printed(": missed by %.0f of %.0f, first with ", static_cast<double>(missed),
                            static_cast<double>(verdicts.size())) +
                    figure);
  }
  return out;
}

Fared fared(const Verdicts& verdicts) {
  Fared out;
  out.played = static_cast<int>(verdicts.size());
  out.passes = static_cast<int>(passes_of(verdicts));
  out.missed = missed_marks(verdicts);
  for (const Played& one : verdicts) {
    out.score += one.judgement.score / out.played;
    if (!one.breakage.empty() && out.broken++ == 0) out.breakage = one.breakage;
  }
  return out;
}

void compare(const Verdicts& soft, const Verdicts& rigid, DifficultyInTissue& out) {
  for (std::size_t i = 0; i < std::min(soft.size(), rigid.size()); ++i) {
    ++out.compared;
    out.alike += soft[i].judgement.passed == rigid[i].judgement.passed ? 1 : 0;
  }
}

}  // namespace

Result<DifficultyInTissue> measure_difficulty(const Scenario& scenario,
                                              const std::shared_ptr<const Scene>& scene,
                                              const Tries& tries, const Progress& progress) {
  const auto n_rigid = static_cast<std::size_t>(tries.rigid);
  const Players rigid(scenario, scene, true);
  Verdicts experts;
  Verdicts novices;
  ARTUS_TRY(rigid.play_on(expert_skill(), n_rigid, experts));
  ARTUS_TRY(rigid.play_on(novice_skill(), n_rigid, novices));
  DifficultyInTissue out;
  out.rigid = {tries.rigid, fared(experts), fared(novices)};
  out.soft.tries = gives_way(scene->joint()) ? tries.soft : 0;
  if (progress) progress("playing " + scenario.name, 0.5);
  if (out.soft.tries > 0) {
    const auto n = static_cast<std::size_t>(out.soft.tries);
    const Players soft(scenario, scene, false);
    Verdicts soft_experts;
    ARTUS_TRY(soft.play_on(expert_skill(), n, soft_experts));
    const auto soft_novices = play_novices(soft, tries.soft_novices ? n : 0);
    ARTUS_TRY(soft_novices);
    out.soft.expert = fared(soft_experts);
    out.soft.novice = fared(*soft_novices);
    compare(soft_experts, experts, out);
    compare(*soft_novices, novices, out);
  }
  if (progress) progress("playing " + scenario.name, 1);
  return out;
}

}  // namespace artus
