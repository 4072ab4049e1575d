// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/label_maps/joint_labels.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/anatomy/import/structure_names.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kFinest = 0.05 * kMillimetre;
constexpr double kCoarsest = 20 * kMillimetre;
constexpr double kMostVoxels = 536870912;
constexpr int kAir = 3;  // voxels around the joint
constexpr RegionId kFiller = kFirstRegion;

/// From the joint's frame to LPS, by the directions of its axes ("LPS", "RAS", "AIR").
Eigen::Matrix3d lps_of_axes(const std::string& axes) {
  Eigen::Matrix3d to = Eigen::Matrix3d::Identity();
  for (int k = 0; k < 3 && axes.size() == 3; ++k) {
    to.col(k).setZero();
    switch (axes[static_cast<std::size_t>(k)]) {
      case 'L':
        to(0, k) = 1;
        break;
      case 'R':
        to(0, k) = -1;
        break;
      case 'P':
        to(1, k) = 1;
        break;
      case 'A':
        to(1, k) = -1;
        break;
      case 'S':
        to(2, k) = 1;
        break;
      default:
        to(2, k) = -1;
    }
  }
  return to;
}

/// The grid around all vertices. Errors: invalid.
Result<void> place_grid(const CompiledJoint& joint, const LabelGrid& grid, LabelVolume& volume) {
  if (!(grid.spacing.minCoeff() >= kFinest && grid.spacing.maxCoeff() <= kCoarsest))
    return fail(ErrorCode::invalid, "a voxel's edges are from 0.05 to 20 mm", "--spacing");
  const Eigen::Matrix3d turned = (Eigen::AngleAxisd(grid.turn.z(), Vec3::UnitZ()) *
                                  Eigen::AngleAxisd(grid.turn.y(), Vec3::UnitY()) *
                                  Eigen::AngleAxisd(grid.turn.x(), Vec3::UnitX()))
                                     .toRotationMatrix();
  const Vec3 signs = grid.is_ras ? Vec3(-1, -1, 1) : Vec3(1, 1, 1);
  volume.X_LI.linear() = turned * signs.asDiagonal() * grid.spacing.asDiagonal();
  volume.X_LI = rounded_frame(volume.X_LI);
  const Eigen::Matrix3d edges = volume.X_LI.linear();
  const Eigen::Matrix3d to_index = edges.inverse() * lps_of_axes(joint.axes);
  Eigen::AlignedBox3d box;
  for (const Vec3& p : joint.mesh.vertices) box.extend(to_index * p);
  const Vec3 low = box.min() - Vec3::Constant(kAir);
  const Vec3 size = (box.max() - box.min()).array().ceil() + (2 * kAir + 1);
  if (box.isEmpty() || !(size.prod() <= kMostVoxels))
    return fail(ErrorCode::invalid,
                printed("the joint has %.0f x %.0f x %.0f voxels of this size; take --spacing %.2g "
                        "or more",
                        size.x(), size.y(), size.z(),
                        std::cbrt(size.prod() * grid.spacing.prod() / kMostVoxels) / kMillimetre),
                "--spacing");
  for (int k = 0; k < 3; ++k)
    volume.size[static_cast<std::size_t>(k)] = static_cast<std::size_t>(size[k]);
  volume.X_LI.translation() = edges * low;
  volume.X_LI = rounded_frame(volume.X_LI);
  return {};
}

/// Gives the voxels whose centres lie in a tetrahedron its label; those that have one keep it.
class TetPainter {
 public:
  explicit TetPainter(LabelVolume& volume) : volume_(volume) {}

