// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/medium/texture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/detail/core/noise.h"
#include "artus/detail/echo/medium/simd.h"

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
/// them, z along the fibres. The tile is eight coarse features long along z; a nerve's, which no
/// nerve is as thick as, two.
struct Recipe {
  TissueKind kind = TissueKind::plain;
  std::array<double, 3> cell{};         // m
  std::array<std::uint32_t, 3> bits{};  // the tile has 2^bits cells
  Sheets coarse;
  Sheets fine;
  double bed = 0;  // nepers by which the bed is brighter or darker from place to place, at the most
  /// Cells along z by which the next tile along x and along y lies on: the same sheets do not come
  /// again one tile deeper or beside, but first two deeper and one beside.
  [[nodiscard]] constexpr int shift_x() const { return 3 * coarse.feature[2]; }
  [[nodiscard]] constexpr int shift_y() const { return 2 * coarse.feature[2]; }
};

constexpr std::array<Recipe, 4> kRecipes{{
    {TissueKind::muscle,
     {0.1e-3, 0.3e-3, 2e-3},
     {7, 6, 7},
     {{16, 16, 2}, 0.20e-3, 8, 0.9},
     {{8, 8, 2}, 0.14e-3, 6, 0.85},
     2.6},
    {TissueKind::fat,
     {0.1e-3, 0.5e-3, 0.5e-3},
     {7, 6, 7},
     {{32, 16, 16}, 0.12e-3, 9, 0.95},
     {{16, 8, 8}, 0.09e-3, 1.5, 0.9}},
    {TissueKind::tendon,
     {0.06e-3, 0.12e-3, 1.5e-3},
     {7, 6, 6},
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

/// Smooth noise on a tile, -1..1, that goes on in the tiles around: random values on a coarse grid,
/// blended in between. A step over the end along x or y also moves on along z.
class ValueNoise {
 public:
  ValueNoise(std::uint64_t seed, const Recipe& recipe, const std::array<int, 3>& sides,
             const std::array<int, 3>& feature)
      : feature_(feature),
        shift_x_(recipe.shift_x() / feature[2]),
        shift_y_(recipe.shift_y() / feature[2]) {
    for (std::size_t a = 0; a < 3; ++a) n_[a] = sides[a] / feature[a];
    const std::size_t size =
        static_cast<std::size_t>(n_[0] * n_[1]) * static_cast<std::size_t>(n_[2]);
    for (std::size_t i = 0; i < size; ++i) grid_.push_back(2 * uniform_noise(seed, i) - 1);
    for (int j = 0; j < feature[0]; ++j) {
      blend_.push_back(static_cast<float>(smooth(static_cast<double>(j) / feature[0])));
    }
  }

  /// Adds `factor` times the values along x at (y, z), a row of the tile and the first value
  /// beyond. y may be the first beyond the tile.
  void add_row(int y, int z, float factor, std::vector<float>& row) const {
    const double ty = smooth(static_cast<double>(y % feature_[1]) / feature_[1]);
    const double tz = smooth(static_cast<double>(z % feature_[2]) / feature_[2]);
    const int y0 = y / feature_[1];
    const int z0 = z / feature_[2];
    const auto node = [&](int x) {
      const double near = (1 - ty) * value(x, y0, z0) + ty * value(x, y0 + 1, z0);
      const double far = (1 - ty) * value(x, y0, z0 + 1) + ty * value(x, y0 + 1, z0 + 1);
      return static_cast<float>((1 - tz) * near + tz * far) * factor;
    };
    const auto width = static_cast<std::size_t>(feature_[0]);
    float next = node(0);
    for (int k = 0; k < n_[0]; ++k) {
      const float here = next;
      next = node(k + 1);
      float* out = row.data() + static_cast<std::size_t>(k) * width;
      for (std::size_t j = 0; j < width; ++j) {
        out[j] += here + blend_[j] * (next - here);
      }
    }
    row[static_cast<std::size_t>(n_[0]) * width] += next;
  }

 private:
  [[nodiscard]] double value(int x, int y, int z) const {
    z += x / n_[0] * shift_x_ + y / n_[1] * shift_y_;
    const int at = (z % n_[2] * n_[1] + y % n_[1]) * n_[0] + x % n_[0];
    return grid_[static_cast<std::size_t>(at)];
  }

  std::array<int, 3> feature_;
  int shift_x_;
  int shift_y_;
  std::array<int, 3> n_{};
  std::vector<double> grid_;
  std::vector<float> blend_;  // within a feature along x
};

/// Adds one set of sheets to a tile. A second, slower noise makes them come and go.
void add_sheets(const Recipe& recipe, const Sheets& sheets, std::uint64_t seed,
                const std::array<int, 3>& sides, std::vector<float>& tile) {
  std::array<int, 3> half{};
  for (std::size_t a = 0; a < 3; ++a) half[a] = std::max(1, sheets.feature[a] / 2);
  const ValueNoise large(seed, recipe, sides, sheets.feature);
  const ValueNoise small(seed + 1, recipe, sides, half);
  const ValueNoise strength(seed + 2, recipe, sides, half);
  const auto width = static_cast<std::size_t>(sides[0]);
  const auto make_row = [&](int y, int z, std::vector<float>& row) {
    row.assign(width + 1, 0.0F);
    large.add_row(y, z, 1, row);
    small.add_row(y, z, 0.3F, row);
  };
  std::vector<float> row;
  std::vector<float> beside;  // the row at y + 1
  std::vector<float> comes_and_goes;
  float* out = tile.data();
  for (int z = 0; z < sides[2]; ++z) {
    make_row(0, z, beside);
    for (int y = 0; y < sides[1]; ++y, out += width) {
      std::swap(row, beside);
      make_row(y + 1, z, beside);
      comes_and_goes.assign(width + 1, 0.7F);
      strength.add_row(y, z, 0.9F, comes_and_goes);
      for (std::size_t x = 0; x < width; ++x) {
        const double middle = row[x];
        if (std::abs(middle) > 0.4 || comes_and_goes[x] <= 0) continue;  // far from any sheet
        const double slope_x = (row[x + 1] - middle) / recipe.cell[0];
        const double slope_y = (beside[x] - middle) / recipe.cell[1];
        const double slope = std::sqrt(slope_x * slope_x + slope_y * slope_y) + 1e-9;
        const double distance = middle / (slope * sheets.half_thickness);
        if (std::abs(distance) > 3) continue;
        const double along = slope_x / slope;
        const double faces = 1 - sheets.facing * (1 - along * along);
        out[x] += static_cast<float>(sheets.bright * std::exp(-distance * distance) * faces) *
                  comes_and_goes[x];
      }
    }
  }
}

/// A bed around one whose brightness wanders over coarse and fine features.
std::vector<float> make_bed(const Recipe& recipe, std::uint64_t seed,
                            const std::array<int, 3>& sides) {
  if (!(recipe.bed > 0))
    return std::vector<float>(static_cast<std::size_t>(sides[0]) *
                                  static_cast<std::size_t>(sides[1]) *
                                  static_cast<std::size_t>(sides[2]),
                              1.0F);
  std::vector<float> tile;
  const auto bed = static_cast<float>(recipe.bed);
  const std::array<int, 3>& feature = recipe.coarse.feature;
  const ValueNoise slow(seed + 2, recipe, sides, {4 * feature[0], 2 * feature[1], feature[2]});
  const ValueNoise coarse(seed, recipe, sides, feature);
  const ValueNoise fine(seed + 1, recipe, sides, recipe.fine.feature);
  std::vector<float> row;
  for (int z = 0; z < sides[2]; ++z)
    for (int y = 0; y < sides[1]; ++y) {
      row.assign(static_cast<std::size_t>(sides[0]) + 1, 0.0F);
      slow.add_row(y, z, 0.4F * bed, row);
      coarse.add_row(y, z, 0.5F * bed, row);
      fine.add_row(y, z, 0.4F * bed, row);
      for (int x = 0; x < sides[0]; ++x) tile.push_back(std::exp(row[static_cast<std::size_t>(x)]));
    }
  return tile;
}

/// A bed with two sets of sheets, scaled to a mean square of one.
std::vector<float> make_tile(const Recipe& recipe, std::uint64_t seed) {
  std::array<int, 3> sides{};
  for (std::size_t a = 0; a < 3; ++a) sides[a] = 1 << recipe.bits[a];
  std::vector<float> tile = make_bed(recipe, seed + 6, sides);
  add_sheets(recipe, recipe.coarse, seed, sides, tile);
  add_sheets(recipe, recipe.fine, seed + 3, sides, tile);
  double squares = 0;
  for (const float value : tile) squares += static_cast<double>(value) * value;
  const auto unit = static_cast<float>(1 / std::sqrt(squares / static_cast<double>(tile.size())));
  for (float& value : tile) value *= unit;
  return tile;
}

/// A straight walk through the repeated tile, in 16.16 fixed-point cells.
struct TileWalk {
  std::array<std::uint32_t, 3> start{};
  std::array<std::uint32_t, 3> step{};
  std::array<std::uint32_t, 3> bits{};
  std::array<std::uint32_t, 2> shift{};  // cells along z of the next tile along x, along y
};

constexpr std::size_t kBatch = 16;

/// Indices into the tile of kBatch steps from the `first` on.
ARTUS_SIMD
void find_in_tile(const TileWalk& walk, std::uint32_t first, std::uint32_t* at) noexcept {
  const auto [x_bits, y_bits, z_bits] = walk.bits;
  const auto [x_start, y_start, z_start] = walk.start;
  const auto [x_step, y_step, z_step] = walk.step;
  const auto [x_shift, y_shift] = walk.shift;
  for (std::uint32_t n = 0; n < kBatch; ++n) {
    const std::uint32_t x = x_start + (first + n) * x_step;
    const std::uint32_t y = y_start + (first + n) * y_step;
    const std::uint32_t z = z_start + (first + n) * z_step;
    // coarse cells begin at staggered places, so that their borders draw no lines
    const std::uint32_t i = x >> 16U;
    const std::uint32_t j = (y + (i * 40503U & 0xffffU)) >> 16U;
    const std::uint32_t k = ((z + ((i * 27146U + j * 49297U) & 0xffffU)) >> 16U) +
                            (i >> x_bits) * x_shift + (j >> y_bits) * y_shift;
    at[n] = (((k & ((1U << z_bits) - 1)) << y_bits | (j & ((1U << y_bits) - 1))) << x_bits) |
            (i & ((1U << x_bits) - 1));
  }
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

void TissueTexture::sample(TissueKind kind, const Vec3& place, const Vec3& step_by,
                           std::span<float> out) const noexcept {
  const Recipe* recipe = find_recipe(kind);
  if (recipe == nullptr) return;
  const auto in_cells = [&](const Vec3& v) -> std::array<std::uint32_t, 3> {
    return {to_fixed_cells(v.x() / recipe->cell[0]), to_fixed_cells(v.y() / recipe->cell[1]),
            to_fixed_cells(v.z() / recipe->cell[2])};
  };
  const Tile& tile = tiles_[static_cast<std::size_t>(kind)];
  TileWalk walk;
  walk.start = in_cells(place);
  walk.step = in_cells(step_by);
  walk.bits = tile.bits;
  walk.shift = {static_cast<std::uint32_t>(recipe->shift_x()),
                static_cast<std::uint32_t>(recipe->shift_y())};
  std::array<std::uint32_t, kBatch> at;  // NOLINT(cppcoreguidelines-pro-type-member-init): next
  for (std::size_t first = 0; first < out.size(); first += kBatch) {
    find_in_tile(walk, static_cast<std::uint32_t>(first), at.data());
    const std::size_t n = std::min(kBatch, out.size() - first);
    for (std::size_t i = 0; i < n; ++i)
      out[first + i] = tile.unit * static_cast<float>(tile.values[at[i]]);
  }
}

}  // namespace artus
