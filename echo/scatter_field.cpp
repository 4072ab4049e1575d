// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/scatter_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "artus/core/check.h"
#include "artus/core/noise.h"
#include "artus/core/units.h"
#include "artus/echo/simd.h"

namespace artus {
namespace {

constexpr int kAxes = 40;                   // elevation axes: none is farther than 15 degrees
constexpr int kTurns = 24;                  // directions within each plane
constexpr double kBlendAxis = 1 * kDegree;  // of difference in angle over which axes blend
constexpr double kBlendTurn = 0.07;         // of a turn, to either side of the border
constexpr std::size_t kMaxAxes = 3;         // that may blend

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

/// The cell of row z that the walk's sample i lies in; rows are shifted against each other by parts
/// of a cell that never repeat.
inline std::uint32_t hash_row(const LatticeWalk& walk, std::uint32_t i, std::uint32_t z,
                              std::uint32_t seed) noexcept {
  const std::uint32_t y = (walk.start[1] + i * walk.step[1] + z * 40503U) >> 16U;
  const std::uint32_t x = (walk.start[0] + i * walk.step[0] + z * 27146U + y * 49297U) >> 16U;
  return hash_cell(x, y, z, seed);
}

/// Of the lowest two bytes.
inline float difference(std::uint32_t h) noexcept {
  return static_cast<float>(static_cast<std::int32_t>(h & 255U) -
                            static_cast<std::int32_t>((h >> 8U) & 255U));
}

/// The scatterers of one lattice along a walk.
struct ScattererWalk {
  LatticeWalk walk;
  std::uint32_t seed = 0;
  float unit = 1;  // factor that makes their power one, or a share of it
};

ARTUS_SIMD
void add_scatterers(const ScattererWalk& scatterers, const float* gain, float* re, float* im,
                    std::size_t n) noexcept {
  const LatticeWalk& walk = scatterers.walk;
  const std::uint32_t seed = scatterers.seed;
  const float unit = scatterers.unit;
  const std::uint32_t z0 = walk.start[2];
  const std::uint32_t dz = walk.step[2];
  const auto count = static_cast<std::uint32_t>(n);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t at = z0 + i * dz;
    const std::uint32_t z = at >> 16U;
    const float behind = static_cast<float>(at & 0xffffU) * (1.0F / 65536);
    const float before = 1 - behind;
    const float unit_power = unit / std::sqrt(before * before + behind * behind);
    const std::uint32_t first = hash_row(walk, i, z, seed);
    const std::uint32_t second = hash_row(walk, i, z + 1, seed);
    const float g = gain[i] * unit_power;
    re[i] += g * (before * difference(first) + behind * difference(second));
    im[i] += g * (before * difference(first >> 16U) + behind * difference(second >> 16U));
  }
}

}  // namespace

ScatterField::ScatterField(std::uint64_t seed, const ScattererSize& size)
    : size_(size), seed_(mix_bits(seed)) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int k = 0; k < kAxes; ++k) {  // a spiral over the half sphere, evenly spaced
    const double z = (k + 0.5) / kAxes;
    const double r = std::sqrt(1 - z * z);
    Axis axis;
    axis.elevation = Vec3(r * std::cos(golden * k), r * std::sin(golden * k), z);
    axis.reference = axis.elevation.unitOrthogonal();
    axes_.push_back(axis);
  }
}

