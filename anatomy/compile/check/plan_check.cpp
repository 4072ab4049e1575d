// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/check/plan_check.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/anatomy/compile/labels/region_labels.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kOnSkin = 2 * kMillimetre;       // what an entry may lie off the skin
constexpr double kProbeOnSkin = 3 * kMillimetre;  // likewise the middle of a probe's face
constexpr double kStays = 3 * kMillimetre;        // of the shaft that stays outside
constexpr double kShortest = 2 * kMillimetre;     // path of a needle: less is a slip
constexpr double kUsualDepth = 10 * kMillimetre;  // under the skin, where a target is offered
constexpr double kThinnest = 0.6 * kMillimetre;   // layer in which a tip can stop
constexpr double kRoom = 5 * kMillimetre;         // that a mended region has to spare
constexpr std::size_t kMaxTried = 4000;           // places on the skin

std::string place(const Vec3& p) {
  return printed("(%.1f, %.1f, %.1f) mm", p.x() / kMillimetre, p.y() / kMillimetre,
                 p.z() / kMillimetre);
}

std::vector<Vec3> skin_around(const PlanGround& ground, const Vec3& near) {
  std::vector<Vec3> places;
  places.reserve(ground.skin.triangles.size());
  for (const Triangle& t : ground.skin.triangles) places.push_back(triangle_centre(ground.skin, t));
  std::sort(places.begin(), places.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - near).squaredNorm() < (b - near).squaredNorm();
  });
  if (places.size() > kMaxTried) places.resize(kMaxTried);
  return places;
}

/// Whether the path from just under the skin to the target stays inside the body.
bool stays_inside(const PlanGround& ground, const Vec3& entry, const Vec3& target) {
  constexpr int kSteps = 20;
  for (int i = 1; i <= kSteps; ++i)
    if (ground.skin_distance(entry + (i - 0.5) / kSteps * (target - entry)) > kMillimetre)
      return false;
  return true;
}

/// The region made to hold `p`, as a mend and in words.
std::string hold_in_region(const RegionOfInterest& roi, const Vec3& p, PlanProblem& problem) {
  if (roi.half_extent) {
    const Vec3 needed =
        roi.half_extent->cwiseMax((p - roi.centre).cwiseAbs() + Vec3::Constant(kRoom));
    problem.mends.push_back({"half_extent", needed});
    return "enlarge it: half_extent = " + place(needed) + " holds it";
  }
  const double radius = kMillimetre * std::ceil(((p - roi.centre).norm() + kRoom) / kMillimetre);
  problem.mends.push_back({"radius", Vec3(radius, 0, 0)});
  return printed("enlarge it: radius = %.0f mm holds it", radius / kMillimetre);
}

/// Collects what is wrong with one plan after the other.
class Checker {
 public:
  Checker(const JointFile& file, const PlanGround& ground) : file_(file), ground_(ground) {}

  std::vector<PlanProblem> run() {
    if (ground_.skin.triangles.empty()) {
      check_region();
      return std::move(problems_);  // everything else would say the same
    }
    if (file_.X_JP_default) check_probe(*file_.X_JP_default);
    if (file_.needle) check_pass("[needle]", *file_.needle);
    for (const PlannedInjection& pass : file_.injections)
      check_pass("injection '" + pass.name + "'", pass);
    return std::move(problems_);
  }

 private:
  PlanProblem& add(const std::string& plan, int line, std::string message) {
    return problems_.emplace_back(PlanProblem{plan, line, std::move(message), {}});
  }

  void check_region() {
    PlanProblem& problem = add("[region_of_interest]", 0, "holds no skin");
    if (!ground_.region) return;
    const Vec3& centre = ground_.region->centre;
    const double away = ground_.skin_tree.get().distance(centre, 10);
    problem.message += printed(": the nearest is %.1f mm from its centre; ", away / kMillimetre);
    if (const auto skin = ground_.nearest_any_skin(centre); skin && is_wide_enough()) {
      problem.message += "move it: centre = " + place(*skin) + " is on the skin";
      problem.mends.push_back({"centre", *skin});
      return;
    }
    const double needed = away + kPlannedFace / 2;
    const Vec3 far =
        ground_.region->half_extent ? Vec3(Vec3::Constant(needed)) : Vec3(needed * Vec3::UnitX());
    problem.message += hold_in_region(*ground_.region, centre + far, problem);
  }

  /// Whether the region holds a probe's face where it is as it is, but elsewhere.
  [[nodiscard]] bool is_wide_enough() const {
    const RegionOfInterest& roi = *ground_.region;
    return (roi.half_extent ? roi.half_extent->minCoeff() : roi.radius) >= kPlannedFace / 2 + kRoom;
  }

  void check_pass(const std::string& plan, const PlannedInjection& pass) {
    const double length = (pass.target - pass.entry).norm();
    if (!(length > 0)) return;  // told where the file was read
    if (length < kShortest) {
      check_short(plan, pass, length);
      return;
    }
    const bool target_holds = check_place(plan, pass.line, "target", pass.target);
    const bool entry_holds = check_entry(plan, pass);
    if (!target_holds) return;
    if (entry_holds) check_path(plan, pass);
  }

