// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/distance_field.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "artus/detail/anatomy/compile/labels/distance_field_blocks.h"
#include "artus/detail/core/check.h"

namespace artus {
namespace {

using namespace field_blocks;  // NOLINT(google-build-using-namespace): the layout of a block

constexpr int kCubeOfBlocks = 8;      // along an edge: so many blocks are told in or out at once
constexpr double kClampReach = 1.74;  // spacings; nearer to the band a clamped sample may take part

double signed_by_winding(const DistanceTree& tree, const Vec3& p, double distance) {
  return tree.winding_number(p) > 0.5 ? -distance : distance;
}

// The surface does not pass between two samples that are together farther from it than from each
// other, so the winding number is computed only next to the surface.
double signed_at(const DistanceTree& tree, const Vec3& p, double distance, double spacing,
                 const float* here, const std::array<int, 3>& i) {
  const std::array<std::pair<int, int>, 3> steps{{{i[0], 1}, {i[1], kRow}, {i[2], kPlane}}};
  for (const auto& [index, stride] : steps) {
    if (index == 0) continue;
    const double neighbour = static_cast<double>(*(here - stride));
    if (std::abs(neighbour) + distance > 1.001 * spacing) {
      return std::copysign(distance, neighbour);
    }
  }
  return signed_by_winding(tree, p, distance);
}

using SampleFlags = std::array<bool, kBlock>;

// The block's samples that are farther from a surface than a band.
struct Beyond {
  const DistanceTree& tree;
  double spacing;
  double band;
  const Vec3& corner;
  SampleFlags flags{};

