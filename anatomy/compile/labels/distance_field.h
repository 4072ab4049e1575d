// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "artus/detail/anatomy/surfaces/distance_tree.h"
#include "artus/detail/core/byte_stream.h"

namespace artus {

/// An axis-parallel box, m.
struct Box {
  Vec3 lower = Vec3::Zero();
  Vec3 upper = Vec3::Zero();
};

/// How a field is sampled.
struct FieldSampling {
  Box box;             ///< where it is known; outside the box every point counts as outside
  double spacing = 0;  ///< m between samples
  double band = 0;     ///< m; values are clamped to +-band
};

/// A connected part of a field's inside.
struct FieldPart {
  double volume = 0;           ///< m^3
  Vec3 centre = Vec3::Zero();  ///< of its volume
};

/// Signed distance (negative inside) on a grid that stores samples only near the surface, trilinear
/// in between, clamped to +-band. The resolved layers are the sign of such fields, so one cheap
/// query answers "inside?" for surfaces and constructs alike.
class DistanceField {
 public:
  DistanceField() = default;

  /// Samples the distance to a surface; inside is where the winding number exceeds 1/2.
  /// Requires: spacing > 0, band >= 2 spacing. Cost: samples in the band times log n, on all
  /// threads; the result does not depend on their number.
  [[nodiscard]] static DistanceField compute(const DistanceTree& tree,
                                             const FieldSampling& sampling);

  /// Samples any function that is negative inside and changes no faster than distance. Storage
  /// blocks without a zero count as wholly inside or outside: values hold near the surface only.
  [[nodiscard]] static DistanceField compute(const std::function<double(const Vec3&)>& function,
                                             const FieldSampling& sampling);

  /// The same of a function that is nowhere less than half a distance: its values hold throughout
  /// the band, as those of a surface do.
  [[nodiscard]] static DistanceField compute_throughout(
      const std::function<double(const Vec3&)>& function, const FieldSampling& sampling);

  /// Adds a coarser field of a wider band for where this one is clamped: distances far from a
  /// surface are smooth. Beyond its box what is clamped here counts as `sampling.band` away.
  /// Requires: `sampling.band` larger than this band.
  void extend(const DistanceTree& tree, const FieldSampling& sampling);
  /// Takes back what extend added.
  void forget_far() noexcept { far_.reset(); }

  /// Signed distance at `p`, m. Cost: constant, tens of nanoseconds.
  [[nodiscard]] double value(const Vec3& p) const noexcept;

  /// Which side of the surface all of `box` lies on, where the sparse storage alone tells: -1
  /// inside, +1 outside, 0 undecided. Cost: the storage blocks that `box` touches.
  [[nodiscard]] int side_of(const Box& box) const noexcept;

  /// Direction of steepest increase, unit, or zero where the field is flat.
  [[nodiscard]] Vec3 normal(const Vec3& p) const noexcept;

  /// Integral of `weight` over the inside, m^3 (weight 1: the volume), by the midpoint rule over
  /// the cells with a smoothed edge. Cost: cells not outside, on all threads; deterministic.
  [[nodiscard]] double integrate(const std::function<double(const Vec3&)>& weight) const;

  /// The volume where `weight` counts and its centre. Cost: as of integrate.
  [[nodiscard]] FieldPart integrate_part(const std::function<double(const Vec3&)>& weight) const;

  /// Two weights at a point, given the field's value there.
  using Weights = std::function<std::array<double, 2>(const Vec3&, double)>;
  /// The weights for the points of a box.
  using BlockWeights = std::function<Weights(const Box&)>;
  /// Integrals of two weights, m^3, over all cells whose middle lies inside or within half the
  /// spacing of it; `weights_in` is asked once for each storage block. Cost: as of integrate.
  [[nodiscard]] std::array<double, 2> integrate_blocks(const BlockWeights& weights_in) const;

  /// Makes all but the largest connected part of the inside outside; returns the parts there were,
  /// the largest first. Parts are told apart on the samples. Cost: linear in the samples.
  std::vector<FieldPart> keep_largest_part();

  /// All of it, what extend added too.
  void write(ByteWriter& out) const;
  /// What write wrote; empty when it cannot be a field.
  [[nodiscard]] static std::optional<DistanceField> read(ByteReader& in);

  [[nodiscard]] double spacing() const noexcept { return spacing_; }
  [[nodiscard]] double band() const noexcept { return band_; }
  /// Bytes held.
  [[nodiscard]] std::size_t memory() const noexcept;

 private:
  struct Parts;
  using BlockSource = std::function<double(const Vec3&, double)>;
  using BlockFiller = std::function<void(const Vec3&, float*)>;

  [[nodiscard]] double near_value(const Vec3& p) const noexcept;
  [[nodiscard]] bool covers(const Vec3& p) const noexcept;
  void layout(const FieldSampling& sampling);
  /// `coarsest`: along an edge, the blocks whose side `at_centre` can tell at once.
  void sample(const BlockSource& at_centre, int coarsest, const BlockFiller& fill);
  void find_sides(const BlockSource& at_centre, const std::array<int, 3>& first, int n);
  void sample_of(const BlockSource& at_centre, const std::function<double(const Vec3&)>& function);
  [[nodiscard]] std::size_t block_at(int x, int y, int z) const noexcept;
  [[nodiscard]] Vec3 block_corner(std::size_t block) const noexcept;

  Vec3 origin_ = Vec3::Zero();
  double spacing_ = 1;
  double band_ = 0;
  std::array<int, 3> blocks_{0, 0, 0};
  std::vector<std::int32_t> slots_;           // (nx, ny, nz), x fastest: sample block, or kOut, kIn
  std::shared_ptr<const DistanceField> far_;  // coarser, of a wider band
  std::vector<float> samples_;                // (n_slots, 9, 9, 9), x fastest
};

}  // namespace artus