  /// A path too short to be meant: metres for millimetres, or the entry written twice.
  void check_short(const std::string& plan, const PlannedInjection& pass, double length) {
    PlanProblem& problem =
        add(plan, pass.line,
            printed("entry and target are only %.2g mm apart, too short for a needle; check that "
                    "both are in the unit of the file",
                    length / kMillimetre));
    const Vec3 inward = inward_at(pass.entry);
    if (inward.norm() == 0) return;
    const Vec3 inside = pass.entry + kUsualDepth * inward;
    if (ground_.skin_distance(inside) > 0) return;
    problem.message += "; 10 mm under its entry is " + place(inside) + ": use that as target";
    problem.mends.push_back({"target", inside});
  }

  /// The target: inside body and region.
  bool check_place(const std::string& plan, int line, const char* key, const Vec3& p) {
    const double off = ground_.skin_distance(p);
    if (off > 0) {
      PlanProblem& problem = add(
          plan, line, printed("its %s lies %.1f mm outside of the skin", key, off / kMillimetre));
      const auto skin = ground_.nearest_skin(p);
      if (!skin) return false;
      const Vec3 inside = *skin + kUsualDepth * (*skin - p).normalized();
      if (ground_.skin_distance(inside) > 0) return false;
      problem.message += "; 10 mm under the nearest skin is " + place(inside);
      problem.mends.push_back({key, inside});
      return false;
    }
    return check_in_region(plan, line, key, p);
  }

  bool check_in_region(const std::string& plan, int line, const char* key, const Vec3& p) {
    if (ground_.in_region(p)) return true;
    PlanProblem& problem = add(
        plan, line,
        printed("its %s lies %.1f mm outside of the region of interest, where nothing is made; ",
                key, signed_distance(*ground_.region, p) / kMillimetre));
    problem.message += hold_in_region(*ground_.region, p, problem);
    return false;
  }

  bool check_entry(const std::string& plan, const PlannedInjection& pass) {
    if (!check_in_region(plan, pass.line, "entry", pass.entry)) return false;
    const double off = ground_.skin_distance(pass.entry);
    if (std::abs(off) <= kOnSkin) return true;
    PlanProblem& problem =
        add(plan, pass.line,
            printed("its entry lies %.1f mm %s the skin%s", std::abs(off) / kMillimetre,
                    off > 0 ? "off" : "under", on_cut(pass.entry)));
    const Vec3 displacement = (pass.target - pass.entry).normalized();
    const auto along = ground_.skin_along(pass.entry, displacement, 2 * kLongestNeedle);
    const std::optional<Vec3> skin = along ? std::optional<Vec3>(pass.entry + *along * displacement)
                                           : ground_.nearest_skin(pass.entry);
    if (!skin) return false;
    problem.message += std::string("; ") + (along ? "on its line" : "nearest to it") +
                       " the skin is at " + place(*skin) + ": use that as entry";
    problem.mends.push_back({"entry", *skin});
    return false;
  }

  /// Why a place that looks like skin is none.
  [[nodiscard]] const char* on_cut(const Vec3& p) const {
    const bool is_on = ground_.cut_tree.get().distance(p, kProbeOnSkin) < kProbeOnSkin;
    return is_on ? " (where it lies the body was cut and closed)" : "";
  }

  void check_path(const std::string& plan, const PlannedInjection& pass) {
    const double length = (pass.target - pass.entry).norm();
    if (const HardPart* bone = ground_.bone_between(pass.entry, pass.target)) {
      offer_entry(add(plan, pass.line,
                      "bone '" + bone->name + "' is in the needle's path" +
                          where_in_path(pass, bone->name)),
                  pass);
      return;
    }
    if (length > kLongestNeedle - kStays) {
      offer_entry(add(plan, pass.line,
                      printed("its path of %.0f mm is too long for the longest needle, %.0f mm",
                              length / kMillimetre, kLongestNeedle / kMillimetre)),
                  pass);
      return;
    }
    if (ground_.is_compiled) check_layer(plan, pass, length);
  }

  std::string where_in_path(const PlannedInjection& pass, const std::string& bone) const {
    for (const LineLayer& layer : ground_.layers({pass.entry, pass.target}))
      if (layer.name == bone)
        return printed(", %.1f mm after the entry and %.1f mm before the target",
                       layer.entry / kMillimetre,
                       ((pass.target - pass.entry).norm() - layer.entry) / kMillimetre);
    return "";
  }

  void offer_entry(PlanProblem& problem, const PlannedInjection& pass) const {
    if (const auto entry = find_entry(ground_, pass.target, pass.entry)) {
      problem.message +=
          "; from the skin at " + place(*entry) + " the path is free: use that as entry";
      problem.mends.push_back({"entry", *entry});
    } else {
      problem.message += "; no skin near it has a free path to the target: move the target";
    }
  }

