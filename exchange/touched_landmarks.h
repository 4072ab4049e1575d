// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/exchange/landmark_registration.h"

namespace artus {

/// Whether a needle that is watched rests.
enum class TipRest {
  unseen,  ///< its place is not known
  brief,   ///< it is, but for less than half a second
  moving,  ///< the tip moved by more than 1 mm in the last half second
  resting
};
struct RestingTip {
  TipRest rest = TipRest::unseen;
  Pose X_RN = Pose::Identity();  ///< the mean place of the last half second, the newest axis
};

/// Landmarks that a person touches one after the other with a needle whose place is watched: a
/// touch counts where the tip rests.
class TouchedLandmarks {
 public:
  /// `limit`: m (rms), above which a fit is refused.
  TouchedLandmarks(std::vector<Landmark> landmarks, double limit)
      : limit_(limit), landmarks_(std::move(landmarks)), touched_(landmarks_.size()) {}

  /// Where the needle is now, in the hands' own frame; nothing: not seen, which forgets where it
  /// was. Called as often as one looks.
  void see(std::int64_t time_ns, const std::optional<Pose>& X_RN);
  [[nodiscard]] RestingTip tip() const;

  /// The landmark is where the tip is, if it rests; whether it does. Requires: k < landmarks.
  [[nodiscard]] bool touch(std::size_t k);
  /// The motion that brings all that were touched to the joint's. Errors: those of
  /// register_landmarks.
  [[nodiscard]] Result<Registration> fit() const;

  [[nodiscard]] const std::vector<Landmark>& landmarks() const noexcept { return landmarks_; }
  [[nodiscard]] bool is_touched(std::size_t k) const { return touched_[k].has_value(); }
  [[nodiscard]] std::size_t n_touched() const;

 private:
  struct Seen {
    std::int64_t time_ns = 0;
    Pose X_RN;
  };
  double limit_;
  std::vector<Landmark> landmarks_;
  std::vector<std::optional<Vec3>> touched_;  // by landmark, m, the hands' frame
  std::deque<Seen> seen_;                     // of the last half second
};

}  // namespace artus
