// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/kernels.h"

#include <cmath>
#include <cstring>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

std::vector<float> noise(std::size_t n, std::uint64_t seed) {
  std::vector<float> v(n);
  for (std::size_t i = 0; i < n; ++i) v[i] = static_cast<float>(uniform_noise(seed, i) - 0.5);
  return v;
}

/// A trapezium whose triangle is well conditioned.
std::vector<float> trapezium(std::size_t rows, std::size_t columns) {
  std::vector<float> L = noise(rows * columns, rows + 31 * columns);
  for (std::size_t j = 0; j < columns; ++j) L[j * rows + j] = 3.0F + L[j * rows + j];
  return L;
}

CellPack pack_of(std::uint64_t seed) {
  CellPack pack;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    CellMaterial m;
    for (std::size_t g = 0; g < 8; ++g) {
      const double r = uniform_noise(seed + lane, g);
      m.weight[g] = 0.3 + 0.7 * r;
      m.shear[g] = 500 + 4000 * r;
      m.sheet[g] = lane == 2 ? 0 : 2000 * r;
      m.hardening[g] = 3 * r;
    }
    m.bulk = 50e3;
    m.drain = lane == 3 ? 0 : 0.1 * static_cast<double>(1 + seed % 5);
    m.drain_pressure = 2e3;
    m.firm_from = lane == 0 ? 0 : 0.05 * static_cast<double>(lane);
    m.fibre_modulus = lane == 1 ? 0 : 1e4;
    m.sheet_normal = Vec3(0.2, 0.1 * static_cast<double>(lane), 1).normalized();
    m.fibre = Vec3(1, 0.3, 0.1).normalized();
    pack.set(lane, m, 3e-3);
  }
  return pack;
}

class SoftKernelsOf : public testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    const auto all = all_soft_kernels();
    if (GetParam() >= all.size()) GTEST_SKIP() << "this CPU has no such registers";
    wide_ = all[GetParam()];
  }
  const SoftKernels& plain_ = *all_soft_kernels().front();
  const SoftKernels* wide_ = nullptr;
};

TEST_P(SoftKernelsOf, WideRegistersGiveThePlainOnesBytes) {
  for (const std::size_t rows : {3U, 12U, 45U, 101U}) {
    const std::size_t columns = rows / 3 + 1;
    const std::vector<float> L = trapezium(rows, columns);
    std::vector<float> a = noise(rows, 5);
    std::vector<float> b = a;
    wide_->forward(L.data(), rows, columns, a.data());
    plain_.forward(L.data(), rows, columns, b.data());
    wide_->backward(L.data(), rows, columns, a.data());
    plain_.backward(L.data(), rows, columns, b.data());
    const std::vector<float> x = noise(columns, 9);
    wide_->multiply(L.data(), rows, columns, x.data(), a.data());
    plain_.multiply(L.data(), rows, columns, x.data(), b.data());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), rows * sizeof(float)), 0) << rows;
  }
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const CellPack pack = pack_of(seed);
    CellPackState a;
    for (std::size_t i = 0; i < 24; ++i) {
      for (std::size_t l = 0; l < kLanes; ++l)
        a.u[i][l] = 2e-3 * (uniform_noise(seed, 100 + 4 * i + l) - 0.5);
    }
    CellPackState b = a;
    wide_->cells(pack, a);
    plain_.cells(pack, b);
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0) << seed;
  }
}

/// A positive definite matrix of n rows, far from a multiple of the identity.
Eigen::MatrixXd positive(Eigen::Index n) {
  Eigen::MatrixXd R(n, n);
  for (Eigen::Index i = 0; i < R.size(); ++i)
    R.data()[i] = uniform_noise(static_cast<std::uint64_t>(n), static_cast<std::uint64_t>(i)) - 0.5;
  return R * R.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
}

struct FrontSize {
  Eigen::Index rows, columns;
};
// none, one, all columns; fewer and more than a register, a tile and a depth hold
constexpr FrontSize kFronts[] = {{1, 1},   {3, 0},   {5, 2},    {8, 8},     {9, 9},     {24, 3},
                                 {31, 17}, {64, 33}, {150, 57}, {150, 150}, {300, 129}, {301, 260}};

TEST_P(SoftKernelsOf, EliminationGivesThePlainOnesBytes) {
  for (const auto& [rows, columns] : kFronts) {
    Eigen::MatrixXd a = positive(rows);
    Eigen::MatrixXd b = a;
    const auto n = static_cast<std::size_t>(rows);
    std::vector<double> scratch(elimination_scratch(n));
    ASSERT_TRUE(wide_->eliminate(a.data(), n, static_cast<std::size_t>(columns), scratch.data()));
    ASSERT_TRUE(plain_.eliminate(b.data(), n, static_cast<std::size_t>(columns), scratch.data()));
    for (Eigen::Index j = 0; j < rows; ++j)
      EXPECT_EQ(
          std::memcmp(&a(j, j), &b(j, j), sizeof(double) * static_cast<std::size_t>(rows - j)), 0)
          << rows << " " << columns << " column " << j;
  }
}

