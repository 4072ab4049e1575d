// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/anatomy/compiled_joint.h"

namespace artus {

/// Cubes of tissue around a space, one copy of a cube for each part of it that the space keeps from
/// the others within it. Neighbouring copies share nodes where their tissue goes on from one into
/// the other, so that a field on the nodes is continuous in tissue and free to jump across the
/// space; beyond the space's rim both sides are one. Frame J. Immutable.
/// Source: nodes doubled by what a cube's pieces touch as in [Molino2004].
class SidedCage {
 public:
  static constexpr std::int32_t kNoCopy = -1;   ///< nothing there
  static constexpr std::int32_t kSeveral = -2;  ///< where a rim begins
  /// A point and the copy of a cube that it is carried in.
  struct Place {
    Vec3 p = Vec3::Zero();   ///< m, frame J
    std::int32_t copy = -1;  ///< -1: outside the cage
  };
  struct Copy {
    std::array<std::uint32_t, 8> nodes{};  ///< x fastest, then y, then z
    std::array<std::int32_t, 3> cube{};
    /// The one on each side: -x, +x, -y, +y, -z, +z; kNoCopy, kSeveral.
    std::array<std::int32_t, 6> next{kNoCopy, kNoCopy, kNoCopy, kNoCopy, kNoCopy, kNoCopy};
    std::vector<RegionId> samples;  ///< a region for each sample of it
  };
  /// A piece of the space's walls.
  struct Wall {
    std::array<Vec3, 3> p{};  ///< m
    Vec3 into;                ///< unit, out of the space into tissue
  };

  /// Where walls lie on each other: tissue to both sides, and how much of the walls it stands for.
  struct Film {
    Place here;
    Place there;
    double area = 0;  ///< m^2
  };

  /// Requires: one of `space` has interfaces. Cost: some tenths of a second.
  SidedCage(const CompiledJoint& joint, std::span<const RegionId> space);

  [[nodiscard]] std::span<const Copy> copies() const noexcept { return copies_; }
  [[nodiscard]] std::size_t n_nodes() const noexcept { return nodes_.size(); }
  [[nodiscard]] const Vec3& node(std::size_t i) const noexcept { return nodes_[i]; }
  [[nodiscard]] std::span<const Wall> walls() const noexcept { return walls_; }
  [[nodiscard]] std::span<const Film> films() const noexcept { return films_; }
  [[nodiscard]] double edge() const noexcept { return edge_; }                ///< m, of a cube
  [[nodiscard]] double spacing() const noexcept { return edge_ / kSamples; }  ///< m, of samples
  [[nodiscard]] double extent() const noexcept { return extent_; }  ///< m, the space's diagonal
  [[nodiscard]] bool on_border(const Copy& copy, std::size_t corner) const noexcept;

  /// The tissue at a point: the nearest that can be seen from it, not through a wall. `into`: of a
  /// point on a wall, the way into its tissue (any length); zero: it is on none.
  [[nodiscard]] Place locate(const Vec3& p, const Vec3& into) const;
  /// The point carried on to `p` in tissue. Cost: some ns for a cube on the way.
  void carry(Place& place, const Vec3& p) const noexcept;
  /// Weights of the copy's nodes; where it has no neighbour, as at its nearest point.
  [[nodiscard]] std::array<double, 8> weights(const Place& place) const noexcept;

  static constexpr int kSamples = 4;  ///< along each edge of a cube

 private:
  static constexpr std::uint8_t kNone = 255;  // a part of no cube
  static constexpr int kReach = 3;            // samples, in which the tissue of a point is sought
  using Index = std::array<std::int32_t, 3>;
  struct Hit {
    double at;
    RegionId before;
    RegionId behind;
    bool wall;
    double facing;  // of a unit normal, the part along the line
  };
  struct Pair {
    Index here;
    Index there;
    double area;
  };
  [[nodiscard]] std::size_t cube_index(const Index& c) const noexcept;
  [[nodiscard]] std::size_t sample_index(const Index& s) const noexcept;
  [[nodiscard]] Vec3 sample_at(const Index& s) const noexcept;
  [[nodiscard]] bool is_sample(const Index& s) const noexcept;
  [[nodiscard]] std::int32_t copy_of(const Index& s) const noexcept;
  [[nodiscard]] std::int32_t next_of(std::int32_t copy, std::size_t face,
                                     const Vec3& p) const noexcept;
  void find_box(const CompiledJoint& joint, std::span<const RegionId> space);
  void scan(const CompiledJoint& joint, int axis);
  void read_line(int axis, const Index& first, std::vector<Hit>& hits);
  void find_films(int axis, const Index& first, const std::vector<Hit>& hits);
  void place_films();
  void drop_air();
  void make_copies();
  void join_copies();
  void file_walls();
  void list_offsets();
  [[nodiscard]] bool sees(const Vec3& a, const Vec3& b) const;

  std::vector<bool> in_space_;  // by region
  double edge_ = 0;
  double extent_ = 0;
  Vec3 low_ = Vec3::Zero();
  Index cubes_{};
  std::vector<RegionId> region_;       // by sample, x fastest
  std::vector<std::uint8_t> blocked_;  // by sample: bit a: a wall before the next along axis a
  std::vector<std::uint8_t> part_;     // by sample: of its cube; kNone: no tissue
  std::vector<std::int32_t> first_;    // by cube: its first copy; (n + 1)
  std::vector<Copy> copies_;
  std::vector<Vec3> nodes_;
  std::vector<Wall> walls_;
  std::vector<Pair> pairs_;  // of samples, of films
  std::vector<Film> films_;
  std::vector<std::vector<std::uint32_t>> walls_near_;  // by cube
  std::vector<Index> offsets_;                          // of samples
};

}  // namespace artus
