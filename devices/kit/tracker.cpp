// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/tracker.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/check.h"
#include "artus/detail/devices/kit/edge_lines.h"

namespace artus::kit {
namespace {

constexpr double kNeedleGone = 0.1;  // s
constexpr double kProbeGone = 0.5;   // s
constexpr double kSheetHeld = 5;     // s that camera and sheet may be trusted not to have moved
constexpr double kDeviations = 2;    // of 95 %, of the whole spread in space

/// A body whose tool's place is not sure counts as not seen: two markers of one face say little of
/// a tip that is 90 mm away.
std::optional<BodyPose> if_sure(std::optional<BodyPose> body, const Pose& tool) {
  constexpr double kSure = 1.9e-3;  // m, 95 %
  if (body && kDeviations * std::sqrt(body->covariance_at(tool.translation()).trace()) > kSure)
    body.reset();
  return body;
}

}  // namespace

std::vector<SeenMarker> see_markers(const cv::Mat& grey) {
  std::vector<SeenMarker> seen;
  for (const FoundMarker& found : find_markers(grey))
    if (const auto corners = corners_by_edges(grey, found)) seen.push_back({found.id, *corners});
  return seen;
}

Tracker::Tracker(const Kit& kit)
    : kit_(kit),
      needle_(kNeedleGone),
      probe_(kProbeGone),
      needle_filter_({}),
      probe_filter_({}),
      sheet_filter_({0.3, 20, 1, 0.1}) {}

void Tracker::take_sheet(const std::vector<SeenMarker>& seen, double time, HandsFrame& out) {
  constexpr double kMoved = 10e-3;  // m; further is no noise: sheet or camera were moved
  const auto found = find_pose(kit_.sheet, seen, kit_.lens, X_CS_ ? &*X_CS_ : nullptr);
  if (found) {
    if (X_CS_ && (found->X_CB.translation() - X_CS_->translation()).norm() > kMoved)
      sheet_filter_.forget();
    X_CS_ = sheet_filter_.take(time, found->X_CB, Vec3::Zero());
    sheet_seen_ = time;
    out.sheet = true;
  } else if (X_CS_ && time - sheet_seen_ > kSheetHeld) {
    X_CS_.reset();
    sheet_filter_.forget();
  }
}

std::optional<double> Tracker::plunger_of(const std::vector<SeenMarker>& seen,
                                          const Pose& X_CB) const {
  constexpr double kFar = 2.5;  // pixels: not this marker, or not on this syringe
  const auto one = std::find_if(seen.begin(), seen.end(),
                                [&](const auto& s) { return s.id == kit_.plunger.id; });
  if (one == seen.end()) return std::nullopt;
  double z = -kStroke / 2;  // m from all the way in
  double off = 0;
  for (int pass = 0; pass < 8; ++pass) {
    double slope = 0;
    double fall = 0;
    off = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 p = X_CB * (kit_.plunger.corners[i] + Vec3(0, 0, z));
      const Vec3 d = X_CB.linear().col(2);
      if (!(p.z() > 0)) return std::nullopt;
      const double f = kit_.lens.fx;
      const Eigen::Vector2d r = f * (p.head<2>() / p.z() - kit_.lens.looks_at(one->corners[i]));
      const Eigen::Vector2d by_z =
          f * (d.head<2>() * p.z() - p.head<2>() * d.z()) / (p.z() * p.z());
      slope += by_z.squaredNorm();
      fall += by_z.dot(r);
      off += r.squaredNorm();
    }
    if (!(slope > 0)) return std::nullopt;
    z -= fall / slope;
  }
  if (off > 4 * kFar * kFar || z < -2 * kStroke || z > kStroke) return std::nullopt;
  return kStroke + z;
}

HandsFrame Tracker::take(const cv::Mat& grey, double time) {
  ARTUS_REQUIRE(grey.type() == CV_8UC1, "a grey picture");
  HandsFrame out;
  out.time = time;
  const std::vector<SeenMarker> seen = see_markers(grey);
  out.n_markers = static_cast<int>(seen.size());
  take_sheet(seen, time, out);
  const auto syringe =
      if_sure(find_pose(kit_.syringe, seen, kit_.lens, needle_.recent(time)), kit_.X_BN);
  const auto probe =
      if_sure(find_pose(kit_.probe, seen, kit_.lens, probe_.recent(time)), kit_.X_BP);
  const auto in_camera = [](const std::optional<BodyPose>& body) {
    return body ? std::optional<Pose>(body->X_CB) : std::nullopt;
  };
  const bool has_needle = needle_.take(time, in_camera(syringe));
  const bool has_probe = probe_.take(time, in_camera(probe));
  if (!has_needle && needle_.recent(time) == nullptr) needle_filter_.forget();
  if (!has_probe && probe_.recent(time) == nullptr) probe_filter_.forget();
  if (X_CS_) {
    const Pose X_SC = X_CS_->inverse();
    if (has_needle)
      out.X_SN = needle_filter_.take(time, X_SC * syringe->X_CB * kit_.X_BN, Vec3::Zero());
    if (has_probe)
      out.X_SP = probe_filter_.take(time, X_SC * probe->X_CB * kit_.X_BP, Vec3::Zero());
  }
  if (has_needle) out.plunger = plunger_of(seen, syringe->X_CB);
  if (has_needle && has_probe) {
    const Pose X_CN = syringe->X_CB * kit_.X_BN;
    const Pose X_CP = probe->X_CB * kit_.X_BP;
    out.X_PN = X_CP.inverse() * X_CN;
    const Vec3 tip_of_probe = probe->X_CB.inverse() * X_CN.translation();
    const Eigen::Matrix3d spread =
        syringe->covariance_at(kit_.X_BN.translation()) + probe->covariance_at(tip_of_probe);
    const double by_focus =
        kit_.lens.focal_error * (X_CN.translation() - X_CP.translation()).norm();
    out.told_error =
        std::sqrt(kDeviations * kDeviations * spread.trace() + kit_.tip_error * kit_.tip_error +
                  kit_.face_error * kit_.face_error + by_focus * by_focus);
  }
  return out;
}

}  // namespace artus::kit
