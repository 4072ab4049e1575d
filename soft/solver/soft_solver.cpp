// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/soft_solver.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

using Index = Eigen::Index;

constexpr int kHalvings = 4;           // of a step that is too long, before it is taken back
constexpr double kHeldOffShare = 0.5;  // of the way to the greatest force that a step goes
constexpr double kOvershoot = 0.5;     // of the pull that a step takes up may point back at its end

Eigen::VectorXd root_of(const Eigen::VectorXd& x, const std::vector<std::uint32_t>& root) {
  Eigen::VectorXd part(static_cast<Index>(3 * root.size()));
  for (std::size_t k = 0; k < root.size(); ++k)
    part.segment<3>(static_cast<Index>(3 * k)) = x.segment<3>(3 * static_cast<Index>(root[k]));
  return part;
}

}  // namespace

SoftSolver::SoftSolver(std::shared_ptr<const SoftModel> model,
                       std::vector<std::uint32_t> contact_unknowns, const SoftSolverParams& params)
    : model_(std::move(model)), params_(params), root_(std::move(contact_unknowns)) {
  const Dissection plan = dissect(model_->graph(), model_->unknown_places(), root_);
  factor_ = std::make_shared<Cholesky>(plan);
  spare_ = std::make_shared<Cholesky>(plan);
  reset();
}

void SoftSolver::reset() {
  x_ = Eigen::VectorXd::Zero(static_cast<Index>(3 * model_->n_unknowns()));
  lift_face();
  multipliers_.setZero();
  bad_ = 0;
  last_ = {};
  evaluate();
  refresh();
}

/// Whether the body can be there.
bool SoftSolver::place(std::span<const Vec3> displacements) {
  ARTUS_REQUIRE(displacements.size() == u_.size(), "one displacement for each node");
  if (refreshing()) end_refresh();
  const auto unknown = model_->unknown_nodes();
  for (std::size_t i = 0; i < unknown.size(); ++i)
    x_.segment<3>(static_cast<Index>(3 * i)) = displacements[unknown[i]];
  lift_face();
  bad_ = 0;
  last_ = {};
  evaluate();
  return forces_.on_unknowns.allFinite() && forces_.min_volume >= params_.min_volume;
}

void SoftSolver::start_from(std::span<const Vec3> displacements) {
  if (!place(displacements) || !refresh()) reset();
}

void SoftSolver::go_on_from(std::span<const Vec3> displacements) {
  if (!place(displacements)) reset();
}

void SoftSolver::set_face(SkinPatch skin, const ProbeFace& face) {
  contact_ = std::make_unique<FaceContact>(model_, std::move(skin), face, root_);
  lift_face();
}

void SoftSolver::set_skin_lifts(std::vector<Vec3> lifts) {
  ARTUS_REQUIRE(contact_ != nullptr, "a face is needed");
  contact_->set_lifts(std::move(lifts));
}

void SoftSolver::set_loads(std::vector<PointLoad> loads) {
  loads_ = std::move(loads);
  load_places_.clear();
  for (const PointLoad& load : loads_)
    load_places_.push_back(model_->cage().locate(load.p_rest, 2));
}

void SoftSolver::set_constraints(std::vector<SoftConstraint> constraints) {
  if (refreshing()) end_refresh();
  constraints_ = std::move(constraints);
  const auto n = static_cast<Index>(constraints_.size());
  constraint_loads_ = Eigen::MatrixXd::Zero(x_.size(), n);
  for (Index k = 0; k < n; ++k) {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(x_.size());
    for (const PointLoad& term : constraints_[static_cast<std::size_t>(k)].terms)
      model_->add_force(model_->cage().locate(term.p_rest, 2), term.force, load);
    constraint_loads_.col(k) = load;
  }
  multipliers_ = Eigen::VectorXd::Zero(n);
  columns_ = columns_of(*factor_);
}

void SoftSolver::set_constraint_value(std::size_t index, double value) {
  ARTUS_REQUIRE(index < constraints_.size(), "a constraint that is there");
  constraints_[index].value = value;
}

double SoftSolver::multiplier(std::size_t index) const {
  ARTUS_REQUIRE(index < constraints_.size(), "a constraint that is there");
  return multipliers_[static_cast<Index>(index)];
}

double SoftSolver::constraint_sum(std::size_t index) const {
  ARTUS_REQUIRE(index < constraints_.size(), "a constraint that is there");
  double sum = 0;
  for (const PointLoad& term : constraints_[index].terms)
    sum += term.force.dot(model_->displacement_at(model_->cage().locate(term.p_rest, 2), u_));
  return sum;
}

