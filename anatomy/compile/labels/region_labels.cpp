// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/region_labels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

namespace artus {
namespace {

constexpr double kIndexEdge = 2.5e-3;  // m: a few facets, so that most blocks see few surfaces

// The block that holds `p`, or -1.
std::ptrdiff_t find_block(const LayerIndex& index, const Vec3& p) {
  if (!(index.edge > 0)) return -1;
  std::ptrdiff_t block = 0;
  for (std::size_t a = 3; a-- > 0;) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double i = std::floor((p[axis] - index.box.lower[axis]) / index.edge);
    if (!(i >= 0 && i < index.blocks[a])) return -1;
    block = block * index.blocks[a] + static_cast<std::ptrdiff_t>(i);
  }
  return block;
}

/// Whether all of a box lies inside the region of interest, whose distance has its maximum over a
/// box at a corner.
bool holds(const RegionOfInterest& roi, const Box& box) {
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner((k & 1) != 0 ? box.upper[0] : box.lower[0],
                      (k & 2) != 0 ? box.upper[1] : box.lower[1],
                      (k & 4) != 0 ? box.upper[2] : box.lower[2]);
    if (signed_distance(roi, corner) >= 0) return false;
  }
  return true;
}

}  // namespace

std::pair<std::size_t, double> partition_of(const JointFile& file, const Structure& structure) {
  for (std::size_t i = 0; i < file.partitions.size(); ++i)
    if (file.partitions[i].name == structure.partition) return {i + 1, file.partitions[i].film};
  return {0, 0};
}

double signed_distance(const RegionOfInterest& roi, const Vec3& p) {
  if (!roi.half_extent) return (p - roi.centre).norm() - roi.radius;
  const Vec3 q = (p - roi.centre).cwiseAbs() - *roi.half_extent;
  return q.cwiseMax(Vec3::Zero()).norm() + std::min(q.maxCoeff(), 0.0);
}

RegionId RegionLabels::at(const Vec3& p) const {
  const std::ptrdiff_t block = find_block(index, p);
  if (block < 0 || index.meshed[static_cast<std::size_t>(block)] == 0) {
    if (body.value(p) >= 0) return kOutside;
    if (region_of_interest && signed_distance(*region_of_interest, p) >= 0) return kBeyond;
  }
  if (block < 0) {
    for (const Layer& layer : layers) {
      if (layer.field.value(p) < 0) return layer.region;
    }
    return at_film(p);
  }
  const auto b = static_cast<std::size_t>(block);
  bool is_near_film = false;
  for (std::uint32_t k = index.first[b]; k < index.first[b + 1]; ++k) {
    const Layer& layer = layers[index.layers[k]];
    if (index.filled[b] != 0 && k + 1 == index.first[b + 1]) return layer.region;
    if (layer.field.value(p) < 0) return layer.region;
    is_near_film = is_near_film || layer.partition != 0;
  }
  return is_near_film ? at_film(p) : filler;
}

RegionId RegionLabels::at_film(const Vec3& p) const {
  const double to_skin = -body.value(p);
  RegionId best = filler;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Layer& layer = layers[i];
    if (layer.partition == 0) continue;
    const double own = layer.field.value(p);
    if (own >= layer.film || own >= least) continue;
    double other = to_skin;
    for (std::size_t k = 0; k < layers.size(); ++k)
      if (k != i && layers[k].partition == layer.partition)
        other = std::min(other, layers[k].field.value(p));
    if (own > other || own + other >= layer.film) continue;
    least = own;
    best = layer.region;
  }
  return best;
}

void RegionLabels::make_index(const Box& box) {
  index = {};
  index.box = box;
  index.edge = kIndexEdge;
  std::size_t n_blocks = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    index.blocks[a] = static_cast<int>(std::ceil((box.upper[axis] - box.lower[axis]) / index.edge));
    n_blocks *= static_cast<std::size_t>(index.blocks[a]);
  }
  std::vector<std::vector<std::uint16_t>> candidates(n_blocks);
  index.meshed.assign(n_blocks, 0);
  index.filled.assign(n_blocks, 0);
  tbb::parallel_for(std::size_t{0}, n_blocks, [&](std::size_t b) {
    const std::size_t nx = static_cast<std::size_t>(index.blocks[0]);
    const std::size_t ny = static_cast<std::size_t>(index.blocks[1]);
    const std::array<std::size_t, 3> cell{b % nx, b / nx % ny, b / (nx * ny)};
    const Vec3 corner =
        box.lower + index.edge * Vec3(static_cast<double>(cell[0]), static_cast<double>(cell[1]),
                                      static_cast<double>(cell[2]));
    // A hair wider than the block: rounding may put a point of its face into the neighbour.
    const Vec3 hair = Vec3::Constant(1e-6 * index.edge);
    const Box around{corner - hair, corner + Vec3::Constant(index.edge) + hair};
    index.meshed[b] =
        body.side_of(around) < 0 && (!region_of_interest || holds(*region_of_interest, around));
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const Vec3 film = Vec3::Constant(layers[i].film);
      const int side = layers[i].field.side_of({around.lower - film, around.upper + film});
      if (side > 0) continue;
      candidates[b].push_back(static_cast<std::uint16_t>(i));
      if (side >= 0) continue;
      index.filled[b] = 1;
      break;
    }
  });
  index.first.assign(n_blocks + 1, 0);
  for (std::size_t b = 0; b < n_blocks; ++b) {
    index.layers.insert(index.layers.end(), candidates[b].begin(), candidates[b].end());
    index.first[b + 1] = static_cast<std::uint32_t>(index.layers.size());
  }
}

const RegionLabels::Layer* RegionLabels::layer_of(RegionId region) const {
  const auto found = std::find_if(layers.begin(), layers.end(),
                                  [region](const Layer& l) { return l.region == region; });
  return found == layers.end() ? nullptr : &*found;
}

double RegionLabels::separation(RegionId a, RegionId b, const Vec3& p) const {
  if (a == kOutside || b == kOutside) return body.value(p);
  if (a == kBeyond || b == kBeyond) return signed_distance(*region_of_interest, p);
  for (const Layer& layer : layers) {
    if (layer.region == a || layer.region == b) return layer.field.value(p);
  }
  return 0;
}

}  // namespace artus