ScatterView ScatterField::make_view(const Vec3& direction_J,
                                    const Vec3& elevation_J) const noexcept {
  struct Near {
    double cosine = -1;
    std::size_t axis = 0;
    double angle = 0;
  };
  std::array<Near, kMaxAxes> near;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    Near candidate{std::abs(elevation_J.dot(axes_[k].elevation)), k};
    for (Near& n : near) {
      if (candidate.cosine > n.cosine) std::swap(candidate, n);
    }
  }
  for (Near& n : near) n.angle = std::acos(std::min(1.0, n.cosine));
  ScatterView view;
  double power = 0;
  for (const Near& n : near) {
    const double axis_share = 1 - (n.angle - near[0].angle) / kBlendAxis;
    if (axis_share <= 0) continue;
    const Axis& axis = axes_[n.axis];
    const Vec3 other = axis.elevation.cross(axis.reference);
    const double turn = std::atan2(direction_J.dot(other), direction_J.dot(axis.reference)) /
                        (2 * std::numbers::pi) * kTurns;
    const double nearest = std::round(turn);
    const double off = turn - nearest;
    const double beyond = std::max(0.0, (std::abs(off) - 0.5 + kBlendTurn) / (2 * kBlendTurn));
    for (const bool second : {false, true}) {
      const double share = axis_share * (second ? beyond : 1 - beyond);
      if (share <= 0) continue;
      const double at = nearest + (second ? std::copysign(1.0, off) : 0.0);
      const auto index = static_cast<std::uint64_t>((static_cast<int>(at) + 2 * kTurns) % kTurns);
      const double angle = 2 * std::numbers::pi / kTurns * static_cast<double>(index);
      const Vec3 axial = std::cos(angle) * axis.reference + std::sin(angle) * other;
      ScatterView::Lattice& lattice = view.lattices[view.size++];
      lattice.cells_J.row(0) = axis.elevation.cross(axial) / size_.lateral;
      lattice.cells_J.row(1) = axis.elevation / size_.elevation;
      lattice.cells_J.row(2) = axial / size_.axial;
      lattice.seed = static_cast<std::uint32_t>(mix_bits(seed_ + n.axis * kTurns + index));
      lattice.weight = static_cast<float>(std::sqrt(share));
      power += share;
    }
  }
  const auto unit = static_cast<float>(1 / std::sqrt(power));
  for (std::size_t k = 0; k < view.size; ++k) view.lattices[k].weight *= unit;
  return view;
}

void ScatterField::add(const ScatterView& view, const Vec3& p_J, const Vec3& step_J,
                       std::span<const float> gain, std::span<float> re,
                       std::span<float> im) noexcept {
  ARTUS_ASSERT(gain.size() == re.size() && gain.size() == im.size());
  for (std::size_t k = 0; k < view.size; ++k) {
    const ScatterView::Lattice& lattice = view.lattices[k];
    const Vec3 start = lattice.cells_J * p_J;
    const Vec3 step = lattice.cells_J * step_J;
    const LatticeWalk walk{
        {to_fixed_cells(start.x()), to_fixed_cells(start.y()), to_fixed_cells(start.z())},
        {to_fixed_cells(step.x()), to_fixed_cells(step.y()), to_fixed_cells(step.z())}};
    add_scatterers({walk, lattice.seed, kUnitPower * lattice.weight}, gain.data(), re.data(),
                   im.data(), gain.size());
  }
}

double ScatterField::shared(double distance, double cell) noexcept {
  return std::max(0.0, 1 - std::abs(distance) / cell);
}

double ScatterField::shared_axially(double distance, double cell) noexcept {
  constexpr int kSteps = 64;  // of where in its cell the first sample lies
  const double apart = std::abs(distance) / cell;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double first = (k + 0.5) / kSteps;
    const double second = first + apart;
    const double cells = std::floor(second);
    const double behind = second - cells;
    const double power = std::hypot(first, 1 - first) * std::hypot(behind, 1 - behind);
    if (cells == 0) sum += ((1 - first) * (1 - behind) + first * behind) / power;
    if (cells == 1) sum += first * (1 - behind) / power;
  }
  return sum / kSteps;
}

void add_white_noise(std::uint64_t seed, int line, std::span<const float> gain, std::span<float> re,
                     std::span<float> im) noexcept {
  const LatticeWalk walk{{static_cast<std::uint32_t>(line) << 16U, 0, 0}, {0, 0, 1U << 16U}};
  add_scatterers({walk, static_cast<std::uint32_t>(mix_bits(seed)), kUnitPower}, gain.data(),
                 re.data(), im.data(), gain.size());
}

}  // namespace artus
