// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "haptics/needle_model.h"
#include "haptics/passivity.h"

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
  std::vector<double> workspace_mm;  ///< centre x, y, z and radius, frame J; empty: none
  double workspace_push = HemisphereParams{}.push;  ///< N
  bool passivity_control = false;
};
void add_law_options(CLI::App* command, LawOptions& options);

/// What a run feels by.
struct RunLaws {
  LawSelection laws;
  PatientProfile patient;
  NeedleParams needle;
  PassivityParams passivity;
};

/// What the flags mean for a joint. Errors: not_found (law, tissue of the joint), invalid (factor,
/// workspace), each with the flag.
[[nodiscard]] Result<RunLaws> make_laws(const LawOptions& options, const CompiledJoint& joint);

}  // namespace artus
