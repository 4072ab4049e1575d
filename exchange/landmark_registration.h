// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

/// A place that is known in the joint and was touched with a tracked tip.
struct LandmarkPair {
  std::string name;
  Vec3 p_J = Vec3::Zero();  ///< m
  Vec3 p_R = Vec3::Zero();  ///< m, Reference frame
};

/// The rigid motion that brings the touched points nearest to the landmarks.
struct Registration {
  Pose X_JR = Pose::Identity();
  std::vector<double> residuals;  ///< m, one a pair
  double rms = 0;                 ///< m, of them
};

/// Least squares without scale. Errors: invalid, when there are fewer than three pairs, when the
/// touched points spread as if they had been given in metres, centimetres or inches, when they lie
/// on a line (within 2 mm), or when rms is above `limit` (m): the message lists the residuals.
/// Source [Umeyama1991].
[[nodiscard]] Result<Registration> register_landmarks(const std::vector<LandmarkPair>& pairs,
                                                      double limit);

/// Reads pairs as CSV: landmark,x_mm,y_mm,z_mm with the names of the joint's landmarks and where
/// they were touched. Errors: not_found (file; a landmark, with those there are), unreadable,
/// malformed with file:line, invalid (a landmark twice).
[[nodiscard]] Result<std::vector<LandmarkPair>> read_landmark_pairs(
    const std::filesystem::path& file, const CompiledJoint& joint);
[[nodiscard]] Result<std::vector<LandmarkPair>> parse_landmark_pairs(std::string_view text,
                                                                     const std::string& name,
                                                                     const CompiledJoint& joint);

}  // namespace artus
