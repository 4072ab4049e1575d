// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "artus/detail/soft/solver/face_contact.h"
#include "artus/detail/soft/solver/soft_model.h"

namespace artus {

/// A force on a point of the body.
struct PointLoad {
  Vec3 p_rest = Vec3::Zero();  ///< m, frame C
  Vec3 force = Vec3::Zero();   ///< N, frame C
};

/// A weighted sum of displacements that must have a value, held by one unknown force or pressure:
/// sum over terms of term.force . u(term.p_rest) = value, by the forces `multiplier * term.force`.
/// One term of unit length: a point held along a line (value m, multiplier N). The walls of a space
/// with their normals times their areas: its change of volume (value m^3, multiplier Pa). For a
/// volume that is not linear in u the caller gives value = wanted - now + (the sum now) each step.
struct SoftConstraint {
  std::vector<PointLoad> terms;
  double value = 0;
};

struct SoftSolverParams {
  double relaxation = 0.05;     ///< s, time in which tissue follows a load to 63 %; assumed: a tent
                                ///< falls to a tenth within 0.15 s
  double step_limit = 0.5e-3;   ///< m a node may move in one step beyond what the face moves
  double probe_advance = 1e-3;  ///< m the face may move in one step; a faster hand is followed late
  double probe_turn = 0.05;     ///< rad the same
  double most_force = 40;       ///< N that the face presses with at most: what a device's hand gets
                                ///< at most; a hand that is deeper leaves the face behind
  double min_volume = 0.02;     ///< of any point; a step that squeezes more is halved, at last
                                ///< taken back
  int bad_steps = 3;            ///< in a row after which the body starts again from rest
};

/// What a step did; bits of SoftStatus.
enum SoftStatus : std::uint32_t {
  kSoftOk = 0,
  kSoftLagging = 1,    ///< the face is not yet where the hand is
  kSoftLimited = 2,    ///< a node's step was cut
  kSoftTakenBack = 4,  ///< the step was not finite or squeezed too much: the last state stands
  kSoftRestarted = 8,  ///< back to rest after several such steps
  kSoftOutside = 16,   ///< the face presses where the contact does not reach
  kSoftNoFactor = 32,  ///< the tangent was not positive definite; the one before is used
  kSoftHeldOff = 64,   ///< the face stays off the hand, which would press with more than most_force
};

struct SoftStep {
  std::uint32_t status = kSoftOk;
  double residual = 0;      ///< N, norm of the unbalanced force before the step
  double largest_move = 0;  ///< m
  double min_volume = 1;
  ContactForce contact;
};

/// A model and a factor of its tangent, which do not change.
struct FactoredModel {
  std::shared_ptr<const SoftModel> model;
  std::shared_ptr<const Cholesky> factor;
};

/// The body as it gives way: displacement of the nodes, forces of the face, and the factor of a
/// tangent that is refreshed when asked. Quasi-static with one relaxation time: a step of dt goes
/// the share 1 - exp(-dt/tau) of the displacement. Quasi-Newton: the factor may be older than the
/// state. The state is finite always. One thread; the same calls give the same bytes.
class SoftSolver {
 public:
  /// `contact_unknowns`: those that a face may press (contact_unknowns below), ascending.
  SoftSolver(std::shared_ptr<const SoftModel> model, std::vector<std::uint32_t> contact_unknowns,
             const SoftSolverParams& params = {});

  void set_face(SkinPatch skin, const ProbeFace& face);
  /// FaceContact::set_lifts, from the next step on. Requires: a face.
  void set_skin_lifts(std::vector<Vec3> lifts);
  /// Forces from outside: of a needle, of a fluid on the walls of its space. They may change from
  /// step to step; those at held nodes go to what holds them.
  void set_loads(std::vector<PointLoad> loads);
  /// What must be displaced by how much; replaces all constraints and forgets their multipliers.
  /// Their columns of the compliance are computed here and with each refresh: some ms each. Ends a
  /// refresh that is under way.
  void set_constraints(std::vector<SoftConstraint> constraints);
  /// A new value of one constraint: costs nothing. Requires: an index of set_constraints.
  void set_constraint_value(std::size_t index, double value);
  /// The force or pressure that holds a constraint, and what its sum is now.
  [[nodiscard]] double multiplier(std::size_t index) const;
  [[nodiscard]] double constraint_sum(std::size_t index) const;
  /// Compliance of the constraints, (n, n): what the sum of row i becomes by a multiplier 1 of
  /// column j, all else free.
  [[nodiscard]] const Eigen::MatrixXd& constraint_compliance() const noexcept {
    return columns_.compliance;
  }
  /// J0 of each cube; empty: 1. Requires: one for each cube.
  void set_targets(std::vector<double> targets);
  /// Where held nodes are (n_nodes), m: bones that moved. Requires: one for each node.
  void set_prescribed(std::vector<Vec3> prescribed);

  /// Factor of the tangent at the present state. False when it is not positive definite: the old
  /// one stays.
  bool refresh();

  /// The same in a thread of its own: `begin_refresh` takes the present state and returns at once,
  /// `end_refresh` waits for the factor and takes it. Between them the solver may step. Which step
  /// first uses a factor is thus the caller's choice, never a matter of speed.
  void begin_refresh();
  bool end_refresh();
  [[nodiscard]] bool refreshing() const noexcept { return pending_.valid(); }

