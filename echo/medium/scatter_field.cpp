// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/medium/scatter_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "artus/detail/core/check.h"
#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"
#include "artus/detail/echo/medium/simd.h"

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

/// Of the lowest two bytes.
inline float difference(std::uint32_t h) noexcept {
  return static_cast<float>(static_cast<std::int32_t>(h & 255U) -
                            static_cast<std::int32_t>((h >> 8U) & 255U));
}

/// The scatterers of one lattice.
struct Scatterers {
  std::uint32_t seed = 0;
  float unit = 1;  // factor that makes their power one, or a share of it
};

/// The cell of row z at (x, y); rows are shifted against each other by parts of a cell that never
/// repeat.
inline std::uint32_t hash_row(std::uint32_t x, std::uint32_t y, std::uint32_t z,
                              std::uint32_t seed) noexcept {
  const std::uint32_t row = (y + z * 40503U) >> 16U;
  return hash_cell((x + z * 27146U + row * 49297U) >> 16U, row, z, seed);
}

/// A place in a lattice, 16.16 fixed-point cells.
struct LatticePlace {
  std::uint32_t x;
  std::uint32_t y;
  std::uint32_t z;
};

/// Adds gain times the scatterer at a place.
inline void add_scatterer(const Scatterers& scatterers, const LatticePlace& at, float gain,
                          float& re, float& im) noexcept {
  const std::uint32_t z = at.z >> 16U;
  const float behind = static_cast<float>(at.z & 0xffffU) * (1.0F / 65536);
  const float before = 1 - behind;
  const float unit_power = scatterers.unit / std::sqrt(before * before + behind * behind);
  const std::uint32_t first = hash_row(at.x, at.y, z, scatterers.seed);
  const std::uint32_t second = hash_row(at.x, at.y, z + 1, scatterers.seed);
  const float g = gain * unit_power;
  re += g * (before * difference(first) + behind * difference(second));
  im += g * (before * difference(first >> 16U) + behind * difference(second >> 16U));
}

/// Along a straight walk.
ARTUS_SIMD
void add_scatterers(const Scatterers& scatterers, const LatticeWalk& walk, const float* gain,
                    float* re, float* im, std::size_t n) noexcept {
  const auto count = static_cast<std::uint32_t>(n);
  for (std::uint32_t i = 0; i < count; ++i) {
    add_scatterer(scatterers,
                  {walk.start[0] + i * walk.step[0], walk.start[1] + i * walk.step[1],
                   walk.start[2] + i * walk.step[2]},
                  gain[i], re[i], im[i]);
  }
}

/// Where a line's samples are in a lattice, one row a coordinate.
struct LatticeRows {
  const std::uint32_t* x;
  const std::uint32_t* y;
  const std::uint32_t* z;
};

/// Along any walk.
ARTUS_SIMD
void add_scatterers(const Scatterers& scatterers, const LatticeRows& rows, const float* gain,
                    float* re, float* im, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i)
    add_scatterer(scatterers, {rows.x[i], rows.y[i], rows.z[i]}, gain[i], re[i], im[i]);
}

/// Another hash of a cell, from its first.
inline std::uint32_t hash_again(std::uint32_t h, std::uint32_t factor) noexcept {
  h = (h ^ (h >> 16U)) * factor;
  return h ^ (h >> 15U);
}

/// Where the echoes go: in phase and quadrature of the first set, then of the others' differences.
using SetRows = std::array<float*, 2 + 2 * ScatterField::kMoreSets>;

constexpr std::size_t kSetLanes = 64;

/// Along any walk, with the differences that two other sets make. What a few samples get is held
/// apart until it is added: six rows that might overlap would not vectorise.
ARTUS_SIMD
void add_scatterer_sets(const Scatterers& scatterers, const LatticeRows& rows, const float* gain,
                        const SetRows& out, std::size_t n) noexcept {
  float held[6][kSetLanes];
  for (std::size_t from = 0; from < n; from += kSetLanes) {
    const std::size_t lanes = std::min(kSetLanes, n - from);
    for (std::size_t j = 0; j < lanes; ++j) {
      const std::size_t i = from + j;
      const std::uint32_t z = rows.z[i] >> 16U;
      const float behind = static_cast<float>(rows.z[i] & 0xffffU) * (1.0F / 65536);
      const float before = 1 - behind;
      const float g = gain[i] * (scatterers.unit / std::sqrt(before * before + behind * behind));
      const float g0 = g * before;
      const float g1 = g * behind;
      const std::uint32_t a = hash_row(rows.x[i], rows.y[i], z, scatterers.seed);
      const std::uint32_t b = hash_row(rows.x[i], rows.y[i], z + 1, scatterers.seed);
      const float re = g0 * difference(a) + g1 * difference(b);
      const float im = g0 * difference(a >> 16U) + g1 * difference(b >> 16U);
      const std::uint32_t a1 = hash_again(a, 0x7feb352dU);
      const std::uint32_t b1 = hash_again(b, 0x7feb352dU);
      const std::uint32_t a2 = hash_again(a, 0x846ca68bU);
      const std::uint32_t b2 = hash_again(b, 0x846ca68bU);
      held[0][j] = re;
      held[1][j] = im;
      held[2][j] = g0 * difference(a1) + g1 * difference(b1) - re;
      held[3][j] = g0 * difference(a1 >> 16U) + g1 * difference(b1 >> 16U) - im;
      held[4][j] = g0 * difference(a2) + g1 * difference(b2) - re;
      held[5][j] = g0 * difference(a2 >> 16U) + g1 * difference(b2 >> 16U) - im;
    }
    for (std::size_t k = 0; k < out.size(); ++k)
      for (std::size_t j = 0; j < lanes; ++j) out[k][from + j] += held[k][j];
  }
}