  void mark(const std::array<int, 3>& first, int cells);
};

// Marks what is beyond in a cube of `cells` cells, cube by smaller cube.
void Beyond::mark(const std::array<int, 3>& first, int cells) {
  constexpr int kSmallest = 2;
  const double half = 0.5 * cells * spacing;
  const double reach = band + 1.0001 * std::sqrt(3.0) * half;
  const Vec3 centre = corner + spacing * Vec3(first[0], first[1], first[2]) + Vec3::Constant(half);
  if (tree.distance(centre, reach) >= reach) {
    for (int z = first[2]; z <= first[2] + cells; ++z)
      for (int y = first[1]; y <= first[1] + cells; ++y)
        for (int x = first[0]; x <= first[0] + cells; ++x)
          flags[static_cast<std::size_t>(x + kRow * y + kPlane * z)] = true;
    return;
  }
  if (cells == kSmallest) return;
  const int part = cells / 2;
  for (int k = 0; k < 8; ++k)
    mark({first[0] + part * (k & 1), first[1] + part * (k >> 1 & 1), first[2] + part * (k >> 2)},
         part);
}

void fill_from_tree(const DistanceTree& tree, double spacing, double band, const Vec3& corner,
                    float* out) {
  Beyond beyond{tree, spacing, band, corner};
  for (int k = 0; k < 8; ++k)
    beyond.mark({kCells / 2 * (k & 1), kCells / 2 * (k >> 1 & 1), kCells / 2 * (k >> 2)},
                kCells / 2);
  for (int i = 0; i < kBlock; ++i) {
    const std::array<int, 3> index{i % kSide, i / kSide % kSide, i / kPlane};
    constexpr std::array<int, 3> kStrides{1, kRow, kPlane};
    float* here = out + i;
    double bound = band;
    for (std::size_t a = 0; a < 3; ++a) {
      if (index[a] == 0) continue;
      const double neighbour = std::abs(static_cast<double>(*(here - kStrides[a])));
      bound = std::min(bound, neighbour + 1.001 * spacing);
    }
    const Vec3 p = corner + spacing * Vec3(index[0], index[1], index[2]);
    const double distance =
        beyond.flags[static_cast<std::size_t>(i)] ? band : tree.distance(p, bound);
    *here = static_cast<float>(signed_at(tree, p, distance, spacing, here, index));
  }
}

// A function made from clamped fields is small also far from its zero: looks closer, on a lattice
// so dense that no zero fits between its points, and then says `bound` when there is none.
double value_for_block(const std::function<double(const Vec3&)>& function, const Vec3& centre,
                       double bound, double spacing) {
  const double middle = function(centre);
  if (std::abs(middle) >= bound) return middle;
  constexpr int kHalf = kCells / 4;
  constexpr int kPoints = 2 * kHalf + 1;
  const double step = 2 * spacing;
  for (int i = 0; i < kPoints * kPoints * kPoints; ++i) {
    const Vec3 index(i % kPoints - kHalf, i / kPoints % kPoints - kHalf,
                     i / (kPoints * kPoints) - kHalf);
    const double value = function(centre + step * index);
    if (std::abs(value) < kClampReach * spacing || (value < 0) != (middle < 0)) return middle;
  }
  return std::copysign(bound, middle);
}

}  // namespace

void DistanceField::layout(const FieldSampling& sampling) {
  ARTUS_REQUIRE(sampling.spacing > 0 && sampling.band >= 2 * sampling.spacing,
                "spacing must be positive and the band at least two of it");
  spacing_ = sampling.spacing;
  band_ = sampling.band;
  origin_ = sampling.box.lower;
  const Vec3 size = (sampling.box.upper - sampling.box.lower).cwiseMax(Vec3::Zero());
  for (std::size_t a = 0; a < 3; ++a) {
    blocks_[a] =
        static_cast<int>(std::ceil(size[static_cast<Eigen::Index>(a)] / (kCells * spacing_)));
  }
}

std::size_t DistanceField::block_at(int x, int y, int z) const noexcept {
  return static_cast<std::size_t>(x + static_cast<std::ptrdiff_t>(blocks_[0]) *
                                          (y + static_cast<std::ptrdiff_t>(blocks_[1]) * z));
}

Vec3 DistanceField::block_corner(std::size_t block) const noexcept {
  const auto nx = static_cast<std::size_t>(blocks_[0]);
  const auto ny = static_cast<std::size_t>(blocks_[1]);
  const Vec3 index(static_cast<double>(block % nx), static_cast<double>(block / nx % ny),
                   static_cast<double>(block / (nx * ny)));
  return origin_ + kCells * spacing_ * index;
}

// Tells of a cube of blocks which lie wholly in or out; the others stay 0.
void DistanceField::find_sides(const BlockSource& at_centre, const std::array<int, 3>& first,
                               int n) {
  std::array<int, 3> end{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (first[a] >= blocks_[a]) return;
    end[a] = std::min(first[a] + n, blocks_[a]);
  }
  const double edge = n * kCells * spacing_;
  const Vec3 corner = origin_ + kCells * spacing_ * Vec3(first[0], first[1], first[2]);
  const double bound = band_ + edge * std::sqrt(3.0) / 2;
  const double d = at_centre(corner + Vec3::Constant(edge / 2), bound);
  if (std::abs(d) >= bound) {
    for (int z = first[2]; z < end[2]; ++z)
      for (int y = first[1]; y < end[1]; ++y)
        for (int x = first[0]; x < end[0]; ++x) slots_[block_at(x, y, z)] = d < 0 ? kIn : kOut;
    return;
  }
  if (n == 1) return;
  const int half = n / 2;
  for (int k = 0; k < 8; ++k)
    find_sides(
        at_centre,
        {first[0] + half * (k & 1), first[1] + half * (k >> 1 & 1), first[2] + half * (k >> 2)},
        half);
}

void DistanceField::sample(const BlockSource& at_centre, int coarsest, const BlockFiller& fill) {
  std::array<std::size_t, 3> cubes{};
  for (std::size_t a = 0; a < 3; ++a)
    cubes[a] = static_cast<std::size_t>((blocks_[a] + coarsest - 1) / coarsest);
  const std::size_t n = static_cast<std::size_t>(blocks_[0]) *
                        static_cast<std::size_t>(blocks_[1]) * static_cast<std::size_t>(blocks_[2]);
  slots_.assign(n, 0);
  tbb::parallel_for(std::size_t{0}, cubes[0] * cubes[1] * cubes[2], [&](std::size_t i) {
    find_sides(at_centre,
               {coarsest * static_cast<int>(i % cubes[0]),
                coarsest * static_cast<int>(i / cubes[0] % cubes[1]),
                coarsest * static_cast<int>(i / (cubes[0] * cubes[1]))},
               coarsest);
  });
  std::vector<std::size_t> active;
  for (std::size_t block = 0; block < n; ++block) {
    if (slots_[block] != 0) continue;
    slots_[block] = static_cast<std::int32_t>(active.size());
    active.push_back(block);
  }
  samples_.resize(active.size() * kBlock);
  tbb::parallel_for(std::size_t{0}, active.size(),
                    [&](std::size_t i) { fill(block_corner(active[i]), &samples_[i * kBlock]); });
}

DistanceField DistanceField::compute(const DistanceTree& tree, const FieldSampling& sampling) {
  DistanceField field;
  field.layout(sampling);
  field.sample(
      [&tree](const Vec3& p, double bound) {
        const double d = tree.distance(p, bound);
        return d < bound ? d : signed_by_winding(tree, p, d);  // a side is asked of what is far
      },
      kCubeOfBlocks,
      [&](const Vec3& corner, float* out) {
        fill_from_tree(tree, field.spacing_, field.band_, corner, out);
      });
  return field;
}

void DistanceField::sample_of(const BlockSource& at_centre,
                              const std::function<double(const Vec3&)>& function) {
  sample(at_centre, 1, [&](const Vec3& corner, float* out) {
    for (int i = 0; i < kBlock; ++i) {
      const Vec3 index(i % kSide, i / kSide % kSide, i / kPlane);
      const double value = function(corner + spacing_ * index);
      out[i] = static_cast<float>(std::clamp(value, -band_, band_));
    }
  });
}

DistanceField DistanceField::compute(const std::function<double(const Vec3&)>& function,
                                     const FieldSampling& sampling) {
  DistanceField field;
  field.layout(sampling);
  field.sample_of(
      [&](const Vec3& centre, double bound) {
        return value_for_block(function, centre, bound, field.spacing_);
      },
      function);
  return field;
}

DistanceField DistanceField::compute_throughout(const std::function<double(const Vec3&)>& function,
                                                const FieldSampling& sampling) {
  DistanceField field;
  field.layout(sampling);
  field.sample_of([&](const Vec3& centre, double /*bound*/) { return function(centre); }, function);
  return field;
}

double DistanceField::value(const Vec3& p) const noexcept {
  const double near = near_value(p);
  if (!far_ || std::abs(near) < band_ - kClampReach * spacing_) return near;
  return far_->covers(p) ? far_->value(p) : std::copysign(far_->band_, near);
}

bool DistanceField::covers(const Vec3& p) const noexcept {
  const Vec3 q = (p - origin_) / (kCells * spacing_);
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = q[static_cast<Eigen::Index>(a)];
    if (!(at >= 0 && at < blocks_[a])) return false;
  }
  return true;
}

