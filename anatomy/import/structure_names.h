// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

/// The name in place of a tissue that stands for the outline of the whole body.
inline constexpr std::string_view kBodyOutline = "body";

/// A label that the user names.
struct NamedLabel {
  double value = 0;
  std::string name;
  std::string tissue;  ///< empty: by its name
};

/// A nerve or vessel that the user typed points of.
struct NamedTube {
  std::string name;
  std::string tissue;
  double radius = 0;         ///< m
  std::vector<Vec3> points;  ///< m, LPS
};

/// What names and codes mean, in the order in which they are asked.
struct StructureNames {
  struct Map {
    std::vector<std::string> patterns;
    std::string tissue;
  };
  struct Code {
    std::string code;  ///< "SCT 272673000"
    std::string tissue;
  };
  std::vector<NamedLabel> labels;
  std::vector<Map> maps;
  std::vector<Code> codes;
  std::vector<NamedTube> tubes;
};

/// A table of names (meshes/structure_names.toml says its form), or a user's file, which may have
/// [[label]] with value, name and tissue, and [[tube]] with name, tissue, radius and points (mm,
/// LPS), too. Errors: malformed, invalid (all problems at once;
/// tissues that the bundled library does not have, with the nearest).
[[nodiscard]] Result<StructureNames> parse_structure_names(std::string_view text,
                                                           const std::string& name);

/// The labels' names alone, of 3D Slicer's colour table (.ctbl) or ITK-SNAP's label descriptions
/// (.txt, .label). Errors: malformed (no line of it names a label).
[[nodiscard]] Result<StructureNames> parse_colour_table(std::string_view text,
                                                        const std::string& name);

/// The names of a file, by its ending (.toml or a colour table). Errors: not_found, unreadable; as
/// parse_structure_names and parse_colour_table.
[[nodiscard]] Result<StructureNames> read_structure_names(const std::filesystem::path& file);

/// The table that comes with artus.
[[nodiscard]] Result<StructureNames> read_bundled_structure_names();

/// Lower case, words joined by '_', without side and file ending: "Deltoid muscle.l" is
/// "deltoid_muscle". Only [a-z0-9_].
[[nodiscard]] std::string plain_structure_name(std::string_view name);

/// "left", "right" or "none", as the name says.
[[nodiscard]] std::string side_of_name(std::string_view name);

/// Whether the words of `pattern` stand whole and together in `plain`; '*' is any run of
/// characters.
[[nodiscard]] bool fits(std::string_view pattern, std::string_view plain);

/// What a structure is made of, and by what that is known.
struct KnownTissue {
  std::string tissue;  ///< or kBodyOutline
  std::string by;      ///< "name 'femur'", "code SCT 272673000", "your file"
};

/// Asks the user's file, then codes, then names. nullopt: unknown.
[[nodiscard]] std::optional<KnownTissue> find_tissue(const StructureNames& of_user,
                                                     const StructureNames& bundled,
                                                     const std::string& name,
                                                     const std::string& code);

}  // namespace artus
