// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/label_volume.h"
#include "artus/detail/anatomy/import/structure_names.h"
#include "artus/detail/anatomy/import/surface_nets.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"
#include "artus/detail/core/progress.h"

namespace artus {

/// A structure of an imported joint, or one that was left out.
struct ImportedStructure {
  std::string name;    ///< as joint.toml has it
  std::string source;  ///< as the file has it
  std::string tissue;  ///< empty: left out
  std::string by;      ///< how the tissue is known, or why it is left out
  double value = 0;    ///< label in the file
  std::size_t n_voxels = 0;
  LabelVolumes volumes;   ///< of a label; a surface has `fitted` alone
  bool is_swept = false;  ///< made of points that were typed: no member of the partition
  SurfaceMesh mesh;       ///< LPS, m
  SurfaceMesh before;     ///< as the file has it: the faces of its voxels
};

/// A structure that was not segmented and is made of others when the joint is compiled.
struct AssumedStructure {
  std::string name;
  std::string tissue;
  std::string shape;  ///< as joint.toml has it: "cap = { ... }"
};

/// A region of interest that was chosen.
struct ImportedRegion {
  Vec3 centre = Vec3::Zero();
  double radius = 0;  ///< m
  std::string by;     ///< "where 'femur' and 'tibia' are nearest"
};

/// What an import makes: the files of a joint folder, and what is to be told of it.
struct ImportedJoint {
  std::string name;  ///< [a-z0-9-]+
  std::string title;
  std::string format;  ///< of the source
  std::string side = "none";
  double voxel = 0;                           ///< m, edge; 0: no voxels
  std::vector<ImportedStructure> structures;  ///< small before large
  std::vector<ImportedStructure> left_out;
  SurfaceMesh body;
  SurfaceMesh cuts;     ///< the part of body that is no skin; may be empty
  std::string body_by;  ///< how the body's outline is known
  bool body_is_assumed = false;
  bool has_skin = false;               ///< a structure of its own, not a shell
  bool is_partition = false;           ///< structures share their borders
  std::vector<AssumedStructure> made;  ///< of others, when the joint is compiled
  std::size_t n_before_made = 0;       ///< structures that stand before those in the file
  std::optional<ImportedRegion> region;
  std::vector<std::string> notes;    ///< to look at
  std::vector<std::string> assumed;  ///< made and not measured
};

/// What the user says of an import.
struct ImportOptions {
  std::string name;                    ///< of the joint; empty: from the file's name
  std::string side;                    ///< empty: by the structures' names
  StructureNames names;                ///< of --labels
  std::optional<ImageVolume> image;    ///< the scan, for the skin
  std::optional<double> surface_unit;  ///< m, of files that do not say their own; else mm
  double threshold = 0.5;              ///< of a fractional DICOM segmentation
  std::vector<std::string> between;    ///< two structures between which the joint lies; or none
  bool whole = false;                  ///< all of the body is meshed: no region of interest
  std::vector<std::string> assume;     ///< of kAssumable
  std::vector<std::string> bursa;      ///< two structures between which there is one; or none
};

/// Makes a joint of a label volume: [Frisken2022]'s nets, volumes fitted, tissues by name, what a
/// segmentation lacks. Errors: invalid (no label of a known tissue, no bone to hold the tissue is
/// noted alone; those of outline_body). Cost: about 3 s for 24 million voxels.
[[nodiscard]] Result<ImportedJoint> import_labels(LabelVolume volume, const ImportOptions& options,
                                                  const std::string& file,
                                                  const Progress& progress = {});

/// The text of joint.toml.
[[nodiscard]] std::string to_joint_toml(const ImportedJoint& joint);

/// Whether a joint may be written to `folder`. Errors: invalid (it holds a joint.toml already,
/// unless `replace`).
[[nodiscard]] Result<void> may_write_joint(const std::filesystem::path& folder, bool replace);

/// Writes joint.toml and surfaces/*.ply (mm). Errors: invalid (the folder holds a joint.toml
/// already, unless `replace`), unreadable.
[[nodiscard]] Result<void> write_imported_joint(const ImportedJoint& joint,
                                                const std::filesystem::path& folder, bool replace);

/// A file's name as a joint's: "KNEE label.seg.nrrd" is "knee-label".
[[nodiscard]] std::string joint_name_of(const std::filesystem::path& file);

/// Gives names that are plain and one of their own each, and the joint its side: that of all names,
/// else none and the side stays in the names.
void name_structures(ImportedJoint& joint);

/// The ball around the place where two bones are nearest, as large as holds it and its skin;
/// nullopt where the whole body is no larger or asked for, or there are no two bones.
/// `options.between` names them. Structures without a vertex in it move to `left_out`. Errors:
/// not_found (a name of `between`).
[[nodiscard]] Result<void> choose_region(ImportedJoint& joint, const ImportOptions& options);

}  // namespace artus