void DistanceField::extend(const DistanceTree& tree, const FieldSampling& sampling) {
  far_ = std::make_shared<const DistanceField>(compute(tree, sampling));
}

double DistanceField::near_value(const Vec3& p) const noexcept {
  const Vec3 q = (p - origin_) / spacing_;
  std::array<unsigned, 3> i{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = q[static_cast<Eigen::Index>(a)];
    if (!(at >= 0 && at < blocks_[a] * kCells)) return band_;
    i[a] = static_cast<unsigned>(at);
  }
  constexpr auto kPer = static_cast<unsigned>(kCells);
  const std::size_t block =
      i[0] / kPer + static_cast<std::size_t>(blocks_[0]) *
                        (i[1] / kPer + static_cast<std::size_t>(blocks_[1]) * (i[2] / kPer));
  const std::int32_t slot = slots_[block];
  if (slot < 0) return slot == kIn ? -band_ : band_;
  const float* s = &samples_[static_cast<std::size_t>(slot) * kBlock + i[0] % kPer +
                             kRow * (i[1] % kPer) + kPlane * (i[2] % kPer)];
  const double fx = q[0] - i[0];
  const double fy = q[1] - i[1];
  const double fz = q[2] - i[2];
  const auto along_x = [&](int offset) {
    return (1 - fx) * static_cast<double>(s[offset]) + fx * static_cast<double>(s[offset + 1]);
  };
  const double low = (1 - fy) * along_x(0) + fy * along_x(kRow);
  const double high = (1 - fy) * along_x(kPlane) + fy * along_x(kPlane + kRow);
  return (1 - fz) * low + fz * high;
}

int DistanceField::side_of(const Box& box) const noexcept {
  std::array<int, 3> first{};
  std::array<int, 3> last{};
  bool beyond_samples = false;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double edge = spacing_ * kCells;
    const double low = std::floor((box.lower[axis] - origin_[axis]) / edge);
    const double high = std::floor((box.upper[axis] - origin_[axis]) / edge);
    if (high < 0 || low >= blocks_[a]) return 1;
    beyond_samples = beyond_samples || low < 0 || high >= blocks_[a];
    first[a] = static_cast<int>(std::max(low, 0.0));
    last[a] = static_cast<int>(std::min(high, blocks_[a] - 1.0));
  }
  bool any_in = false;
  bool any_out = beyond_samples;
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int x = first[0]; x <= last[0]; ++x) {
        const std::int32_t slot = slots_[block_at(x, y, z)];
        if (slot >= 0) return 0;
        (slot == kIn ? any_in : any_out) = true;
      }
    }
  }
  if (any_in == any_out) return 0;
  return any_in ? -1 : 1;
}

