// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/joint_space_toml.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "artus/detail/anatomy/body/liquid.h"
#include "artus/detail/anatomy/body/space_toml.h"
#include "artus/detail/core/known_names.h"

namespace artus {
namespace {

constexpr double kKilopascal = 1e3;  // Pa

/// What a [[space]] may speak of; `taken` and `spaces` grow with each one read.
struct SpaceNames {
  const std::set<std::string, std::less<>>& regions;
  std::set<std::string, std::less<>> liquids;
  std::set<std::string, std::less<>> spaces;
  std::set<std::string, std::less<>> taken;
};

void read_likeness(TomlTable& toml, const std::vector<SpaceProfile>& profiles, Space& space) {
  const auto like = toml.text("like");
  if (!like) return;
  if (const auto* profile = find_profile(profiles, *like)) {
    space = profile->space;
    return;
  }
  std::set<std::string, std::less<>> names;
  for (const SpaceProfile& p : profiles) names.insert(p.space.name);
  toml.problem_at("like", "there is no kind of space '" + *like + "'" + did_you_mean(*like, names));
}

/// The spaces that have one of its regions, or its name, become part of it.
void take_in(std::vector<Space>& before, Space& space) {
  const auto in = [&space](const std::string& region) {
    return std::find(space.regions.begin(), space.regions.end(), region) != space.regions.end();
  };
  for (auto at = before.begin(); at != before.end();) {
    const bool one =
        at->name == space.name || std::any_of(at->regions.begin(), at->regions.end(), in);
    if (one)
      std::copy_if(at->regions.begin(), at->regions.end(), std::back_inserter(space.regions),
                   [&](const std::string& region) { return !in(region); });
    at = one ? before.erase(at) : at + 1;
  }
}

Space read_space(TomlTable& toml, const std::vector<SpaceProfile>& profiles, SpaceNames& names,
                 bool joins) {
  Space space;
  read_likeness(toml, profiles, space);
  space.name = toml.required_text("name");
  if (!space.name.empty() && !names.spaces.insert(space.name).second && !joins)
    toml.problem_at("name", "is already used");
  space.regions = toml.required_texts("regions");
  for (const std::string& region : space.regions) {
    if (names.regions.count(region) == 0)
      toml.problem_at("regions", "there is no structure '" + region + "'" +
                                     did_you_mean(region, names.regions));
    else if (!names.taken.insert(region).second && !joins)
      toml.problem_at("regions", "'" + region + "' is in a space already");
  }
  read_space_law(toml, !toml.has("like"), space.law);
  if (const auto liquid = toml.text("contents")) space.liquid = *liquid;
  if (!space.liquid.empty() && names.liquids.count(space.liquid) == 0)
    toml.problem_at("contents", "there is no liquid '" + space.liquid + "'" +
                                    did_you_mean(space.liquid, names.liquids));
  space.leaks_to = toml.text("leaks_to").value_or("");
  space.leak_resistance = toml.number("leak_resistance_pa_s_m3", 1, 1e18).value_or(1e9);
  space.leak_opening = toml.number("leak_opening_kpa", 0, 1e4, kKilopascal).value_or(0);
  if (!space.leaks_to.empty() && space.leaks_to == space.name)
    toml.problem_at("leaks_to", "must be another space");
  toml.finish();
  return space;
}

}  // namespace

Result<std::vector<Space>> read_spaces(TomlTable& toml,
                                       const std::set<std::string, std::less<>>& regions) {
  const auto profiles = read_bundled_space_profiles();
  ARTUS_TRY(profiles);
  const auto liquids = read_bundled_liquids();
  ARTUS_TRY(liquids);
  SpaceNames names{regions, {}, {}, {}};
  for (const Liquid& liquid : *liquids) names.liquids.insert(liquid.name);
  std::vector<Space> spaces;
  for (const auto* table : toml.tables("space")) {
    TomlTable space(*table, "space", toml.problems());
    const bool joins = space.boolean("joins").value_or(false);
    Space read = read_space(space, *profiles, names, joins);
    if (joins) take_in(spaces, read);
    spaces.push_back(std::move(read));
  }
  names.spaces.clear();
  for (const Space& s : spaces) names.spaces.insert(s.name);
  for (const Space& s : spaces)
    if (!s.leaks_to.empty() && names.spaces.count(s.leaks_to) + regions.count(s.leaks_to) == 0)
      toml.problem("space '" + s.name + "' leaks to '" + s.leaks_to + "', which is not a space" +
                   did_you_mean(s.leaks_to, names.spaces));
  return spaces;
}

}  // namespace artus
