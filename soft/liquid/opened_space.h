// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/soft/liquid/opening_field.h"
#include "artus/detail/soft/liquid/sided_cage.h"

namespace artus {

/// A space that is pushed open by liquid: all of its regions together, whichever of them the liquid
/// came into. Tissue follows the flow of one linear elastic field (OpeningField) for as long as it
/// takes: dx/dtau = v(x), so that nothing folds and no wall passes another, however much there is.
/// Liquid is first around the tip and spreads as more comes: v is multiplied by (1 - (r/a)^2)^2, r
/// the distance from the tip as the walls have it and a such that the patch is some millimetres
/// thick, until all of the space is open. Volumes are those of the walls' triangles, so truth,
/// labels and picture agree. Immutable: any number of threads may open it.
class OpenedSpace {
 public:
  /// What presses on the space from outside at a point (m, frame J) of its walls, as a share of
  /// the pressure that its liquid has when nothing does.
  using Press = std::function<double(const Vec3&)>;
  /// Liquid in it.
  struct Filling {
    Vec3 tip = Vec3::Zero();  ///< m, frame J, where it came in
    double volume = 0;        ///< m^3 more than at rest
    Press press;              ///< empty: none
  };

  /// `stop` as in OpeningField. Requires: one of `regions` has interfaces. Cost: one to three
  /// seconds of one thread.
  OpenedSpace(const CompiledJoint& joint, std::vector<RegionId> regions,
              const std::atomic<bool>* stop = nullptr);

  /// All vertices of a mesh once the filling is in, its volume kept to 1e-9 of it where anything
  /// gives way. `mesh`: the joint's, its vertices pushed aside by what was opened before (its own
  /// first, then new ones). Under a press v is multiplied by max(0, lambda - press), lambda such
  /// that the volume is kept: the walls are springs, side by side, and the liquid has one pressure,
  /// so that it goes aside. Requires: volume >= 0. Cost: some tenths of a second.
  [[nodiscard]] std::vector<Vec3> vertices(const TetMesh& mesh, const Filling& filling) const;

  /// Tissue points (m, frame J) carried by the flow of a filling, or back by it: `back` undoes
  /// `forth` to 1e-9 m. `into`: of a point on a wall, the way into its tissue; zero: on none.
  class Flow {
   public:
    [[nodiscard]] SidedCage::Place place_of(const Vec3& p, const Vec3& into) const;
    [[nodiscard]] SidedCage::Place forth(SidedCage::Place place) const;
    [[nodiscard]] SidedCage::Place back(SidedCage::Place place) const;

   private:
    friend class OpenedSpace;
    struct Node {
      Vec3 motion;      // m/Pa
      double from = 0;  // m^2, the square of the tip's distance
      double press = 0;
    };
    [[nodiscard]] Vec3 velocity(const SidedCage::Place& place) const;
    const SidedCage* cage_ = nullptr;
    std::vector<Node> nodes_;
    double reach_ = 0;  // m
    double lambda_ = 1;
    double length_ = 0;  // Pa
    int steps_ = 1;
  };
  /// Of the joint at rest. Cost: as vertices().
  [[nodiscard]] Flow flow(const Filling& filling) const {
    return flow_in(mesh_, places_in(mesh_), filling);
  }

  /// m by which the walls are apart more than at rest where they are most so.
  [[nodiscard]] double largest_opening(const Vec3& tip, double volume) const;
  /// Whether `volume` m^3 open all of the space, as far as it takes.
  [[nodiscard]] bool confines(const Vec3& tip, double volume) const;
  /// m^3 of the space at rest.
  [[nodiscard]] double rest_volume() const;
  /// m^3 within its walls in a mesh as vertices() takes or gives it.
  [[nodiscard]] double volume_in(const TetMesh& mesh) const;
  /// m^3 more than at rest that its shape can take. Two walls of an area A that do not stretch, as
  /// a flat sac blown round, hold 1.2185 (A / pi)^(3/2) ([Paulsen1994], a mylar balloon); a
  /// quarter more is let in, of walls 8 % longer. Fitted: beyond it the tissue around small spaces
  /// is drawn out so much that its layers' volumes change. A joint is more than the recess that a
  /// body has of it.
  [[nodiscard]] double max_volume() const;
  [[nodiscard]] std::span<const RegionId> regions() const noexcept { return regions_; }

 private:
  [[nodiscard]] bool is_in(RegionId region) const { return region < in_.size() && in_[region]; }
  [[nodiscard]] std::vector<SidedCage::Place> places_in(const TetMesh& mesh) const;
  void place_boluses(const TetMesh& mesh, std::vector<bool>& known,
                     std::vector<SidedCage::Place>& places) const;
  void find_places();
  [[nodiscard]] double thickness(const Flow& flow, double volume) const;
  [[nodiscard]] double reach_of(const Flow& flow, double volume) const;
  [[nodiscard]] int steps_for(const Flow& flow) const;
  [[nodiscard]] Flow flow_in(const TetMesh& mesh, std::span<const SidedCage::Place> places,
                             const Filling& filling) const;
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  [[nodiscard]] std::vector<Edge> edges_inside(const TetMesh& mesh) const;
  static void smooth(std::span<const Edge> edges, const TetMesh& mesh, std::vector<Vec3>& moved);
  [[nodiscard]] std::vector<bool> held_in(const TetMesh& mesh) const;
  void put_right(const TetMesh& mesh, std::vector<bool> held, std::vector<Vec3>& moved) const;
  void fill_inside(const TetMesh& mesh, std::vector<Vec3>& moved) const;

  std::vector<RegionId> regions_;
  std::vector<bool> in_;    // by region: of the space
  std::vector<bool> hard_;  // by region
  TetMesh mesh_;            // at rest
  SidedCage cage_;
  OpeningField field_;
  std::vector<SidedCage::Place> places_;  // by vertex at rest; no copy: outside the cage, or inside
  std::vector<SidedCage::Place> wall_places_;  // by the cage's walls, of their middles
  std::vector<bool> inside_;                   // by vertex: the space, off its walls
  std::vector<Edge> edges_;                    // edges_inside of mesh_
};

}  // namespace artus
