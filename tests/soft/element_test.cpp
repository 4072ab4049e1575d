// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/element.h"

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/core/noise.h"
#include "artus/detail/soft/cage/material.h"

namespace artus {
namespace {

CellMaterial mixed_material() {
  CellMaterial m;
  for (std::size_t g = 0; g < 8; ++g) {
    m.weight[g] = 0.4 + 0.05 * static_cast<double>(g);
    m.shear[g] = 800 + 300 * static_cast<double>(g);
    m.sheet[g] = g % 2 == 0 ? 5000 : 0;
    m.hardening[g] = 2.4;
  }
  m.bulk = 20e3;
  m.fibre_modulus = 3e4;
  m.sheet_normal = Vec3(0.2, 0.1, 1).normalized();
  m.fibre = Vec3(1, 0.5, 0.1).normalized();
  return m;
}

CellVector random_displacement(double size, std::uint64_t seed) {
  CellVector u;
  for (int i = 0; i < 24; ++i)
    u[i] = size * (2 * uniform_noise(seed, static_cast<unsigned>(i)) - 1);
  return u;
}

TEST(SoftTissues, AreOfTheTissueLibraryAndSayWhereTheirValuesComeFrom) {
  const auto library = read_bundled_tissues();
  ASSERT_TRUE(library);
  const auto values = read_bundled_soft_tissues();
  ASSERT_TRUE(values) << values.error().to_string();
  EXPECT_EQ(values->size(), 16U);
  for (const SoftTissue& soft : *values) {
    const auto tissue = std::find_if(library->begin(), library->end(),
                                     [&](const Tissue& t) { return t.name == soft.tissue; });
    ASSERT_NE(tissue, library->end()) << soft.tissue;
    EXPECT_FALSE(tissue->haptic.hard) << soft.tissue;
    EXPECT_GE(soft.shear, 100) << soft.tissue;
    EXPECT_TRUE(soft.source.find('[') == 0 || soft.source.find("assumed: ") == 0) << soft.source;
    const SoftMaterial material = make_soft_material(*tissue, *values, Vec3::UnitX(), 0.47);
    EXPECT_EQ(material.shear, soft.shear);
    EXPECT_EQ(material.fibre_modulus, soft.fibre_modulus);
  }
}

TEST(Element, ResistsVolumesThatAlternateWithinIt) {
  CellMaterial m;
  for (std::size_t g = 0; g < 8; ++g) {
    m.weight[g] = 1;
    m.shear[g] = 1000;
  }
  m.bulk = 20e3;
  // One half of the cube wider, the other narrower: the mean volume stays.
  CellVector u = CellVector::Zero();
  for (Eigen::Index n = 0; n < 8; ++n) {
    const double x = (n & 1) != 0 ? 1 : -1;
    const double y = (n & 2) != 0 ? 1 : -1;
    const double z = (n & 4) != 0 ? 1 : -1;
    u[3 * n] = 1e-6 * x * y * z;
  }
  const double with = cell_response(m, 3e-3, u).energy;
  m.bulk = 0;  // evenness is lambda at most: none
  const double without = cell_response(m, 3e-3, u).energy;
  EXPECT_GT(with, 1.1 * without);
}

TEST(Element, HasNoForceAtRest) {
  const CellResponse r = cell_response(mixed_material(), 3e-3, CellVector::Zero());
  EXPECT_LT(r.force.norm(), 1e-12);
  EXPECT_NEAR(r.energy, 0, 1e-18);
}

/// That the cube's force is minus the gradient of its energy.
void expect_force_is_gradient(const CellMaterial& m, double edge, const CellVector& u) {
  const CellVector force = cell_response(m, edge, u).force;
  for (int i = 0; i < 24; ++i) {
    CellVector plus = u;
    CellVector minus = u;
    plus[i] += 1e-8;
    minus[i] -= 1e-8;
    const double slope =
        (cell_response(m, edge, plus).energy - cell_response(m, edge, minus).energy) / 2e-8;
    EXPECT_NEAR(force[i], -slope, 1e-5 * force.norm()) << i;
  }
}

TEST(Element, ForceIsMinusTheGradientOfTheEnergy) {
  const CellMaterial m = mixed_material();
  const double edge = 3e-3;
  const CellVector u = random_displacement(0.5e-3, 7);
  expect_force_is_gradient(m, edge, u);
}

/// A cube of which a fifth drains under 2 kPa, squeezed to the share `J` of its volume.
CellVector squeezed_to(double J, double edge) {
  CellVector u = random_displacement(1e-9, 5);
  for (int a = 4; a < 8; ++a) u[3 * a + 2] -= (1 - J) * edge;
  return u;
}

CellMaterial draining() {
  CellMaterial m;
  for (std::size_t g = 0; g < 8; ++g) {
    m.weight[g] = 1;
    m.shear[g] = 1000;
  }
  m.bulk = 50e3;
  m.drain = 0.2;
  m.drain_pressure = 2e3;
  return m;
}

TEST(Element, FluidThatDrainsLeavesUnderItsPressureAndThenTheRestResists) {
  const CellMaterial m = draining();
  EXPECT_NEAR(cell_pressure(m, 0.9), 1e3, 1e-9);  // half of it has left
  EXPECT_NEAR(cell_pressure(m, 0.84), 1.6e3, 1e-9);
  const double slope = (cell_pressure(m, 0.70) - cell_pressure(m, 0.72)) / 0.02;
  EXPECT_NEAR(slope, 50e3, 1e-6);
  EXPECT_NEAR(cell_pressure(m, 1.01), -500, 1e-9);  // nothing is drawn in
  for (const double J : {0.97, 0.82, 0.7}) {
    const double edge = 3e-3;
    const CellVector u = squeezed_to(J, edge);
    const CellVector force = cell_response(m, edge, u).force;
    const CellMatrix K = cell_tangent(m, edge, u);
    CellMaterial stiff = m;
    stiff.drain = 0;
    EXPECT_LT(cell_response(m, edge, u).energy, cell_response(stiff, edge, u).energy);
    for (int i = 0; i < 24; ++i) {
      CellVector plus = u;
      CellVector minus = u;
      plus[i] += 1e-8;
      minus[i] -= 1e-8;
      const CellResponse after = cell_response(m, edge, plus);
      const CellResponse before = cell_response(m, edge, minus);
      EXPECT_NEAR(force[i], -(after.energy - before.energy) / 2e-8, 1e-5 * force.norm()) << J;
      // What is held back is 0.4 % there; the slope of a body that does not drain is far off.
      if (J > 0.95) {
        EXPECT_LT((K.col(i) + (after.force - before.force) / 2e-8).norm(), 1e-2 * K.norm()) << i;
      }
    }
  }
}

CellMaterial fat_like() {
  CellMaterial m;
  for (std::size_t g = 0; g < 8; ++g) {
    m.weight[g] = 1;
    m.shear[g] = 800;
  }
  m.bulk = 50e3;
  return m;
}

/// A cube squeezed to the share `z` of its height and wide enough to be left with `volume`.
CellVector squeezed(double edge, double z, double volume) {
  CellVector u = CellVector::Zero();
  const double wide = std::sqrt(volume / z);
  for (Eigen::Index n = 0; n < 8; ++n) {
    u[3 * n] = (n & 1) != 0 ? edge * (wide - 1) : 0;
    u[3 * n + 1] = (n & 2) != 0 ? edge * (wide - 1) : 0;
    u[3 * n + 2] = (n & 4) != 0 ? edge * (z - 1) : 0;
  }
  return u;
}

TEST(Element, BulkHardensWhereATenthOfTheVolumeIsLostAndNotBefore) {
  CellMaterial m = fat_like();
  CellMaterial plain = m;
  m.firm_from = 0.1;
  EXPECT_EQ(cell_pressure(m, 0.91), cell_pressure(plain, 0.91));
  EXPECT_EQ(cell_pressure(m, 1.5), cell_pressure(plain, 1.5));
  // lambda (q + (q - v)^2/w) by hand: q = 0.2, v = 0.1, w = 0.01.
  EXPECT_NEAR(cell_pressure(m, 0.8), 50e3 * (0.2 + 1.0), 1e-6);
  m.drain = 0.2;  // what drains leaves before that
  m.drain_pressure = 2e3;
  EXPECT_NEAR(cell_pressure(m, 0.7) - cell_pressure(m, 0.71), 500, 1);
  EXPECT_GT(cell_pressure(m, 0.6) - cell_pressure(m, 0.61), 2000);
  constexpr double kEdge = 3e-3;
  const CellVector u = squeezed_to(0.6, kEdge);
  expect_force_is_gradient(m, kEdge, u);
}

TEST(Element, PartOfNearlyNothingButAirIsNoneThatIsCrushed) {
  CellMaterial m = fat_like();
  const CellVector u = squeezed(3e-3, 0.5, 0.5);
  EXPECT_NEAR(cell_response(m, 3e-3, u).min_volume, 0.5, 1e-12);
  m.weight.fill(kMinWeight);
  EXPECT_EQ(cell_response(m, 3e-3, u).min_volume, 1);
}

TEST(Element, TangentIsTheForcesDerivativeWhereNothingIsHeldBack) {
  CellMaterial m = mixed_material();
  const double edge = 3e-3;
  // Stretched along the fibres and the sheet, little pressure: neither is clamped.
  CellVector u = random_displacement(2e-6, 3);
  for (int a = 0; a < 8; ++a) {
    if ((a & 1) != 0) u[3 * a] += 0.10 * edge;
    if ((a & 2) != 0) u[3 * a + 1] += 0.05 * edge;
    if ((a & 4) != 0) u[3 * a + 2] -= 0.12 * edge;
  }
  const CellMatrix K = cell_tangent(m, edge, u, cell_dilatation(m, edge, u));
  for (int i = 0; i < 24; ++i) {
    CellVector plus = u;
    CellVector minus = u;
    plus[i] += 1e-8;
    minus[i] -= 1e-8;
    const double target = cell_dilatation(m, edge, u);
    const CellVector slope =
        (cell_response(m, edge, plus, target).force - cell_response(m, edge, minus, target).force) /
        -2e-8;
    EXPECT_LT((K.col(i) - slope).norm(), 2e-4 * K.norm()) << i;
  }
}

TEST(Element, TangentIsSymmetricAndAtRestPositiveButForRigidMotions) {
  const CellMatrix K = cell_tangent(mixed_material(), 3e-3, CellVector::Zero());
  EXPECT_LT((K - K.transpose()).norm(), 1e-9 * K.norm());
  const Eigen::SelfAdjointEigenSolver<CellMatrix> solver(K);
  EXPECT_LT(std::abs(solver.eigenvalues()[5]), 1e-9 * solver.eigenvalues()[23]);
  EXPECT_GT(solver.eigenvalues()[6], 1e-4 * solver.eigenvalues()[23]);
}

TEST(Element, TangentUnderAPressureFarAboveShearIsPositiveAndKeepsWhatStiffens) {
  constexpr double kEdge = 3e-3;
  constexpr double kStep = 1e-9;
  const CellMaterial m = fat_like();
  const CellVector u = squeezed(kEdge, 0.8, 0.8);  // 10 kPa, 12 times mu
  const CellMatrix K = cell_tangent(m, kEdge, u);
  const Eigen::SelfAdjointEigenSolver<CellMatrix> solver(K);
  EXPECT_GT(solver.eigenvalues()[0], -1e-9 * solver.eigenvalues()[23]);
  // By the forces, no way is stiffer than the tangent says: a whole step does not pass its end.
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const CellVector path = random_displacement(1, seed);
    const CellVector change = cell_response(m, kEdge, u + kStep * path).force -
                              cell_response(m, kEdge, u - kStep * path).force;
    const double exact = -change.dot(path) / (2 * kStep);
    EXPECT_LE(exact, path.dot(K * path) * (1 + 1e-5)) << seed;
  }
}

TEST(Element, CrushedPartPushesBackThoughTheMeanVolumeStays) {
  constexpr double kEdge = 3e-3;
  const CellMaterial m = fat_like();
  const auto energy = [&](double z) {
    return cell_response(m, kEdge, squeezed(kEdge, z, z)).energy;
  };
  // lambda/2 (1 - J)^2 and the shear's share are the whole above kMinPart, less than it below.
  const double volume = kEdge * kEdge * kEdge;
  const auto plain = [&](double z) {
    const double psi = 0.5 * (z * z - 1) - (z - 1) + 0.5 * (z - 1) * (z - 1);
    return volume * (800 * psi + 25e3 * (z - 1) * (z - 1));
  };
  EXPECT_NEAR(energy(0.5), plain(0.5), 1e-9 * plain(0.5));
  const double below = 0.5 * kMinPart;
  EXPECT_NEAR(energy(below) - plain(below), volume * 25e3 * 0.25, 1e-9 * plain(below));
}

TEST(Element, FeelsNothingOfARotation) {
  const double edge = 3e-3;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  CellVector u;
  for (int a = 0; a < 8; ++a) {
    const Vec3 X = edge * Vec3(a & 1, a >> 1 & 1, a >> 2);
    u.segment<3>(3 * a) = R * X - X;
  }
  const CellResponse r = cell_response(mixed_material(), edge, u);
  EXPECT_LT(r.force.norm(), 1e-9);
  EXPECT_NEAR(r.min_volume, 1, 1e-12);
}

TEST(Element, StaysFiniteWhenTurnedInsideOut) {
  CellVector u;
  for (int a = 0; a < 8; ++a) {
    const Vec3 X = 3e-3 * Vec3(a & 1, a >> 1 & 1, a >> 2);
    u.segment<3>(3 * a) = Vec3(0, 0, -2.2 * X.z());
  }
  const CellResponse r = cell_response(mixed_material(), 3e-3, u);
  EXPECT_TRUE(r.force.allFinite());
  EXPECT_LT(r.min_volume, 0);
  EXPECT_TRUE(cell_tangent(mixed_material(), 3e-3, u).allFinite());
}

}  // namespace
}  // namespace artus