  /// A bursa on the path or a layer thick enough to stop in at the target.
  void check_layer(const std::string& plan, const PlannedInjection& pass, double length) {
    const Vec3 displacement = (pass.target - pass.entry) / length;
    const auto layers = ground_.layers({pass.entry, pass.target + 5 * kMillimetre * displacement});
    for (const LineLayer& layer : layers) {
      if (layer.tissue == "bursa" && layer.exit - layer.entry > kThinnest) return;
      const bool holds_target = layer.entry <= length && length <= layer.exit;
      if (!holds_target || layer.hard || layer.exit - layer.entry > kThinnest) continue;
      PlanProblem& problem =
          add(plan, pass.line,
              printed("its target lies in '%s', which is %.2f mm thick on its line",
                      layer.name.c_str(), (layer.exit - layer.entry) / kMillimetre));
      for (const LineLayer& other : layers) {
        if (other.hard || other.name == "outside" || other.exit - other.entry < 2 * kMillimetre)
          continue;
        const Vec3 p = pass.entry + (other.entry + other.exit) / 2 * displacement;
        problem.message += "; '" + other.name + "' is on its line at " + place(p) + ": use that";
        problem.mends = {{"target", p}};
      }
    }
  }

  void check_probe(const Pose& X_JP) {
    const Vec3 p = X_JP.translation();
    const Vec3 beam = X_JP.linear().col(2);
    const double off = ground_.skin_distance(p);
    std::string message;
    if (std::abs(off) > kProbeOnSkin) {
      message = printed("its position lies %.1f mm %s the skin%s", std::abs(off) / kMillimetre,
                        off > 0 ? "off" : "under", on_cut(p));
    } else if (!(ground_.skin_distance(p + 5 * kMillimetre * beam) < off - kMillimetre)) {
      message = "it points along the skin or away from the body";
    } else if (!stands_on_skin(ground_, X_JP)) {
      message = printed(
          "its face of %.0f mm does not rest on skin of the region of interest over its whole "
          "length",
          kPlannedFace / kMillimetre);
    } else {
      return;
    }
    offer_stand(add("[probe]", file_.probe_line, message), X_JP);
  }

  void offer_stand(PlanProblem& problem, const Pose& X_JP) const {
    for (const Vec3& stand : skin_around(ground_, X_JP.translation())) {
      const Vec3 beam = inward_at(stand);
      if (beam.norm() == 0) continue;
      const Pose X = make_pose(stand, beam, X_JP.linear().col(0));
      if (!stands_on_skin(ground_, X)) continue;
      problem.message += "; it rests on skin at position = " + place(stand) +
                         printed(" with direction = (%.3f, %.3f, %.3f), or leave [probe] out",
                                 beam.x(), beam.y(), beam.z());
      problem.mends = {{"position", stand}, {"direction", beam}};
      return;
    }
    problem.message += "; enlarge the region of interest so that it holds more skin";
  }

  /// The direction in which the distance to the skin falls fastest.
  [[nodiscard]] Vec3 inward_at(const Vec3& p) const {
    constexpr double kStep = 3 * kMillimetre;
    Vec3 slope;
    for (int a = 0; a < 3; ++a)
      slope[a] = ground_.skin_distance(p + kStep * Vec3::Unit(a)) -
                 ground_.skin_distance(p - kStep * Vec3::Unit(a));
    return slope.norm() > 0 ? Vec3(-slope.normalized()) : Vec3::Zero();
  }

  const JointFile& file_;
  const PlanGround& ground_;
  std::vector<PlanProblem> problems_;
};

}  // namespace

std::string to_line(const PlanProblem& problem) {
  const std::string line = problem.line > 0 ? " (line " + std::to_string(problem.line) + ")" : "";
  return problem.plan + line + ": " + problem.message;
}

Result<void> refuse_all(const std::vector<std::string>& lines, const JointFile& file) {
  if (lines.empty()) return {};
  const std::string where = (file.folder / "joint.toml").string();
  if (lines.size() == 1) return fail(ErrorCode::defective, lines.front(), where);
  std::string message = std::to_string(lines.size()) + " problems";
  for (const std::string& line : lines) message += "\n  " + line;
  return fail(ErrorCode::defective, message, where);
}

bool stands_on_skin(const PlanGround& ground, const Pose& X_JP, double reach) {
  for (const double share : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
    const Vec3 p = X_JP * Vec3(share * kPlannedFace, 0, 0);
    const Vec3 beam = X_JP.linear().col(2);
    const auto depth = ground.skin_along(p, beam, reach);
    if (!depth || !ground.in_region(p + *depth * beam)) return false;
  }
  return true;
}

std::optional<Vec3> find_entry(const PlanGround& ground, const Vec3& target, const Vec3& near) {
  for (const Vec3& entry : skin_around(ground, near)) {
    const double length = (target - entry).norm();
    if (length > kLongestNeedle - kStays || length < kStays) continue;
    if (!ground.in_region(entry + 2 * kMillimetre * (entry - target).normalized())) continue;
    if (ground.bone_between(entry, target) == nullptr && stays_inside(ground, entry, target))
      return entry;
  }
  return std::nullopt;
}

std::vector<PlanProblem> find_plan_problems(const JointFile& file, const PlanGround& ground) {
  return Checker(file, ground).run();
}

}  // namespace artus
