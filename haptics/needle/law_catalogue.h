// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string_view>
#include <vector>

namespace artus {

/// One number of a force law, with the value that a run takes when nobody says otherwise.
struct LawParameter {
  std::string_view name;
  double value = 0;
  std::string_view unit;
  std::string_view source;  ///< a reference, or "assumed"
};

/// One force law as a user meets it.
struct LawDescription {
  std::string_view component;  ///< what it is a law of: "cutting", "friction", ...
  std::string_view name;
  std::string_view chosen_by;  ///< flag of a run; empty: always on
  std::string_view says;       ///< the law in a line
  std::string_view source;     ///< reference and equation
  std::vector<LawParameter> parameters;
};

/// All force laws of the needle, grouped by component. Values are those of the parameter structs;
/// what a tissue brings itself (f_R, K_t, f_A, ...) is named in `says` and stands in the tissue
/// library. Errors: none.
[[nodiscard]] std::vector<LawDescription> describe_laws();

}  // namespace artus
