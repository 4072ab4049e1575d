// SPDX-License-Identifier: AGPL-3.0-or-later
#include "echo/texture.h"

#include <algorithm>
#include <cmath>

#include "core/noise.h"

namespace artus {
namespace {

/// One set of bright sheets: where a smooth noise passes through zero.
struct Sheets {
  std::array<int, 3> feature{};  // cells between independent values
  double half_thickness = 0;     // m
  double bright = 0;             // amplitude over the bed's
  double facing = 0;  // share that is lost where a sheet stands along the depth axis, 0..1
};

/// How a kind of tissue looks: sheets in a dark bed. Axes: x across the stacked sheets, y beside
/// them, z along the fibres.
struct Recipe {
  TissueKind kind = TissueKind::plain;
  std::array<double, 3> cell{};         // m
  std::array<std::uint32_t, 3> bits{};  // the tile has 2^bits cells
  Sheets coarse;
  Sheets fine;
};

constexpr std::array<Recipe, 4> kRecipes{{
    {TissueKind::muscle,
     {0.1e-3, 0.3e-3, 2e-3},
     {7, 6, 6},
     {{16, 16, 16}, 0.12e-3, 15, 0.9},
     {{8, 8, 8}, 0.10e-3, 8, 0.85}},
    {TissueKind::fat,
     {0.1e-3, 0.5e-3, 0.5e-3},
     {7, 6, 6},
     {{32, 16, 16}, 0.12e-3, 9, 0.95},
     {{16, 8, 8}, 0.09e-3, 1.5, 0.9}},
    {TissueKind::tendon,
     {0.06e-3, 0.12e-3, 1.5e-3},
     {7, 6, 5},
     {{8, 8, 8}, 0.06e-3, 4, 0.9},
     {{4, 4, 4}, 0.05e-3, 1.5, 0.9}},
    {TissueKind::nerve,
     {0.08e-3, 0.08e-3, 2e-3},
     {6, 6, 5},
     {{8, 8, 16}, 0.09e-3, 4, 0.5},
     {{4, 4, 8}, 0.05e-3, 0.5, 0.5}},
}};

double smooth(double t) {
  return t * t * (3 - 2 * t);
}

/// Smooth periodic noise, -1..1: random values on a coarse grid, blended in between.
class ValueNoise {
 public:
  ValueNoise(std::uint64_t seed, const std::array<int, 3>& sides, const std::array<int, 3>& feature)
      : feature_(feature) {
    for (std::size_t a = 0; a < 3; ++a) n_[a] = sides[a] / feature[a];
    const std::size_t size =
        static_cast<std::size_t>(n_[0] * n_[1]) * static_cast<std::size_t>(n_[2]);
    for (std::size_t i = 0; i < size; ++i) grid_.push_back(2 * uniform_noise(seed, i) - 1);
  }

  [[nodiscard]] double at(const std::array<int, 3>& p) const {
    std::array<int, 3> low{};
    std::array<int, 3> high{};
    std::array<double, 3> t{};
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = p[a] / feature_[a];
      high[a] = (low[a] + 1) % n_[a];
      t[a] = smooth(static_cast<double>(p[a] % feature_[a]) / feature_[a]);
    }
    const auto row = [&](int y, int z) {
      const auto base = static_cast<std::size_t>((z * n_[1] + y) * n_[0]);
      const double near = grid_[base + static_cast<std::size_t>(low[0])];
      return near + t[0] * (grid_[base + static_cast<std::size_t>(high[0])] - near);
    };
    const auto face = [&](int z) {
      const double near = row(low[1], z);
      return near + t[1] * (row(high[1], z) - near);
    };
    const double near = face(low[2]);
    return near + t[2] * (face(high[2]) - near);
  }

