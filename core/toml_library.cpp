// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/toml_library.h"

#include <algorithm>

namespace artus {
namespace {

std::vector<std::pair<std::string, const toml::node*>> in_file_order(const toml::table& table) {
  std::vector<std::pair<std::string, const toml::node*>> entries;
  std::vector<toml::source_position> places;
  for (const auto& [key, node] : table) {
    const auto at = key.source().begin;
    const auto place = std::upper_bound(places.begin(), places.end(), at);
    entries.emplace(entries.begin() + (place - places.begin()), std::string(key.str()), &node);
    places.insert(place, at);
  }
  return entries;
}

}  // namespace

void read_entries(const toml::table& entries, const std::string& group, Problems& problems,
                  const EntryReader& read) {
  for (const auto& [name, node] : in_file_order(entries)) {
    if (node->is_table() && is_plain_name(name, '_'))
      read(name, *node->as_table(), problems);
    else
      problems.add(*node, "[" + group + "." + name + "] must be a table with a name of [a-z0-9_]");
  }
}

Result<void> parse_library(std::string_view text, const std::string& name, const std::string& group,
                           const EntryReader& read) {
  const auto document = parse_toml(text, name);
  ARTUS_TRY(document);
  Problems problems;
  TomlTable toml(*document, name, problems);
  if (toml.required_number("format", 1, 1) == 0) toml.problem("this build reads format = 1");
  if (const auto* entries = toml.table(group))
    read_entries(*entries, group, problems, read);
  else
    toml.problem("there is no " + group + " in it ([" + group + ".NAME])");
  toml.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
  return {};
}

}  // namespace artus
