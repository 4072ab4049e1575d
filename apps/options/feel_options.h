// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "artus/detail/apps/options/command.h"
#include "artus/haptics/needle_feel.h"

namespace artus {

/// The flags that choose how the needle feels, as they were given.
struct FeelOptions {
  std::vector<std::string> cutting;        ///< "voigt" for all tissues, "skin=spring" for one
  std::vector<std::string> prepuncture;    ///< likewise
  std::vector<std::string> patient;        ///< "cutting=1.2"
  std::optional<std::string> tap;          ///< else decaying_sinusoid
  std::optional<std::string> clamping;     ///< else projection
  std::optional<int> friction_set;         ///< else 3
  std::optional<double> needle_length_mm;  ///< else 35; its flag is add_needle_length_option's
  std::vector<double> workspace_mm;        ///< centre x, y, z and radius, frame J; empty: none
  double workspace_push = HemisphereParams{}.push;  ///< N
  bool passivity_control = false;
};
void add_feel_options(Command* command, FeelOptions& options);

/// What the flags mean; what was not given stays unset. Errors: not_found (law, factor), invalid
/// (factor, workspace), each with the flag.
[[nodiscard]] Result<NeedleFeel> make_feel(const FeelOptions& options);
/// The same for a joint. Errors: also not_found (tissue of the joint).
[[nodiscard]] Result<NeedleFeel> make_feel(const FeelOptions& options, const CompiledJoint& joint);

/// An error of check(NeedleFeel) with the flag that sets what it names.
[[nodiscard]] Error at_flag(Error error);

}  // namespace artus