  void paint(const std::array<Vec3, 4>& corners, std::uint16_t label) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
      edges.col(k) = corners[static_cast<std::size_t>(k) + 1] - corners[0];
    if (!(std::abs(edges.determinant()) > kFlat)) return;
    const Eigen::Matrix3d inverse = edges.inverse();
    Eigen::Matrix<double, 4, 3> slope;  // of the four shares, per index
    slope.bottomRows<3>() = inverse;
    slope.row(0) = -inverse.colwise().sum();
    Eigen::Vector4d at_zero;
    at_zero.tail<3>() = -inverse * corners[0];
    at_zero[0] = 1 - at_zero.tail<3>().sum();
    Vec3 low = corners[0], high = corners[0];
    for (const Vec3& p : corners) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    for (auto z = index(low.z()); z <= high.z(); ++z)
      for (auto y = index(low.y()); y <= high.y(); ++y) {
        const Eigen::Vector4d row = at_zero + slope.col(1) * y + slope.col(2) * z;
        paint_row(row, slope.col(0), {low.x(), high.x()},
                  (static_cast<std::size_t>(z) * volume_.size[1] + static_cast<std::size_t>(y)) *
                      volume_.size[0],
                  label);
      }
  }

 private:
  static constexpr double kFlat = 1e-12;   // voxels
  static constexpr double kSlack = 1e-10;  // of a share: faces belong to both sides

  /// The first index that is not below a coordinate of the box.
  [[nodiscard]] static double index(double low) { return std::max(0.0, std::ceil(low)); }

  /// The voxels of a row between two indices; `start` is the row's first.
  void paint_row(const Eigen::Vector4d& row, const Eigen::Vector4d& slope,
                 std::pair<double, double> reach, std::size_t start, std::uint16_t label) {
    auto& [low, high] = reach;
    for (int k = 0; k < 4; ++k) {
      if (std::abs(slope[k]) < kFlat) {
        if (row[k] < -kSlack) return;
      } else if (slope[k] > 0) {
        low = std::max(low, (-kSlack - row[k]) / slope[k]);
      } else {
        high = std::min(high, (-kSlack - row[k]) / slope[k]);
      }
    }
    for (double x = std::max(0.0, std::ceil(low)); x <= high; ++x) {
      std::uint16_t& at = volume_.labels[start + static_cast<std::size_t>(x)];
      if (at != 0) continue;
      at = label;
      ++volume_.segments[label - 1U].n_voxels;
    }
  }

  LabelVolume& volume_;
};

/// The code of a tissue in 3D Slicer's terminology; empty when it has none there.
std::string code_of(const StructureNames& names, const std::string& tissue) {
  for (const auto& known : names.codes)
    if (known.tissue == tissue) return known.code;
  return {};
}

/// Names, codes and tissues of the structures, then of the rest.
Result<void> name_segments(const CompiledJoint& joint, JointLabels& out) {
  const auto names = read_bundled_structure_names();
  ARTUS_TRY(names);
  const auto add = [&](const std::string& name, const std::string& tissue) {
    LabelSegment segment;
    segment.name = name;
    segment.value = static_cast<double>(out.volume.segments.size() + 1);
    segment.code = code_of(*names, tissue);
    out.volume.segments.push_back(std::move(segment));
    out.tissues.push_back(tissue);
  };
  for (std::size_t r = kFiller + 1U; r < joint.regions.size(); ++r)
    add(joint.regions[r].name, joint.tissue_of(static_cast<RegionId>(r)).name);
  add(std::string(kBodyOutline), std::string(kBodyOutline));
  return {};
}

}  // namespace

Result<JointLabels> label_joint(const CompiledJoint& joint, const LabelGrid& grid) {
  JointLabels out;
  out.is_ras = grid.is_ras;
  out.volume.format = "joint";
  ARTUS_TRY(name_segments(joint, out));
  ARTUS_TRY(place_grid(joint, grid, out.volume));
  out.volume.labels.assign(out.volume.size[0] * out.volume.size[1] * out.volume.size[2], 0);
  const Eigen::Affine3d to_index =
      out.volume.X_LI.inverse() * Eigen::Affine3d(lps_of_axes(joint.axes));
  std::vector<Vec3> places;
  for (const Vec3& p : joint.mesh.vertices) places.push_back(to_index * p);
  TetPainter painter(out.volume);
  const auto rest = static_cast<std::uint16_t>(out.volume.segments.size());
  for (std::size_t t = 0; t < joint.mesh.tetrahedra.size(); ++t) {
    const RegionId region = joint.mesh.regions[t];
    if (region < kFiller) continue;
    std::array<Vec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = places[joint.mesh.tetrahedra[t][k]];
    painter.paint(corners, region == kFiller ? rest : static_cast<std::uint16_t>(region - kFiller));
  }
  out.is_cut =
      std::any_of(joint.mesh.interfaces.begin(), joint.mesh.interfaces.end(),
                  [](const Interface& f) { return f.front == kBeyond || f.back == kBeyond; });
  return out;
}

}  // namespace artus
