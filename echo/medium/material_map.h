// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "artus/core/geometry.h"

namespace artus {

/// Where a point lies in a tissue's own structure: across its stacked sheets, beside them, along
/// its fibres.
struct MaterialPoint {
  Vec3 place = Vec3::Zero();                               ///< m
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();  ///< rows: of each coordinate by p_J
};

/// Smooth coordinates of a curved tissue: three polynomials of degree four in the point's place.
/// Fibres are the curves along which the first two stay the same.
class MaterialMap {
 public:
  static constexpr int kDegree = 4;
  static constexpr std::size_t kTerms = 35;    ///< x^i y^j z^k with i + j + k <= 4
  static constexpr std::size_t kColumns = 16;  ///< of a row: 3 values, 9 slopes, 4 that fill up
  /// One column a coordinate, m; one row a term, of (p_J - centre) / scale. See terms().
  using Coefficients = Eigen::Matrix<double, static_cast<int>(kTerms), 3>;
  using Terms = Eigen::Matrix<double, static_cast<int>(kTerms), 1>;
  using Slopes = Eigen::Matrix<double, 3, static_cast<int>(kTerms)>;

  /// Requires: scale > 0.
  MaterialMap(const Vec3& centre_J, double scale, const Coefficients& coefficients);

  /// Cost: about 30 ns.
  [[nodiscard]] MaterialPoint evaluate(const Vec3& p_J) const noexcept;

  /// The terms of the polynomials at x, dimensionless; the first is the constant.
  [[nodiscard]] static Terms terms(const Vec3& x) noexcept;
  /// Their gradients, one column a term.
  [[nodiscard]] static Slopes slopes(const Vec3& x) noexcept;

 private:
  Vec3 centre_;
  double inverse_scale_;
  std::array<std::array<float, kColumns>, kTerms> table_{};
};

}  // namespace artus
