// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/anatomy/source/joint_parameter.h"
#include "artus/detail/core/toml_table.h"

namespace artus {

/// The [parameter.NAME] of a joint file, in alphabetical order.
[[nodiscard]] std::vector<JointParameter> read_parameters(const toml::table& joint,
                                                          Problems& problems);

/// Makes a joint file's table that of the patient: each value moves the numbers that its parameter
/// acts on, by `per` for each unit away from the modelled value, and no word of parameters is left.
/// Returns `variants` with those that a value of 0.5 or more switches on. Problems: a key that does
/// not exist and has no `base`.
[[nodiscard]] std::vector<std::string> apply_patient(toml::table& joint,
                                                     const std::vector<PatientValue>& patient,
                                                     std::vector<std::string> variants,
                                                     Problems& problems);

}  // namespace artus
