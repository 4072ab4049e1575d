// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/anatomy/body/joint_places.h"
#include "artus/detail/anatomy/body/joint_pose.h"
#include "artus/detail/anatomy/body/region.h"
#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/anatomy/body/standard_view.h"
#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/anatomy/body/tissue.h"

namespace artus {

/// A joint ready for use: everything the engine needs, nothing of the source meshes.
struct CompiledJoint {
  std::string name;
  std::string side;
  std::string axes;
  std::vector<Tissue> tissues;  ///< the joint's own values
  std::vector<Region> regions;  ///< [0] outside, [1] beyond, then filler and structures
  TetMesh mesh;
  std::vector<Landmark> landmarks;
  Pose X_JP_default = Pose::Identity();
  Pose X_JN_default = Pose::Identity();
  std::vector<PlannedInjection> injections;
  std::string source_digest;        ///< hex digest of joint file, tissues and surfaces
  std::vector<Space> spaces;        ///< the joint's own; make_joint_spaces adds the tissues'
  std::vector<JointPose> poses;     ///< how it may be held (pose_joint)
  std::vector<StandardView> views;  ///< what protocols ask to be shown of it

  [[nodiscard]] const Tissue& tissue_of(RegionId region) const {
    return tissues[regions[region].tissue];
  }
};

/// Writes the joint to `file` (see docs/file-format.md), atomically: a crash leaves the old file or
/// none. Errors: unreadable.
[[nodiscard]] Result<void> write_compiled_joint(const CompiledJoint& joint,
                                                const std::filesystem::path& file);

/// The joint in the payload of a compiled file (what follows its header); `where` names the file in
/// errors. Errors: corrupt, as below.
[[nodiscard]] Result<CompiledJoint> parse_compiled_joint(const std::string& payload,
                                                         const std::string& where);

/// Reads what write_compiled_joint wrote, or the bundled file of that name (find_joint). Errors:
/// not_found, unsupported (other version), corrupt (truncated, checksum, index, not finite).
[[nodiscard]] Result<CompiledJoint> read_compiled_joint(const std::filesystem::path& file);

}  // namespace artus
