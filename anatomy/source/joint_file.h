// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/anatomy/body/joint_path.h"
#include "artus/detail/anatomy/body/joint_places.h"
#include "artus/detail/anatomy/body/joint_pose.h"
#include "artus/detail/anatomy/body/region.h"
#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/anatomy/body/standard_view.h"
#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/anatomy/source/joint_parameter.h"
#include "artus/detail/anatomy/source/joint_variant.h"

namespace artus {

/// A layer of given thickness just inside the body surface or inside another structure (skin).
struct ShellConstruct {
  std::string inside;    ///< structure whose surface it lines; empty = the body surface
  double thickness = 0;  ///< m
};

/// A layer on a bone where it faces another structure (articular cartilage).
struct CapConstruct {
  std::string on;                 ///< the bone
  std::vector<std::string> near;  ///< what it must face
  double within = 0;              ///< m, how near the facing structure must be
  double thickness = 0;           ///< m; never more than half the gap to what it faces
};

/// A thin fluid-filled cleft between two groups of structures (a bursa, a joint space).
struct GapConstruct {
  std::vector<std::string> roof;
  std::vector<std::string> floor;
  double thickness = 0;  ///< m, full thickness where the two sides leave room or overlap
  double within = 0;     ///< m, where roof and floor are farther apart than this there is none
  Vec3 centre = Vec3::Zero();  ///< the cleft lies in the ball (centre, radius)
  double radius = 0;           ///< m
  double edge = 0;             ///< m, over which the rim thins out; 0: the thickness
  double inflation = 0;        ///< m^3 of fluid that fill it before it is tight; 0: not known
};

/// The part of a muscle near a bone (its tendinous end).
struct EndConstruct {
  std::string of;      ///< the muscle it is cut from
  std::string toward;  ///< the bone it inserts on
  double within = 0;   ///< m, length of the tendinous end measured to the insertion
  std::optional<Vec3>
      insertion;  ///< centre of the insertion; default: the muscle's nearest contact
};

/// A surface read from a file.
struct SurfaceFile {
  std::filesystem::path file;   ///< relative to the joint's surface folder
  double unit = 1e-3;           ///< m per unit of the file
  bool has_own_unit = false;    ///< the joint file says `units` for this file: its size is meant
  std::string repair = "auto";  ///< "auto", "none", "wrap"
  double thicken = 0;           ///< m; an open sheet becomes a plate of this thickness (0: refused)
  /// m, how far its side that faces the skin is moved outward, along the skin's normal; negative:
  /// inward. Of the body: all of its skin.
  double grow = 0;
  /// Of the body: the part of its surface where it was cut, which is no skin; empty: found by what
  /// repair closes. Relative to the surface folder.
  std::filesystem::path cuts;
};

/// One thing of the body: where it comes from, what it is made of. Earlier in the list wins where
/// two overlap.
struct Structure {
  std::string name;    ///< unique; [a-z0-9_]+
  std::string tissue;  ///< name in the tissue library
  std::variant<SurfaceFile, ShellConstruct, CapConstruct, GapConstruct, EndConstruct> shape;
  double facet_size = 0;           ///< m, 0 = the joint's default
  double facet_distance = 0;       ///< m, 0 = the joint's default
  std::optional<Vec3> fibre_axis;  ///< along the fibres, if one axis is a fair description
  FibreCourse fibre_course = FibreCourse::ends;  ///< how they follow that axis
  std::string partition;                         ///< of the joint file; empty: of none
  int line = 0;                                  ///< of joint.toml; 0: of no file
};

/// Structures that share their borders without overlap: they are not checked for crossing each
/// other, and a film of nothing between two of them is none.
struct Partition {
  std::string name;
  double film = 0;  ///< m, a gap narrower than this belongs to the nearer neighbour
};

/// The region that is meshed: a ball, or a box when `half_extent` is set.
struct RegionOfInterest {
  Vec3 centre = Vec3::Zero();
  double radius = 0;                ///< m
  std::optional<Vec3> half_extent;  ///< m
};

/// A joint file, parsed and valid: units are metres, names are unique and known.
struct JointFile {
  std::string name;              ///< with variants and patient: "shoulder+effusion@fat=12,bmi=31"
  std::string title;             ///< one line for people
  std::string side;              ///< "left", "right" or "none"
  std::string axes;              ///< "LPS", "RAS", ...: direction of +x +y +z
  std::filesystem::path folder;  ///< where joint.toml is
  std::filesystem::path surface_folder;  ///< where the surface files are
  Structure body;                        ///< the outer skin; its tissue is the filler's
  std::string filler_name;               ///< region name of what no structure claims
  std::vector<Structure> structures;     ///< priority order, first wins
  std::vector<Partition> partitions;     ///< that structures name
  std::vector<Tissue> tissues;           ///< library with the joint's overrides applied
  std::optional<RegionOfInterest> region_of_interest;
  double facet_size = 0;      ///< m
  double facet_distance = 0;  ///< m
  double cell_size = 0;       ///< m
  std::vector<Landmark> landmarks;
  std::optional<Pose> X_JP_default;          ///< default probe pose
  int probe_line = 0;                        ///< of joint.toml, where [probe] stands; 0: nowhere
  std::optional<PlannedInjection> needle;    ///< what X_JN_default was made from
  std::optional<Pose> X_JN_default;          ///< default needle pose: tip at the target
  std::vector<PlannedInjection> injections;  ///< of the three-injections scenario
  std::vector<Space> spaces;                 ///< where liquid may go, as far as the file says
  std::vector<JointPose> poses;              ///< how the joint may be held
  std::vector<StandardView> views;           ///< what protocols ask to be shown
  std::vector<JointVariant> variants;        ///< all that the file declares, which are chosen
  std::vector<JointParameter> parameters;    ///< all that the file declares
  std::vector<PatientValue> patient;         ///< whose joint it is; empty: as modelled
  std::filesystem::path tissue_library;      ///< the file it names; empty: the bundled one
  std::string shape;                         ///< what of it shapes the body (to_joint_shape)
};

/// Reads joint.toml in the folder of `joint` (find_joint), with the variants that it asks for
/// and of the patient it names (split_variants). `surface_folder` replaces the file's own when not
/// empty; otherwise the environment's ARTUS_SURFACES_<NAME> does (joint name in capitals, '-' as
/// '_') when set. Errors: not_found (file, surface folder, tissue library), malformed (with line
/// and column), invalid (unknown key or tissue, duplicate name, missing value, construct of an
/// unknown structure); every problem of the file is named in one message.
[[nodiscard]] Result<JointFile> read_joint(const std::filesystem::path& joint,
                                           const std::filesystem::path& surface_folder = {});

/// The same from memory, without looking whether the surface files exist: `text` is the content
/// of joint.toml. A tissue library that `text` names is read.
[[nodiscard]] Result<JointFile> parse_joint(std::string_view text,
                                            const std::filesystem::path& joint,
                                            const std::filesystem::path& surface_folder = {});

}  // namespace artus
