// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <tbb/task_group.h>

#include "artus/detail/anatomy/compile/attach_metadata.h"
#include "artus/detail/anatomy/compile/check/compile_warnings.h"
#include "artus/detail/anatomy/compile/check/held.h"
#include "artus/detail/anatomy/compile/check/misplaced.h"
#include "artus/detail/anatomy/compile/check/plan_check.h"
#include "artus/detail/anatomy/compile/labels/compile_labels.h"
#include "artus/detail/anatomy/compile/labels/compile_surfaces.h"
#include "artus/detail/anatomy/compile/labels/cut_faces.h"
#include "artus/detail/anatomy/compile/labels/fit_interfaces.h"
#include "artus/detail/anatomy/compile/labels/part_cache.h"
#include "artus/detail/anatomy/compile/labels/resolve.h"
#include "artus/detail/anatomy/compile/mesh/compile_measure.h"
#include "artus/detail/anatomy/compile/mesh/isolated.h"
#include "artus/detail/anatomy/compile/mesh/tet_topology.h"
#include "artus/detail/anatomy/compile/mesh/tetrahedralize.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uintmax_t kMaxPartBytes = 1'000'000'000;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Tells the listener and times each step.
class Steps {
 public:
  Steps(const Progress& progress, CompileReport& report) : progress_(progress), report_(report) {}
  template <class Work>
  auto run(const char* step, double fraction, Work&& work) {
    if (progress_) progress_(step, fraction);
    const auto start = Clock::now();
    auto result = work();
    report_.steps.push_back({step, seconds_since(start)});
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
    report.is_hard = std::any_of(file.tissues.begin(), file.tissues.end(), [&](const Tissue& t) {
      return t.name == s.tissue && t.haptic.hard;
    });
    reports.push_back(std::move(report));
  }
  return reports;
}

// One error that names all that must be mended before anything is made.
Result<void> check_refusals(const JointSources& sources,
                            const std::vector<StructureReport>& reports,
                            const PreparedSurfaces& surfaces, const CompileOptions& options) {
  const JointFile& file = sources.joint();
  std::vector<std::string> refusals;
  if (!options.skip_refused)
    for (const StructureReport& r : reports)
      if (!r.refused.empty()) refusals.push_back(r.name + ": " + r.refused);
  if (options.check_plans) {
    for (const Finding& f : find_foreign_frames(sources))
      refusals.push_back(f.what + ": " + f.message);
    for (const Finding& f : find_misplaced(file, surfaces))
      if (f.verdict == Verdict::refused && !(options.skip_refused && f.kind == "lost"))
        refusals.push_back(f.what + ": " + f.message);
    for (const Finding& f : find_other_frames(file, surfaces))
      if (f.verdict == Verdict::refused) refusals.push_back(f.what + ": " + f.message);
    for (const Finding& f : find_pressed_bones(file, surfaces))
      refusals.push_back("pose '" + f.what + "': " + f.message);
    for (const Finding& f : find_unheld(file, surfaces))
      refusals.push_back(f.what + ": " + f.message);
    for (const PlanProblem& p : find_plan_problems(file, make_ground(file, surfaces)))
      refusals.push_back(to_line(p));
  }
  return refuse_all(refusals, file);
}

double area_in_region(const SurfaceMesh& mesh, const std::optional<RegionOfInterest>& roi) {
  double area = 0;
  for (const Triangle& t : mesh.triangles)
    if (!roi || signed_distance(*roi, triangle_centre(mesh, t)) <= 0)
      area += triangle_area(mesh, t);
  return area;
}

/// The area of the interfaces of each structure, without where the region of interest ends, m^2.
std::vector<double> interface_areas(const TetMesh& mesh, std::size_t n_structures) {
  std::vector<double> areas(n_structures, 0);
  for (const Interface& f : mesh.interfaces) {
    if (f.front == kBeyond) continue;
    const Vec3& a = mesh.vertices[f.vertices[0]];
    const double area =
        (mesh.vertices[f.vertices[1]] - a).cross(mesh.vertices[f.vertices[2]] - a).norm() / 2;
    for (const RegionId region : {f.front, f.back})
      if (region >= region_of_structure(0)) areas[region - region_of_structure(0)] += area;
  }
  return areas;
}

