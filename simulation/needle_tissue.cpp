// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/needle_tissue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace artus {
namespace {

constexpr double kTakeTime = 0.25;       // s that a compliance may take to compute
constexpr double kAhead = 15e-3;         // m from the tip to the skin at which it is begun
constexpr double kTrackLength = 40e-3;   // m of material that it is of
constexpr double kBehind = 0.1;          // m from the tip back to the skin, at most
constexpr double kTrackDistance = 1e-3;  // m that the entry moves before it is too old
constexpr double kTrackTurn = 0.04;      // rad
constexpr double kUnlike = 0.2e-3;       // m, assumed: others carry the tissue outward by no more

bool same_loads(const std::vector<PointLoad>& a, const std::vector<PointLoad>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.p_rest == y.p_rest && x.force == y.force;
  });
}

}  // namespace

NeedleTissue::NeedleTissue(double image_rate)
    : dt_(1 / image_rate),
      to_take_(static_cast<std::uint64_t>(std::ceil(kTakeTime * image_rate))) {}

bool NeedleTissue::load(SoftBody& body, const DeformedBody& tissue,
                        const std::optional<NeedleGrip>& needle) {
  std::vector<PointLoad> loads;
  if (needle) {
    NeedleLine shaft;  // laid back from the material point at the tip
    const Pose X_CJ = body.cage_pose().inverse();
    shaft.axis = X_CJ.linear() * needle->X_JN.linear().col(2);
    const Vec3 tip = X_CJ * tissue.to_rest(needle->X_JN.translation()).p_rest;
    shaft.entry = tip - needle->load.tip_depth * shaft.axis;
    loads = loads_of(needle->load, shaft, packet_.compliance.spacing);
  }
  if (same_loads(loads, loads_)) return false;
  loads_ = loads;
  body.solver().set_loads(std::move(loads));
  return true;
}

/// The needle's line from where it meets the skin now, in the body at rest. None: it is not near.
std::optional<NeedleLine> NeedleTissue::find_track(const SoftBody& body, const Scene& scene,
                                                   const Pose& X_JN) const {
  std::array<TissueInterval, 64> met;
  const Vec3 tip = X_JN.translation();
  const Vec3 axis = X_JN.linear().col(2);
  const Vec3 start = tip - kBehind * axis;
  const QueryCount count = scene.find_intervals({start, tip + kAhead * axis}, met);
  const auto end = met.begin() + static_cast<std::ptrdiff_t>(count.size);
  const auto skin = std::adjacent_find(std::make_reverse_iterator(end), met.rend(),
                                       [](const auto& in, const auto& out) {
                                         return in.region >= kFirstRegion && out.region == kOutside;
                                       });
  if (skin == met.rend()) return std::nullopt;
  const Vec3 entry = start + skin->entry * axis;
  const DeformedBody& tissue = *scene.tissue();
  const Vec3 rest = tissue.to_rest(entry).p_rest;
  const Vec3 deep = tissue.to_rest(entry + 0.5 * kTrackLength * axis).p_rest;
  const Pose X_CJ = body.cage_pose().inverse();
  NeedleLine track;
  track.entry = X_CJ * rest;
  track.axis = X_CJ.linear() * (deep - rest).normalized();
  track.length = kTrackLength;
  return track;
}

void NeedleTissue::step(const SoftBody& body, const Scene& scene,
                        const std::optional<NeedleGrip>& needle) {
  ++images_;
  if (next_.valid() && images_ >= due_) packet_.compliance = next_.get();
  packet_.carried = {};
  packet_.compliance_scale = 1;
  if (!needle) {
    pushed_ = 0;
    return;
  }
  const double share = 1 - std::exp(-dt_ / SoftSolverParams{}.relaxation);
  pushed_ += share * (cube_displacement(packet_.compliance, needle->load) - pushed_);
  const Vec3 tip = needle->X_JN.translation();
  const Vec3 axis = needle->X_JN.linear().col(2);
  const Vec3 moved = tip - scene.tissue()->to_rest(tip).p_rest;
  // Tissue that the tip presses far is stiffer than its compliance says. What it went less is no
  // motion by others, which would stay when the needle lets go.
  double by_needle = pushed_;
  if (pushed_ > 0) by_needle = std::clamp(moved.dot(axis) + kUnlike, 0.0, pushed_);
  packet_.compliance_scale = pushed_ > 0 ? by_needle / pushed_ : 1;
  const Vec3 carried = moved - by_needle * axis;
  std::copy(carried.begin(), carried.end(), packet_.carried.begin());
  if (next_.valid()) return;
  const auto track = find_track(body, scene, needle->X_JN);
  if (!track) return;
  if (!old_ && (track->entry - track_.entry).norm() < kTrackDistance &&
      track->axis.dot(track_.axis) > std::cos(kTrackTurn))
    return;
  track_ = *track;
  old_ = false;
  due_ = images_ + to_take_;
  next_ = std::async(std::launch::async, [factored = body.solver().factored(), track = track_] {
    return compute_needle_compliance(factored, track);
  });
}

void NeedleTissue::forget() {
  if (next_.valid()) next_.get();
  loads_.clear();
  pushed_ = 0;
  old_ = true;
}

}  // namespace artus
