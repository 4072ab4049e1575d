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
  return out;
}

namespace {

constexpr double kTissueRate = 10;  // Hz, enough for hands that only glance

/// What counts of an attempt.
struct Played {
  Judgement judgement;
  std::string breakage;  // of the body; empty: it is whole
};

/// Expert and novice by turns, seed by seed.
Result<std::vector<Played>> play_all(const Scenario& scenario,
                                     const std::shared_ptr<const Scene>& scene, int tries,
                                     bool rigid) {
  std::vector<Result<Played>> played(static_cast<std::size_t>(2 * tries),
                                     fail(ErrorCode::failed, "not played"));
  tbb::parallel_for(std::size_t{0}, played.size(), [&](std::size_t i) {
    PlayOptions options;
    options.seed = 1 + i / 2;
    options.record = false;
    options.rigid = rigid;
    options.tissue_rate = kTissueRate;
    const auto attempt =
        play(scenario, scene, i % 2 == 0 ? expert_skill() : novice_skill(), options);
    if (!attempt) {
      played[i] = tl::unexpected<Error>(attempt.error());
      return;
    }
    const bool broken = attempt->health && !attempt->health->sound();
    played[i] = Played{attempt->judgement, broken ? to_text(*attempt->health) : std::string()};
  });
  std::vector<Played> out;
  for (auto& one : played) {
    ARTUS_TRY(one);
    out.push_back(std::move(*one));
  }
  return out;
}

Difficulty difficulty_of(const std::vector<Played>& played) {
  Difficulty out;
  out.tries = static_cast<int>(played.size() / 2);
  for (std::size_t i = 0; i < played.size(); ++i) {
    const Judgement& judged = played[i].judgement;
    if (!played[i].breakage.empty() && out.broken++ == 0) out.breakage = played[i].breakage;
    (i % 2 == 0 ? out.expert_passes : out.novice_passes) += judged.passed ? 1 : 0;
    (i % 2 == 0 ? out.expert_score : out.novice_score) += judged.score / out.tries;
  }
  return out;
}

}  // namespace

Result<DifficultyInTissue> measure_difficulty(const Scenario& scenario,
                                              const std::shared_ptr<const Scene>& scene,
                                              const Tries& tries, const Progress& progress) {
  const auto rigid = play_all(scenario, scene, tries.rigid, true);
  ARTUS_TRY(rigid);
  if (progress) progress("playing " + scenario.name, 0.5);
  const auto soft = play_all(scenario, scene, gives_way(scene->joint()) ? tries.soft : 0, false);
  ARTUS_TRY(soft);
  DifficultyInTissue out{difficulty_of(*rigid), difficulty_of(*soft), 0};
  for (std::size_t i = 0; i < std::min(soft->size(), rigid->size()); ++i)
    out.alike += (*soft)[i].judgement.passed == (*rigid)[i].judgement.passed ? 1 : 0;
  if (progress) progress("playing " + scenario.name, 1);
  return out;
}

}  // namespace artus
