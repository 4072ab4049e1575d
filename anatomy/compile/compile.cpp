// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile/compile.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <sys/resource.h>

#include <Eigen/Eigenvalues>
#include <tbb/task_group.h>

#include "artus/anatomy/compile/compile_labels.h"
#include "artus/anatomy/compile/compile_measure.h"
#include "artus/anatomy/compile/compile_surfaces.h"
#include "artus/anatomy/compile/compile_warnings.h"
#include "artus/anatomy/compile/default_poses.h"
#include "artus/anatomy/compile/fit_interfaces.h"
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

// One error that names all refused structures.
Result<void> check_refusals(const JointFile& file, const std::vector<StructureReport>& reports) {
  std::string message;
  for (const StructureReport& r : reports) {
    if (r.refused.empty()) continue;
    message += (message.empty() ? "" : "; ") + r.name + ": " + r.refused;
  }
  if (message.empty()) return {};
  return fail(ErrorCode::defective, "surfaces are refused: " + message, file.name);
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
  if (!neighbours) return tl::unexpected(neighbours.error());
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
  if (!neighbours) return tl::unexpected(neighbours.error());
  report.crumbs = absorb_crumbs(*mesh, *neighbours,
                                [&](RegionId r) { return smallest_part(space.resolve.sizing, r); });
  if (auto done = finish_topology(*mesh, space.labels); !done) {
    return tl::unexpected(done.error());
  }
  stages.run("fitting interfaces", 0.6, [&] {
    fit_interfaces(*mesh, space.labels);
    return true;
  });
  neighbours = find_tet_neighbours(*mesh);
  if (!neighbours) return tl::unexpected(neighbours.error());
  const FillMethod filled = stages.run("filling with tetrahedra", 0.7,
                                       [&] { return fill_with_tetgen(*mesh, *neighbours); });
  report.fill_method = name_of(filled);
  if (auto done = finish_topology(*mesh, space.labels); !done) {
    return tl::unexpected(done.error());
  }
  return mesh;
}

TissueId tissue_index(const JointFile& file, const std::string& name) {
  const auto found = std::find_if(file.tissues.begin(), file.tissues.end(),
                                  [&](const Tissue& t) { return t.name == name; });
  return found == file.tissues.end() ? TissueId{0}
                                     : static_cast<TissueId>(found - file.tissues.begin());
}

// Principal axes of muscles and tendons: the direction their volume extends most.
std::vector<Vec3> principal_axes(const TetMesh& mesh, std::size_t n_regions) {
  struct Moments {
    double volume = 0;
    Vec3 first = Vec3::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  };
  std::vector<Moments> moments(n_regions);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    Vec3 centroid = Vec3::Zero();
    for (const std::uint32_t v : mesh.tetrahedra[t]) centroid += mesh.vertices[v] / 4;
    const double volume = tet_volume(mesh, t);
    Moments& m = moments[mesh.regions[t]];
    m.volume += volume;
    m.first += volume * centroid;
    m.second += volume * centroid * centroid.transpose();
  }
  std::vector<Vec3> axes(n_regions, Vec3::Zero());
  for (std::size_t r = 0; r < n_regions; ++r) {
    const Moments& m = moments[r];
    if (!(m.volume > 0)) continue;
    const Vec3 mean = m.first / m.volume;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(m.second / m.volume -
                                                               mean * mean.transpose());
    axes[r] = eigen.eigenvectors().col(2);
    Eigen::Index largest = 0;
    axes[r].cwiseAbs().maxCoeff(&largest);
    if (axes[r][largest] < 0) axes[r] = -axes[r];
  }
  return axes;
}

std::vector<Region> make_regions(const JointFile& file, const TetMesh& mesh) {
  // assumed: outside the skin there is gel, or the first tissue where a library has none
  const TissueId gel = tissue_index(file, "gel");
  std::vector<Region> regions{{"outside", gel, Vec3::Zero()}, {"beyond", gel, Vec3::Zero()}};
  regions.push_back({file.filler_name, tissue_index(file, file.body.tissue), Vec3::Zero()});
  regions[kBeyond].tissue = regions[kFirstRegion].tissue;
  const std::vector<Vec3> axes = principal_axes(mesh, region_of_structure(file.structures.size()));
  for (const Structure& s : file.structures) {
    Region region{s.name, tissue_index(file, s.tissue), Vec3::Zero()};
    if (s.fibre_axis && s.fibre_axis->norm() > 0) {
      region.fibre_axis = s.fibre_axis->normalized();
    } else if (s.tissue == "muscle" || s.tissue == "tendon") {
      region.fibre_axis = axes[regions.size()];
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

CompiledJoint make_joint(const JointFile& file, TetMesh mesh, std::string digest,
                         std::vector<std::string>& notes) {
  CompiledJoint joint;
  joint.name = file.name;
  joint.side = file.side;
  joint.axes = file.axes;
  joint.tissues = file.tissues;
  joint.regions = make_regions(file, mesh);
  joint.mesh = std::move(mesh);
  joint.landmarks = file.landmarks;
  const DefaultPoses poses = find_default_poses(file, joint, notes);
  joint.X_JP_default = poses.X_JP;
  joint.X_JN_default = poses.X_JN;
  joint.injections = file.injections;
  joint.source_digest = std::move(digest);
  return joint;
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
  if (!digest) return tl::unexpected(digest.error());
  std::vector<StructureReport> reports = start_reports(file);
  const auto surfaces = stages.run("reading and repairing surfaces", 0,
                                   [&] { return prepare_surfaces(file, reports); });
  if (!surfaces) return tl::unexpected(surfaces.error());
  if (!options.skip_refused) {
    if (auto accepted = check_refusals(file, reports); !accepted) {
      return tl::unexpected(accepted.error());
    }
  }
  StructureReport filler;
  filler.name = file.filler_name;
  filler.tissue = file.body.tissue;
  filler.kind = "filler";
  report.structures.push_back(std::move(filler));
  report.structures.insert(report.structures.end(), reports.begin(), reports.end());
  const auto space = stages.run("measuring distances", 0.1,
                                [&] { return make_labelled_space(file, *surfaces, progress); });
  if (!space) return tl::unexpected(space.error());
  Result<TetMesh> mesh = mesh_regions(*space, stages, report);
  if (!mesh) return tl::unexpected(mesh.error());
  stages.run("measuring the result", 0.9, [&] {
    measure_mesh(*mesh, space->labels, *surfaces, report);
    append_warnings(file, space->labels, *surfaces, report);
    append_gap_cuts(file, *space, report);
    return true;
  });
  outcome.joint =
      make_joint(file, std::move(*mesh), std::move(*digest), report.structures.front().warnings);
  report.seconds = seconds_since(start);
  report.peak_memory = peak_memory();
  if (progress) progress("done", 1);
  return outcome;
}

}  // namespace artus
