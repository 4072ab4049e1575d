// SPDX-License-Identifier: AGPL-3.0-or-later
#include "echo/texture.h"

#include <algorithm>
#include <cmath>

#include "core/noise.h"

namespace artus {
namespace {

constexpr int kSide = 64;
constexpr double kFixedOne = 65536;  // one cell in 16.16 fixed point

/// How a kind of tissue looks: cells across and along the fibres, and bright sheets in a dark bed.
struct Recipe {
  TissueKind kind = TissueKind::plain;
  double across = 0;   // m per cell
  double along = 0;    // m per cell
  int feature = 8;     // cells between features; divides 64
  double sheet = 0.2;  // thickness of the bright sheets in units of the noise
  double bright = 3;   // amplitude of a sheet over the bed's
};

constexpr std::array<Recipe, 4> kRecipes{{
    {TissueKind::muscle, 0.20e-3, 2.4e-3, 8, 0.09, 5.0},
    {TissueKind::fat, 1.0e-3, 0.25e-3, 8, 0.06, 5.0},  // along: across the layers
    {TissueKind::tendon, 0.10e-3, 2.0e-3, 4, 0.25, 2.5},
    {TissueKind::nerve, 0.12e-3, 3.0e-3, 8, 0.18, 4.0},
}};

double smooth(double t) {
  return t * t * (3 - 2 * t);
}

/// Periodic value noise, one random value every `feature` cells, -1..1.
double value_noise(std::uint64_t seed, int x, int y, int z, int feature) {
  const int period = kSide / feature;
  const auto corner = [&](int i, int j, int k) {
    const int index = ((k % period) * period + j % period) * period + i % period;
    return 2 * uniform_noise(seed, static_cast<std::uint64_t>(index)) - 1;
  };
  const int i = x / feature;
  const int j = y / feature;
  const int k = z / feature;
  const double tx = smooth(static_cast<double>(x % feature) / feature);
  const double ty = smooth(static_cast<double>(y % feature) / feature);
  const double tz = smooth(static_cast<double>(z % feature) / feature);
  const auto row = [&](int dj, int dk) {
    return (1 - tx) * corner(i, j + dj, k + dk) + tx * corner(i + 1, j + dj, k + dk);
  };
  const double near = (1 - ty) * row(0, 0) + ty * row(1, 0);
  const double far = (1 - ty) * row(0, 1) + ty * row(1, 1);
  return (1 - tz) * near + tz * far;
}

/// Bright sheets lie where a smooth noise passes through zero; a second, slower noise makes them
/// come and go.
std::vector<float> make_tile(const Recipe& recipe, std::uint64_t seed) {
  std::vector<float> tile(static_cast<std::size_t>(kSide) * kSide * kSide);
  double squares = 0;
  std::size_t at = 0;
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const double shape = value_noise(seed, x, y, z, recipe.feature) +
                             0.3 * value_noise(seed + 1, x, y, z, recipe.feature / 2);
        const double strength = 0.8 + 0.7 * value_noise(seed + 2, x, y, z, recipe.feature);
        const double ridge = std::exp(-shape * shape / (recipe.sheet * recipe.sheet));
        const double value = 1 + (recipe.bright - 1) * ridge * strength;
        squares += value * value;
        tile[at++] = static_cast<float>(value);
      }
    }
  }
  const auto unit = static_cast<float>(1 / std::sqrt(squares / static_cast<double>(tile.size())));
  for (float& value : tile) value *= unit;
  return tile;
}

const Recipe* find_recipe(TissueKind kind) noexcept {
  for (const Recipe& recipe : kRecipes) {
    if (recipe.kind == kind) return &recipe;
  }
  return nullptr;
}

std::uint32_t to_fixed(double cells) noexcept {
  return static_cast<std::uint32_t>(std::llround(cells * kFixedOne));
}

}  // namespace

TissueTexture::TissueTexture(std::uint64_t seed) {
  for (const Recipe& recipe : kRecipes) {
    const auto kind = static_cast<std::size_t>(recipe.kind);
    const std::vector<float> values = make_tile(recipe, mix_bits(seed + 16 * kind));
    Tile& tile = tiles_[kind];
    tile.unit = *std::max_element(values.begin(), values.end()) / 255;
    tile.values.reserve(values.size());
    for (const float value : values) {
      tile.values.push_back(static_cast<std::uint8_t>(std::lround(value / tile.unit)));
    }
  }
}

bool TissueTexture::has(TissueKind kind) const noexcept {
  return !tiles_[static_cast<std::size_t>(kind)].values.empty();
}

void TissueTexture::sample(TissueKind kind, const LatticeWalk& walk,
                           std::span<float> out) const noexcept {
  const Tile& tile = tiles_[static_cast<std::size_t>(kind)];
  const std::uint8_t* values = tile.values.data();
  std::uint32_t x = walk.start[0];
  std::uint32_t y = walk.start[1];
  std::uint32_t z = walk.start[2];
  for (float& factor : out) {
    const std::uint32_t at =
        (((((z >> 16U) & kMask) << kBits) | ((y >> 16U) & kMask)) << kBits) | ((x >> 16U) & kMask);
    factor = tile.unit * static_cast<float>(values[at]);
    x += walk.step[0];
    y += walk.step[1];
    z += walk.step[2];
  }
}

LatticeWalk TissueTexture::make_walk(const RegionAcoustics& region, const Vec3& p_J,
                                     const Vec3& step_J) const noexcept {
  LatticeWalk walk;
  const Recipe* recipe = find_recipe(region.kind);
  if (recipe == nullptr) return walk;
  const bool has_axis = region.fibre.squaredNorm() > 0.5;
  const Vec3 z = has_axis ? region.fibre : Vec3(0.48, 0.6, 0.64);
  const Vec3 x = z.unitOrthogonal();
  const Vec3 y = z.cross(x);
  const double along = has_axis ? recipe->along : recipe->across;
  walk.start = {to_fixed(x.dot(p_J) / recipe->across), to_fixed(y.dot(p_J) / recipe->across),
                to_fixed(z.dot(p_J) / along)};
  walk.step = {to_fixed(x.dot(step_J) / recipe->across), to_fixed(y.dot(step_J) / recipe->across),
               to_fixed(z.dot(step_J) / along)};
  return walk;
}

}  // namespace artus