SoftSolver::Columns SoftSolver::columns_of(const Cholesky& factor) const {
  Columns columns;
  columns.by_load = constraint_loads_;
  for (Index k = 0; k < columns.by_load.cols(); ++k) {
    Eigen::VectorXd x = columns.by_load.col(k);
    factor.solve(x);
    columns.by_load.col(k) = x;
  }
  const Eigen::MatrixXd product = constraint_loads_.transpose() * columns.by_load;
  columns.compliance = 0.5 * (product + product.transpose());
  return columns;
}

/// Changes the multipliers so that this step brings each constraint to its value, as far as contact
/// stays as it is; what contact then changes the next step takes out.
void SoftSolver::hold_constraints(double alpha, Eigen::VectorXd& r) {
  if (constraints_.empty()) return;
  r += constraint_loads_ * multipliers_;
  Eigen::VectorXd missing = -alpha * (columns_.by_load.transpose() * r);
  for (std::size_t k = 0; k < constraints_.size(); ++k)
    missing[static_cast<Index>(k)] += constraints_[k].value - constraint_sum(k);
  const Eigen::VectorXd change = (alpha * columns_.compliance).ldlt().solve(missing);
  if (!change.allFinite()) return;
  multipliers_ += change;
  r += constraint_loads_ * change;
}

void SoftSolver::set_targets(std::vector<double> targets) {
  ARTUS_REQUIRE(targets.empty() || targets.size() == model_->cage().cells().size(),
                "one target for each cube");
  targets_ = std::move(targets);
  evaluate();
}

void SoftSolver::set_prescribed(std::vector<Vec3> prescribed) {
  ARTUS_REQUIRE(prescribed.size() == model_->cage().nodes().size(), "one place for each node");
  prescribed_ = std::move(prescribed);
  evaluate();
}

void SoftSolver::evaluate() {
  model_->expand(x_, prescribed_, u_);
  model_->compute_forces(u_, targets_, forces_);
}

bool SoftSolver::make_factor(std::span<const Vec3> u, std::span<const double> targets) {
  BlockMatrix tangent(model_->graph());
  model_->assemble_tangent(u, targets, tangent);
  if (spare_.use_count() > 1) spare_ = std::make_shared<Cholesky>(*spare_);  // held elsewhere
  std::atomic_thread_fence(std::memory_order_acquire);  // after what its last holder read
  if (!spare_->factorize(tangent)) return false;
  spare_inverse_ = spare_->root_inverse().cast<float>();
  spare_columns_ = columns_of(*spare_);
  return true;
}

void SoftSolver::take_factor() {
  std::swap(factor_, spare_);
  std::swap(root_inverse_, spare_inverse_);
  std::swap(columns_, spare_columns_);
}

bool SoftSolver::refresh() {
  if (refreshing()) end_refresh();
  if (!make_factor(u_, targets_)) return false;
  take_factor();
  return true;
}

void SoftSolver::begin_refresh() {
  if (refreshing()) end_refresh();
  pending_ = std::async(std::launch::async,
                        [this, u = u_, targets = targets_] { return make_factor(u, targets); });
}

bool SoftSolver::end_refresh() {
  if (!refreshing() || !pending_.get()) return false;
  take_factor();
  return true;
}

void SoftSolver::lift_face() noexcept {
  if (contact_) contact_->release();
  touching_ = false;
  held_off_ = 0;
}

/// Where the face may be: short of the hand by what the tissue's stiffness says that it presses too
/// hard, and back at the hand as the force allows.
Pose SoftSolver::hold_off(const Pose& hand, std::uint32_t& status) {
  if (!touching_) return hand;
  const Vec3 into = hand.linear().col(2);
  const double excess = -contact_->force_at_rest().force.dot(into) - params_.most_force;
  if (excess <= 0 && held_off_ == 0) return hand;
  const double stiffness = contact_->stiffness_at_rest();
  const double change = stiffness > 0 ? kHeldOffShare * excess / stiffness : -params_.probe_advance;
  // No deeper while it presses too hard, however fast the hand is.
  if (excess > 0)
    held_off_ = std::max(held_off_, into.dot(hand.translation() - X_CP_.translation()));
  held_off_ =
      std::max(0.0, held_off_ + std::clamp(change, -params_.probe_advance, params_.probe_advance));
  if (held_off_ > 0) status |= kSoftHeldOff;
  Pose face = hand;
  face.translation() -= held_off_ * into;
  return face;
}