 private:
  std::array<int, 3> feature_;
  std::array<int, 3> n_{};
  std::vector<double> grid_;
};

/// Adds one set of sheets to a tile. A second, slower noise makes them come and go.
void add_sheets(const Recipe& recipe, const Sheets& sheets, std::uint64_t seed,
                const std::array<int, 3>& sides, std::vector<float>& tile) {
  std::array<int, 3> half{};
  for (std::size_t a = 0; a < 3; ++a) half[a] = std::max(1, sheets.feature[a] / 2);
  const ValueNoise large(seed, sides, sheets.feature);
  const ValueNoise small(seed + 1, sides, half);
  const ValueNoise strength(seed + 2, sides, half);
  const auto shape = [&](const std::array<int, 3>& p) {
    return large.at(p) + 0.3 * small.at(p);
  };
  const double thin = 1 / sheets.half_thickness;
  std::size_t i = 0;
  for (int z = 0; z < sides[2]; ++z) {
    for (int y = 0; y < sides[1]; ++y) {
      double here = shape({0, y, z});
      for (int x = 0; x < sides[0]; ++x, ++i) {
        const double next = shape({(x + 1) % sides[0], y, z});
        const double middle = here;
        here = next;
        if (std::abs(middle) > 0.4) continue;  // far from any sheet
        const double slope_x = (next - middle) / recipe.cell[0];
        const double slope_y = (shape({x, (y + 1) % sides[1], z}) - middle) / recipe.cell[1];
        const double slope = std::hypot(slope_x, slope_y) + 1e-9;
        const double distance = middle / slope * thin;
        const double faces = 1 - sheets.facing * (1 - std::pow(slope_x / slope, 2));
        const double comes_and_goes = std::max(0.0, 0.7 + 0.9 * strength.at({x, y, z}));
        tile[i] += static_cast<float>(sheets.bright * std::exp(-distance * distance) * faces *
                                      comes_and_goes);
      }
    }
  }
}

/// A bed of one with two sets of sheets, scaled to a mean square of one.
std::vector<float> make_tile(const Recipe& recipe, std::uint64_t seed) {
  std::array<int, 3> sides{};
  for (std::size_t a = 0; a < 3; ++a) sides[a] = 1 << recipe.bits[a];
  std::vector<float> tile(
      static_cast<std::size_t>(sides[0] * sides[1]) * static_cast<std::size_t>(sides[2]), 1.0F);
  add_sheets(recipe, recipe.coarse, seed, sides, tile);
  add_sheets(recipe, recipe.fine, seed + 3, sides, tile);
  double squares = 0;
  for (const float value : tile) squares += static_cast<double>(value) * value;
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

}  // namespace

TissueTexture::TissueTexture(std::uint64_t seed, bool enabled) {
  if (!enabled) return;
  for (const Recipe& recipe : kRecipes) {
    const auto kind = static_cast<std::size_t>(recipe.kind);
    const std::vector<float> values = make_tile(recipe, mix_bits(seed + 16 * kind));
    Tile& tile = tiles_[kind];
    tile.bits = recipe.bits;
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

void TissueTexture::sample(const RegionAcoustics& region, const Vec3& p_J, const Vec3& step_J,
                           std::span<float> out) const noexcept {
  const Recipe* recipe = find_recipe(region.kind);
  if (recipe == nullptr) return;
  const Vec3 along =
      region.fibre.squaredNorm() > 0.5 ? region.fibre : Vec3(region.sheet_normal.unitOrthogonal());
  const Vec3 beside = along.cross(region.sheet_normal);
  const auto place = [&](const Vec3& v) -> std::array<std::uint32_t, 3> {
    return {to_fixed_cells(region.sheet_normal.dot(v) / recipe->cell[0]),
            to_fixed_cells(beside.dot(v) / recipe->cell[1]),
            to_fixed_cells(along.dot(v) / recipe->cell[2])};
  };
  const auto step = place(step_J);
  auto [x, y, z] = place(p_J);
  const Tile& tile = tiles_[static_cast<std::size_t>(region.kind)];
  const std::uint8_t* values = tile.values.data();
  const std::uint32_t x_mask = (1U << tile.bits[0]) - 1;
  const std::uint32_t y_mask = (1U << tile.bits[1]) - 1;
  const std::uint32_t z_mask = (1U << tile.bits[2]) - 1;
  const float unit = tile.unit;
  for (float& factor : out) {
    // coarse cells begin at staggered places, so that their borders draw no lines
    const std::uint32_t i = x >> 16U;
    const std::uint32_t j = (y + (i * 40503U & 0xffffU)) >> 16U;
    const std::uint32_t k = (z + ((i * 27146U + j * 49297U) & 0xffffU)) >> 16U;
    const std::uint32_t at =
        (((k & z_mask) << tile.bits[1] | (j & y_mask)) << tile.bits[0]) | (i & x_mask);
    factor = unit * static_cast<float>(values[at]);
    x += step[0];
    y += step[1];
    z += step[2];
  }
}

}  // namespace artus
