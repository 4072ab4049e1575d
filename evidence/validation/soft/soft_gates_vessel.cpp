// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "artus/detail/core/noise.h"
#include "artus/detail/evidence/validation/soft/soft_gates.h"
#include "artus/detail/soft/solver/soft_block.h"
#include "artus/detail/soft/solver/soft_solver.h"

namespace artus {
namespace {

constexpr double kWallYoung = 10e3;   // Pa, of the wall
constexpr double kWallNu = 0.47;      // of the wall
constexpr double kInner = 9e-3;       // m
constexpr double kOuter = 21e-3;      // m
constexpr double kWallCube = 1.5e-3;  // m
constexpr double kPressure = 1.0;     // Pa, small: the closed forms are of small displacements
constexpr double kSample = 1.5e-3;    // m between the points that carry the pressure

enum class Shape { sphere, tube };

/// An eighth of a hollow sphere, or a quarter of a slice of a tube, its flat faces mirrors.
std::shared_ptr<const SoftModel> make_wall(Shape shape) {
  const double side = kOuter + kWallCube;
  SoftModelParams params;
  params.cage = {
      Vec3::Zero(), Vec3(side, side, shape == Shape::tube ? 2 * kWallCube : side), kWallCube, {}};
  params.samples = 8;
  params.held = [shape](const Vec3& p) {
    const bool end = shape == Shape::tube && p.z() > 2 * kWallCube - 1e-9;
    return HeldNode{{p.x() < 1e-9, p.y() < 1e-9, p.z() < 1e-9 || end}};
  };
  MaterialField field;
  field.materials = {linear_material(kWallYoung, kWallNu)};
  field.at = [shape](const Vec3& p) {
    const double r = shape == Shape::tube ? std::hypot(p.x(), p.y()) : p.norm();
    return r > kInner && r < kOuter && p.minCoeff() > 0 ? 0 : kNoMaterial;
  };
  return std::make_shared<const SoftModel>(field, params);
}

/// The pressure on the inner wall as forces at points of equal area.
std::vector<PointLoad> inner_pressure(Shape shape) {
  std::vector<PointLoad> loads;
  const int n = static_cast<int>(std::ceil(0.5 * std::numbers::pi * kInner / kSample)) * 2;
  const double quarter = 0.5 * std::numbers::pi;
  for (int i = 0; i < n; ++i) {
    const double phi = quarter * (i + 0.5) / n;
    const int across = shape == Shape::tube ? 4 : n;
    for (int j = 0; j < across; ++j) {
      const double share = (j + 0.5) / across;
      Vec3 normal(std::cos(phi), std::sin(phi), 0);
      Vec3 p = kInner * normal;
      double area = quarter * kInner / n * (2 * kWallCube) / across;
      if (shape == Shape::tube) {
        p.z() = share * 2 * kWallCube;
      } else {
        normal = Vec3(std::sqrt(1 - share * share) * normal.x(),
                      std::sqrt(1 - share * share) * normal.y(), share);
        p = kInner * normal;
        area = quarter * kInner * kInner / (n * across);
      }
      loads.push_back({p, kPressure * area * normal});
    }
  }
  return loads;
}

/// Lame's radial displacement at r of the thick-walled sphere and, in plane strain, of the tube.
double lame(Shape shape, double r) {
  const double a = kInner;
  const double b = kOuter;
  if (shape == Shape::tube) {
    return (1 + kWallNu) * kPressure * a * a / (kWallYoung * (b * b - a * a)) *
           ((1 - 2 * kWallNu) * r + b * b / r);
  }
  return kPressure * a * a * a / (kWallYoung * (b * b * b - a * a * a)) *
         ((1 - 2 * kWallNu) * r + 0.5 * (1 + kWallNu) * b * b * b / (r * r));
}

/// The worst ratio less 1 of the wall's displacement to Lame's, over radii within the wall.
Settled worst_error(Shape shape) {
  SoftSolver solver(make_wall(shape), {});
  solver.set_loads(inner_pressure(shape));
  const bool at_rest = solver.settle(std::nullopt, 1e-12, 20);
  const SoftModel& model = solver.model();
  double worst = 0;
  for (const double r : {kInner + 2 * kWallCube, kInner + 3 * kWallCube, kInner + 4 * kWallCube}) {
    double mean = 0;
    int n = 0;
    for (const double degrees : {15.0, 35.0, 45.0, 55.0, 75.0}) {
      const double phi = degrees * std::numbers::pi / 180;
      Vec3 direction(std::cos(phi), std::sin(phi), 0);
      if (shape == Shape::sphere) direction = Vec3(direction.x(), direction.y(), 0.7).normalized();
      Vec3 p = r * direction;
      if (shape == Shape::tube) p.z() = kWallCube;
      mean += model.displacement_at(model.cage().locate(p), solver.displacements()).dot(direction);
      ++n;
    }
    worst = std::max(worst, std::abs(mean / n / lame(shape, r) - 1));
  }
  return {worst, at_rest};
}

/// Energy that a smooth load stores in a block whose layers end on the cubes' faces.
Settled smooth_energy(double cube) {
  SoftBlock block;
  block.half_x = block.half_y = 24e-3;
  block.quarter = true;
  block.layers = {{6e-3, linear_material(15e3, kWallNu)}, {18e-3, linear_material(5e3, kWallNu)}};
  SoftSolver solver(make_block_model(block, cube), {});
  std::vector<PointLoad> loads;
  constexpr int kPoints = 48;  // along the edge, four to the finest cube
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const Vec3 p(24e-3 * (i + 0.5) / kPoints, 24e-3 * (j + 0.5) / kPoints, 0);
      const double at = std::cos(0.5 * std::numbers::pi * p.x() / 24e-3) *
                        std::cos(0.5 * std::numbers::pi * p.y() / 24e-3);
      loads.push_back({p, Vec3(0, 0, 1e-6 * at * at)});
    }
  }
  solver.set_loads(loads);
  const bool at_rest = solver.settle(std::nullopt, 1e-12, 20);
  return {solver.forces().energy, at_rest};
}

}  // namespace

