// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "artus/detail/devices/kit/body.h"
#include "artus/detail/devices/kit/lens.h"

namespace artus::kit {

/// A marker's four corners as the picture has them, pixels.
struct SeenMarker {
  int id = 0;
  std::array<Eigen::Vector2d, 4> corners;
};

/// Where a body is, and how well that is known.
struct BodyPose {
  Pose X_CB = Pose::Identity();
  /// Of a small turn (rad, about the axes of C through B's origin) and then a shift (m, along
  /// them): by how far the corners fit, and at least kCornerNoise.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double rms = 0;     ///< pixels
  int n_markers = 0;  ///< that fit
  int n_dropped = 0;  ///< markers that were off by more than kFarMarker
  double ratio = 0;   ///< next best pose's rms over this one's; infinite: there is none

  /// Standard deviation of where a point of B is, m: in the worst direction of C.
  [[nodiscard]] Eigen::Matrix3d covariance_at(const Vec3& p_B) const;
};

inline constexpr double kCornerNoise = 0.08;  // pixels, at least
inline constexpr double kFarMarker = 0.8;     // pixels, rms of a marker's corners
inline constexpr double kSureRatio = 2;       // of the second pose's rms
inline constexpr double kSamePose = 0.1745;   // rad; poses further apart are two

/// The pose from all of the body's markers that were seen, two at least: from `before` (may be
/// null) and from each marker's own two poses by itself, least squares over all corners, the best
/// of them. A marker off by more than 0.8 pixels is dropped. A flat marker seen nearly from the
/// front has two poses: when the second fits nearly as well (ratio below 2), the one near `before`
/// is taken, and without it none. Empty: not seen well enough. Cost: below 1 ms.
[[nodiscard]] std::optional<BodyPose> find_pose(const MarkerBody& body,
                                                const std::vector<SeenMarker>& seen,
                                                const Lens& lens, const Pose* before);

/// A pose that is known roughly, made as good as the corners say; all of them count. nullopt: it
/// does not converge. `rms`: pixels.
[[nodiscard]] std::optional<Pose> refine_pose(const MarkerBody& body,
                                              const std::vector<SeenMarker>& seen, const Lens& lens,
                                              const Pose& start, double& rms);

}  // namespace artus::kit
