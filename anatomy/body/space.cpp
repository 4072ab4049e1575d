// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/space.h"

#include <algorithm>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/body/bundled_fluids.h"
#include "artus/detail/anatomy/body/space_toml.h"
#include "artus/detail/core/toml_fields.h"
#include "artus/detail/core/toml_library.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kKilo = 1e3;  // Pa

constexpr std::array<TomlField<SpaceLaw>, 18> kFields{{
    {"opening_kpa", &SpaceLaw::opening, 0, 1e5, kKilo},
    {"resistance_pa_s_m3", &SpaceLaw::resistance, 0, 1e15, 1},
    {"rest_kpa", &SpaceLaw::rest, -90, 1e3, kKilo},
    {"stiffness_kpa_ml", &SpaceLaw::stiffness, 0, 1e6, kKilo / kCubicCentimetre},
    {"slack_ml", &SpaceLaw::slack, 0, 1e3, kCubicCentimetre},
    {"toe_ml", &SpaceLaw::toe, 0, 1e3, kCubicCentimetre},
    {"yield_ml", &SpaceLaw::yield, 0, 1e4, kCubicCentimetre},
    {"rupture_ml", &SpaceLaw::rupture, 0, 1e4, kCubicCentimetre},
    {"suction_kpa", &SpaceLaw::suction, 0, 90, kKilo},
    {"suction_ml", &SpaceLaw::suction_volume, 0, 1e3, kCubicCentimetre},
    {"relaxing", &SpaceLaw::relaxing, 0, 10, 1},
    {"relaxation_s", &SpaceLaw::relaxation, 0, 1e5, 1},
    {"film_gap_mm", &SpaceLaw::film_gap, 0, 10, 1e-3},
    {"film_area_cm2", &SpaceLaw::film_area, 0, 1e3, 1e-4},
    {"peak_kpa", &SpaceLaw::peak, 0, 1e5, kKilo},
    {"peak_ml", &SpaceLaw::peak_volume, 1e-4, 1e3, kCubicCentimetre},
    {"stop_kpa", &SpaceLaw::stop, 0, 1e5, kKilo},
    {"contents_ml", &SpaceLaw::contents, 0, 1e5, kCubicCentimetre},
}};

void check_law(TomlTable& toml, const SpaceLaw& law) {
  if (law.kind == SpaceKind::cavity && !(law.stiffness > 0))
    toml.problem("a cavity needs 'stiffness_kpa_ml' above 0");
  if (law.kind == SpaceKind::split && (!(law.peak >= law.opening) || !(law.peak_volume > 0)))
    toml.problem("a split needs 'peak_kpa' of at least 'opening_kpa', and 'peak_ml'");
  if (law.rupture < law.yield) toml.problem("'rupture_ml' must not be below 'yield_ml'");
  if ((law.film_gap > 0) != (law.film_area > 0))
    toml.problem("'film_gap_mm' and 'film_area_cm2' belong together");
  if ((law.suction > 0) != (law.suction_volume > 0))
    toml.problem("'suction_kpa' and 'suction_ml' belong together");
  if (law.relaxing > 0 && !(law.relaxation > 0))
    toml.problem("'relaxing' needs 'relaxation_s' above 0");
}

SpaceProfile read_profile(const std::string& name, const toml::table& table, Problems& problems) {
  TomlTable toml(table, "space '" + name + "'", problems);
  SpaceProfile profile;
  profile.space.name = name;
  profile.space.like = name;
  read_space_law(toml, true, profile.space.law);
  profile.space.liquid = toml.text("contents").value_or("");
  if (toml.has("tissues")) profile.tissues = toml.required_texts("tissues");
  profile.source = toml.required_text("source");
  toml.finish();
  return profile;
}

