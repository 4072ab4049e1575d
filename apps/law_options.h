// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "haptics/needle_model.h"

#include "apps/command.h"

namespace artus {

/// The flags that choose force laws for a run, as they were given.
struct LawOptions {
  std::vector<std::string> cutting;      ///< "voigt" for all tissues, "skin=spring" for one
  std::vector<std::string> prepuncture;  ///< likewise
  std::vector<std::string> patient;      ///< "cutting=1.2"
  std::string tap = "decaying_sinusoid";
  std::string clamping = "projection";
  int friction_set = 3;
};
void add_law_options(CLI::App* command, LawOptions& options);

/// What a run feels by.
struct RunLaws {
  LawSelection laws;
  PatientProfile patient;
  NeedleParams needle;
};

/// What the flags mean for a joint. Errors: not_found (law, tissue of the joint), invalid (factor),
/// each with the flag.
[[nodiscard]] Result<RunLaws> make_laws(const LawOptions& options, const CompiledJoint& joint);

}  // namespace artus
