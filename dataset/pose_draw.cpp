// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/pose_draw.h"

#include <array>
#include <cmath>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/printed.h"

namespace artus {
namespace {

/// Numbers for one frame; each has its place, so that a new one changes none of the others.
class Dice {
 public:
  Dice(std::uint64_t seed, std::size_t frame) : seed_(mix_bits(mix_bits(seed) ^ frame)) {}
  [[nodiscard]] double uniform(std::uint64_t place) const { return uniform_noise(seed_, place); }
  [[nodiscard]] double in(const DrawRange& range, std::uint64_t place) const {
    return range.low + (range.high - range.low) * uniform(place);
  }
  /// One of `n`, each as likely.
  [[nodiscard]] std::size_t of(std::size_t n, std::uint64_t place) const {
    return static_cast<std::size_t>(uniform(place) * static_cast<double>(n));
  }

 private:
  std::uint64_t seed_;
};

enum Place : std::uint64_t {
  kLateral,
  kElevation,
  kTurn,
  kTilt,
  kRock,
  kHasNeedle,
  kWhich,
  kAlong,
  kAsideX,
  kAsideY,
  kSlantX,
  kSlantY,
  kInPlane,
  kPatient,
  kTransducer,
  kGauge,
  kLength,
  kEchogenic,
  kPresses,
  kPress
};

/// Moves a probe along its beam until the middle of its face lies on the skin; where it looks past
/// the body it stays.
void set_on_skin(const Scene& scene, Pose& X_JP) {
  constexpr double kReach = 60e-3;  // m in front of and behind the drawn place
  const Vec3 beam = X_JP.linear().col(2);
  const Vec3 p = X_JP.translation();
  std::array<Crossing, 64> crossings;
  const QueryCount found = scene.find_crossings({p - kReach * beam, p + kReach * beam}, crossings);
  for (std::size_t i = 0; i < found.size; ++i)
    if (crossings[i].from == kOutside) {
      X_JP.translation() = p + (crossings[i].depth - kReach) * beam;
      return;
    }
}

Pose draw_probe(const Scene& scene, const DrawRanges& ranges, const Dice& dice) {
  Pose X_JP = scene.joint().X_JP_default;
  X_JP.translate(Vec3(dice.in(ranges.lateral, kLateral), dice.in(ranges.elevation, kElevation), 0));
  X_JP.rotate(Eigen::AngleAxisd(dice.in(ranges.turn, kTurn), Vec3::UnitZ()));
  X_JP.rotate(Eigen::AngleAxisd(dice.in(ranges.tilt, kTilt), Vec3::UnitX()));
  X_JP.rotate(Eigen::AngleAxisd(dice.in(ranges.rock, kRock), Vec3::UnitY()));
  set_on_skin(scene, X_JP);
  return X_JP;
}

Pose draw_needle(const CompiledJoint& joint, const DrawRanges& ranges, const Dice& dice) {
  Pose X_JN = joint.X_JN_default;
  if (const auto& plans = joint.injections; !plans.empty()) {
    const PlannedInjection& plan = plans[dice.of(plans.size(), kWhich)];
    X_JN = make_pose(plan.target, plan.target - plan.entry, joint.X_JP_default.linear().col(1));
  }
  X_JN.translate(Vec3(dice.in(ranges.aside, kAsideX), dice.in(ranges.aside, kAsideY),
                      dice.in(ranges.along, kAlong)));
  X_JN.rotate(Eigen::AngleAxisd(dice.in(ranges.slant, kSlantX), Vec3::UnitX()));
  X_JN.rotate(Eigen::AngleAxisd(dice.in(ranges.slant, kSlantY), Vec3::UnitY()));
  return X_JN;
}

/// The needle laid into the probe's plane y = 0, tip and direction; where it stands across the
/// plane it stays.
Pose laid_in_plane(const Pose& X_JN, const Pose& X_JP) {
  constexpr double kAcross = 0.05;  // of a needle's direction that must lie in the plane
  Pose X_PN = X_JP.inverse() * X_JN;
  Vec3 axis = X_PN.linear().col(2);
  axis.y() = 0;
  if (axis.norm() < kAcross) return X_JN;
  Vec3 tip = X_PN.translation();
  tip.y() = 0;
  return X_JP * make_pose(tip, axis, Vec3::UnitY());
}

NeedleShape draw_shape(const NeedleShape& own, const DrawRanges& ranges, const Dice& dice) {
  NeedleShape shape = own;
  if (!ranges.gauges.empty())
    shape = *needle_of_gauge(ranges.gauges[dice.of(ranges.gauges.size(), kGauge)]);
  shape.length = ranges.length ? dice.in(*ranges.length, kLength) : own.length;
  shape.echogenic =
      ranges.echogenic_share ? dice.uniform(kEchogenic) < *ranges.echogenic_share : own.echogenic;
  return shape;
}

}  // namespace

FrameSource drawn_frames(const DrawBase& base, const DrawRanges& ranges, std::uint64_t seed,
                         std::size_t count) {
  FrameSource source;
  source.count = count;
  source.digest =
      "drawn-" + in_hexadecimal(mix_bits(mix_bits(mix_bits(seed) ^ count) ^ hash_of(ranges)));
  source.frame = [base, ranges, seed](std::size_t i) {
    const Dice dice(seed, i);
    FrameOrder frame;
    frame.patient = dice.of(base.patients.size(), kPatient);
    const Scene& scene = *base.patients[frame.patient];
    if (!ranges.transducers.empty())
      frame.transducer = 1 + dice.of(ranges.transducers.size(), kTransducer);
    frame.X_JP = draw_probe(scene, ranges, dice);
    if (dice.uniform(kPresses) < ranges.press_share)
      frame.press = dice.in(ranges.press_depth, kPress);
    if (!(dice.uniform(kHasNeedle) < ranges.needle_share)) return frame;
    frame.X_JN = draw_needle(scene.joint(), ranges, dice);
    if (dice.uniform(kInPlane) < ranges.in_plane_share)
      frame.X_JN = laid_in_plane(*frame.X_JN, frame.X_JP);
    frame.needle = draw_shape(base.needle, ranges, dice);
    return frame;
  };
  return source;
}

}  // namespace artus
