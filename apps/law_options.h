// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "artus/apps/command.h"
#include "artus/evidence/needle/experiment_laws.h"
#include "artus/haptics/needle/needle_model.h"
#include "artus/haptics/passivity.h"

namespace artus {

/// The flags that choose force laws for a run, as they were given.
struct LawOptions {
  std::vector<std::string> cutting;      ///< "voigt" for all tissues, "skin=spring" for one
  std::vector<std::string> prepuncture;  ///< likewise
  std::vector<std::string> patient;      ///< "cutting=1.2"
  std::optional<std::string> tap;        ///< else decaying_sinusoid
  std::optional<std::string> clamping;   ///< else projection
  std::optional<int> friction_set;       ///< else 3
  std::vector<double> workspace_mm;      ///< centre x, y, z and radius, frame J; empty: none
  double workspace_push = HemisphereParams{}.push;  ///< N
  bool passivity_control = false;
};
void add_law_options(Command* command, LawOptions& options);

/// What a run feels by.
struct RunLaws {
  LawSelection laws;
  PatientProfile patient;
  NeedleParams needle;
  PassivityParams passivity;
};

/// What the flags mean for a published experiment, whose layers stand in a tissue's place; what was
/// not given stays unset. Errors: as of make_laws.
[[nodiscard]] Result<ExperimentLaws> make_experiment_laws(const LawOptions& options);

/// What the flags mean for a joint. Errors: not_found (law, tissue of the joint), invalid (factor,
/// workspace), each with the flag.
[[nodiscard]] Result<RunLaws> make_laws(const LawOptions& options, const CompiledJoint& joint);

}  // namespace artus
