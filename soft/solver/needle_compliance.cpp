// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/needle_compliance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

using Index = Eigen::Index;

/// The radius at which the field of a line force, shared out to a cube's nodes, is what those nodes
/// themselves move: the mean logarithm of the nodes' distances across the line, with the lattice's
/// own 0.2 h of a node from itself [Peaceman1978].
double lattice_radius(const SoftModel& model, const CagePlace& place, const Vec3& axis) {
  const CageCell& cell = model.cage().cells()[static_cast<std::size_t>(place.cell)];
  const double edge = model.cage().edge(cell);
  double sum = 0;
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = 0; b < 8; ++b) {
      const Vec3 apart = model.cage().nodes()[cell.nodes[a]] - model.cage().nodes()[cell.nodes[b]];
      const double across = (apart - apart.dot(axis) * axis).norm();
      sum += place.weights[a] * place.weights[b] * std::log(std::max(across, 0.2 * edge));
    }
  }
  return std::exp(sum);
}

/// Displacement along the track between the needle's surface and the cube's own field, m/N.
double near_field(const SoftModel& model, const CagePlace& place, const NeedleLine& track,
                  double length) {
  if (place.cell < 0) return 0;
  const CellMaterial& material = model.materials()[static_cast<std::size_t>(place.cell)];
  double shear = 0;
  double weight = 0;
  for (std::size_t g = 0; g < 8; ++g) {
    shear += material.weight[g] * material.shear[g];
    weight += material.weight[g];
  }
  const double ratio = lattice_radius(model, place, track.axis.normalized()) / track.radius;
  if (!(shear > 0) || ratio <= 1) return 0;
  return std::log(ratio) * weight / (2 * std::numbers::pi * shear * length);
}

}  // namespace

TrackPlace find_on_track(const NeedleCompliance& compliance, double depth) noexcept {
  const auto last = static_cast<double>(compliance.points - 1);
  const double at = std::clamp(depth / compliance.spacing - 0.5, 0.0, last);
  TrackPlace place;
  place.low = static_cast<std::size_t>(at);
  place.high = std::min(place.low + 1, compliance.points - 1);
  place.share = at - static_cast<double>(place.low);
  return place;
}

double cube_compliance(const NeedleCompliance& compliance, double depth) noexcept {
  const TrackPlace b = find_on_track(compliance, depth);
  const double other = 1 - b.share;
  const auto& C = compliance.by_load;
  const auto& near = compliance.near_field;
  return other * other * (C[b.low][b.low] - near[b.low]) +
         2 * other * b.share * (C[b.low][b.high] - (b.low == b.high ? near[b.low] : 0)) +
         b.share * b.share * (C[b.high][b.high] - near[b.high]);
}

double cube_displacement(const NeedleCompliance& compliance, const NeedleLoad& load) noexcept {
  if (compliance.points == 0) return 0;
  const TrackPlace b = find_on_track(compliance, load.tip_depth);
  const auto of_shaft = [&](std::size_t point) {
    double u = -compliance.near_field[point] * load.shaft[point];
    for (std::size_t j = 0; j < compliance.points; ++j)
      u += compliance.by_load[point][j] * load.shaft[j];
    return u;
  };
  return (1 - b.share) * of_shaft(b.low) + b.share * of_shaft(b.high) +
         cube_compliance(compliance, load.tip_depth) * load.tip;
}

NeedleCompliance compute_needle_compliance(const FactoredModel& factored, const NeedleLine& track,
                                           std::size_t points) {
  ARTUS_REQUIRE(points > 0 && points <= NeedleCompliance::kMax, "1 to 16 points");
  ARTUS_REQUIRE(track.length > 0 && track.radius > 0, "a track with length and radius");
  const SoftModel& model = *factored.model;
  const Vec3 axis = track.axis.normalized();
  NeedleCompliance out;
  out.points = points;
  out.spacing = track.length / static_cast<double>(points);
  const auto n = static_cast<Index>(3 * model.n_unknowns());
  const auto m = static_cast<Index>(points);
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(n, m);
  Eigen::MatrixXd moved(n, m);
  for (Index i = 0; i < m; ++i) {
    const Vec3 p = track.entry + (static_cast<double>(i) + 0.5) * out.spacing * axis;
    const CagePlace place = model.cage().locate(p, 2);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    model.add_force(place, axis, x);
    loads.col(i) = x;
    factored.factor->solve(x);
    moved.col(i) = x;
    const auto k = static_cast<std::size_t>(i);
    out.near_field[k] = near_field(model, place, track, out.spacing);
    out.by_load[k][k] = out.near_field[k];
  }
  const Eigen::MatrixXd product = loads.transpose() * moved;
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t j = 0; j < points; ++j) {
      const auto a = static_cast<Index>(i);
      const auto b = static_cast<Index>(j);
      out.by_load[i][j] += 0.5 * (product(a, b) + product(b, a));
    }
    out.by_load[i][i] = std::max(out.by_load[i][i], 1e-9);
  }
  return out;
}

std::vector<PointLoad> loads_of(const NeedleLoad& load, const NeedleLine& track, double spacing) {
  std::vector<PointLoad> loads;
  for (std::size_t i = 0; i < load.shaft.size(); ++i) {
    if (load.shaft[i] != 0)
      loads.push_back({track.entry + (static_cast<double>(i) + 0.5) * spacing * track.axis,
                       load.shaft[i] * track.axis});
  }
  if (load.tip != 0)
    loads.push_back({track.entry + load.tip_depth * track.axis, load.tip * track.axis});
  return loads;
}

}  // namespace artus
