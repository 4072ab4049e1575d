// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "artus/detail/evidence/validation/soft/soft_gates.h"
#include "artus/detail/soft/solver/soft_block.h"
#include "artus/detail/soft/solver/soft_solver.h"

namespace artus {
namespace {

constexpr double kYoung = 3e3;  // Pa, of fat

std::vector<Vec3> nodes_moved(const SoftModel& model,
                              const std::function<Vec3(const Vec3&)>& field) {
  std::vector<Vec3> moved;
  moved.reserve(model.cage().nodes().size());
  for (const Vec3& p : model.cage().nodes()) moved.push_back(field(p));
  return moved;
}

/// Displacement of a half-space under a force on its surface, z into it. Source [Johnson1985] 3.18.
Vec3 boussinesq(const Vec3& p, double force, double shear, double nu) {
  const double R = p.norm();
  const double r = std::hypot(p.x(), p.y());
  const double scale = force / (4 * std::numbers::pi * shear);
  const double u_z = scale * (p.z() * p.z() / (R * R * R) + 2 * (1 - nu) / R);
  if (r < 1e-12) return {0, 0, u_z};
  const double u_r = scale * (r * p.z() / (R * R * R) - (1 - 2 * nu) * r / (R * (R + p.z())));
  return {u_r * p.x() / r, u_r * p.y() / r, u_z};
}

/// A quarter of a half-space, fine around the origin, whose far sides follow the point force.
struct HalfSpace {
  SoftBlock block;
  std::shared_ptr<const SoftModel> model;

  HalfSpace(double nu, double fine, double zone, double coarse) {
    block.half_x = block.half_y = 4 * coarse;
    block.quarter = true;
    block.layers = {{4 * coarse, linear_material(kYoung, nu)}};
    model = make_block_model(block, coarse,
                             {{Vec3::Constant(-1), Vec3(zone, zone, 0.7 * zone), fine},
                              {Vec3::Constant(-1), Vec3(2 * zone, 2 * zone, 2 * zone), 2 * fine}});
  }
  [[nodiscard]] std::vector<Vec3> far_field(double force, double nu) const {
    const double shear = block.layers[0].material.shear;
    return nodes_moved(*model, [&](const Vec3& p) {
      return p.norm() < 0.5 * block.half_x ? Vec3(Vec3::Zero()) : boussinesq(p, force, shear, nu);
    });
  }
};

/// Worst error of the displacement under a point force, from `nearest` to 9 cubes away.
Settled point_force_error(double nu, int nearest) {
  constexpr double kForce = 1e-4;
  constexpr double kCube = 2e-3;
  const HalfSpace space(nu, kCube, 20e-3, 16e-3);
  SoftSolver solver(space.model, {});
  solver.set_prescribed(space.far_field(kForce, nu));
  solver.set_loads({{Vec3::Zero(), Vec3(0, 0, kForce / 4)}});
  const bool at_rest = solver.settle(std::nullopt, 1e-10, 20);
  double worst = 0;
  for (int cubes = nearest; cubes <= 9; ++cubes) {
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(1, 1, 1)}) {
      const Vec3 p = cubes * kCube * direction.normalized();
      const Vec3 exact = boussinesq(p, kForce, space.block.layers[0].material.shear, nu);
      const Vec3 u =
          space.model->displacement_at(space.model->cage().locate(p), solver.displacements());
      worst = std::max(worst, (u - exact).norm() / exact.norm());
    }
  }
  return {worst, at_rest};
}

Settled punch_ratio(double nu, double radius_in_cubes) {
  constexpr double kRadius = 10e-3;
  constexpr double kPress = 0.01e-3;
  const double cube = kRadius / radius_in_cubes;
  const HalfSpace space(nu, cube, 1.4 * kRadius, 8 * kRadius / 3);
  const double expected = 2 * kRadius * kYoung / (1 - nu * nu) * kPress;  // [Johnson1985] 3.36
  const SkinPatch skin = make_flat_skin(space.block, cube);
  const Vec3 reach = Vec3::Constant(1.3 * kRadius);
  SoftSolver solver(space.model, contact_unknowns(*space.model, skin, -reach, reach));
  ProbeFace face;
  face.round = true;
  face.friction = 0;
  face.length = face.width = 2 * (kRadius - 0.3 * cube);  // inset as SoftBodyParams has it
  face.points_x = face.points_y = 2 * static_cast<int>(std::lround(1.5 * radius_in_cubes));
  solver.set_face(skin, face);
  solver.set_prescribed(space.far_field(expected, nu));
  Pose pose = Pose::Identity();
  pose.translation().z() = kPress;
  const bool at_rest = solver.settle(pose, 1e-9, 30);
  return {-4 * solver.last().contact.force.z() / expected, at_rest};
}