/// The face follows the hand by as much as one step can take in.
Pose SoftSolver::advance(const Pose& target, std::uint32_t& status) const {
  if (!touching_) return target;
  const Vec3 offset = target.translation() - X_CP_.translation();
  const Eigen::AngleAxisd turn(X_CP_.linear().transpose() * target.linear());
  const double share = std::min({1.0, params_.probe_advance / std::max(offset.norm(), 1e-12),
                                 params_.probe_turn / std::max(std::abs(turn.angle()), 1e-12)});
  if (share >= 1) return target;
  status |= kSoftLagging;
  Pose pose = X_CP_;
  pose.translation() += share * offset;
  pose.rotate(Eigen::AngleAxisd(share * turn.angle(), turn.axis()));
  return pose;
}

/// Whether the state is one to go on from.
bool SoftSolver::stands() const {
  return std::isfinite(forces_.energy) && forces_.on_unknowns.allFinite() &&
         forces_.min_volume >= params_.min_volume;
}

/// Goes the share `alpha` of `displacement`, but no node farther than `limit`, and half as far as
/// long as it squeezes too much or goes beyond where nothing pulls along it any more: stretched
/// fibres and crushed tissue are stiffer than the tangent knows, and whole steps would go to and
/// fro. `pull`: the forces that `displacement` balances by the tangent, N.
double SoftSolver::apply(const Eigen::VectorXd& offset, double alpha, const Eigen::VectorXd& pull,
                         double limit, std::uint32_t& status) {
  const Eigen::VectorXd step = alpha * offset;
  double largest = 0;
  for (Index i = 0; i < step.size(); i += 3) largest = std::max(largest, step.segment<3>(i).norm());
  if (!std::isfinite(largest)) return largest;
  double share = 1;
  if (largest > limit) {
    share = limit / largest;
    status |= kSoftLimited;
  }
  const Eigen::VectorXd before = x_;
  const Eigen::VectorXd outer = pull - forces_.on_unknowns;
  const double least = -kOvershoot * alpha * step.dot(pull);
  for (int k = 0; k <= kHalvings; ++k) {
    if (k > 0) {
      share *= 0.5;
      status |= kSoftLimited;
    }
    x_ = before + share * step;
    evaluate();
    if (stands() && step.dot(outer + forces_.on_unknowns) >= least) break;
  }
  return largest * share;
}

void SoftSolver::take_back(const Eigen::VectorXd& x, std::uint32_t& status) {
  status |= kSoftTakenBack;
  x_ = x;
  evaluate();
  if (++bad_ < params_.bad_steps) return;
  reset();
  status |= kSoftRestarted;
}

/// The root's nodes between forward and backward substitution, with what contact changes, which it
/// adds to `pull`.
void SoftSolver::solve_root(bool pressed, double alpha, Eigen::VectorXd& r, Eigen::VectorXd& pull) {
  const auto n = static_cast<std::size_t>(root_inverse_.rows());
  if (n == 0) return;
  const SoftKernels& kernels = soft_kernels();
  const Eigen::VectorXf load = root_of(r, root_).cast<float>();
  Eigen::VectorXf moved = Eigen::VectorXf::Zero(load.size());
  kernels.multiply(root_inverse_.data(), n, n, load.data(), moved.data());
  if (pressed) {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(load.size());
    const Eigen::VectorXd free = moved.cast<double>();
    contact_->settle(free, u_);
    contact_->solve(free, u_, alpha, change);
    for (std::size_t k = 0; k < root_.size(); ++k)
      pull.segment<3>(3 * static_cast<Index>(root_[k])) +=
          change.segment<3>(static_cast<Index>(3 * k));
    const Eigen::VectorXf by = change.cast<float>();
    for (std::size_t k = 0; k < n; k += 3) {  // most of the root's nodes are not touched
      if (by.segment<3>(static_cast<Index>(k)).squaredNorm() > 0)
        kernels.multiply(root_inverse_.data() + n * k, n, 3, by.data() + k, moved.data());
    }
  }
  for (std::size_t k = 0; k < root_.size(); ++k)
    r.segment<3>(3 * static_cast<Index>(root_[k])) =
        moved.segment<3>(static_cast<Index>(3 * k)).cast<double>();
}

const SoftStep& SoftSolver::step(const std::optional<Pose>& X_CP, double dt) {
  return go(X_CP, 1 - std::exp(-dt / params_.relaxation));
}