/// What of a structure the joint lacks, and what would do; empty: it is there. A layer keeps its
/// surface whatever lies inside of it, so that its volume alone tells nothing.
std::string explain_lost(const StructureReport& r, double given_area, double area) {
  constexpr double kLeast = 0.5;        // of the volume that others leave, assumed
  constexpr double kLeastShown = 0.25;  // of its own surface in the region, as find_misplaced
  const double left = r.region_volume - r.lost_volume;
  const std::string numbers =
      printed("%.3g of its %.3g cm3 would be in the joint", r.resolved_volume / kCubicCentimetre,
              r.surface_volume / kCubicCentimetre);
  if (area < kLeastShown * given_area)
    return numbers + (r.lost_to.empty()
                          ? std::string("; check its unit, frame and position, or remove it")
                          : ": '" + r.lost_to +
                                "' stands before it and takes it; put it before that, or remove "
                                "it");
  if (r.resolved_volume < kLeast * left)
    return numbers + printed(
                         ", although %.3g cm3 of it lie in the region and nothing takes them: "
                         "its tetrahedra are too coarse; give it a smaller facet_size and "
                         "facet_distance",
                         left / kCubicCentimetre);
  return {};
}

// What was given and of which nothing, or much less, is there is no joint that its author meant.
Result<void> check_lost(const JointFile& file, const PreparedSurfaces& surfaces,
                        const TetMesh& mesh, const CompileReport& report,
                        const CompileOptions& options) {
  std::vector<std::string> refusals;
  if (!options.check_plans || options.skip_refused) return {};
  const std::vector<double> areas = interface_areas(mesh, file.structures.size());
  for (std::size_t i = 0; i < file.structures.size(); ++i) {
    const StructureReport& r = report.structures[i + 1];  // behind the filler
    if (r.kind != "surface" || !r.refused.empty() || !surfaces.structures[i]) continue;
    if (has_region_of_variant(file.variants) && 2 * r.region_volume < r.surface_volume) continue;
    const double given = area_in_region(surfaces.structures[i]->mesh, file.region_of_interest);
    const std::string lost = explain_lost(r, given, areas[i]);
    if (!lost.empty()) refusals.push_back(r.name + ": " + lost);
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

// Where the body was cut it goes on beyond, as it does where the region of interest ends.
void mark_cuts(TetMesh& mesh, const PreparedSurface& body, double grow) {
  if (body.is_cut.empty()) return;
  const DistanceTree cut(without_cuts(body.mesh, body.is_cut, true));
  const DistanceTree skin(without_cuts(body.mesh, body.is_cut));
  // m, no face of the hull lies farther from the body's surface
  const double near = 5e-3 + std::abs(grow);
  for (Interface& f : mesh.interfaces) {
    if (f.front != kOutside) continue;
    Vec3 centre = Vec3::Zero();
    for (const auto v : f.vertices) centre += mesh.vertices[v] / 3;
    const double to_cut = cut.distance(centre, near);
    if (to_cut < near && to_cut < skin.distance(centre, near)) f.front = kBeyond;
  }
}

// A mesh and who shares its faces.
struct Complex {
  TetMesh mesh;
  TetNeighbours neighbours;
};

// What is neighbour of what stays true: no tetrahedron changes its place.
void finish_topology(Complex& complex, const RegionLabels& labels) {
  rebuild_interfaces(complex.mesh, complex.neighbours,
                     [&](const Vec3& p) { return front_of_hull(labels, p); });
  order_vertices(complex.mesh);
}

// The complex whose interfaces stay.
Result<Complex> make_interfaces(const LabelledSpace& space, Steps& steps, CompileReport& report) {
  Result<TetMesh> mesh = steps.run("resolving overlaps", 0.2, [&] {
    tbb::task_group beside;  // the mesher has one thread, and volumes need nothing of it
    beside.run([&] { measure_labels(space.labels, report); });
    Result<TetMesh> resolved = resolve_regions(space.labels, space.resolve);
    beside.wait();
    return resolved;
  });
  ARTUS_TRY(mesh);
  auto neighbours = find_tet_neighbours(*mesh);
  ARTUS_TRY(neighbours);
  Complex complex{std::move(*mesh), std::move(*neighbours)};
  report.fragments = merge_fragments(complex.mesh, complex.neighbours, [&](RegionId r) {
    return smallest_part(space.resolve.sizing, r);
  });
  finish_topology(complex, space.labels);
  steps.run("fitting interfaces", 0.6, [&] {
    fit_interfaces(complex.mesh, space.labels);
    return true;
  });
  return complex;
}

// Fills between the interfaces.
Result<void> fill(Complex& complex, const LabelledSpace& space, Steps& steps,
                  CompileReport& report) {
  const std::size_t n_interfaces = complex.mesh.interfaces.size();
  report.fill_method = name_of(steps.run("filling with tetrahedra", 0.7, [&] {
    return fill_with_tetgen(complex.mesh, complex.neighbours, space.resolve.sizing);
  }));
  auto neighbours = find_tet_neighbours(complex.mesh);
  ARTUS_TRY(neighbours);
  complex.neighbours = std::move(*neighbours);
  finish_topology(complex, space.labels);
  if (complex.mesh.interfaces.size() != n_interfaces)
    return fail(ErrorCode::failed, "the tetrahedra do not meet at the interfaces");
  steps.run("measuring tetrahedra", 0.9, [&] {
    measure_mesh(complex.mesh, complex.neighbours, report);
    return true;
  });
  return {};
}

}  // namespace

Result<CompileOutcome> compile_joint(const JointSources& sources, const CompileOptions& options,
                                     const Progress& progress) {
  const JointFile& file = sources.joint();
  const auto start = Clock::now();
  CompileOutcome outcome;
  CompileReport& report = outcome.report;
  Steps steps(progress, report);
  auto digest = compute_source_digest(sources);
  ARTUS_TRY(digest);
  std::vector<StructureReport> reports = start_reports(file);
  const PartCache parts(options.parts);
  auto surfaces = steps.run("reading and repairing surfaces", 0,
                            [&] { return prepare_surfaces(sources, reports, parts); });
  ARTUS_TRY(surfaces);
  ARTUS_TRY(check_refusals(sources, reports, *surfaces, options));
  StructureReport filler;
  filler.name = file.filler_name;
  filler.tissue = file.body.tissue;
  filler.kind = "filler";
  report.structures.push_back(std::move(filler));
  report.structures.insert(report.structures.end(), reports.begin(), reports.end());
  auto space = steps.run("measuring distances", 0.1,
                         [&] { return make_labelled_space(file, *surfaces, progress, parts); });
  ARTUS_TRY(space);
  parts.forget_old(kMaxPartBytes);
  report.parts_cached = parts.found();
  Result<Complex> complex = make_interfaces(*space, steps, report);
  ARTUS_TRY(complex);
  steps.run("measuring interfaces", 0.65, [&] {
    measure_distances(complex->mesh, space->labels, *surfaces, report);
    return true;
  });
  // Their memory is TetGen's now; of the labels the outermost surface is all that it needs.
  for (auto& surface : surfaces->structures)
    if (surface) surface->tree = DistanceTree(SurfaceMesh{});
  space->labels.layers.clear();
  space->labels.layers.shrink_to_fit();
  space->labels.index = {};
  ARTUS_TRY(fill(*complex, *space, steps, report));
  mark_cuts(complex->mesh, surfaces->body, std::get<SurfaceFile>(file.body.shape).grow);
  for (const std::string& warning : surfaces->body.warnings)
    report.notes.push_back("body: " + warning);
  append_warnings(file, space->labels, *surfaces, report);
  append_gap_cuts(file, *space, report);
  ARTUS_TRY(check_lost(file, *surfaces, complex->mesh, report, options));
  outcome.joint = attach_metadata(file, std::move(complex->mesh), std::move(*digest), report.notes);
  report.seconds = seconds_since(start);
  report.peak_memory = peak_memory();
  if (progress) progress("done", 1);
  return outcome;
}

}  // namespace artus
