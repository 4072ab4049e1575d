// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "artus/detail/anatomy/import/surface_nets.h"

namespace artus {
namespace {

constexpr double kFarthest = 0.49;  // voxel, from the middle of the cell

/// Area vector of a face (towards `above`), m^2, of its two triangles.
Vec3 area_vector(const NetFace& face, std::span<const Vec3> places) {
  Vec3 sum = Vec3::Zero();
  for (const auto& t : triangles_of(face, places)) {
    const Vec3& a = places[face.vertices[t[0]]];
    sum += (places[face.vertices[t[1]]] - a).cross(places[face.vertices[t[2]]] - a) / 2;
  }
  return sum;
}

/// Enclosed volumes of the labels from 0 on, m^3. Frames that mirror turn the sign.
std::vector<double> enclosed(const SurfaceNet& net, std::span<const Vec3> places,
                             std::size_t n_labels, double handedness) {
  std::vector<double> volumes(n_labels + 1, 0);
  const Vec3 origin = places.empty() ? Vec3::Zero() : places.front();
  for (const NetFace& face : net.faces) {
    double v = 0;
    for (const auto& t : triangles_of(face, places)) {
      const Vec3 a = places[face.vertices[t[0]]] - origin;
      const Vec3 b = places[face.vertices[t[1]]] - origin;
      const Vec3 c = places[face.vertices[t[2]]] - origin;
      v += a.dot(b.cross(c)) / 6;
    }
    v *= handedness;
    volumes[face.below] += v;
    volumes[face.above] -= v;
  }
  return volumes;
}

/// Offsets p of the labels that give each the missing volume; 0 for those that are left out.
Eigen::VectorXd solve_offsets(const SurfaceNet& net, std::span<const Vec3> places,
                              const std::vector<double>& missing, const std::vector<bool>& moves) {
  std::vector<Eigen::Index> row(missing.size(), -1);
  Eigen::Index n = 0;
  for (std::size_t a = 0; a < missing.size(); ++a)
    if (moves[a]) row[a] = n++;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  for (const NetFace& face : net.faces) {
    if (face.cut) continue;
    const double area = area_vector(face, places).norm();
    const auto i = row[face.below];
    const auto k = row[face.above];
    if (i >= 0) A(i, i) += area;
    if (k >= 0) A(k, k) += area;
    if (i >= 0 && k >= 0) {
      A(i, k) -= area;
      A(k, i) -= area;
    }
  }
  for (std::size_t a = 0; a < missing.size(); ++a)
    if (row[a] >= 0) b[row[a]] = missing[a];
  // Labels that touch nothing but each other and the border have no offset of their own.
  constexpr double kHair = 1e-9;
  if (n > 0) A.diagonal().array() += kHair * A.diagonal().maxCoeff();
  const Eigen::VectorXd p = A.ldlt().solve(b);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(missing.size()));
  for (std::size_t a = 0; a < missing.size(); ++a)
    if (row[a] >= 0) all[static_cast<Eigen::Index>(a)] = p[row[a]];
  return all;
}

void move_along_normals(SurfaceNet& net, std::span<const Vec3> places, const Eigen::VectorXd& p,
                        const IndexFrame& X_LI, double handedness) {
  std::vector<Vec3> pull(net.points.size(), Vec3::Zero());
  std::vector<double> area(net.points.size(), 0);
  for (const NetFace& face : net.faces) {
    if (face.cut) continue;
    const Vec3 n = handedness * area_vector(face, places);
    const double offset = p[face.below] - p[face.above];
    for (const auto v : face.vertices) {
      pull[v] += offset * n;
      area[v] += n.norm();
    }
  }
  const Eigen::Matrix3d to_index = X_LI.linear().inverse();
  for (std::size_t v = 0; v < pull.size(); ++v) {
    if (!(area[v] > 0)) continue;
    const Vec3 moved = net.points[v] + to_index * (pull[v] / area[v]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t c = net.cells[v].at(axis);
      if (c < 0 || c + 1 >= static_cast<std::int32_t>(net.size.at(axis))) continue;
      const auto k = static_cast<Eigen::Index>(axis);
      net.points[v][k] = std::clamp(moved[k], c + 0.5 - kFarthest, c + 0.5 + kFarthest);
    }
  }
}

}  // namespace

std::vector<LabelVolumes> fit_volumes(SurfaceNet& net, std::span<const std::size_t> counts,
                                      const IndexFrame& X_LI, std::size_t least) {
  constexpr int kRounds = 4;
  const double handedness = X_LI.linear().determinant() < 0 ? -1 : 1;
  const double voxel = std::abs(X_LI.linear().determinant());
  std::vector<LabelVolumes> told(counts.size());
  std::vector<bool> moves(counts.size() + 1, false);
  for (std::size_t a = 1; a <= counts.size(); ++a) {
    moves[a] = counts[a - 1] >= least;
    told[a - 1].counted = static_cast<double>(counts[a - 1]) * voxel;
  }
  for (int round = 0; round <= kRounds; ++round) {
    const auto places = places_of(net, X_LI);
    const auto volumes = enclosed(net, places, counts.size(), handedness);
    std::vector<double> missing(volumes.size(), 0);
    for (std::size_t a = 1; a <= counts.size(); ++a) {
      if (round == 0) told[a - 1].smoothed = volumes[a];
      told[a - 1].fitted = volumes[a];
      missing[a] = told[a - 1].counted - volumes[a];
    }
    if (round < kRounds)
      move_along_normals(net, places, solve_offsets(net, places, missing, moves), X_LI, handedness);
  }
  return told;
}

}  // namespace artus
