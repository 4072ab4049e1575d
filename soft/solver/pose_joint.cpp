// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/pose_joint.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include "artus/detail/core/closest_point.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/rigid.h"
#include "artus/detail/core/units.h"
#include "artus/detail/soft/cage/tet_locator.h"

namespace artus {
namespace {

using Twist =
    Eigen::Matrix<double, 6, 1>;  // turn (rad), then the displacement of the frame's origin (m)

constexpr double kUnitModulus = 15e3;  // Pa, muscle's: conductance 1
constexpr double kMinConductance = 0.2;
constexpr double kMaxConductance = 30;
constexpr double kFilmConductance = 0.02;  // of bursa and joint fluid: what is slack slides
constexpr double kShareTolerance = 1e-6;   // of the shares
constexpr double kWhole = 1e-9;            // a share this near to 0 or 1 is 0 or 1
constexpr double kTouch = 0.5e-3;          // m, by which bones may share a place
constexpr double kMaxFolded = 0.02;
constexpr double kMeasured = 2e-7;  // m^3, smallest tissue whose volume is compared

Eigen::Matrix3d cross_matrix(const Vec3& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Twist twist_of(const Pose& X) {
  const Eigen::AngleAxisd turn(X.linear());
  const Vec3 w = turn.angle() * turn.axis();
  const double a = turn.angle();
  const Eigen::Matrix3d W = cross_matrix(w);
  const double second =
      a < 1e-4 ? 1.0 / 12 : (1 - a * std::sin(a) / (2 * (1 - std::cos(a)))) / (a * a);
  Twist twist;
  twist << w, (Eigen::Matrix3d::Identity() - 0.5 * W + second * W * W) * X.translation();
  return twist;
}

Pose pose_of(const Twist& twist) {
  const Vec3 w = twist.head<3>();
  const double a = w.norm();
  const Eigen::Matrix3d W = cross_matrix(w);
  const double first = a < 1e-4 ? 0.5 : (1 - std::cos(a)) / (a * a);
  const double second = a < 1e-4 ? 1.0 / 6 : (a - std::sin(a)) / (a * a * a);
  Pose X = Pose::Identity();
  if (a > 0) X.linear() = Eigen::AngleAxisd(a, w / a).toRotationMatrix();
  X.translation() = (Eigen::Matrix3d::Identity() + first * W + second * W * W) * twist.tail<3>();
  return X;
}

/// How firmly a tissue passes motion on.
double conductance_of(const Tissue& tissue) {
  if (tissue.acoustic.kind == TissueKind::fluid) return kFilmConductance;
  return std::clamp(std::sqrt(tissue.mechanical.youngs_modulus / kUnitModulus), kMinConductance,
                    kMaxConductance);
}

Result<RegionId> find_bone(const CompiledJoint& joint, const std::string& name) {
  for (std::size_t r = kFirstRegion; r < joint.regions.size(); ++r) {
    if (joint.regions[r].name != name) continue;
    if (joint.tissue_of(static_cast<RegionId>(r)).haptic.hard) return static_cast<RegionId>(r);
    return fail(ErrorCode::not_found, "'" + name + "' is no bone", joint.name);
  }
  return fail(ErrorCode::not_found, "there is no bone '" + name + "'", joint.name);
}

/// The bone that each vertex is in or on; kOutside: none.
std::vector<RegionId> bones_of_vertices(const CompiledJoint& joint) {
  std::vector<RegionId> bone(joint.mesh.vertices.size(), kOutside);
  for (std::size_t t = 0; t < joint.mesh.tetrahedra.size(); ++t) {
    const RegionId region = joint.mesh.regions[t];
    if (!joint.tissue_of(region).haptic.hard) continue;
    for (const std::uint32_t v : joint.mesh.tetrahedra[t]) bone[v] = region;
  }
  return bone;
}

/// Integrals of products of the gradients of a tetrahedron's corner functions; zero where it is
/// flat.
Eigen::Matrix4d stiffness_of(const TetMesh& mesh, std::size_t t) {
  const auto& [a, b, c, d] = mesh.tetrahedra[t];
  const auto& v = mesh.vertices;
  Eigen::Matrix3d edges;
  edges << v[b] - v[a], v[c] - v[a], v[d] - v[a];
  const double six = edges.determinant();
  if (!(six > 0)) return Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> gradient;
  gradient.bottomRows<3>() = edges.inverse();
  gradient.row(0) = -gradient.bottomRows<3>().colwise().sum();
  return six / 6 * gradient * gradient.transpose();
}

/// The places of a joint that go with its tissue.
class TissueMotion {
 public:
  TissueMotion(const CompiledJoint& joint, const TetLocator& locator,
               std::span<const Twist> of_vertex)
      : mesh_(joint.mesh), locator_(locator), twist_(of_vertex) {
    for (const Interface& i : mesh_.interfaces) {
      if (i.front != kOutside && i.back != kOutside) continue;
      skin_.insert(skin_.end(), i.vertices.begin(), i.vertices.end());
    }
  }

  /// Of the tissue at `p`, or of the nearest vertex of the skin.
  [[nodiscard]] Pose at(const Vec3& p) const {
    const std::int64_t t = locator_.find(p);
    std::uint32_t nearest = skin_.empty() ? 0 : skin_.front();
    if (t < 0) {
      for (const std::uint32_t v : skin_) {
        if ((mesh_.vertices[v] - p).squaredNorm() < (mesh_.vertices[nearest] - p).squaredNorm())
          nearest = v;
      }
      return pose_of(twist_[nearest]);
    }
    const auto& tet = mesh_.tetrahedra[static_cast<std::size_t>(t)];
    const auto& v = mesh_.vertices;
    Eigen::Matrix3d edges;
    edges << v[tet[1]] - v[tet[0]], v[tet[2]] - v[tet[0]], v[tet[3]] - v[tet[0]];
    const Vec3 w = edges.inverse() * (p - v[tet[0]]);
    return pose_of((1 - w.sum()) * twist_[tet[0]] + w.x() * twist_[tet[1]] +
                   w.y() * twist_[tet[2]] + w.z() * twist_[tet[3]]);
  }

 private:
  const TetMesh& mesh_;
  const TetLocator& locator_;
  std::span<const Twist> twist_;
  std::vector<std::uint32_t> skin_;
};

/// Distance from a point to a bone's surface.
double distance_to(const TetMesh& mesh, RegionId bone, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Interface& i : mesh.interfaces) {
    if (i.front != bone && i.back != bone) continue;
    const auto& v = mesh.vertices;
    const Vec3 q =
        closest_point_on_triangle(p, {v[i.vertices[0]], v[i.vertices[1]], v[i.vertices[2]]});
    least = std::min(least, (q - p).norm());
  }
  return least;
}

struct Motions {
  std::vector<RegionId> bones;
  std::vector<Pose> X_J;

