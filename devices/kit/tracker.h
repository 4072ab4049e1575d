// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "artus/detail/devices/kit/body_pose.h"
#include "artus/detail/devices/kit/hand_state.h"
#include "artus/detail/devices/kit/one_euro.h"

namespace artus::kit {

/// All that was measured of one kit.
struct Kit {
  Hand hand = Hand::right;
  Lens lens;
  MarkerBody probe = make_probe_body();
  MarkerBody syringe = make_syringe_body();
  MarkerBody sheet = make_sheet_body();
  Marker plunger = make_plunger_marker(Hand::right);
  Pose X_BN = nominal_needle();           ///< needle on the syringe
  Pose X_BP = nominal_face(Hand::right);  ///< face on the probe mock
  double tip_error = 2e-3;                ///< m, 95 %: assumed until it was measured
  double face_error = 2e-3;               ///< m, 95 %: the same
  double block_height = 50e-3;            ///< m, of the block on the sheet
};

/// What one picture says.
struct HandsFrame {
  double time = 0;                ///< s, mid-exposure
  std::optional<Pose> X_SN;       ///< needle on the sheet, filtered; empty: not seen
  std::optional<Pose> X_SP;       ///< the probe's face on the sheet, filtered
  std::optional<double> plunger;  ///< m, positive in, 0: all the way out
  std::optional<Pose> X_PN;       ///< needle in the probe's frame, of this picture alone
  double told_error = 0;          ///< m, 95 %, of the tip in the probe's frame
  bool sheet = false;             ///< is it seen now?
  int n_markers = 0;
};

/// Pictures in, poses out; all relative to the sheet under the block, so that an error of the
/// camera's place or focal length is common to both hands. Cost: 5 to 15 ms a picture of 720p on
/// one core, most of it the search.
class Tracker {
 public:
  explicit Tracker(const Kit& kit);

  /// `grey`: 8 bit, of the lens' size; `time` must rise, s.
  [[nodiscard]] HandsFrame take(const cv::Mat& grey, double time);

 private:
  void take_sheet(const std::vector<SeenMarker>& seen, double time, HandsFrame& out);
  [[nodiscard]] std::optional<double> plunger_of(const std::vector<SeenMarker>& seen,
                                                 const Pose& X_CB) const;

  Kit kit_;
  Presence needle_;
  Presence probe_;
  PoseFilter needle_filter_;
  PoseFilter probe_filter_;
  PoseFilter sheet_filter_;
  std::optional<Pose> X_CS_;
  double sheet_seen_ = 0;  // s
};

/// The markers of a picture with corners by their edges.
[[nodiscard]] std::vector<SeenMarker> see_markers(const cv::Mat& grey);

}  // namespace artus::kit
