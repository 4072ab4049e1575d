// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/probe/probe_contact_column.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

constexpr int kMaxSteps = 80;
constexpr double kTolerance = 1e-12;  // relative, of the pressure

/// J/m^2 stored when a pressure (Pa) has compressed the layers by `indentation`.
double stored_energy(const ColumnParams& params, std::span<const ColumnLayer> layers,
                     double pressure, double indentation) noexcept {
  double complementary = pressure * pressure / (2 * params.stop_stiffness);
  for (const ColumnLayer& layer : layers)
    complementary += layer.thickness * complementary_energy(params, layer, pressure);
  return std::max(0.0, pressure * indentation - complementary);
}

struct Compression {
  double depth;  // m at a pressure
  double slope;  // m/Pa
};

Compression compress(const ColumnParams& params, std::span<const ColumnLayer> layers,
                     double pressure) noexcept {
  Compression sum{pressure / params.stop_stiffness, 1 / params.stop_stiffness};
  for (const ColumnLayer& layer : layers) {
    const double modulus = std::max(layer.modulus, params.min_modulus);
    const double stiffened = modulus + pressure / params.strain_limit;
    sum.depth += layer.thickness * pressure / stiffened;
    sum.slope += layer.thickness * modulus / (stiffened * stiffened);
  }
  return sum;
}

}  // namespace

double complementary_energy(const ColumnParams& params, const ColumnLayer& layer,
                            double pressure) noexcept {
  const double scale = std::max(layer.modulus, params.min_modulus) * params.strain_limit;
  return params.strain_limit * (pressure - scale * std::log1p(pressure / scale));
}

ColumnResponse compress_column(const ColumnParams& params, std::span<const ColumnLayer> layers,
                               double indentation) noexcept {
  if (!(indentation > 0)) return {};
  // The depth is a rising concave function of the pressure: Newton from the left never overshoots.
  double pressure = indentation / compress(params, layers, 0).slope;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Compression now = compress(params, layers, pressure);
    const double step = (indentation - now.depth) / now.slope;
    ARTUS_ASSERT(step >= -1e-9 * pressure);
    pressure += step;
    if (step <= kTolerance * pressure) break;
  }
  return {pressure, 1 / compress(params, layers, pressure).slope,
          stored_energy(params, layers, pressure, indentation)};
}

}  // namespace artus