  [[nodiscard]] Pose of(RegionId bone) const {
    const auto at = std::find(bones.begin(), bones.end(), bone);
    return at == bones.end() ? Pose::Identity() : X_J[static_cast<std::size_t>(at - bones.begin())];
  }
};

/// No bone that moves may lie in another one.
Result<void> check_bones(const CompiledJoint& joint, const TetLocator& locator,
                         const Motions& motions, std::span<const RegionId> bone_of) {
  double deepest = kTouch;
  std::string worst;
  for (std::size_t v = 0; v < bone_of.size(); ++v) {
    const RegionId bone = bone_of[v];
    if (bone == kOutside) continue;
    const Vec3 p = motions.of(bone) * joint.mesh.vertices[v];
    for (RegionId other = kFirstRegion; other < joint.regions.size(); ++other) {
      if (other == bone || !joint.tissue_of(other).haptic.hard) continue;
      const Pose X_J = motions.of(other);
      if (X_J.isApprox(motions.of(bone), 1e-12)) continue;
      const Vec3 q = X_J.inverse() * p;
      const std::int64_t t = locator.find(q);
      if (t < 0 || joint.mesh.regions[static_cast<std::size_t>(t)] != other) continue;
      const double depth = distance_to(joint.mesh, other, q);
      if (!(depth > deepest)) continue;
      deepest = depth;
      const std::string text =
          printed("%.1f mm into '%s', at (%.1f, %.1f, %.1f) mm", depth / kMillimetre,
                  joint.regions[other].name.c_str(), p.x() / kMillimetre, p.y() / kMillimetre,
                  p.z() / kMillimetre);
      worst = "'" + joint.regions[bone].name + "' would run " + text;
    }
  }
  if (!worst.empty()) return fail(ErrorCode::invalid, worst, joint.name);
  return {};
}

Result<Motions> find_motions(const CompiledJoint& joint, const JointPose& pose) {
  Motions motions;
  for (const BoneMotion& m : pose.motions) {
    const auto bone = find_bone(joint, m.structure);
    ARTUS_TRY(bone);
    const std::string where = joint.name + ", pose '" + pose.name + "'";
    if (!is_rigid(m.X_J))
      return fail(ErrorCode::invalid, "the motion of '" + m.structure + "' is not rigid", where);
    if (Eigen::AngleAxisd(m.X_J.linear()).angle() > 170 * kDegree)
      return fail(ErrorCode::invalid, "'" + m.structure + "' turns by half a turn", where);
    motions.bones.push_back(*bone);
    motions.X_J.push_back(m.X_J);
  }
  return motions;
}

/// What became of the tissues' volumes; the folds are told of by the share they have.
void measure_volumes(const CompiledJoint& rest, PosedJoint& posed) {
  std::vector<double> before(rest.tissues.size(), 0);
  std::vector<double> after(rest.tissues.size(), 0);
  double folded = 0;
  double soft = 0;
  for (std::size_t t = 0; t < rest.mesh.tetrahedra.size(); ++t) {
    const RegionId region = rest.mesh.regions[t];
    if (rest.tissue_of(region).haptic.hard) continue;
    const double v0 = tet_volume(rest.mesh, t);
    const double v1 = tet_volume(posed.joint.mesh, t);
    before[rest.regions[region].tissue] += v0;
    after[rest.regions[region].tissue] += v1;
    soft += v0;
    if (v1 <= 0 && v0 > 0) folded += v0;
  }
  posed.turned_inside = soft > 0 ? folded / soft : 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (before[k] < kMeasured) continue;
    posed.min_volume = std::min(posed.min_volume, after[k] / before[k]);
    posed.max_volume = std::max(posed.max_volume, after[k] / before[k]);
  }
}

/// Fibre axes turn by the mean turn of their structure's volume.
void turn_fibres(const CompiledJoint& rest, std::span<const Twist> twists, CompiledJoint& posed) {
  std::vector<Vec3> turn(rest.regions.size(), Vec3::Zero());
  std::vector<double> volume(rest.regions.size(), 0);
  for (std::size_t t = 0; t < rest.mesh.tetrahedra.size(); ++t) {
    const double part = 0.25 * tet_volume(rest.mesh, t);
    const RegionId region = rest.mesh.regions[t];
    volume[region] += 4 * part;
    for (const std::uint32_t v : rest.mesh.tetrahedra[t])
      turn[region] += part * twists[v].head<3>();
  }
  for (std::size_t r = kFirstRegion; r < turn.size(); ++r) {
    if (!(volume[r] > 0)) continue;
    const Vec3 w = turn[r] / volume[r];
    if (w.norm() > kWhole)
      posed.regions[r].fibre_axis =
          Eigen::AngleAxisd(w.norm(), w.normalized()) * rest.regions[r].fibre_axis;
  }
}

void move_places(const TissueMotion& motion, const JointPose& pose, CompiledJoint& joint) {
  const auto move = [&](Vec3& p) {
    p = motion.at(p) * p;
  };
  for (Landmark& l : joint.landmarks) move(l.position);
  for (PlannedInjection& i : joint.injections) {
    move(i.entry);
    move(i.target);
  }
  joint.X_JN_default = motion.at(joint.X_JN_default.translation()) * joint.X_JN_default;
  joint.X_JP_default =
      pose.X_JP.value_or(motion.at(joint.X_JP_default.translation()) * joint.X_JP_default);
}

/// The vertices in soft tissue alone, numbered; -1: the others.
std::vector<int> number_unknowns(const TetMesh& mesh, std::span<const RegionId> bone_of) {
  std::vector<bool> in_tissue(mesh.vertices.size(), false);
  for (const auto& tet : mesh.tetrahedra) {
    for (const std::uint32_t v : tet) in_tissue[v] = true;
  }
  std::vector<int> unknown(mesh.vertices.size(), -1);
  int n = 0;
  for (std::size_t v = 0; v < unknown.size(); ++v) {
    if (bone_of[v] == kOutside && in_tissue[v]) unknown[v] = n++;
  }
  return unknown;
}

/// The equations of the unknown shares, with those of bones on their right side.
struct ShareEquations {
  Eigen::SparseMatrix<double> matrix;
  Eigen::MatrixXd right;  // (n_unknowns, n_bones)
};

ShareEquations assemble_shares(const CompiledJoint& joint, std::span<const int> unknown,
                               const Eigen::MatrixXd& of_vertex) {
  const int n = 1 + *std::max_element(unknown.begin(), unknown.end());
  ShareEquations equations{Eigen::SparseMatrix<double>(n, n),
                           Eigen::MatrixXd::Zero(n, of_vertex.cols())};
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t t = 0; t < joint.mesh.tetrahedra.size(); ++t) {
    const Tissue& tissue = joint.tissue_of(joint.mesh.regions[t]);
    if (tissue.haptic.hard) continue;
    const Eigen::Matrix4d K = conductance_of(tissue) * stiffness_of(joint.mesh, t);
    const auto& tet = joint.mesh.tetrahedra[t];
    for (int i = 0; i < 4; ++i) {
      const int row = unknown[tet[static_cast<std::size_t>(i)]];
      if (row < 0) continue;
      for (int j = 0; j < 4; ++j) {
        const std::uint32_t other = tet[static_cast<std::size_t>(j)];
        if (unknown[other] >= 0)
          entries.emplace_back(row, unknown[other], K(i, j));
        else
          equations.right.row(row) -= K(i, j) * of_vertex.row(other);
      }
    }
  }
  equations.matrix.setFromTriplets(entries.begin(), entries.end());
  return equations;
}

}  // namespace