/// Tip deflection of a beam 10 x 10 x 100 mm, held at one end, against Timoshenko's.
Settled beam_ratio(double nu) {
  SoftModelParams params;
  params.cage = {Vec3::Zero(), Vec3(100e-3, 10e-3, 10e-3), 1.25e-3, {}};
  params.held = [](const Vec3& p) {
    const bool wall = p.x() < 1e-9;
    // Free to narrow: held across only at the middle of the wall.
    return HeldNode{
        {wall, wall && std::abs(p.y() - 5e-3) < 1e-9, wall && std::abs(p.z() - 5e-3) < 1e-9}};
  };
  MaterialField field;
  field.materials = {linear_material(kYoung, nu)};
  field.at = [](const Vec3&) {
    return 0;
  };
  const auto model = std::make_shared<const SoftModel>(field, params);
  SoftSolver solver(model, {});
  constexpr double kForce = 1e-7;  // N, small: the closed form is of small deflections
  std::vector<PointLoad> loads;
  for (const Vec3& p : model->cage().nodes()) {
    if (p.x() < 100e-3 - 1e-9) continue;
    const auto half = [](double s) {
      return s < 1e-9 || s > 10e-3 - 1e-9 ? 0.5 : 1.0;
    };
    loads.push_back({p, Vec3(0, 0, kForce / 64 * half(p.y()) * half(p.z()))});
  }
  solver.set_loads(loads);
  const bool at_rest = solver.settle(std::nullopt, 1e-10, 10);
  const CagePlace tip = model->cage().locate(Vec3(100e-3 - 1e-6, 5e-3, 5e-3));
  const double deflection = model->displacement_at(tip, solver.displacements()).z();
  const double I = std::pow(10e-3, 4) / 12;
  const double shear = kYoung / (2 * (1 + nu));
  const double kappa = 10 * (1 + nu) / (12 + 11 * nu);  // [Cowper1966], rectangle
  const double expected =
      kForce * std::pow(0.1, 3) / (3 * kYoung * I) + kForce * 0.1 / (kappa * shear * 1e-4);
  return {deflection / expected, at_rest};
}

}  // namespace

Gate gate_patch() {
  Gate gate;
  gate.title = "A linear displacement on the rim of a graded cage, hanging nodes inside";
  const double size = 24e-3;
  Eigen::Matrix3d slope;
  slope << 1e-3, 4e-4, -2e-4, 3e-4, -5e-4, 1e-4, 2e-4, -6e-4, 7e-4;
  SoftModelParams params;
  params.cage = {Vec3::Zero(), Vec3::Constant(size), 6e-3, {}};
  params.cage.zones.push_back({Vec3(8e-3, 9e-3, 5e-3), Vec3(14e-3, 15e-3, 9e-3), 1.5e-3});
  params.held = [size](const Vec3& p) {
    const bool rim = p.minCoeff() < 1e-9 || p.maxCoeff() > size - 1e-9;
    return HeldNode{{rim, rim, rim}};
  };
  MaterialField field;
  field.materials = {linear_material(kYoung, 0.47)};
  field.at = [](const Vec3&) {
    return 0;
  };
  const auto model = std::make_shared<const SoftModel>(field, params);
  SoftSolver solver(model, {});
  const auto exact = nodes_moved(*model, [&](const Vec3& p) { return Vec3(slope * p); });
  solver.set_prescribed(exact);
  gate.claims.push_back(claim_at_rest("V1: the cage", solver.settle(std::nullopt, 1e-12)));
  double error = 0;
  double most = 0;
  for (std::size_t n = 0; n < exact.size(); ++n) {
    error = std::max(error, (solver.displacements()[n] - exact[n]).norm());
    most = std::max(most, exact[n].norm());
  }
  gate.claims.push_back(claim_at_most(ClaimKind::independent,
                                      "V1: largest error of the field inside", error / most, 1e-5,
                                      "of the displacement"));
  return gate;
}

