// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile/compile.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <sys/resource.h>

#include <tbb/task_group.h>

#include "artus/anatomy/compile/compile_labels.h"
#include "artus/anatomy/compile/compile_measure.h"
#include "artus/anatomy/compile/compile_surfaces.h"
#include "artus/anatomy/compile/compile_warnings.h"
#include "artus/anatomy/compile/dress_body.h"
#include "artus/anatomy/compile/fit_interfaces.h"
#include "artus/anatomy/compile/misplaced.h"
#include "artus/anatomy/compile/plan_check.h"
#include "artus/anatomy/compile/resolve.h"
#include "artus/anatomy/compile/tet_topology.h"
#include "artus/anatomy/compile/tetrahedralize.h"

namespace artus {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Tells the listener and times each stage.
class Stages {
 public:
  Stages(const Progress& progress, CompileReport& report) : progress_(progress), report_(report) {}
  template <class Work>
  auto run(const char* stage, double fraction, Work&& work) {
    if (progress_) progress_(stage, fraction);
    const auto start = Clock::now();
    auto result = work();
    report_.stages.push_back({stage, seconds_since(start)});
    return result;
  }

 private:
  const Progress& progress_;
  CompileReport& report_;
};

const char* kind_of(const Structure& s) {
  constexpr std::array<const char*, 5> kNames{"surface", "shell", "cap", "gap", "end"};
  return kNames[s.shape.index()];
}

const char* name_of(FillMethod method) {
  if (method == FillMethod::quality) return "quality";
  return method == FillMethod::plain ? "plain" : "kept";
}

std::vector<StructureReport> start_reports(const JointFile& file) {
  std::vector<StructureReport> reports;
  for (const Structure& s : file.structures) {
    StructureReport report;
    report.name = s.name;
    report.tissue = s.tissue;
    report.kind = kind_of(s);
    reports.push_back(std::move(report));
  }
  return reports;
}

// One error that names all that must be mended before anything is made.
Result<void> check_refusals(const JointFile& file, const std::vector<StructureReport>& reports,
                            const PreparedSurfaces& surfaces, const CompileOptions& options) {
  std::vector<std::string> refusals;
  if (!options.skip_refused)
    for (const StructureReport& r : reports)
      if (!r.refused.empty()) refusals.push_back(r.name + ": " + r.refused);
  if (options.check_plans) {
    for (const Finding& f : find_misplaced(file, surfaces))
      if (f.verdict == Verdict::refused) refusals.push_back(f.what + ": " + f.message);
    for (const PlanProblem& p : find_plan_problems(file, make_ground(file, surfaces)))
      refusals.push_back(to_line(p));
  }
  return refuse_all(refusals, file);
}

// The hull is cut by the region of interest where that is the nearer of the two boundaries.
RegionId front_of_hull(const RegionLabels& labels, const Vec3& p) {
  if (!labels.region_of_interest) return kOutside;
  return signed_distance(*labels.region_of_interest, p) > labels.body.value(p) ? kBeyond : kOutside;
}

// A part smaller than a ball of the region's facet size is an accident of meshing.
double smallest_part(const std::vector<RegionSizing>& sizing, RegionId region) {
  const double size = sizing[region].facet_size;
  return size * size * size / 2;
}

Result<void> finish_topology(TetMesh& mesh, const RegionLabels& labels) {
  const Result<TetNeighbours> neighbours = find_tet_neighbours(mesh);
  ARTUS_TRY(neighbours);
  rebuild_interfaces(mesh, *neighbours, [&](const Vec3& p) { return front_of_hull(labels, p); });
  order_vertices(mesh);
  return {};
}

Result<TetMesh> mesh_regions(const LabelledSpace& space, Stages& stages, CompileReport& report) {
  Result<TetMesh> mesh = stages.run("resolving overlaps", 0.2, [&] {
    tbb::task_group beside;  // the mesher has one thread, and volumes need nothing of it
    beside.run([&] { measure_labels(space.labels, report); });
    Result<TetMesh> resolved = resolve_regions(space.labels, space.resolve);
    beside.wait();
    return resolved;
  });
  if (!mesh) return mesh;
  auto neighbours = find_tet_neighbours(*mesh);
  ARTUS_TRY(neighbours);
  report.crumbs = absorb_crumbs(*mesh, *neighbours,
                                [&](RegionId r) { return smallest_part(space.resolve.sizing, r); });
  ARTUS_TRY(finish_topology(*mesh, space.labels));
  stages.run("fitting interfaces", 0.6, [&] {
    fit_interfaces(*mesh, space.labels);
    return true;
  });
  neighbours = find_tet_neighbours(*mesh);
  ARTUS_TRY(neighbours);
  const FillMethod filled = stages.run("filling with tetrahedra", 0.7,
                                       [&] { return fill_with_tetgen(*mesh, *neighbours); });
  report.fill_method = name_of(filled);
  ARTUS_TRY(finish_topology(*mesh, space.labels));
  return mesh;
}

double peak_memory() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  constexpr double kKibibyte = 1024;
  return kKibibyte * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

Result<CompileOutcome> compile_joint(const JointFile& file, const CompileOptions& options,
                                     const Progress& progress) {
  const auto start = Clock::now();
  CompileOutcome outcome;
  CompileReport& report = outcome.report;
  Stages stages(progress, report);
  auto digest = compute_source_digest(file);
  ARTUS_TRY(digest);
  std::vector<StructureReport> reports = start_reports(file);
  const auto surfaces = stages.run("reading and repairing surfaces", 0,
                                   [&] { return prepare_surfaces(file, reports); });
  ARTUS_TRY(surfaces);
  ARTUS_TRY(check_refusals(file, reports, *surfaces, options));
  StructureReport filler;
  filler.name = file.filler_name;
  filler.tissue = file.body.tissue;
  filler.kind = "filler";
  report.structures.push_back(std::move(filler));
  report.structures.insert(report.structures.end(), reports.begin(), reports.end());
  const auto space = stages.run("measuring distances", 0.1,
                                [&] { return make_labelled_space(file, *surfaces, progress); });
  ARTUS_TRY(space);
  Result<TetMesh> mesh = mesh_regions(*space, stages, report);
  ARTUS_TRY(mesh);
  stages.run("measuring the result", 0.9, [&] {
    measure_mesh(*mesh, space->labels, *surfaces, report);
    append_warnings(file, space->labels, *surfaces, report);
    append_gap_cuts(file, *space, report);
    return true;
  });
  outcome.joint = dress_body(file, std::move(*mesh), std::move(*digest), report.notes);
  report.seconds = seconds_since(start);
  report.peak_memory = peak_memory();
  if (progress) progress("done", 1);
  return outcome;
}

}  // namespace artus
