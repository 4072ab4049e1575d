// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/known_names.h"

#include <algorithm>

namespace artus {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string listed(KnownNames names) {
  std::string list;
  for (const std::string_view name : names) list.append(list.empty() ? "" : ", ").append(name);
  return list;
}

Result<std::size_t> find_name(KnownNames names, std::string_view name, std::string_view what,
                              std::string_view where) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  return fail(ErrorCode::not_found,
              "no " + std::string(what) + " \"" + std::string(name) + "\"; there are " +
                  (names.empty() ? "none" : listed(names)) + did_you_mean(name, names),
              std::string(where));
}

std::string_view nearest_name(std::string_view word, KnownNames names) {
  constexpr std::size_t kLongest = 64;
  if (word.size() > kLongest) return {};
  std::string_view best;
  std::size_t least = 1 + word.size() / 3;
  for (const std::string_view name : names) {
    const std::size_t d = edit_distance(word, name);
    if (d <= least && (best.empty() || d < least)) {
      best = name;
      least = d;
    }
  }
  return best;
}

}  // namespace artus
