// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/learning_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr double kBarrier = 1e-7;  // of all outcomes: keeps shares off 0 and 1
constexpr int kSteps = 60;         // of Newton's method, each halved until it climbs
constexpr int kRates = 80;         // tried from kSlowest to 1
constexpr double kSlowest = 1e-3;
constexpr int kCloser = 40;  // looks about the best of them, each 0.7 as far

/// What practice leaves and what it takes away, at one rate of learning.
using Shares = Eigen::Vector2d;

/// Log-likelihood of the counts at one rate of learning: concave in the shares.
class Likelihood {
 public:
  Likelihood(std::span<const TrialCount> trials, double rate) : trials_(trials), rate_(rate) {
    for (const TrialCount& trial : trials)
      barrier_ += kBarrier * static_cast<double>(trial.learners);
  }

  /// -infinity where shares are none. Gradient and Hessian into `g`, `h` when these are given.
  double at(const Shares& x, Shares* g = nullptr, Eigen::Matrix2d* h = nullptr) const {
    const double top = 1 - x[0] - x[1];
    if (!(x[0] > 0 && x[1] > 0 && top > 0)) return -std::numeric_limits<double>::infinity();
    double sum = barrier_ * (std::log(x[0]) + std::log(x[1]) + std::log(top));
    if (g != nullptr) {
      const Shares inverse(1 / x[0], 1 / x[1]);
      *g = barrier_ * (inverse - Shares::Constant(1 / top));
      *h = -barrier_ * (Eigen::Matrix2d(inverse.cwiseAbs2().asDiagonal()) +
                        Eigen::Matrix2d::Constant(1 / (top * top)));
    }
    double left = 1;
    for (const TrialCount& trial : trials_) {
      const Shares of(1, left);
      const double p = of.dot(x);
      const auto failures = static_cast<double>(trial.failures);
      const double passes = static_cast<double>(trial.learners) - failures;
      sum += failures * std::log(p) + passes * std::log(1 - p);
      if (g != nullptr) {
        *g += (failures / p - passes / (1 - p)) * of;
        *h -= (failures / (p * p) + passes / ((1 - p) * (1 - p))) * of * of.transpose();
      }
      left *= 1 - rate_;
    }
    return sum;
  }

  /// The most likely shares.
  [[nodiscard]] Shares best() const {
    Shares x(1.0 / 3, 1.0 / 3);
    Shares g;
    Eigen::Matrix2d h;
    for (int i = 0; i < kSteps; ++i) {
      const double now = at(x, &g, &h);
      Shares step = h.ldlt().solve(-g);
      while (step.norm() > 1e-12 && !(at(x + step) > now)) step /= 2;
      if (step.norm() <= 1e-12) break;
      x += step;
    }
    return x;
  }

 private:
  std::span<const TrialCount> trials_;
  double rate_;
  double barrier_ = 0;
};

double max_at(double rate, std::span<const TrialCount> trials) {
  const Likelihood likelihood(trials, rate);
  return likelihood.at(likelihood.best());
}

/// Of rates k steps of a geometric row from kSlowest to 1.
double rate_of(double k) {
  return std::pow(kSlowest, 1 - k / kRates);
}

}  // namespace

double LearningFit::at(std::size_t trial) const {
  return last + (first - last) * std::pow(1 - rate, static_cast<double>(trial) - 1);
}

LearningFit fit_learning(std::span<const TrialCount> trials) {
  ARTUS_REQUIRE(
      std::any_of(trials.begin(), trials.end(), [](const TrialCount& t) { return t.learners > 0; }),
      "at least one trial must have learners");
  double k = 0;
  double max = max_at(rate_of(k), trials);
  for (int i = 1; i < kRates; ++i) {
    const double value = max_at(rate_of(i), trials);
    if (value <= max) continue;
    max = value;
    k = i;
  }
  double reach = 1;
  for (int i = 0; i < kCloser; ++i, reach *= 0.7)
    for (const double other : {k - reach, k + reach}) {
      if (other < 0 || other >= kRates) continue;
      const double value = max_at(rate_of(other), trials);
      if (value <= max) continue;
      max = value;
      k = other;
    }
  const Shares shares = Likelihood(trials, rate_of(k)).best();
  return {shares.sum(), shares[0], rate_of(k)};
}

}  // namespace artus
