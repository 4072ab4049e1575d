// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "artus/anatomy/compiled_joint.h"

namespace artus {

/// How a cleft opens; assumed: all of it. A plate held at its rim, h = h0 (1 - (r/a)^2)^2, around
/// the tip, over the area that it has where nothing keeps the cleft shut: beside a rim or bone it
/// reaches farther.
struct OpeningParams {
  double fill = 3e-6;       ///< m^3 at which the fluid has come to its widest
  double widest = 29.5e-3;  ///< m, radius of the patch there; fitted: 5 ml open by less than 6 mm
  double rim = 4e-3;        ///< m from the cleft's own rim over which it stays shut; of a space
                            ///< too small for that a half, or a quarter
  double spread = 20e-3;    ///< m above the roof at which the lift is twice as wide
};

/// A thin space between a roof and a floor that is pushed open by a volume: the roof and what lies
/// on it are lifted, the floor stays, and what lies between is drawn out, so that no wall folds
/// over another. The lift spreads upward so that the same volume passes every level: what lies
/// above keeps its volume. The walls lie along a sphere fitted to them, which suits a bursa on a
/// head as well as a flat one; where they are none, as of a thick recess, along a plane. Of a space
/// that lies over itself the sheet around the tip opens. Volumes are those of the region's
/// triangles, so truth, labels and picture agree.
class InflatedSpace {
 public:
  /// `tip`: m, frame J, where the liquid comes in. Requires: a region with interfaces.
  InflatedSpace(const CompiledJoint& joint, RegionId region, const Vec3& tip,
                const OpeningParams& params = {});

  /// What presses on the space from outside at a point (m, frame J) of its middle, as a share of
  /// the pressure that its liquid has when nothing does.
  using Press = std::function<double(const Vec3&)>;

  /// All vertices of the joint's mesh with `volume` m^3 more in the space, to 1e-15 m^3. Under
  /// `press` what opens by h when nothing presses opens by h max(0, lambda - press), lambda such
  /// that the volume is kept: the walls are springs, side by side, and the liquid has one pressure
  /// (lambda of what it had), so that it goes aside. Requires: volume >= 0. Cost: some passes over
  /// the vertices.
  [[nodiscard]] std::vector<Vec3> vertices(double volume, const Press& press = {}) const;

  /// m by which the walls are apart more than at rest where they are most so.
  [[nodiscard]] double largest_opening(double volume) const;
  /// Whether the space is too small for the patch that `volume` m^3 would open in a wide one: then
  /// all of it opens, as far as it takes.
  [[nodiscard]] bool confines(double volume) const;
  /// m^3 of the space at rest.
  [[nodiscard]] double rest_volume() const noexcept { return rest_volume_; }

 private:
  struct Lift {
    std::uint32_t vertex;
    Vec3 direction;  // unit
    double r;        // m along the sphere from the tip's direction, already drawn together
    double share;    // of the lift at the roof
    double u;        // m, where on the map that is
    double v;
  };
  [[nodiscard]] std::optional<Vec3> find_centre(const Vec3& tip) const;
  [[nodiscard]] Vec3 find_normal(const Vec3& tip) const;
  /// Where the walls' centre lies from the tip, m, and the direction in which they open.
  struct Frame {
    Vec3 to_centre;
    Vec3 toward;
  };
  void set_frame(const CompiledJoint& joint, const Vec3& tip, const Frame& frame);
  [[nodiscard]] double extent(const Vec3& tip) const;
  void choose_frame(const CompiledJoint& joint, const Vec3& tip);
  [[nodiscard]] double middle(int i) const;
  [[nodiscard]] int cell_of(double x) const;
  [[nodiscard]] std::size_t at(int u, int v) const;
  [[nodiscard]] double widest() const { return cells_ * cell_ / 2; }  // m, half of the map
  using Span = std::array<double, 2>;  // m, heights of a floor and a roof
  [[nodiscard]] std::vector<std::vector<Span>> find_spans() const;
  void map_walls();
  void smooth_walls();
  [[nodiscard]] std::vector<bool> find_bone(const CompiledJoint& joint) const;
  [[nodiscard]] bool find_shut(const CompiledJoint& joint);
  void find_lifts();
  [[nodiscard]] Vec3 polar(const Vec3& p) const;
  [[nodiscard]] Vec3 place_of(double u, double v, double height) const;
  [[nodiscard]] double between(const std::vector<double>& map, double u, double v) const;
  [[nodiscard]] double radius(double volume) const;
  [[nodiscard]] double open_area(double radius, bool everywhere) const;
  /// By how much each lift goes up.
  [[nodiscard]] std::vector<double> heights(double height, double radius) const;
  [[nodiscard]] std::vector<double> squeezed(double volume, const std::vector<double>& rested,
                                             const Press& press) const;
  [[nodiscard]] std::vector<Vec3> lifted(const std::vector<double>& heights) const;
  [[nodiscard]] double opened_by(const std::vector<double>& heights) const;
  [[nodiscard]] double height_for(double volume) const;
  [[nodiscard]] double volume_of(const std::vector<Vec3>& vertices) const;

  OpeningParams params_;
  std::vector<Vec3> rest_;                               // m, frame J
  std::vector<std::array<std::uint32_t, 3>> triangles_;  // of the space, normals outward
  Vec3 centre_ = Vec3::Zero();
  Vec3 up_ = Vec3::UnitZ();  // from the centre through the tip, away from the floor or toward it
  Vec3 side_ = Vec3::UnitX();
  double sphere_ = 1;  // m
  double sign_ = 1;    // 1: the roof is farther from the centre than the floor
  double rest_volume_ = 0;
  int cells_ = 0;               // of the map of walls, along each side
  double cell_ = 0;             // m
  double rim_ = 0;              // m, over which it stays shut
  std::vector<bool> bone_;      // by vertex
  std::vector<bool> open_;      // by cell: the sheet around the tip is there
  std::vector<double> floor_;   // m, its height, also beside the sheet
  std::vector<double> roof_;    // m
  std::vector<double> inside_;  // 0 at the rim .. 1
  std::vector<Lift> lifts_;
};

}  // namespace artus
