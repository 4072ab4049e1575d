// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/zero_phase.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kReflected = 0.5;  // s

/// One pass; starts as if the first value had always been there.
template <class Iterator>
void filter_once(const LowPass& f, Iterator first, Iterator last) {
  double z2 = (f.b2 - f.a2) * *first;
  double z1 = (f.b1 - f.a1) * *first + z2;
  for (; first != last; ++first) {
    const double x = *first;
    const double y = f.b0 * x + z1;
    z1 = f.b1 * x - f.a1 * y + z2;
    z2 = f.b2 * x - f.a2 * y;
    *first = y;
  }
}

}  // namespace

LowPass make_butterworth(double corner, double rate) {
  ARTUS_REQUIRE(corner > 0 && corner < rate / 2, "the corner must lie below half the rate");
  const double k = std::tan(kPi * corner / rate);
  const double norm = 1 / (1 + std::sqrt(2.0) * k + k * k);
  LowPass f;
  f.b0 = k * k * norm;
  f.b1 = 2 * f.b0;
  f.b2 = f.b0;
  f.a1 = 2 * (k * k - 1) * norm;
  f.a2 = (1 - std::sqrt(2.0) * k + k * k) * norm;
  return f;
}

void filter_zero_phase(const LowPass& filter, double rate, std::span<double> values) {
  if (values.size() < 2) return;
  const std::size_t n = values.size();
  const std::size_t pad = std::min(n - 1, static_cast<std::size_t>(kReflected * rate));
  std::vector<double> x(n + 2 * pad);
  for (std::size_t i = 0; i < pad; ++i) {
    x[i] = 2 * values[0] - values[pad - i];
    x[pad + n + i] = 2 * values[n - 1] - values[n - 2 - i];
  }
  std::copy(values.begin(), values.end(), x.begin() + static_cast<std::ptrdiff_t>(pad));
  filter_once(filter, x.begin(), x.end());
  filter_once(filter, x.rbegin(), x.rend());
  std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(pad), n, values.begin());
}

}  // namespace artus
