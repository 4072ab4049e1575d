// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/check/joint_check.h"

#include <algorithm>
#include <map>
#include <utility>

#include <tbb/parallel_for.h>

#include "artus/detail/anatomy/compile/check/held.h"
#include "artus/detail/anatomy/compile/check/joint_defects.h"
#include "artus/detail/anatomy/compile/check/misplaced.h"
#include "artus/detail/anatomy/compile/check/plan_check.h"

namespace artus {
namespace {

/// A structure with a surface file, and what became of it.
struct Repaired {
  const Structure* structure = nullptr;
  StructureReport report;
  std::optional<PreparedSurface> surface;
  bool unreadable = false;  // already among the defects
};

std::vector<Repaired> repair_all(const JointSources& sources, const Progress& progress) {
  const JointFile& joint = sources.joint();
  std::vector<Repaired> all(joint.structures.size() + 1);
  all[0].structure = &joint.body;
  for (std::size_t i = 0; i < joint.structures.size(); ++i)
    all[i + 1].structure = &joint.structures[i];
  if (progress) progress("repairing", 0);
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    Repaired& one = all[i];
    one.report.name = one.structure->name;
    const auto* surface = std::get_if<SurfaceFile>(&one.structure->shape);
    if (surface == nullptr) return;
    auto prepared =
        i == 0 ? prepare_body(sources, one.report) : prepare_surface(sources, *surface, one.report);
    if (prepared) {
      one.surface = std::move(*prepared);
    } else {
      one.unreadable = prepared.error().code != ErrorCode::defective;
      one.report.refused = prepared.error().message;
    }
  });
  if (progress) progress("repairing", 1);
  return all;
}

class Collector {
 public:
  Collector(const JointSources& sources, const Progress& progress)
      : sources_(sources),
        joint_(sources.joint()),
        progress_(progress),
        repaired_(repair_all(sources, progress)) {
    for (const Repaired& one : repaired_) by_name_[one.structure->name] = &one;
  }

  JointCheck run() {
    add_refusals();
    for (Finding& f : find_foreign_frames(sources_)) check_.findings.push_back(std::move(f));
    add_defects();
    take_surfaces();
    if (!check_.prepared.body.mesh.triangles.empty()) add_places();
    std::stable_sort(check_.findings.begin(), check_.findings.end(),
                     [](const Finding& a, const Finding& b) { return a.verdict < b.verdict; });
    std::stable_sort(check_.crossings.begin(), check_.crossings.end(),
                     [](const Defect& a, const Defect& b) { return a.count > b.count; });
    return std::move(check_);
  }

 private:
  void add_refusals() {
    for (const Repaired& one : repaired_) {
      if (!std::holds_alternative<SurfaceFile>(one.structure->shape)) continue;
      check_.surfaces.push_back(
          {one.report.name, one.report.surface_volume, one.report.repairs, one.report.refused});
      if (!one.report.refused.empty() && !one.unreadable)
        check_.findings.push_back({Verdict::refused, "refused_surface", one.report.name,
                                   one.structure->line, one.report.refused});
      for (const std::string& repair : one.report.repairs)
        check_.findings.push_back(
            {Verdict::mended, "repair", one.report.name, one.structure->line, repair});
      if (!one.surface) continue;
      for (const std::string& warning : one.surface->warnings)
        check_.findings.push_back(
            {Verdict::look, "surface", one.report.name, one.structure->line, warning});
    }
  }

  void add_defects() {
    for (Defect& defect : find_joint_defects(sources_, {}, progress_)) {
      if (defect.kind == DefectKind::crossing_layers) {
        check_.crossings.push_back(std::move(defect));
        continue;
      }
      const auto found = by_name_.find(defect.structure);
      const bool is_refused = found != by_name_.end() && !found->second->report.refused.empty();
      check_.findings.push_back(
          {verdict_of(defect, is_refused), to_string(defect.kind), defect.structure,
           found != by_name_.end() ? found->second->structure->line : 0, defect.message});
    }
  }

  void take_surfaces() {
    if (repaired_[0].surface) check_.prepared.body = std::move(*repaired_[0].surface);
    for (std::size_t i = 1; i < repaired_.size(); ++i)
      check_.prepared.structures.push_back(std::move(repaired_[i].surface));
  }

  void add_places() {
    const auto add = [this](std::vector<Finding> more) {
      for (Finding& f : more) check_.findings.push_back(std::move(f));
    };
    add(find_misplaced(joint_, check_.prepared));
    add(find_other_frames(joint_, check_.prepared));
    add(find_pressed_bones(joint_, check_.prepared));
    add(find_mirrored(joint_, check_.prepared));
    add(find_unheld(joint_, check_.prepared));
    check_.held_by = describe(find_holders(joint_, check_.prepared));
    for (const PlanProblem& p : find_plan_problems(joint_, make_ground(joint_, check_.prepared)))
      check_.findings.push_back({Verdict::refused, "plan", p.plan, p.line, p.message});
  }

  const JointSources& sources_;
  const JointFile& joint_;
  const Progress& progress_;
  std::vector<Repaired> repaired_;
  std::map<std::string, const Repaired*> by_name_;
  JointCheck check_;
};

}  // namespace

const char* to_string(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::refused:
      return "refused";
    case Verdict::look:
      return "look";
    case Verdict::mended:
      return "mended";
    case Verdict::note:
      return "note";
  }
  return "note";
}

Verdict verdict_of(const Defect& defect, bool is_refused) noexcept {
  if (defect.kind == DefectKind::unreadable_file || defect.kind == DefectKind::unknown_tissue)
    return Verdict::refused;
  if (defect.kind == DefectKind::size_outlier || defect.kind == DefectKind::place_outlier)
    return Verdict::look;
  if (is_refused) return Verdict::note;  // the refusal itself says what to do
  switch (severity_of(defect.kind)) {
    case DefectSeverity::note:
      return Verdict::note;
    case DefectSeverity::repairable:
      return Verdict::mended;
    default:
      return Verdict::look;
  }
}

std::size_t JointCheck::count(Verdict verdict) const noexcept {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [verdict](const Finding& f) { return f.verdict == verdict; }));
}

JointCheck check_joint(const JointSources& sources, const Progress& progress) {
  return Collector(sources, progress).run();
}

}  // namespace artus
