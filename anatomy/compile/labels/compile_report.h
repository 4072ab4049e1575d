// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/compile/labels/quality.h"
#include "artus/detail/anatomy/surfaces/surface_distance.h"

namespace artus {

/// What became of one structure.
struct StructureReport {
  std::string name;
  std::string tissue;
  std::string kind;                   ///< "surface", "shell", "cap", "gap", "end", "filler"
  bool is_hard = false;               ///< bone: keeps its shape
  std::vector<std::string> repairs;   ///< what was done to its surface, in words
  std::string refused;                ///< why it is not in the joint; empty: it is
  std::vector<std::string> warnings;  ///< what its author should look at, in words
  double surface_volume = 0;          ///< m^3 enclosed by the repaired surface, all of it
  double region_volume = 0;           ///< m^3 of that inside body and region of interest
  double lost_volume = 0;             ///< m^3 of that to structures of higher priority
  std::string lost_to;                ///< the one that takes most of it, when it is much
  Vec3 lost_at = Vec3::Zero();        ///< the middle of what that one takes
  double resolved_volume = 0;         ///< m^3 of its tetrahedra
  DistanceStatistics distance;  ///< of the interfaces it shapes to its own surface and of that,
                                ///< where nothing comes before it, to its interfaces; the worse
  std::size_t parts = 0;        ///< connected parts of its tetrahedra
  std::size_t tetrahedra = 0;

  /// resolved / (region - lost) - 1; zero when nothing was expected.
  [[nodiscard]] double volume_error() const noexcept;

  /// Whether it is more than 5 % from what was given: by its tetrahedra, or by what others take.
  [[nodiscard]] bool is_changed() const noexcept;
};

struct StepTime {
  std::string step;
  double seconds = 0;
};

/// The whole account of one compilation.
struct CompileReport {
  std::vector<StructureReport> structures;  ///< the filler first, then file order
  DistanceStatistics distance;              ///< of all that lie on a surface file, both ways
  TetQuality quality;
  std::size_t vertices = 0;
  std::size_t tetrahedra = 0;
  std::size_t interfaces = 0;
  std::size_t fragments = 0;       ///< tiny parts given to their neighbours
  std::string fill_method;         ///< "quality", "plain", "kept": see FillMethod
  std::vector<std::string> notes;  ///< what was chosen where the joint file says nothing
  bool body_kept = false;          ///< the tetrahedra are those of an earlier compilation
  std::size_t parts_cached = 0;    ///< repaired surfaces and distance fields of earlier ones
  std::vector<StepTime> steps;
  double seconds = 0;
  double peak_memory = 0;  ///< bytes, of the process or of one that it started
};

/// The report as JSON, lengths in mm and volumes in cm^3 as the keys say.
[[nodiscard]] std::string to_json(const CompileReport& report);

/// The report that to_json wrote; `where` names it in errors. Errors: malformed.
[[nodiscard]] Result<CompileReport> parse_compile_report(const std::string& text,
                                                         const std::string& where);

}  // namespace artus