  /// One quasi-Newton step toward the face at `X_CP` (none: no probe), `dt` (s) after the last one;
  /// infinite: without relaxation.
  const SoftStep& step(const std::optional<Pose>& X_CP, double dt);

  /// Steps without relaxation, refreshing before each, until the displacement left is below
  /// `tolerance` (m) at every node. A step that turns back on the one before goes half as far,
  /// since between two states of contact whole ones may go to and fro for ever. False when
  /// `max_steps` are not enough.
  bool settle(const std::optional<Pose>& X_CP, double tolerance = 1e-7, int max_steps = 200);

  [[nodiscard]] std::span<const Vec3> displacements() const noexcept { return u_; }
  [[nodiscard]] const SoftStep& last() const noexcept { return last_; }
  [[nodiscard]] const SoftForces& forces() const noexcept { return forces_; }
  [[nodiscard]] const SoftModel& model() const noexcept { return *model_; }
  [[nodiscard]] const Cholesky& factor() const noexcept { return *factor_; }
  /// Both, for another thread: they stay as they are while somebody holds them.
  [[nodiscard]] FactoredModel factored() const noexcept { return {model_, factor_}; }
  /// What the face would press with if the tissue came to rest under it as it is now, by the last
  /// step's tangent. Zero without one.
  [[nodiscard]] FacePress press_at_rest() const;
  /// The same of a face at `X_CP` that is not there. Requires: a face. Cost: some ms.
  [[nodiscard]] FacePress try_press(const Pose& X_CP) const;
  [[nodiscard]] const FaceContact* contact() const noexcept { return contact_.get(); }
  [[nodiscard]] const Pose& face_pose() const noexcept { return X_CP_; }
  /// How far the face is short of the hand along its z, m; see most_force.
  [[nodiscard]] double held_off() const noexcept { return held_off_; }

  /// Sum of the forces that hold the body, N, frame C, at the present state.
  [[nodiscard]] Vec3 reaction() const;

  void reset();  ///< to rest, without probe
  /// Goes on from displacements of the nodes (n_nodes), m, without probe: those of a body that was
  /// in another cage. From rest where they cannot be: not finite, or a cube squeezed to nothing.
  void start_from(std::span<const Vec3> displacements);
  /// The same with the factor that is there, of a state near this one. Cost: some ms.
  void go_on_from(std::span<const Vec3> displacements);

 private:
  /// K^-1 g of each constraint and g^T K^-1 g of all, by one factor.
  struct Columns {
    Eigen::MatrixXd by_load;     // (3 n_unknowns, n)
    Eigen::MatrixXd compliance;  // (n, n)
  };
  const SoftStep& go(const std::optional<Pose>& X_CP, double alpha);
  [[nodiscard]] Pose advance(const Pose& target, std::uint32_t& status) const;
  [[nodiscard]] Pose hold_off(const Pose& hand, std::uint32_t& status);
  void lift_face() noexcept;
  [[nodiscard]] Columns columns_of(const Cholesky& factor) const;
  void hold_constraints(double alpha, Eigen::VectorXd& r);
  void solve_root(bool pressed, double alpha, Eigen::VectorXd& r, Eigen::VectorXd& pull);
  void evaluate();
  [[nodiscard]] bool place(std::span<const Vec3> displacements);
  bool make_factor(std::span<const Vec3> u, std::span<const double> targets);
  void take_factor();
  [[nodiscard]] bool stands() const;
  [[nodiscard]] double apply(const Eigen::VectorXd& path, double alpha, const Eigen::VectorXd& pull,
                             double limit, std::uint32_t& status);
  void take_back(const Eigen::VectorXd& x, std::uint32_t& status);

  std::shared_ptr<const SoftModel> model_;
  SoftSolverParams params_;
  std::vector<std::uint32_t> root_;
  std::shared_ptr<Cholesky> factor_;
  std::shared_ptr<Cholesky> spare_;
  std::unique_ptr<FaceContact> contact_;
  Eigen::MatrixXf root_inverse_;
  Eigen::MatrixXf spare_inverse_;
  std::vector<PointLoad> loads_;
  std::vector<CagePlace> load_places_;
  std::vector<SoftConstraint> constraints_;
  Eigen::MatrixXd constraint_loads_;  // (3 n_unknowns, n)
  Eigen::VectorXd multipliers_;
  Columns columns_;
  Columns spare_columns_;
  std::vector<double> targets_;
  std::vector<Vec3> prescribed_;
  Eigen::VectorXd x_;    // (3 n_unknowns) displacement
  std::vector<Vec3> u_;  // (n_nodes)
  SoftForces forces_;
  Pose X_CP_ = Pose::Identity();
  bool touching_ = false;  // X_CP_ is where the face was
  double held_off_ = 0;    // m along the face's z that it is short of the hand
  int bad_ = 0;
  SoftStep last_;
  std::future<bool> pending_;  // the last member: it ends before what it works on
};

/// The unknowns that move the skin inside a box of frame C, ascending: what a face may press there.
[[nodiscard]] std::vector<std::uint32_t> contact_unknowns(const SoftModel& model,
                                                          const SkinPatch& skin, const Vec3& low,
                                                          const Vec3& high);

}  // namespace artus
