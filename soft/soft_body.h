// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "artus/anatomy/body/compiled_joint.h"
#include "artus/core/result.h"
#include "artus/soft/deformed_body.h"
#include "artus/soft/soft_solver.h"

namespace artus {

struct SoftBodyParams {
  double fine_cell = 3e-3;      ///< m, under the face; see docs/deformation.md for what it costs
  double near_cell = 3e-3;      ///< m, within `near` of the footprint and down to `near_depth`
  double far_cell = 6e-3;       ///< m, within `far` and down to `far_depth`
  double coarse_cell = 12e-3;   ///< m, beyond
  double fine_margin = 6e-3;    ///< m beyond the footprint
  double fine_depth = 9e-3;     ///< m below the skin
  double near = 12e-3;          ///< m beyond the footprint, sideways
  double near_depth = 27e-3;    ///< m below the skin
  double far = 30e-3;           ///< m beyond the footprint, sideways
  double far_depth = 48e-3;     ///< m below the skin
  double reach = 6e-3;          ///< m beyond the footprint that the face may slide
  double poisson_ratio = 0.47;  ///< numerical; see make_soft_material
  double inset = 0.3;           ///< of a cube, by which the face's points stand in from its edges
  ProbeFace face;
  SoftSolverParams solver;
};

/// A joint that gives way: its cage around a probe pose, and the solver of its state. Frame C of
/// the cage is the probe's frame at that pose, so that the cubes lie along the footprint. Not
/// thread safe; snapshots are immutable and may be read by any number of threads.
class SoftBody {
 public:
  /// `X_JP`: the pose around which the cage is fine. Errors: invalid (no tetrahedra, as in
  /// phantoms; no skin below the pose). Cost: some s for a joint of 1e6 tetrahedra.
  [[nodiscard]] static Result<SoftBody> make(std::shared_ptr<const CompiledJoint> joint,
                                             const Pose& X_JP, const SoftBodyParams& params = {});

  /// One step (SoftSolver::step) with the probe at `X_JP`, or without one.
  const SoftStep& step(const std::optional<Pose>& X_JP, double dt);
  /// SoftSolver::settle.
  bool settle(const std::optional<Pose>& X_JP, double tolerance = 1e-6, int most_steps = 100);

  /// The present state. Cost: some ms.
  [[nodiscard]] std::shared_ptr<const DeformedBody> snapshot() const;

  /// Force and torque on the probe about its face's centre, frame J.
  [[nodiscard]] ContactForce force_J() const;

  [[nodiscard]] SoftSolver& solver() noexcept { return *solver_; }
  [[nodiscard]] const SoftSolver& solver() const noexcept { return *solver_; }
  [[nodiscard]] const Pose& cage_pose() const noexcept { return map_->X_JC; }
  [[nodiscard]] const std::shared_ptr<const CompiledJoint>& joint() const noexcept {
    return joint_;
  }

 private:
  SoftBody() = default;

  std::shared_ptr<const CompiledJoint> joint_;
  std::shared_ptr<const BodyMap> map_;
  std::unique_ptr<SoftSolver> solver_;
};

}  // namespace artus
