// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"

namespace artus {

/// The names that something may have, in the order in which they are told.
using KnownNames = std::span<const std::string_view>;

/// "a, b, c".
[[nodiscard]] std::string listed(KnownNames names);

/// The names of items that have a `name`; valid as long as the items are.
template <class Items>
[[nodiscard]] std::vector<std::string_view> item_names(const Items& items) {
  std::vector<std::string_view> names;
  for (const auto& item : items) names.emplace_back(item.name);
  return names;
}

/// The place of `name` among `names`. Errors: not_found, with what there is: `no gate "x"; there
/// are a, b`, and the nearest when one is near. `what` is a gate, `where` a flag or file.
[[nodiscard]] Result<std::size_t> find_name(KnownNames names, std::string_view name,
                                            std::string_view what, std::string_view where = {});

/// Of `names` the one most like `word`; empty when none is near.
[[nodiscard]] std::string_view nearest_name(std::string_view word, KnownNames names);

/// The name most like `word` as the end of a message, " (did you mean 'x'?)"; empty when none is
/// near. `names` is a container of strings.
template <class Names>
[[nodiscard]] std::string did_you_mean(std::string_view word, const Names& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string_view nearest = nearest_name(word, views);
  return nearest.empty() ? "" : " (did you mean '" + std::string(nearest) + "'?)";
}

}  // namespace artus
