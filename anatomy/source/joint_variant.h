// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace artus {

/// Something that a joint can have or lack: a disease, a structure that only some trainings need.
struct JointVariant {
  std::string name;   ///< [a-z0-9_]+
  std::string title;  ///< one line for people
  bool chosen = false;
  bool has_region = false;  ///< it brings its own region of interest
};

/// Whether a chosen one brings its region of interest: a part of the joint, cut out on purpose.
[[nodiscard]] bool has_region_of_variant(const std::vector<JointVariant>& variants);

[[nodiscard]] std::vector<std::string> chosen_names(const std::vector<JointVariant>& variants);

}  // namespace artus