constexpr std::uint32_t kWalkLanes = 16;

/// A straight walk's coordinates, up to a full multiple of kWalkLanes.
ARTUS_SIMD
void walk_rows(LatticeWalk walk, std::uint32_t* __restrict x, std::uint32_t* __restrict y,
               std::uint32_t* __restrict z, std::size_t n) noexcept {
  const auto go = [n](std::uint32_t start, std::uint32_t step, std::uint32_t* row) {
    for (std::uint32_t i = 0; i < n; i += kWalkLanes) {
      const std::uint32_t from = start + i * step;
      for (std::uint32_t j = 0; j < kWalkLanes; ++j) row[i + j] = from + j * step;
    }
  };
  go(walk.start[0], walk.step[0], x);
  go(walk.start[1], walk.step[1], y);
  go(walk.start[2], walk.step[2], z);
}

LatticeWalk make_walk(const ScatterView::Lattice& lattice, const Vec3& p_J,
                      const Vec3& step_J) noexcept {
  const Vec3 start = lattice.cells_J * p_J;
  const Vec3 step = lattice.cells_J * step_J;
  return {{to_fixed_cells(start.x()), to_fixed_cells(start.y()), to_fixed_cells(start.z())},
          {to_fixed_cells(step.x()), to_fixed_cells(step.y()), to_fixed_cells(step.z())}};
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
    add_scatterers({lattice.seed, kUnitPower * lattice.weight}, make_walk(lattice, p_J, step_J),
                   gain.data(), re.data(), im.data(), gain.size());
  }
}

void ScatterRoom::resize(std::size_t n) {
  for (auto& row : cells_) row.resize(n + kWalkLanes);
}

namespace {

/// For each lattice and each stretch of it that is covered without a gap, up to `n` samples long:
/// add_stretch(scatterers, rows, begin, end) with the stretch's cells in `rows`.
template <class AddStretch>
void for_stretches(const ScatterView& view, std::span<const ScatterPiece> pieces,
                   const std::array<std::uint32_t*, 3>& cells,
                   const AddStretch& add_stretch) noexcept {
  const auto [x, y, z] = cells;
  for (std::size_t k = 0; k < view.size; ++k) {
    const ScatterView::Lattice& lattice = view.lattices[k];
    const Scatterers scatterers{lattice.seed, kUnitPower * lattice.weight};
    for (std::size_t i = 0; i < pieces.size();) {
      const std::size_t begin = pieces[i].begin;
      std::size_t end = begin;
      for (; i < pieces.size() && pieces[i].begin == end; ++i) {
        const LatticeWalk walk = make_walk(lattice, pieces[i].p_J, pieces[i].step_J);
        const std::size_t n = pieces[i].end - end;
        walk_rows(walk, x + end, y + end, z + end, n);
        end = pieces[i].end;
      }
      add_stretch(scatterers, LatticeRows{x + begin, y + begin, z + begin}, begin, end);
    }
  }
}

}  // namespace

void ScatterField::add(const ScatterView& view, std::span<const ScatterPiece> pieces,
                       std::span<const float> gain, ScatterRoom& room, std::span<float> re,
                       std::span<float> im) noexcept {
  ARTUS_ASSERT(gain.size() == re.size() && gain.size() == im.size());
  ARTUS_ASSERT(room.cells_[0].size() >= gain.size() + kWalkLanes);
  auto& [x, y, z] = room.cells_;
  for_stretches(view, pieces, {x.data(), y.data(), z.data()},
                [&](const Scatterers& scatterers, const LatticeRows& rows, std::size_t begin,
                    std::size_t end) {
                  add_scatterers(scatterers, rows, gain.data() + begin, re.data() + begin,
                                 im.data() + begin, end - begin);
                });
}

void ScatterField::add(const ScatterView& view, std::span<const ScatterPiece> pieces,
                       std::span<const float> gain, ScatterRoom& room, EchoSpan echoes,
                       const MoreSets& more) noexcept {
  ARTUS_ASSERT(gain.size() == echoes.size());
  ARTUS_ASSERT(room.cells_[0].size() >= gain.size() + kWalkLanes);
  auto& [x, y, z] = room.cells_;
  for_stretches(view, pieces, {x.data(), y.data(), z.data()},
                [&](const Scatterers& scatterers, const LatticeRows& rows, std::size_t begin,
                    std::size_t end) {
                  SetRows out{echoes.re.data() + begin, echoes.im.data() + begin};
                  for (std::size_t k = 0; k < more.size(); ++k) {
                    out[2 + 2 * k] = more[k].re.data() + begin;
                    out[3 + 2 * k] = more[k].im.data() + begin;
                  }
                  add_scatterer_sets(scatterers, rows, gain.data() + begin, out, end - begin);
                });
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
  add_scatterers({static_cast<std::uint32_t>(mix_bits(seed)), kUnitPower}, walk, gain.data(),
                 re.data(), im.data(), gain.size());
}

}  // namespace artus
