// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

#include <Eigen/Core>

namespace artus {

/// Shares of the variance of one observation of each person under each condition (a scenario, a
/// seed, a rater): what persons differ by, what conditions do, and the rest. Negative estimates are
/// 0.
struct VarianceParts {
  double person = 0;
  double condition = 0;
  double rest = 0;
  int persons = 0;
  int conditions = 0;

  /// Of means over `n` conditions: whether they put persons in the same order (relative), and at
  /// the same value (absolute). 0 where nothing varies.
  [[nodiscard]] double relative(double n) const noexcept;
  [[nodiscard]] double absolute(double n) const noexcept;
  /// Conditions from which on absolute() reaches `wanted`, in (0, 1); 0: none does.
  [[nodiscard]] int conditions_for(double wanted) const noexcept;
};

/// `values`: (persons, conditions), all observed. Requires: two of each at least. absolute(1) is
/// the intraclass correlation of single ratings ICC(2,1), absolute(k) ICC(2,k). Source [Shrout1979]
/// table 2, [Brennan2001] section 2.3.
[[nodiscard]] VarianceParts split_variance(const Eigen::MatrixXd& values);

/// How much the items of a form go together: (persons, items). Requires: as split_variance.
/// Source [Cronbach1951]; equals relative(items).
[[nodiscard]] double cronbach_alpha(const Eigen::MatrixXd& values);

/// A pass mark between two groups.
struct GroupCut {
  double cut = 0;           ///< passes who has it or more
  double experts_fail = 0;  ///< share below it
  double novices_pass = 0;  ///< share at it or above
};

/// The value that separates two groups with the smallest sum of both errors; the middle of those
/// that do so alike. Requires: none empty. Source: the contrasting groups of [Livingston1982].
[[nodiscard]] GroupCut find_group_cut(std::span<const double> experts,
                                      std::span<const double> novices);

}  // namespace artus