Gate gate_vessel() {
  Gate gate;
  gate.title = "Hollow sphere and tube under pressure, walls of 8 cubes cut by the cage, to Lame";
  const Settled sphere = worst_error(Shape::sphere);
  const Settled tube = worst_error(Shape::tube);
  gate.claims.push_back(claim_at_rest("V5: the wall", sphere.at_rest && tube.at_rest));
  gate.claims.push_back(claim_at_most({ClaimKind::fitted, "the cubes' evenness was chosen by it"},
                                      "V5: sphere, worst inside the wall", sphere.value, 0.03,
                                      "of the displacement"));
  gate.claims.push_back(claim_at_most(ClaimKind::independent, "V5: tube, worst inside the wall",
                                      tube.value, 0.03, "of the displacement"));
  return gate;
}

Gate gate_convergence() {
  Gate gate;
  gate.title = "Stored energy of two layers under a smooth load, cubes of 6, 3, 1.5 mm";
  const Settled coarse = smooth_energy(6e-3);
  const Settled middle = smooth_energy(3e-3);
  const Settled fine = smooth_energy(1.5e-3);
  gate.claims.push_back(
      claim_at_rest("V7: the block", coarse.at_rest && middle.at_rest && fine.at_rest));
  gate.claims.push_back(
      claim_at_least({ClaimKind::fitted, "the cubes' evenness was chosen with it in view"},
                     "V7: the energy's change from one halving to the next falls by",
                     (coarse.value - middle.value) / (middle.value - fine.value), 1.8, ""));
  return gate;
}

Gate gate_reciprocity() {
  Gate gate;
  gate.title = "Compliance of random points in a pressed block: C against its transpose";
  SoftBlock block;
  block.half_x = block.half_y = 24e-3;
  block.layers = {{2e-3, linear_material(150e3, kWallNu)}, {22e-3, linear_material(5e3, kWallNu)}};
  const auto model = make_block_model(block, 3e-3);
  SoftSolver solver(model, {});
  solver.set_loads({{Vec3(1e-3, 2e-3, 0), Vec3(0, 0, 0.3)}});
  gate.claims.push_back(claim_at_rest("V10: the block", solver.settle(std::nullopt, 1e-8, 60)));
  solver.refresh();
  constexpr int kRows = 12;
  const auto size = static_cast<Eigen::Index>(3 * model->n_unknowns());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(size, kRows);
  for (int k = 0; k < kRows; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    const Vec3 p(36e-3 * (uniform_noise(1, i) - 0.5), 36e-3 * (uniform_noise(2, i) - 0.5),
                 18e-3 * uniform_noise(3, i));
    const Vec3 force(uniform_noise(4, i) - 0.5, uniform_noise(5, i) - 0.5,
                     uniform_noise(6, i) - 0.5);
    Eigen::VectorXd column = Eigen::VectorXd::Zero(size);
    model->add_force(model->cage().locate(p), force, column);
    rows.col(k) = column;
  }
  Eigen::MatrixXd answers(size, kRows);
  for (int k = 0; k < kRows; ++k) {
    Eigen::VectorXd x = rows.col(k);
    solver.factor().solve(x);
    answers.col(k) = x;
  }
  const Eigen::MatrixXd C = rows.transpose() * answers;
  gate.claims.push_back(
      claim_at_most(ClaimKind::independent, "V10: largest difference to the transpose",
                    (C - C.transpose()).cwiseAbs().maxCoeff() / C.diagonal().cwiseAbs().minCoeff(),
                    1e-4, "of the least compliance"));
  return gate;
}

}  // namespace artus
