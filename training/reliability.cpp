// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/reliability.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

double ratio(double part, double whole) {
  return whole > 0 ? part / whole : 0;
}

double share_below(std::span<const double> values, double cut) {
  const auto below =
      std::count_if(values.begin(), values.end(), [cut](double value) { return value < cut; });
  return static_cast<double>(below) / static_cast<double>(values.size());
}

}  // namespace

double VarianceParts::relative(double n) const noexcept {
  return ratio(person, person + rest / n);
}

double VarianceParts::absolute(double n) const noexcept {
  return ratio(person, person + (condition + rest) / n);
}

int VarianceParts::conditions_for(double wanted) const noexcept {
  if (!(person > 0)) return 0;
  const double n = wanted / (1 - wanted) * (condition + rest) / person;
  constexpr double kRounding = 1e-9;
  return std::max(1, static_cast<int>(std::ceil(n - kRounding)));
}

VarianceParts split_variance(const Eigen::MatrixXd& values) {
  ARTUS_REQUIRE(values.rows() >= 2 && values.cols() >= 2, "two of each at least");
  const auto n = static_cast<double>(values.rows());
  const auto k = static_cast<double>(values.cols());
  const double mean = values.mean();
  const Eigen::VectorXd of_person = values.rowwise().mean();
  const Eigen::RowVectorXd of_condition = values.colwise().mean();
  const double persons = k * (of_person.array() - mean).square().sum() / (n - 1);
  const double conditions = n * (of_condition.array() - mean).square().sum() / (k - 1);
  const Eigen::MatrixXd left =
      (values.colwise() - of_person).rowwise() - (of_condition.array() - mean).matrix();
  const double rest = left.squaredNorm() / ((n - 1) * (k - 1));
  VarianceParts parts;
  parts.person = std::max(0.0, (persons - rest) / k);
  parts.condition = std::max(0.0, (conditions - rest) / n);
  parts.rest = rest;
  parts.persons = static_cast<int>(values.rows());
  parts.conditions = static_cast<int>(values.cols());
  return parts;
}

double cronbach_alpha(const Eigen::MatrixXd& values) {
  ARTUS_REQUIRE(values.rows() >= 2 && values.cols() >= 2, "two of each at least");
  const auto variance = [](const Eigen::VectorXd& column) {
    return (column.array() - column.mean()).square().sum() / static_cast<double>(column.size() - 1);
  };
  double items = 0;
  for (Eigen::Index i = 0; i < values.cols(); ++i) items += variance(values.col(i));
  const double sum = variance(values.rowwise().sum());
  const auto k = static_cast<double>(values.cols());
  return sum > 0 ? k / (k - 1) * (1 - items / sum) : 0;
}

GroupCut find_group_cut(std::span<const double> experts, std::span<const double> novices) {
  ARTUS_REQUIRE(!experts.empty() && !novices.empty(), "no group is empty");
  std::vector<double> values(experts.begin(), experts.end());
  values.insert(values.end(), novices.begin(), novices.end());
  std::sort(values.begin(), values.end());
  constexpr double kSame = 1e-12;
  double least = 3;
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double errors = share_below(experts, values[i]) + 1 - share_below(novices, values[i]);
    if (errors < least - kSame) {
      least = errors;
      first = i;
    }
    if (errors <= least + kSame) last = i;
  }
  // Any value above the one before the first does as well as the first.
  const double from = first > 0 ? values[first - 1] : values[first];
  GroupCut out;
  out.cut = (from + values[last]) / 2;
  out.experts_fail = share_below(experts, out.cut);
  out.novices_pass = 1 - share_below(novices, out.cut);
  return out;
}

}  // namespace artus
