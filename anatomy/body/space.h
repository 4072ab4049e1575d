// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/body/tissue.h"

namespace artus {

/// How a place takes liquid in.
enum class SpaceKind : std::uint8_t {
  open,    ///< constant pressure, carries everything away: air, a vessel
  cavity,  ///< a bag with a pressure-volume curve
  split,   ///< tissue that parts: rises to a peak, then falls as the split grows
  solid    ///< takes nothing
};
inline constexpr std::array<std::string_view, 4> kSpaceKindNames{"open", "cavity", "split",
                                                                 "solid"};

/// m of tissue beside a cavity that does not hold liquid: it tears and lets it in; assumed.
inline constexpr double kHoldingFilm = 0.5e-3;

/// Pressure against volume of a place, and what it takes to get in. Gauge pressures, Pa; volumes
/// m^3 of what was put in.
struct SpaceLaw {
  SpaceKind kind = SpaceKind::open;
  double opening = 0;     ///< Pa above its own pressure before anything flows
  double resistance = 0;  ///< Pa s/m^3 near the tip
  double rest = 0;        ///< Pa at volume 0
  double stiffness = 0;   ///< Pa/m^3 of the straight part
  double slack = 0;       ///< m^3 before it resists
  double toe = 0;         ///< m^3 over which the slope comes up
  double yield = std::numeric_limits<double>::infinity();    ///< m^3, a third of the slope beyond
  double rupture = std::numeric_limits<double>::infinity();  ///< m^3, from which on it leaks
  double suction = 0;                                        ///< Pa below `rest` at volume 0
  double suction_volume = 0;                                 ///< m^3 over which that goes
  double relaxing = 0;     ///< share of the stiffness that relaxes
  double relaxation = 0;   ///< s in which it does
  double film_gap = 0;     ///< m between walls that touch; 0: no film
  double film_area = 0;    ///< m^2 of that film
  double peak = 0;         ///< Pa at which a split begins to run
  double peak_volume = 0;  ///< m^3 up to there
  double stop = std::numeric_limits<double>::infinity();  ///< Pa at which one should stop
  double contents = 0;                                    ///< m^3 of liquid of its own
};

/// Profile of what lies outside the skin.
inline constexpr std::string_view kOutsideSpace = "air";

/// A named place that liquid may go to.
struct Space {
  std::string name;
  std::vector<std::string> regions;  ///< those that are this place
  SpaceLaw law;
  std::string like;            ///< profile it was made from
  std::string liquid;          ///< its own contents; empty: none comes out
  std::string leaks_to;        ///< another space; empty: none
  double leak_resistance = 0;  ///< Pa s/m^3
  double leak_opening = 0;     ///< Pa
};

/// A kind of place in the bundled file: what tissues behave so.
struct SpaceProfile {
  Space space;  ///< its name is the profile's; no regions
  std::vector<std::string> tissues;
  std::string source;  ///< reference or "assumed: why"
};

/// The profiles of a file. Errors: malformed (with line), invalid.
[[nodiscard]] Result<std::vector<SpaceProfile>> parse_space_profiles(std::string_view text,
                                                                     const std::string& name);

/// Those that come with artus (meshes/spaces.toml, built in).
[[nodiscard]] Result<std::vector<SpaceProfile>> read_bundled_space_profiles();

/// What a tissue does where a joint says nothing: the profile that names it, otherwise that of its
/// kind, otherwise muscle's. Requires: the bundled profiles or such as have "bone" and "muscle".
[[nodiscard]] const SpaceProfile& profile_of(const std::vector<SpaceProfile>& profiles,
                                             const Tissue& tissue);

struct CompiledJoint;

/// All places of a joint: its own spaces, then one for each region that they leave, named like it.
struct JointSpaces {
  std::vector<Space> spaces;
  std::vector<std::uint32_t> of_region;  ///< (n_regions) index into spaces
};
/// Errors: invalid (a region that the joint does not have, or in two spaces; an unknown leak).
[[nodiscard]] Result<JointSpaces> make_joint_spaces(const CompiledJoint& joint);

}  // namespace artus
