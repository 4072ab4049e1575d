// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace artus {

/// Triangles over points of their own.
struct Surface {
  std::vector<Eigen::Vector3f> points;  ///< m
  std::vector<std::uint32_t> indices;   ///< three a triangle
  /// Of each point, or empty: points of unequal labels stay apart in a decimation.
  std::vector<std::uint64_t> labels;
  /// Of each point, or empty: the vertex of a joint that it goes with when that moves.
  std::vector<std::uint32_t> sources;
};

/// The same surface with all points of one label in a cube of edge `cell` (m) drawn into their
/// mean, and without the triangles that vanish so; never more than before. A mean goes with the
/// vertex that is nearest to it. Cost: linear. Source [Rossignac1993]; the labels are ours.
[[nodiscard]] Surface decimated(const Surface& surface, double cell);

/// Chooses how finely the joint is drawn by the time that it takes: coarser when a picture took
/// longer than wished, finer when the finer one is known, or can be expected, to be fast enough.
class DetailChooser {
 public:
  static constexpr std::size_t kLevels = 5;
  /// Edge of the cubes of each level, m; 0: as compiled.
  static constexpr std::array<double, kLevels> kCells{0, 0.8e-3, 1.6e-3, 3.2e-3, 5e-3};
  /// Edge of what is drawn as one pixel, pixels.
  static constexpr std::array<int, kLevels> kPixels{1, 1, 1, 1, 2};

  /// Begins at `level`, so that a slow machine shows something soon.
  explicit DetailChooser(double requested_seconds, std::size_t level = 2)
      : requested_(requested_seconds), level_(level) {}
  [[nodiscard]] std::size_t level() const noexcept { return level_; }
  /// A picture of the present level took so long.
  void note(double seconds) noexcept;

 private:
  double requested_;
  std::size_t level_;
  std::array<double, kLevels> took_{};  // s, 0: not known; of the last picture at each level
  int slow_ = 0;                        // slow pictures in a row
  int fast_ = 0;                        // fast ones
};

}  // namespace artus