Gate gate_uniaxial() {
  Gate gate;
  gate.title = "Compression by 0.1 % with free sides, nu 0.49, against F = E A e";
  SoftModelParams params;
  params.cage = {Vec3::Zero(), Vec3(9e-3, 9e-3, 12e-3), 3e-3, {}};
  params.held = [](const Vec3& p) {
    return HeldNode{{p.x() < 1e-9, p.y() < 1e-9, p.z() < 1e-9 || p.z() > 11.999e-3}};
  };
  MaterialField field;
  field.materials = {linear_material(kYoung, 0.49)};
  field.at = [](const Vec3&) {
    return 0;
  };
  const auto model = std::make_shared<const SoftModel>(field, params);
  SoftSolver solver(model, {});
  solver.set_prescribed(
      nodes_moved(*model, [](const Vec3& p) { return Vec3(0, 0, p.z() < 1e-9 ? 12e-6 : 0); }));
  gate.claims.push_back(claim_at_rest("V2: the block", solver.settle(std::nullopt, 1e-12)));
  double force = 0;
  for (std::uint32_t n = 0; n < model->cage().nodes().size(); ++n) {
    if (model->cage().nodes()[n].z() < 1e-9) force -= solver.forces().on_nodes[n].z();
  }
  gate.claims.push_back(
      claim_near(ClaimKind::independent, "V2: force", force, kYoung * 81e-6 * 1e-3, 0.005, "N"));
  return gate;
}

Gate gate_point_force() {
  Gate gate;
  gate.title = "Force on a half-space, displacement by the distance in cubes against Boussinesq";
  for (const double nu : {0.3, 0.47}) {
    const std::string name = nu < 0.4 ? "nu 0.3, " : "nu 0.47, ";
    const Settled near = point_force_error(nu, 3);
    const Settled far = point_force_error(nu, 6);
    gate.claims.push_back(
        claim_at_rest("V4: " + name + "the half-space", near.at_rest && far.at_rest));
    gate.claims.push_back(claim_at_most(ClaimKind::independent, "V4: " + name + "from 3 to 9 cubes",
                                        near.value, 0.03, "of the displacement"));
    gate.claims.push_back(
        claim_at_most({ClaimKind::fitted, "the distance was chosen by the answer"},
                      "V4: " + name + "from 6 to 9 cubes", far.value, 0.03, "of the displacement"));
  }
  return gate;
}

Gate gate_cantilever() {
  Gate gate;
  gate.title = "Beam 10 x 10 x 100 mm in cubes of 1.25 mm, tip against Timoshenko's beam";
  const Settled soft = beam_ratio(0.3);
  const Settled stiff = beam_ratio(0.49);
  gate.claims.push_back(claim_at_rest("V6: the beam", soft.at_rest && stiff.at_rest));
  gate.claims.push_back(claim_near(ClaimKind::independent, "V6: tip at nu 0.3, to closed form",
                                   soft.value, 1, 0.03, ""));
  gate.claims.push_back(claim_near(ClaimKind::independent, "V6: tip at nu 0.49, to closed form",
                                   stiff.value, 1, 0.03, ""));
  gate.claims.push_back(claim_near(ClaimKind::independent, "V6: no locking: the one to the other",
                                   stiff.value / soft.value, 1, 0.03, ""));
  return gate;
}

Gate gate_punch() {
  Gate gate;
  gate.title = "Flat round punch of 10 mm on a half-space, force against 2 a E/(1 - nu^2) d";
  for (const double nu : {0.3, 0.47}) {
    const std::string name = nu < 0.4 ? "nu 0.3" : "nu 0.47";
    const Settled three = punch_ratio(nu, 3);
    const Settled six = punch_ratio(nu, 6);
    gate.claims.push_back(
        claim_at_rest("V3: the half-space, " + name + ",", three.at_rest && six.at_rest));
    gate.claims.push_back(claim_near(ClaimKind::independent, "V3: radius of 3 cubes, " + name,
                                     three.value, 1, 0.10, ""));
    gate.claims.push_back(claim_near(ClaimKind::independent, "V3: radius of 6 cubes, " + name,
                                     six.value, 1, 0.03, ""));
  }
  return gate;
}

}  // namespace artus
