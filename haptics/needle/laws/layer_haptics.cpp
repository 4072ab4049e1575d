// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/layer_haptics.h"

#include <array>

#include "artus/detail/core/known_names.h"
namespace artus {

const char* to_string(CuttingLaw law) noexcept {
  return kCuttingLawNames[static_cast<std::size_t>(law)].data();
}

const char* to_string(PrepunctureLaw law) noexcept {
  return kPrepunctureLawNames[static_cast<std::size_t>(law)].data();
}

Result<CuttingLaw> find_cutting_law(std::string_view name) {
  return find_name(kCuttingLawNames, name, "cutting law").map([](std::size_t at) {
    return static_cast<CuttingLaw>(at);
  });
}

Result<PrepunctureLaw> find_prepuncture_law(std::string_view name) {
  return find_name(kPrepunctureLawNames, name, "pre-puncture law").map([](std::size_t at) {
    return static_cast<PrepunctureLaw>(at);
  });
}

}  // namespace artus
