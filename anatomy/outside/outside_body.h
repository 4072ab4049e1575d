// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// What a person lies or sits on: a box along the axes of the person's frame.
struct Support {
  Pose X_JS = Pose::Identity();  ///< its middle
  Vec3 half = Vec3::Zero();      ///< m
};

/// A bone that can be felt through the skin.
struct BodyLandmark {
  std::string name;              ///< as structures are named
  Vec3 position = Vec3::Zero();  ///< m, frame J
  Vec3 outward = Vec3::UnitZ();  ///< out of the skin that is nearest to it
};

/// The person around a joint, for sight and palpation alone: no layers, no force, no echo.
struct OutsideBody {
  SurfaceMesh skin;  ///< frame J, wound outward
  std::vector<BodyLandmark> landmarks;
  std::vector<Vec3> right;               ///< where the right side is marked, frame J, m
  std::vector<Vec3> left;                ///< likewise
  std::vector<Support> supports;         ///< what the person is on
  std::string posture;                   ///< "sitting", "lying"
  Vec3 up = Vec3::UnitZ();               ///< from feet to head, frame J
  std::optional<RegionOfInterest> hole;  ///< where the joint's own skin is the truth
};

/// The person around the joint of that file: `outside.toml` in its folder says which and where, of
/// the patient that it is asked for (docs/outside.md). Null where the folder has none. Errors:
/// those of the files; invalid. Cost: milliseconds.
[[nodiscard]] Result<std::shared_ptr<const OutsideBody>> read_outside(const JointFile& joint);

/// The same for any name of a joint; null for a compiled file.
[[nodiscard]] Result<std::shared_ptr<const OutsideBody>> read_outside(
    const std::filesystem::path& joint);

/// Whether the joint's own skin is to be seen at `p`.
[[nodiscard]] bool is_in_hole(const OutsideBody& body, const Vec3& p);

}  // namespace artus
