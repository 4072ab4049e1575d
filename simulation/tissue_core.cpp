// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/tissue_core.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/detail/haptics/probe/curve_fit.h"

namespace artus {
namespace {

constexpr double kFactorTime = 0.4;         // s that a factor of the tangent may take
constexpr double kCageTime = 4;             // s that another cage may take
constexpr double kReadyTime = 1;            // s more, for its first factor and index
constexpr double kFactorDistance = 0.5e-3;  // m the face moves before its factor is too old
constexpr double kTissueDistance = 1e-3;    // m the tissue does: crushed, it is much stiffer
constexpr double kFactorTurn = 0.02;        // rad
constexpr double kWaitedFor = 4;            // times as far, where the factor is there at once
constexpr double kStill = 1e-9;          // m; tissue that moves less has come to rest: some 1e-4 mm
constexpr int kOutsideImages = 20;       // in a row before another cage is begun
constexpr int kSteps = 2;                // Newton steps of an image
constexpr double kTryWithin = 25e-3;     // m off the skin from which a press is tried
constexpr double kTriedDepth = 1.5e-3;   // m that it is tried to
constexpr double kTriedDistance = 4e-3;  // m beside it that it tells of
constexpr double kTriedTurn = 0.15;      // rad

double turn_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

SoftBodyParams params_with(const ProbeFace& face) {
  SoftBodyParams params;
  params.face = face;
  return params;
}

}  // namespace

Result<TissueCore> TissueCore::make(std::shared_ptr<const CompiledJoint> joint, const Pose& X_JP,
                                    double image_rate, const ProbeFace& face, bool waits,
                                    std::size_t extra_scene_holders) {
  auto body = SoftBody::make(std::move(joint), X_JP, params_with(face));
  ARTUS_TRY(body);
  return TissueCore(std::move(*body), image_rate, face, waits,
                    MovingScene::kGoingRound + extra_scene_holders);
}

TissueCore TissueCore::make_beside(const SoftBody& other, double image_rate, const ProbeFace& face,
                                   bool waits, std::size_t extra_scene_holders) {
  return {other.another_at_rest(), image_rate, face, waits,
          MovingScene::kGoingRound + extra_scene_holders};
}

TissueCore::TissueCore(SoftBody body, double image_rate, const ProbeFace& face, bool waits,
                       std::size_t scenes)
    : body_(std::move(body)),
      face_(face),
      n_scenes_(scenes),
      waits_(waits),
      dt_(1 / image_rate),
      factor_images_(static_cast<std::uint64_t>(std::ceil(kFactorTime * image_rate))),
      cage_images_(static_cast<std::uint64_t>(std::ceil(kCageTime * image_rate))),
      ready_images_(static_cast<std::uint64_t>(std::ceil(kReadyTime * image_rate))),
      X_JP_factor_(body_.cage_pose()),
      skin_(*body_.joint()),
      needle_(image_rate) {
  keep_state_of_factor();
  tissue_ = body_.snapshot();
  scene_ = scenes_.make_ready(tissue_, n_scenes_)[0];
}

bool TissueCore::is_within_reach(const Pose& X_JC, const Pose& X_JP) {
  const SoftBodyParams params;
  const Vec3 p = (X_JC.inverse() * X_JP).translation();
  return std::abs(p.x()) < params.reach && std::abs(p.y()) < params.reach &&
         turn_between(X_JC, X_JP) < 0.5;
}

/// Another cage where the probe stays out of this one's reach.
void TissueCore::follow(const std::optional<Pose>& X_JP) {
  if (waits_) {
    if (X_JP && !reaches(*X_JP)) change_cage(*X_JP);
    return;
  }
  outside_ = X_JP && !reaches(*X_JP) ? outside_ + 1 : 0;
  if (images_ == cage_due_) {
    if (cage_.valid()) {
      make_ready(X_JP);
    } else if (next_.valid()) {
      NextCage next = next_.get();
      if (is_wanted(next.body.cage_pose(), X_JP)) take(std::move(next));
    }
    outside_ = 0;
  }
  if (cage_.valid() || next_.valid() || outside_ < kOutsideImages) return;
  cage_due_ = images_ + cage_images_;
  cage_ = std::async(std::launch::async, [joint = body_.joint(), pose = *X_JP, face = face_] {
    return SoftBody::make(joint, pose, params_with(face));
  });
}

/// Not where the probe is back in this cage: the other would not feel it.
bool TissueCore::is_wanted(const Pose& X_JC, const std::optional<Pose>& X_JP) const {
  return !X_JP || !reaches(*X_JP) || is_within_reach(X_JC, *X_JP);
}

/// What the first images in the new cage would wait for: a factor of the tissue as it lies, and the
/// indices of the scenes that go round.
void TissueCore::make_ready(const std::optional<Pose>& X_JP) {
  auto made = cage_.get();
  if (!made || !is_wanted(made->cage_pose(), X_JP)) return;
  cage_due_ = images_ + ready_images_;
  next_ = std::async(std::launch::async,
                     [body = std::move(*made), tissue = tissue_, n = n_scenes_]() mutable {
                       return NextCage::make(std::move(body), *tissue, n);
                     });
}

TissueCore::NextCage TissueCore::NextCage::make(SoftBody body, const DeformedBody& before,
                                                std::size_t n) {
  body.follow(before);
  auto laid = body.snapshot();
  NextCage next{std::move(body), MovingScene(), std::move(laid)};
  next.scenes.make_ready(next.tissue, n);
  return next;
}

/// The same while everybody waits.
void TissueCore::change_cage(const Pose& X_JP) {
  auto made = SoftBody::make(body_.joint(), X_JP, params_with(face_));
  if (made) take(NextCage::make(std::move(*made), *tissue_, n_scenes_));
}

/// Takes the new cage, the tissue from where it is now in the old one.
void TissueCore::take(NextCage next) {
  needle_.forget();
  body_ = std::move(next.body);
  scenes_ = std::move(next.scenes);
  keep_state_of_factor();
  X_JP_factor_ = body_.cage_pose();
  body_.follow_with_factor(*tissue_);
  tissue_ = body_.snapshot(next.tissue.get());
  still_ = false;
}

void TissueCore::keep_state_of_factor() {
  const auto u = body_.solver().displacements();
  u_factor_.assign(u.begin(), u.end());
}

bool TissueCore::has_moved_since_factor(const std::optional<Pose>& X_JP) const {
  const double times = waits_ ? kWaitedFor : 1;
  if (X_JP &&
      ((X_JP->translation() - X_JP_factor_.translation()).norm() >= times * kFactorDistance ||
       turn_between(*X_JP, X_JP_factor_) >= times * kFactorTurn))
    return true;
  const auto u = body_.solver().displacements();
  const double far = times * kTissueDistance;
  return !std::equal(
      u.begin(), u.end(), u_factor_.begin(),
      [far](const Vec3& now, const Vec3& then) { return (now - then).squaredNorm() < far * far; });
}

/// A new factor of the tangent once the face or the tissue has moved on; the state that it is of is
/// the present one.
void TissueCore::refresh(const std::optional<Pose>& X_JP) {
  SoftSolver& solver = body_.solver();
  if (solver.refreshing()) {
    if (images_ < factor_due_) return;
    solver.end_refresh();
    needle_.renew();
    return;
  }
  // One that is begun while a cage is made ready would be waited for when that is taken.
  if (next_.valid() || !has_moved_since_factor(X_JP)) return;
  if (X_JP) X_JP_factor_ = *X_JP;
  keep_state_of_factor();
  if (waits_) {
    solver.refresh();
    needle_.renew();
    return;
  }
  factor_due_ = images_ + factor_images_;
  solver.begin_refresh();
}

void TissueCore::step(const std::optional<Pose>& X_JP, const std::optional<NeedleGrip>& needle,
                      const SoftBody::RestOf& rest_of) {
  ++images_;
  follow(X_JP);
  if (body_.lift_skin(rest_of)) still_ = false;
  std::optional<Pose> face = X_JP;
  if (face && !reaches(*face)) face.reset();
  const bool same = face.has_value() == X_JP_before_.has_value() &&
                    (!face || face->matrix() == X_JP_before_->matrix());
  refresh(face);
  const bool pushed = tissue_ && needle_.load(body_, *tissue_, needle);
  if (pushed || !(same && still_)) {
    double moved = 0;
    std::uint32_t happened = 0;  // in any of the steps; lagging is a matter of the last
    for (int k = 0; k < kSteps; ++k) {
      const SoftStep& step = body_.step(face, dt_ / kSteps);
      moved = std::max(moved, step.largest_move);
      happened |= step.status & ~kSoftLagging;
      status_ = step.status | happened;
    }
    // A face that lags behind its hand has yet to meet the skin.
    still_ =
        same && moved < kStill && (status_ & kSoftLagging) == 0 && !body_.solver().refreshing();
    tissue_ = body_.snapshot(tissue_.get());
    scene_ = scenes_.at(tissue_);
  }
  X_JP_before_ = face;
  needle_.step(body_, *scene_, needle);
  describe(X_JP, rest_of);
}

/// The tissue's curve under a probe at `X_JP`: by how it presses, or before it does by how it
/// would, tried anew where it comes to.
TissueCurve TissueCore::learn(const Pose& X_JP, const ProbePacket& skin) {
  const auto fit = [&](const Pose& X, const FacePress& press) {
    const Eigen::Matrix3d R_PJ = X.linear().transpose();
    return fit_curve(skin,
                     {X, R_PJ * press.contact.force, R_PJ * press.contact.torque, press.stiffness},
                     curve_);
  };
  if (!reaches(X_JP)) return curve_;
  FacePress press = body_.press_at_rest_J();
  if (press.contact.share > 0) {
    X_JP_tried_.reset();
    return fit(body_.face_pose_J(), press);
  }
  FaceDepths face;
  face.set_face(skin.length, skin.width);
  face.look(skin, X_JP);
  const double gap = -face.depth().maxCoeff();
  const bool tried =
      X_JP_tried_ &&
      (X_JP_tried_->translation() - X_JP.translation()).norm() < gap + kTriedDistance &&
      turn_between(*X_JP_tried_, X_JP) < kTriedTurn;
  if (tried || gap > kTryWithin) return curve_;
  X_JP_tried_ = X_JP;
  Pose pressed = X_JP;
  pressed.translation() += (gap + kTriedDepth) * X_JP.linear().col(2);
  curve_.hardening = TissueCurve{}.hardening;
  press = body_.try_press_J(pressed);
  press.stiffness = 0;  // one tangent does not tell how tissue hardens
  return fit(pressed, press);
}

void TissueCore::describe(const std::optional<Pose>& X_JP, const SoftBody::RestOf& rest_of) {
  ProbePacket& felt = packet_.probe;
  const std::uint64_t number = felt.number + 1;
  felt = {};
  felt.number = number;
  packet_.needle = needle_.packet();
  const Pose pose = X_JP.value_or(body_.cage_pose());
  skin_.describe(pose, face_.length, face_.width, rest_of, felt);
  if (X_JP && felt.spacing_x > 0) curve_ = learn(*X_JP, felt);
  felt.curve = curve_;
}

}  // namespace artus