Result<BoneShares> compute_bone_shares(const CompiledJoint& joint,
                                       std::span<const std::string> bones) {
  const std::vector<RegionId> bone_of = bones_of_vertices(joint);
  BoneShares shares;
  shares.of_vertex.setZero(static_cast<Eigen::Index>(bone_of.size()),
                           static_cast<Eigen::Index>(bones.size()));
  for (std::size_t b = 0; b < bones.size(); ++b) {
    const auto bone = find_bone(joint, bones[b]);
    ARTUS_TRY(bone);
    if (std::find(bone_of.begin(), bone_of.end(), *bone) == bone_of.end())
      return fail(ErrorCode::not_found, "'" + bones[b] + "' has no volume", joint.name);
    for (std::size_t v = 0; v < bone_of.size(); ++v) {
      if (bone_of[v] == *bone)
        shares.of_vertex(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(b)) = 1;
    }
  }
  const std::vector<int> unknown = number_unknowns(joint.mesh, bone_of);
  const ShareEquations equations = assemble_shares(joint, unknown, shares.of_vertex);
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper,
                           Eigen::IncompleteCholesky<double>>
      solver;
  solver.setTolerance(kShareTolerance);
  solver.setMaxIterations(5000);
  solver.compute(equations.matrix);
  const Eigen::MatrixXd solved = solver.solve(equations.right);
  if (solver.info() != Eigen::Success || !solved.allFinite())
    return fail(ErrorCode::failed, "how the tissue goes with the bones was not found", joint.name);
  for (std::size_t v = 0; v < unknown.size(); ++v) {
    if (unknown[v] < 0) continue;
    auto row = shares.of_vertex.row(static_cast<Eigen::Index>(v));
    row = solved.row(unknown[v]).cwiseMax(0.0);
    if (row.sum() > 1) row /= row.sum();
  }
  return shares;
}

