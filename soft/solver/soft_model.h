// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "artus/detail/soft/cage/averaging.h"
#include "artus/detail/soft/cage/cage.h"
#include "artus/detail/soft/cage/kernels.h"
#include "artus/detail/soft/cage/layer_map.h"
#include "artus/detail/soft/cage/material.h"
#include "artus/detail/soft/cage/skin_height.h"
#include "artus/detail/soft/solver/cholesky.h"

namespace artus {

/// Directions in which a node is held, frame C.
struct HeldNode {
  std::array<bool, 3> held{};
  [[nodiscard]] bool any() const noexcept { return held[0] || held[1] || held[2]; }
  [[nodiscard]] bool all() const noexcept { return held[0] && held[1] && held[2]; }
};

struct SoftModelParams {
  CageParams cage;
  int samples = 4;          ///< of the field along a cube's edge, even
  double min_share = 0.06;  ///< of a cube that must be tissue; assumed: less is flimsy
  /// Nodes that are held beside those in bone and beyond the meshed part; may be empty.
  std::function<HeldNode(const Vec3& p_C)> held;
};

/// What a displacement does to the body.
struct SoftForces {
  Eigen::VectorXd on_unknowns;  ///< N (3 n_unknowns), by the tissue
  std::vector<Vec3> on_nodes;   ///< N (n_nodes), by the tissue, hanging nodes' shares passed on
  double energy = 0;            ///< J stored
  double min_volume = 1;        ///< smallest J of any integration point, as CellResponse has it
};

/// A share of an unknown node in the displacement of a point.
struct UnknownShare {
  std::uint32_t unknown = 0;
  double weight = 0;
};

/// A body in its cage: cubes with averaged materials, nodes that are free (the unknowns), held or
/// hanging. Knows energy, force and stiffness of a displacement; immutable, no state of its own.
/// Displacements of all nodes are (n_nodes), frame C, m.
class SoftModel {
 public:
  static constexpr std::uint32_t kNotUnknown = std::numeric_limits<std::uint32_t>::max();

  /// Requires: a field whose materials have positive moduli (std::invalid_argument).
  SoftModel(const MaterialField& field, const SoftModelParams& params);

  [[nodiscard]] const Cage& cage() const noexcept { return cage_; }
  [[nodiscard]] std::span<const CellMaterial> materials() const noexcept { return materials_; }
  /// What the cubes hold inside, for DeformedBody.
  [[nodiscard]] const LayerMap& layers() const noexcept { return layers_; }
  /// Where the body begins, for what liquid lifts off it.
  [[nodiscard]] const SkinHeight& skin() const noexcept { return skin_; }
  [[nodiscard]] std::size_t n_unknowns() const noexcept { return unknown_nodes_.size(); }
  [[nodiscard]] std::span<const std::uint32_t> unknown_nodes() const noexcept {
    return unknown_nodes_;
  }
  [[nodiscard]] const NodeGraph& graph() const noexcept { return graph_; }
  [[nodiscard]] const HeldNode& held(std::uint32_t node) const noexcept { return held_[node]; }

  /// Displacements of all nodes from those of the unknowns (3 n_unknowns); held components are
  /// taken from `prescribed` (n_nodes), or are zero when it is empty.
  void expand(const Eigen::VectorXd& unknowns, std::span<const Vec3> prescribed,
              std::vector<Vec3>& u) const;

  /// `targets`: J0 of each cube, or empty: 1. Cost: about 0.2 us a cube.
  void compute_forces(std::span<const Vec3> u, std::span<const double> targets,
                      SoftForces& out) const;

  /// Stiffness of the unknowns around `u`, as cell_tangent has it. Cost: about 20 us a cube.
  void assemble_tangent(std::span<const Vec3> u, std::span<const double> targets,
                        BlockMatrix& out) const;

  [[nodiscard]] Vec3 displacement_at(const CagePlace& place,
                                     std::span<const Vec3> u) const noexcept;

  /// Adds a force at a point to the unknowns' right side.
  void add_force(const CagePlace& place, const Vec3& force, Eigen::VectorXd& on_unknowns) const;

  /// The unknowns that move a point, each once.
  [[nodiscard]] std::vector<UnknownShare> shares_of(const CagePlace& place) const;

  /// Places of the unknowns, frame C.
  [[nodiscard]] std::vector<Vec3> unknown_places() const;

 private:
  void average_materials(const MaterialField& field, int samples);
  void hold_nodes(const MaterialField& field, const SoftModelParams& params);
  void connect();
  template <class Visit>
  void visit_unknowns(std::uint32_t node, Visit visit) const;
  void release_held(BlockMatrix& matrix) const;

  Cage cage_;
  std::vector<CellMaterial> materials_;  // (n_cells)
  std::vector<CellPack> packs_;          // the same, four cubes each
  LayerMap layers_;
  SkinHeight skin_;
  std::vector<HeldNode> held_;                // (n_nodes)
  std::vector<std::uint32_t> unknown_of_;     // (n_nodes)
  std::vector<std::uint32_t> unknown_nodes_;  // (n_unknowns)
  NodeGraph graph_;
};

}  // namespace artus
