// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/touched_landmarks.h"

#include <algorithm>

namespace artus {
namespace {

constexpr std::int64_t kRest = 500'000'000;  // ns over which a place is measured; assumed
constexpr double kSteady = 1e-3;             // m, assumed: a hand on a bony landmark

}  // namespace

void TouchedLandmarks::see(std::int64_t time_ns, const std::optional<Pose>& X_RN) {
  if (!X_RN) {
    seen_.clear();
    return;
  }
  seen_.push_back({time_ns, *X_RN});
  // one that is older than the half second stays, so that all of it is covered
  while (seen_.size() > 1 && time_ns - seen_[1].time_ns >= kRest) seen_.pop_front();
}

RestingTip TouchedLandmarks::tip() const {
  if (seen_.empty()) return {};
  RestingTip tip{TipRest::resting, seen_.back().X_RN};
  Vec3 mean = Vec3::Zero();
  for (const Seen& seen : seen_) mean += seen.X_RN.translation();
  mean /= static_cast<double>(seen_.size());
  tip.X_RN.translation() = mean;
  const auto moves = [&](const Seen& seen) {
    return (seen.X_RN.translation() - mean).norm() > kSteady;
  };
  if (std::any_of(seen_.begin(), seen_.end(), moves)) tip.rest = TipRest::moving;
  if (seen_.back().time_ns - seen_.front().time_ns < kRest) tip.rest = TipRest::brief;
  return tip;
}

bool TouchedLandmarks::touch(std::size_t k) {
  const RestingTip now = tip();
  if (now.rest != TipRest::resting) return false;
  touched_[k] = now.X_RN.translation();
  return true;
}

Result<Registration> TouchedLandmarks::fit() const {
  std::vector<LandmarkPair> pairs;
  for (std::size_t k = 0; k < landmarks_.size(); ++k)
    if (touched_[k]) pairs.push_back({landmarks_[k].name, landmarks_[k].position, *touched_[k]});
  return register_landmarks(pairs, limit_);
}

std::size_t TouchedLandmarks::n_touched() const {
  const auto given = [](const std::optional<Vec3>& p) {
    return p.has_value();
  };
  return static_cast<std::size_t>(std::count_if(touched_.begin(), touched_.end(), given));
}

}  // namespace artus
