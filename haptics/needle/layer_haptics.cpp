// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/needle/layer_haptics.h"

#include <algorithm>
#include <array>
#include <string>

namespace artus {

namespace {

/// The law of a name; `what` stands in the refusal.
template <class Law, std::size_t n>
Result<Law> find_law(const std::array<std::string_view, n>& names, std::string_view name,
                     const std::string& what) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<Law>(at - names.begin());
  std::string known;
  for (const std::string_view other : names)
    known += (known.empty() ? "" : ", ") + std::string(other);
  return fail(ErrorCode::not_found,
              "no " + what + " \"" + std::string(name) + "\"; there are " + known);
}

}  // namespace

const char* to_string(CuttingLaw law) noexcept {
  return kCuttingLawNames[static_cast<std::size_t>(law)].data();
}

const char* to_string(PrepunctureLaw law) noexcept {
  return kPrepunctureLawNames[static_cast<std::size_t>(law)].data();
}

Result<CuttingLaw> find_cutting_law(std::string_view name) {
  return find_law<CuttingLaw>(kCuttingLawNames, name, "cutting law");
}

Result<PrepunctureLaw> find_prepuncture_law(std::string_view name) {
  return find_law<PrepunctureLaw>(kPrepunctureLawNames, name, "pre-puncture law");
}

}  // namespace artus
