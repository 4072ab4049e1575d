// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/atlas/atlas_frame.h"
#include "artus/detail/anatomy/import/scene_parts.h"
#include "artus/detail/core/progress.h"

namespace artus {

/// A surface of a joint whose joint.toml is there already, and how atlases name it.
struct KnownSurface {
  std::string file;                ///< in the joint's folder of surfaces
  int fma = 0;                     ///< in the Foundational Model of Anatomy; 0: none
  std::vector<std::string> names;  ///< without side
  Eigen::AlignedBox3d box;         ///< m, LPS
  double near = 4e-3;              ///< m that a corner may lie from there
};

/// A joint folder that has joint.toml and sources.toml, but none of its surfaces.
struct KnownJoint {
  std::filesystem::path folder;
  std::string side;
  Vec3 centre = Vec3::Zero();  ///< of the region of interest, m
  double radius = 0;           ///< m
  std::vector<KnownSurface> surfaces;
  std::string skin_file;                ///< the body's
  std::vector<std::string> skin_names;  ///< of its plates, without side
  std::vector<std::string> credits;
};

/// Errors: not_found (no sources.toml: the joint comes with its surfaces), malformed, invalid.
[[nodiscard]] Result<KnownJoint> read_known_joint(const std::filesystem::path& folder);

/// What became of one surface.
struct FoundSurface {
  std::string file;    ///< as the joint names it
  std::string source;  ///< file and part
  std::string by;      ///< "FMA23130", "name 'humerus'"
  SurfaceMesh mesh;    ///< LPS, m
};

/// The surfaces of a known joint, taken from an atlas's files.
struct FoundJoint {
  std::vector<FoundSurface> surfaces;
  bool skin_is_plates = false;     ///< to be wrapped when it is compiled
  std::vector<std::string> notes;  ///< to look at: frames, parts that are there twice
};

/// Finds a known joint's surfaces in the files of an atlas as they come: by number or name, or by
/// the name that the joint has for the file, and where unit and axes of a file are others by the
/// boxes that are known. A folder stands for what is in it. Errors: those of read_scene_parts for a
/// file that is named itself (in a folder what is no surface is passed over); not_found (surfaces
/// that no file has, all of them, with number and name); invalid (a part whose box fits in no
/// frame, with both boxes).
[[nodiscard]] Result<FoundJoint> find_known_joint(const KnownJoint& joint,
                                                  const std::vector<std::filesystem::path>& files,
                                                  double unit, const Progress& progress = {});

/// Writes joint.toml, surfaces/*.ply (mm) and CREDITS.txt. Errors: invalid (the folder holds a
/// joint.toml already, unless `replace`), unreadable.
[[nodiscard]] Result<void> write_known_joint(const KnownJoint& joint, const FoundJoint& found,
                                             const std::filesystem::path& folder, bool replace);

}  // namespace artus