/// Own spaces into the table of regions. Errors: invalid.
Result<void> take_regions(const CompiledJoint& joint, const Space& space, std::uint32_t number,
                          std::vector<std::uint32_t>& of_region) {
  for (const std::string& name : space.regions) {
    const auto at = std::find_if(joint.regions.begin(), joint.regions.end(),
                                 [&](const Region& r) { return r.name == name; });
    const std::string where = "space '" + space.name + "'";
    if (at == joint.regions.end())
      return fail(ErrorCode::invalid, "there is no structure '" + name + "'", where);
    std::uint32_t& taken = of_region[static_cast<std::size_t>(at - joint.regions.begin())];
    if (taken != number && taken != std::numeric_limits<std::uint32_t>::max())
      return fail(ErrorCode::invalid, "'" + name + "' is in two spaces", where);
    taken = number;
  }
  return {};
}

}  // namespace

void read_space_law(TomlTable& toml, bool is_new, SpaceLaw& law) {
  if (is_new && !toml.has("law"))
    toml.problem("'law' is missing (" + listed(kSpaceKindNames) + ")");
  read_name(toml, "law", kSpaceKindNames, law.kind);
  read_fields(toml, kFields, law);
  check_law(toml, law);
}

const SpaceProfile* find_profile(const std::vector<SpaceProfile>& profiles, std::string_view name) {
  const auto at = std::find_if(profiles.begin(), profiles.end(),
                               [&](const SpaceProfile& p) { return p.space.name == name; });
  return at == profiles.end() ? nullptr : &*at;
}

Result<std::vector<SpaceProfile>> parse_space_profiles(std::string_view text,
                                                       const std::string& name) {
  std::vector<SpaceProfile> profiles;
  ARTUS_TRY(
      parse_library(text, name, "space",
                    [&](const std::string& entry, const toml::table& table, Problems& problems) {
                      profiles.push_back(read_profile(entry, table, problems));
                    }));
  return profiles;
}

Result<std::vector<SpaceProfile>> read_bundled_space_profiles() {
  return parse_space_profiles(kBundledSpaces, "bundled spaces");
}

const SpaceProfile& profile_of(const std::vector<SpaceProfile>& profiles, const Tissue& tissue) {
  for (const SpaceProfile& p : profiles)
    if (std::find(p.tissues.begin(), p.tissues.end(), tissue.name) != p.tissues.end()) return p;
  const auto kind = static_cast<std::size_t>(tissue.acoustic.kind);
  const std::string_view name = tissue.haptic.hard ? "bone" : kTissueKindNames[kind];
  const SpaceProfile* found = find_profile(profiles, name);
  if (found == nullptr) found = find_profile(profiles, "muscle");
  return *found;
}

Result<JointSpaces> make_joint_spaces(const CompiledJoint& joint) {
  const auto profiles = read_bundled_space_profiles();
  ARTUS_TRY(profiles);
  constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
  JointSpaces all;
  all.spaces = joint.spaces;
  all.of_region.assign(joint.regions.size(), kNone);
  for (std::uint32_t k = 0; k < all.spaces.size(); ++k)
    ARTUS_TRY(take_regions(joint, all.spaces[k], k, all.of_region));
  for (std::size_t r = 0; r < joint.regions.size(); ++r) {
    if (all.of_region[r] != kNone) continue;
    all.of_region[r] = static_cast<std::uint32_t>(all.spaces.size());
    const auto& region = joint.regions[r];
    Space space = r == kOutside ? find_profile(*profiles, kOutsideSpace)->space
                                : profile_of(*profiles, joint.tissues[region.tissue]).space;
    space.name = region.name;
    space.regions = {region.name};
    all.spaces.push_back(std::move(space));
  }
  for (const Space& space : all.spaces) {
    const auto known = [&](const Space& other) {
      return other.name == space.leaks_to;
    };
    if (!space.leaks_to.empty() && std::none_of(all.spaces.begin(), all.spaces.end(), known))
      return fail(ErrorCode::invalid, "leaks to '" + space.leaks_to + "', which is not a space",
                  "space '" + space.name + "'");
  }
  return all;
}

}  // namespace artus
