// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/result.h"
#include "artus/detail/soft/cage/tet_locator.h"
#include "artus/detail/soft/solver/deformed_body.h"
#include "artus/detail/soft/solver/soft_solver.h"

namespace artus {

struct SoftBodyParams {
  double fine_cell = 3e-3;      ///< m, under the face; see docs/deformation.md for what it costs
  double near_cell = 3e-3;      ///< m, within `near` of the footprint and down to `near_depth`
  double far_cell = 6e-3;       ///< m, within `far` and down to `far_depth`
  double coarse_cell = 12e-3;   ///< m, beyond
  double fine_margin = 6e-3;    ///< m beyond the footprint
  double fine_depth = 9e-3;     ///< m below the skin
  double near = 6e-3;           ///< m beyond the footprint, sideways
  double near_depth = 21e-3;    ///< m below the skin
  double far = 24e-3;           ///< m beyond the footprint, sideways
  double far_depth = 42e-3;     ///< m below the skin
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
  /// phantoms; nothing holds the tissue; no skin below the pose). Cost: some s for a joint of 1e6
  /// tetrahedra.
  [[nodiscard]] static Result<SoftBody> make(std::shared_ptr<const CompiledJoint> joint,
                                             const Pose& X_JP, const SoftBodyParams& params = {});

  /// Another body in this one's cage, at rest, for who runs several beside each other or one after
  /// the other. As `make` gives it at `cage_pose()`. May be called on several threads. Cost: of a
  /// refresh.
  [[nodiscard]] SoftBody another_at_rest() const;

  /// Goes on from where another body of this joint has its tissue, as far as this cage reaches: a
  /// probe that presses does not feel that the cage is another. Cost: of a refresh; some ms with
  /// the factor that is there, of a state near that one.
  void follow(const DeformedBody& before);
  void follow_with_factor(const DeformedBody& before);

  /// Where a vertex of the joint's mesh is at rest, m, frame J, by its number.
  using RestOf = std::function<Vec3(std::uint32_t)>;
  /// The skin before the face as what was put under it lifts it; empty: as compiled. The tissue
  /// below stays what it was. True where that is another skin than before.
  bool lift_skin(const RestOf& rest_of);

  /// One step (SoftSolver::step) with the probe at `X_JP`, or without one.
  const SoftStep& step(const std::optional<Pose>& X_JP, double dt);
  /// SoftSolver::settle.
  bool settle(const std::optional<Pose>& X_JP, double tolerance = 1e-6, int max_steps = 100);

  /// Moves bones from where they are at rest, each as a rigid body, and lets the tissue follow;
  /// those that are not named are at rest. In `parts`, so that no cube is torn at once. Bones do
  /// not meet each other: where two share a cube the displacement is short. Errors: not_found (no
  /// such bone in the cage), failed (the tissue did not follow: the state is at rest again). Cost:
  /// some s.
  [[nodiscard]] Result<void> move_bones(std::span<const BoneMotion> motions, int parts = 10);

  /// The present state; `before` as in DeformedBody. Cost: some ms.
  [[nodiscard]] std::shared_ptr<const DeformedBody> snapshot(
      const DeformedBody* before = nullptr) const;

  /// m from the face's centre at its first pose to the nearest place that is held.
  [[nodiscard]] double distance_to_held() const;

  /// Force and torque on the probe about its face's centre, frame J.
  [[nodiscard]] ContactForce force_J() const;

  /// SoftSolver::press_at_rest and try_press, frame J.
  [[nodiscard]] FacePress press_at_rest_J() const;
  [[nodiscard]] FacePress try_press_J(const Pose& X_JP) const;
  /// Where the face is, which follows a fast hand late; requires a step with a probe.
  [[nodiscard]] Pose face_pose_J() const { return map_->X_JC * solver_->face_pose(); }

  [[nodiscard]] SoftSolver& solver() noexcept { return *solver_; }
  [[nodiscard]] const SoftSolver& solver() const noexcept { return *solver_; }
  [[nodiscard]] const Pose& cage_pose() const noexcept { return map_->X_JC; }
  [[nodiscard]] const std::shared_ptr<const CompiledJoint>& joint() const noexcept {
    return joint_;
  }

 private:
  SoftBody() = default;
  struct Start;
  [[nodiscard]] static SoftBody begin(std::shared_ptr<const Start> start);

  [[nodiscard]] ContactForce to_J(ContactForce contact) const;
  [[nodiscard]] std::vector<Vec3> nodes_in(const DeformedBody& other) const;
  [[nodiscard]] Result<std::vector<std::uint32_t>> nodes_of(const std::string& bone,
                                                            const TetLocator& locator) const;

  std::shared_ptr<const Start> start_;
  std::shared_ptr<const CompiledJoint> joint_;
  std::shared_ptr<const BodyMap> map_;
  std::unique_ptr<SoftSolver> solver_;
  std::vector<Vec3> lifts_;  // m, frame C, of these; empty: none
};

}  // namespace artus