Result<PosedJoint> pose_joint(const CompiledJoint& joint, const JointPose& pose) {
  const auto motions = find_motions(joint, pose);
  ARTUS_TRY(motions);
  PosedJoint posed{joint};
  posed.joint.poses.clear();
  if (pose.X_JP) posed.joint.X_JP_default = *pose.X_JP;
  if (motions->bones.empty()) return posed;
  if (joint.mesh.tetrahedra.empty())
    return fail(ErrorCode::invalid, "a body without tetrahedra has no poses", joint.name);
  const TetLocator locator(joint.mesh);
  ARTUS_TRY(check_bones(joint, locator, *motions, bones_of_vertices(joint)));
  std::vector<std::string> names;
  for (const BoneMotion& m : pose.motions) names.push_back(m.structure);
  const auto shares = compute_bone_shares(joint, names);
  ARTUS_TRY(shares);
  std::vector<Twist> twists(joint.mesh.vertices.size(), Twist::Zero());
  for (std::size_t v = 0; v < twists.size(); ++v) {
    const auto share = shares->of_vertex.row(static_cast<Eigen::Index>(v));
    if (share.maxCoeff() < kWhole) continue;
    Eigen::Index whole = 0;
    const bool rigid = share.maxCoeff(&whole) > 1 - kWhole;
    for (Eigen::Index b = 0; b < share.size(); ++b)
      twists[v] += share[b] * twist_of(motions->X_J[static_cast<std::size_t>(b)]);
    Vec3& p = posed.joint.mesh.vertices[v];
    p = (rigid ? motions->X_J[static_cast<std::size_t>(whole)] : pose_of(twists[v])) * p;
  }
  measure_volumes(joint, posed);
  if (posed.turned_inside > kMaxFolded)
    return fail(ErrorCode::invalid,
                "the tissue cannot follow: " +
                    std::to_string(static_cast<int>(std::lround(100 * posed.turned_inside))) +
                    " % of it would be folded",
                joint.name + ", pose '" + pose.name + "'");
  turn_fibres(joint, twists, posed.joint);
  move_places(TissueMotion(joint, locator, twists), pose, posed.joint);
  posed.joint.source_digest += "-" + pose.name;
  return posed;
}

Result<JointPose> find_pose(const CompiledJoint& joint, const std::string& name) {
  const auto names = item_names(joint.poses);
  const auto found = find_name(names, name, "pose", joint.name);
  ARTUS_TRY(found);
  return joint.poses[*found];
}

}  // namespace artus
