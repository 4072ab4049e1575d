// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/attach_metadata.h"

#include <algorithm>
#include <utility>

#include <Eigen/Eigenvalues>

#include "artus/detail/anatomy/body/skin_line.h"
#include "artus/detail/anatomy/compile/check/default_poses.h"
#include "artus/detail/anatomy/compile/labels/compile_labels.h"

namespace artus {
namespace {

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

bool has_fibres(TissueKind kind) {
  return kind == TissueKind::muscle || kind == TissueKind::tendon;
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
      region.fibre_course = s.fibre_course;
    } else if (has_fibres(file.tissues[region.tissue].acoustic.kind)) {
      region.fibre_axis = axes[regions.size()];
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

/// Where the patient's skin is not where it was modelled, plans go on from it as they did.
void follow_skin(CompiledJoint& joint) {
  Pose& X_JP = joint.X_JP_default;
  X_JP.translation() = moved_onto_skin(joint, X_JP.translation(), X_JP.linear().col(2));
  for (StandardView& view : joint.views)
    view.X_JP.translation() =
        moved_onto_skin(joint, view.X_JP.translation(), view.X_JP.linear().col(2));
  for (PlannedInjection& pass : joint.injections)
    pass.entry = moved_onto_skin(joint, pass.entry, (pass.target - pass.entry).normalized());
}

}  // namespace

CompiledJoint attach_metadata(const JointFile& file, TetMesh mesh, std::string digest,
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
  joint.views = file.views;
  if (std::get<SurfaceFile>(file.body.shape).grow != 0) follow_skin(joint);
  joint.spaces = file.spaces;
  joint.poses = file.poses;
  joint.source_digest = std::move(digest);
  return joint;
}

}  // namespace artus