INSTANTIATE_TEST_SUITE_P(Registers, SoftKernelsOf, testing::Values(0, 1, 2));

TEST(SoftKernels, TheWidestRegistersAreTheOnesThatAreUsed) {
  EXPECT_EQ(&soft_kernels(), all_soft_kernels().back());
}

TEST(SoftKernels, EliminationLeavesTheFactorAndTheSchurComplement) {
  for (const auto& [rows, columns] : kFronts) {
    const Eigen::MatrixXd A = positive(rows);
    Eigen::MatrixXd F = A;
    const auto n = static_cast<std::size_t>(rows);
    std::vector<double> scratch(elimination_scratch(n));
    ASSERT_TRUE(
        soft_kernels().eliminate(F.data(), n, static_cast<std::size_t>(columns), scratch.data()));
    const Eigen::Index rest = rows - columns;
    const auto own = A.topLeftCorner(columns, columns);
    const auto below = A.bottomLeftCorner(rest, columns);
    const Eigen::MatrixXd L = F.leftCols(columns).triangularView<Eigen::Lower>();
    EXPECT_LT((L * L.topRows(columns).transpose() - A.leftCols(columns)).norm(), 1e-13 * A.norm())
        << rows << " " << columns;
    const Eigen::MatrixXd complement =
        A.bottomRightCorner(rest, rest) - below * own.ldlt().solve(below.transpose());
    const Eigen::MatrixXd left =
        (F.bottomRightCorner(rest, rest) - complement).triangularView<Eigen::Lower>();
    EXPECT_LT(left.norm(), 1e-11 * A.norm()) << rows << " " << columns;
  }
}

TEST(SoftKernels, EliminationRefusesAPivotThatIsNotPositive) {
  for (const double pivot : {0.0, -1.0, std::nan("")}) {
    for (const Eigen::Index at : {0, 7, 8, 40}) {
      Eigen::MatrixXd F = positive(50);
      F(at, at) = pivot;
      std::vector<double> scratch(elimination_scratch(50));
      EXPECT_FALSE(soft_kernels().eliminate(F.data(), 50, 45, scratch.data()))
          << pivot << " " << at;
    }
  }
}

TEST(SoftKernels, ForwardAndBackwardSolveWithTheirTrapezium) {
  const std::size_t rows = 29;
  const std::size_t columns = 14;
  const std::vector<float> L = trapezium(rows, columns);
  const auto at = [&](std::size_t i, std::size_t j) {
    return static_cast<double>(L[j * rows + i]);
  };
  const std::vector<float> b = noise(rows, 3);
  std::vector<float> x = b;
  soft_kernels().forward(L.data(), rows, columns, x.data());
  for (std::size_t i = 0; i < rows; ++i) {
    double sum = i < columns ? 0 : static_cast<double>(x[i]);
    for (std::size_t j = 0; j < columns && j <= i; ++j) sum += at(i, j) * static_cast<double>(x[j]);
    EXPECT_NEAR(sum, static_cast<double>(b[i]), 1e-5) << i;
  }
  std::vector<float> y = b;
  soft_kernels().backward(L.data(), rows, columns, y.data());
  for (std::size_t j = 0; j < columns; ++j) {
    double sum = 0;
    for (std::size_t i = j; i < rows; ++i) sum += at(i, j) * static_cast<double>(y[i]);
    EXPECT_NEAR(sum, static_cast<double>(b[j]), 1e-5) << j;
  }
  std::vector<float> z(rows, 1.0F);
  soft_kernels().multiply(L.data(), rows, columns, b.data(), z.data());
  for (std::size_t i = 0; i < rows; ++i) {
    double sum = 1;
    for (std::size_t j = 0; j < columns; ++j) sum += at(i, j) * static_cast<double>(b[j]);
    EXPECT_NEAR(sum, static_cast<double>(z[i]), 1e-5) << i;
  }
}

TEST(SoftKernels, EachLaneIsACubeByItself) {
  const CellPack pack = pack_of(4);
  CellPackState all;
  for (std::size_t i = 0; i < 24; ++i) {
    for (std::size_t l = 0; l < kLanes; ++l)
      all.u[i][l] = 1e-3 * (uniform_noise(8, 4 * i + l) - 0.5);
  }
  CellPackState other = all;
  soft_kernels().cells(pack, all);
  for (std::size_t i = 0; i < 24; ++i) other.u[i][1] = 0;
  soft_kernels().cells(pack, other);
  for (std::size_t i = 0; i < 24; ++i) {
    for (const std::size_t l : {std::size_t{0}, std::size_t{2}, std::size_t{3}})
      EXPECT_EQ(all.force[i][l], other.force[i][l]);
    EXPECT_NEAR(other.force[i][1], 0, 1e-12);
  }
}

}  // namespace
}  // namespace artus
