// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "artus/detail/anatomy/source/joint_variant_toml.h"
#include "artus/detail/core/known_names.h"

namespace artus {
namespace {

constexpr std::array<std::string_view, 4> kReplaced{"region_of_interest", "probe", "needle",
                                                    "injection"};

bool is_there(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> declared_names(const std::vector<JointVariant>& variants) {
  std::vector<std::string> names;
  for (const JointVariant& v : variants) names.push_back(v.name);
  return names;
}

std::string refusal_of(const std::string& name, const std::vector<JointVariant>& variants) {
  if (variants.empty()) return "the joint has no variants, so no '" + name + "'";
  const std::vector<std::string_view> known = item_names(variants);
  return "the joint has no variant '" + name + "'" + did_you_mean(name, known) + "; it has " +
         listed(known);
}

/// The declared variants, in the order of the table, which is alphabetical.
std::vector<JointVariant> read_declared(const toml::table& joint,
                                        const std::vector<std::string>& chosen,
                                        Problems& problems) {
  std::vector<JointVariant> declared;
  const toml::node* node = joint.get("variant");
  if (node == nullptr) return declared;
  const toml::table* all = node->as_table();
  if (all == nullptr) {
    problems.add(*node, "joint: 'variant' must be tables: [variant.NAME]");
    return declared;
  }
  for (const auto& [key, value] : *all) {
    const std::string name(key.str());
    const toml::table* table = value.as_table();
    if (table == nullptr || !is_plain_name(name, '_')) {
      problems.add(value, "variant '" + name + "' must be a table [variant.NAME], NAME of a-z, " +
                              "0-9 and _");
      continue;
    }
    TomlTable one(*table, "variant '" + name + "'", problems);
    const std::string title = one.required_text("title");
    for (const std::string_view part : kReplaced)
      if (part == "injection")
        static_cast<void>(one.tables(part));
      else
        static_cast<void>(one.table(part));
    one.finish();
    declared.push_back({name, title, is_there(chosen, name), table->contains(kReplaced[0])});
  }
  return declared;
}

/// What a part of the joint says under `key`: one variant's name or several; empty: it says
/// nothing.
std::optional<std::vector<std::string>> read_condition(const toml::table& part,
                                                       std::string_view key,
                                                       const std::vector<std::string>& known,
                                                       Problems& problems) {
  const toml::node* node = part.get(key);
  if (node == nullptr) return std::nullopt;
  std::vector<std::string> names;
  const auto take = [&](const toml::node& one) {
    const auto name = one.value<std::string>();
    if (!name)
      problems.add(one, "'" + std::string(key) + "' must be a name or a list of names");
    else if (!is_there(known, *name))
      problems.add(one, "there is no [variant." + *name + "]" + did_you_mean(*name, known));
    names.push_back(name.value_or(""));
  };
  if (const toml::array* list = node->as_array())
    for (const toml::node& one : *list) take(one);
  else
    take(*node);
  return names;
}

class Filter {
 public:
  Filter(const std::vector<std::string>& known, const std::vector<std::string>& chosen,
         Problems& problems)
      : known_(known), chosen_(chosen), problems_(problems) {}

  /// Whether a part stays; it forgets its conditions.
  bool keeps(toml::node& node) {
    toml::table* part = node.as_table();
    if (part == nullptr) return true;
    const auto wanted = is_chosen(*part, "variant");
    const auto barred = is_chosen(*part, "unless");
    return wanted.value_or(true) && !barred.value_or(false);
  }

  void apply(toml::array& parts) {
    for (auto at = parts.begin(); at != parts.end();) at = keeps(*at) ? at + 1 : parts.erase(at);
  }
  void apply(toml::table& parts) {
    for (auto at = parts.begin(); at != parts.end();)
      at = keeps(at->second) ? std::next(at) : parts.erase(at);
  }

 private:
  /// Whether one of the variants that it names under `key` is; empty: it names none.
  std::optional<bool> is_chosen(toml::table& part, std::string_view key) {
    const auto names = read_condition(part, key, known_, problems_);
    if (!names) return std::nullopt;
    part.erase(key);
    return std::any_of(names->begin(), names->end(),
                       [this](const std::string& name) { return is_there(chosen_, name); });
  }

  const std::vector<std::string>& known_;
  const std::vector<std::string>& chosen_;
  Problems& problems_;
};

void replace_parts(toml::table& joint, const std::vector<JointVariant>& variants,
                   const std::vector<std::string>& asked) {
  for (const JointVariant& variant : variants) {
    if (!variant.chosen) continue;
    const toml::table& says = *joint.get("variant")->as_table()->get(variant.name)->as_table();
    for (const std::string_view part : kReplaced) {
      if (part != kReplaced[0] && !is_there(asked, variant.name)) continue;
      if (const toml::table* own = says[part].as_table())
        joint.insert_or_assign(part, toml::table(*own));
      else if (const toml::array* list = says[part].as_array())
        joint.insert_or_assign(part, toml::array(*list));
    }
  }
}

}  // namespace

bool has_region_of_variant(const std::vector<JointVariant>& variants) {
  return std::any_of(variants.begin(), variants.end(),
                     [](const JointVariant& v) { return v.chosen && v.has_region; });
}

std::vector<std::string> chosen_names(const std::vector<JointVariant>& variants) {
  std::vector<std::string> names;
  for (const JointVariant& v : variants)
    if (v.chosen) names.push_back(v.name);
  return names;
}

std::vector<JointVariant> choose_variants(toml::table& joint,
                                          const std::vector<std::string>& chosen,
                                          const std::vector<std::string>& asked,
                                          Problems& problems) {
  std::vector<JointVariant> variants = read_declared(joint, chosen, problems);
  const std::vector<std::string> known = declared_names(variants);
  for (const std::string& name : chosen)
    if (!is_there(known, name)) problems.add(joint, refusal_of(name, variants));
  replace_parts(joint, variants, asked);
  joint.erase("variant");
  Filter filter(known, chosen, problems);
  for (auto&& [key, node] : joint) {
    if (toml::array* parts = node.as_array()) filter.apply(*parts);
    if (toml::table* parts = node.as_table()) filter.apply(*parts);
  }
  return variants;
}

}  // namespace artus