Vec3 DistanceField::normal(const Vec3& p) const noexcept {
  const double h = spacing_ / 2;
  Vec3 g;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const Vec3 step = h * Vec3::Unit(a);
    g[a] = value(p + step) - value(p - step);
  }
  const double length = g.norm();
  return length > 0 ? Vec3(g / length) : Vec3(Vec3::Zero());
}

FieldPart DistanceField::integrate_part(const std::function<double(const Vec3&)>& weight) const {
  std::vector<FieldPart> sums(slots_.size());
  tbb::parallel_for(std::size_t{0}, slots_.size(), [&](std::size_t block) {
    if (slots_[block] == kOut) return;
    const Vec3 corner = block_corner(block);
    for (int i = 0; i < kCells * kCells * kCells; ++i) {
      const Vec3 index(i % kCells, i / kCells % kCells, i / (kCells * kCells));
      const Vec3 p = corner + spacing_ * (index + Vec3::Constant(0.5));
      const double inside = std::clamp(0.5 - value(p) / spacing_, 0.0, 1.0);
      if (!(inside > 0)) continue;
      const double share = inside * weight(p);
      sums[block].volume += share;
      sums[block].centre += share * p;
    }
  });
  FieldPart all;
  for (const FieldPart& sum : sums) {
    all.volume += sum.volume;
    all.centre += sum.centre;
  }
  if (all.volume > 0) all.centre /= all.volume;
  all.volume *= spacing_ * spacing_ * spacing_;
  return all;
}

std::array<double, 2> DistanceField::integrate_blocks(const BlockWeights& weights_in) const {
  std::vector<std::array<double, 2>> sums(slots_.size(), {0, 0});
  tbb::parallel_for(std::size_t{0}, slots_.size(), [&](std::size_t block) {
    if (slots_[block] == kOut) return;
    const Vec3 corner = block_corner(block);
    const auto weights = weights_in({corner, corner + Vec3::Constant(kCells * spacing_)});
    for (int i = 0; i < kCells * kCells * kCells; ++i) {
      const Vec3 index(i % kCells, i / kCells % kCells, i / (kCells * kCells));
      const Vec3 p = corner + spacing_ * (index + Vec3::Constant(0.5));
      const double own = value(p);
      if (own >= spacing_ / 2) continue;
      const std::array<double, 2> share = weights(p, own);
      sums[block][0] += share[0];
      sums[block][1] += share[1];
    }
  });
  std::array<double, 2> all{0, 0};
  for (const auto& sum : sums) {
    all[0] += sum[0];
    all[1] += sum[1];
  }
  const double cell = spacing_ * spacing_ * spacing_;
  return {all[0] * cell, all[1] * cell};
}

double DistanceField::integrate(const std::function<double(const Vec3&)>& weight) const {
  return integrate_part(weight).volume;
}

void DistanceField::write(ByteWriter& out) const {
  for (Eigen::Index a = 0; a < 3; ++a) out.put(origin_[a]);
  out.put(spacing_);
  out.put(band_);
  for (const int n : blocks_) out.put(n);
  out.put_array(slots_);
  out.put_array(samples_);
  out.put(static_cast<std::uint8_t>(far_ ? 1 : 0));
  if (far_) far_->write(out);
}

std::optional<DistanceField> DistanceField::read(ByteReader& in) {
  DistanceField field;
  for (Eigen::Index a = 0; a < 3; ++a) field.origin_[a] = in.get<double>();
  field.spacing_ = in.get<double>();
  field.band_ = in.get<double>();
  std::size_t n = 1;
  for (int& blocks : field.blocks_) {
    blocks = in.get<int>();
    n *= static_cast<std::size_t>(std::clamp(blocks, 0, 1 << 20));
  }
  field.slots_ = in.get_array<std::int32_t>();
  field.samples_ = in.get_array<float>();
  const std::size_t n_stored = field.samples_.size() / kBlock;
  const bool slots_stored =
      std::all_of(field.slots_.begin(), field.slots_.end(),
                  [&](std::int32_t s) { return s < 0 || static_cast<std::size_t>(s) < n_stored; });
  if (!in.ok() || field.slots_.size() != n || !slots_stored || !(field.spacing_ > 0))
    return std::nullopt;
  if (in.get<std::uint8_t>() == 0) return field;
  auto far = read(in);
  if (!far) return std::nullopt;
  field.far_ = std::make_shared<const DistanceField>(std::move(*far));
  return field;
}

std::size_t DistanceField::memory() const noexcept {
  return samples_.size() * sizeof(float) + slots_.size() * sizeof(std::int32_t);
}

}  // namespace artus
