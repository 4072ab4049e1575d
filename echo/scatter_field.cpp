// SPDX-License-Identifier: AGPL-3.0-or-later
#include "echo/scatter_field.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/noise.h"
#include "echo/simd.h"

namespace artus {
namespace {

constexpr double kFixedOne = 65536;  // one cell in 16.16 fixed point

std::uint32_t to_fixed(double cells) noexcept {
  return static_cast<std::uint32_t>(std::llround(cells * kFixedOne));
}

/// Four bytes of a well-mixed hash of the cell; two differences of them are the complex amplitude.
inline std::uint32_t hash_cell(std::uint32_t x, std::uint32_t y, std::uint32_t z,
                               std::uint32_t seed) noexcept {
  std::uint32_t h = (x * 0x9e3779b1U) ^ (y * 0x85ebca77U) ^ (z * 0xc2b2ae3dU) ^ seed;
  h ^= h >> 15U;
  h *= 0x2c1b3c6dU;
  h ^= h >> 12U;
  h *= 0x297a2d39U;
  return h ^ (h >> 15U);
}

// The difference of two uniform bytes has variance (256^2 - 1) / 6; twice that for both parts.
constexpr float kUnitPower = 1.0F / 147.8F;

ARTUS_SIMD
void add_scatterers(const LatticeWalk& walk, std::uint32_t seed, const float* gain, float* re,
                    float* im, std::size_t n) noexcept {
  const std::uint32_t x0 = walk.start[0];
  const std::uint32_t y0 = walk.start[1];
  const std::uint32_t z0 = walk.start[2];
  const std::uint32_t dx = walk.step[0];
  const std::uint32_t dy = walk.step[1];
  const std::uint32_t dz = walk.step[2];
  const auto count = static_cast<std::uint32_t>(n);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t h =
        hash_cell((x0 + i * dx) >> 16U, (y0 + i * dy) >> 16U, (z0 + i * dz) >> 16U, seed);
    const auto a =
        static_cast<std::int32_t>(h & 255U) - static_cast<std::int32_t>((h >> 8U) & 255U);
    const auto b =
        static_cast<std::int32_t>((h >> 16U) & 255U) - static_cast<std::int32_t>(h >> 24U);
    const float g = gain[i] * kUnitPower;
    re[i] += g * static_cast<float>(a);
    im[i] += g * static_cast<float>(b);
  }
}

}  // namespace

ScatterField::ScatterField(std::uint64_t seed) : seed_(static_cast<std::uint32_t>(mix_bits(seed))) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.8, 0.31, -0.37, 0.29).normalized();
  R_LJ_ = turn.toRotationMatrix() / kCell;
}

LatticeWalk ScatterField::make_walk(const Vec3& p_J, const Vec3& step_J) const noexcept {
  const Vec3 start = R_LJ_ * p_J;
  const Vec3 step = R_LJ_ * step_J;
  LatticeWalk walk;
  for (Eigen::Index k = 0; k < 3; ++k) {
    walk.start[static_cast<std::size_t>(k)] = to_fixed(start[k]);
    walk.step[static_cast<std::size_t>(k)] = to_fixed(step[k]);
  }
  return walk;
}

void ScatterField::add(const LatticeWalk& walk, std::span<const float> gain, std::span<float> re,
                       std::span<float> im) const noexcept {
  ARTUS_ASSERT(gain.size() == re.size() && gain.size() == im.size());
  add_scatterers(walk, seed_, gain.data(), re.data(), im.data(), gain.size());
}

double ScatterField::axial_power(std::span<const float> weights, double spacing) noexcept {
  double sum = 0;
  double squares = 0;
  const double along = spacing / kCell / std::sqrt(3.0);  // a walk in a generic direction
  for (std::size_t i = 0; i < weights.size(); ++i) {
    squares += static_cast<double>(weights[i]) * weights[i];
    for (std::size_t j = 0; j < weights.size(); ++j) {
      const double gap = along * std::abs(static_cast<double>(i) - static_cast<double>(j));
      const double shared = std::pow(std::max(0.0, 1 - gap), 3);
      sum += shared * weights[i] * weights[j];
    }
  }
  return squares > 0 ? sum / squares : 1;
}

}  // namespace artus