/// A step by the share `alpha` of its displacement.
const SoftStep& SoftSolver::go(const std::optional<Pose>& X_CP, double alpha) {
  SoftStep out;
  const Eigen::VectorXd before = x_;
  const Eigen::VectorXd multipliers = multipliers_;
  Eigen::VectorXd r = forces_.on_unknowns;
  for (std::size_t k = 0; k < loads_.size(); ++k)
    model_->add_force(load_places_[k], loads_[k].force, r);
  double advanced = 0;
  const bool pressed = X_CP && contact_;
  if (pressed) {
    const Pose next = advance(hold_off(*X_CP, out.status), out.status);
    const Pose from = touching_ ? X_CP_ : next;
    advanced = (next.translation() - from.translation()).norm();
    contact_->prepare(u_, next, from);
    contact_->condense(root_inverse_);
    contact_->add_forces(r);
    X_CP_ = next;
    touching_ = true;
  } else {
    lift_face();
  }
  hold_constraints(alpha, r);
  out.residual = r.norm();
  Eigen::VectorXd pull = r;
  factor_->forward(r);
  solve_root(pressed, alpha, r, pull);
  if (pressed) {
    out.contact = contact_->force();
    if (out.contact.outside) out.status |= kSoftOutside;
  }
  factor_->backward(r);
  out.largest_move = apply(r, alpha, pull, params_.step_limit + 2 * advanced, out.status);
  out.min_volume = forces_.min_volume;
  if (!std::isfinite(out.largest_move) || !stands()) {
    multipliers_ = multipliers;
    take_back(before, out.status);
  } else {
    bad_ = 0;
  }
  last_ = out;
  return last_;
}

bool SoftSolver::settle(const std::optional<Pose>& X_CP, double tolerance, int max_steps) {
  constexpr double kMinShare = 0.25;
  double share = 1;
  Eigen::VectorXd last_step = Eigen::VectorXd::Zero(x_.size());
  for (int k = 0; k < max_steps; ++k) {
    const bool fresh = refresh();
    const Eigen::VectorXd before = x_;
    const double held_off = held_off_;
    const SoftStep& s = go(X_CP, share);
    if (!fresh) last_.status |= kSoftNoFactor;
    if (std::abs(held_off_ - held_off) < tolerance &&
        (s.status & (kSoftLagging | kSoftLimited | kSoftTakenBack)) == 0 &&
        s.largest_move < share * tolerance)
      return true;
    const Eigen::VectorXd offset = x_ - before;
    const double along = offset.dot(last_step);
    const double turns = 0.2 * offset.norm() * last_step.norm();
    if (along < -turns) {
      share = std::max(kMinShare, 0.5 * share);
    } else if (along > turns) {
      share = std::min(1.0, 1.5 * share);
    }
    last_step = offset;
  }
  return false;
}

FacePress SoftSolver::press_at_rest() const {
  if (!contact_ || !touching_) return {};
  return {contact_->force_at_rest(), contact_->stiffness_at_rest()};
}

FacePress SoftSolver::try_press(const Pose& X_CP) const {
  ARTUS_REQUIRE(contact_ != nullptr, "a face is needed");
  FaceContact face = *contact_;
  face.release();
  face.prepare(u_, X_CP, X_CP);
  face.condense(root_inverse_);
  face.settle(Eigen::VectorXd::Zero(root_inverse_.rows()), u_);
  return {face.force_at_rest(), face.stiffness_at_rest()};
}

Vec3 SoftSolver::reaction() const {
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t n = 0; n < u_.size(); ++n) {
    if (!model_->cage().masters(n).empty()) continue;
    const HeldNode& hold = model_->held(n);
    for (int k = 0; k < 3; ++k) {
      if (hold.held[static_cast<std::size_t>(k)]) sum[k] -= forces_.on_nodes[n][k];
    }
  }
  return sum;
}

std::vector<std::uint32_t> contact_unknowns(const SoftModel& model, const SkinPatch& skin,
                                            const Vec3& low, const Vec3& high) {
  std::vector<std::uint32_t> all;
  const auto take = [&](const Vec3& p) {
    if ((p - low).minCoeff() < 0 || (high - p).minCoeff() < 0) return;
    for (const UnknownShare& s : model.shares_of(model.cage().locate(p, 2)))
      all.push_back(s.unknown);
  };
  // Points along the triangles, nearer to each other than any cube is large.
  const double spacing = 0.5 * model.cage().finest();
  for (const auto& [ia, ib, ic] : skin.triangles) {
    const Vec3 ab = skin.vertices[ib] - skin.vertices[ia];
    const Vec3 ac = skin.vertices[ic] - skin.vertices[ia];
    const int n =
        1 + static_cast<int>(std::max({ab.norm(), ac.norm(), (ab - ac).norm()}) / spacing);
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) take(skin.vertices[ia] + ab * i / n + ac * j / n);
    }
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace artus
