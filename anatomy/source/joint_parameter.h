// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "artus/core/result.h"

namespace artus {

/// One thing that is known of a patient: a thickness in mm, an age, 1 or 0 for yes or no.
struct PatientValue {
  std::string name;
  double value = 0;
};

/// What of a joint differs from patient to patient: [parameter.NAME] of its file.
struct JointParameter {
  std::string name;  ///< [a-z0-9_]+
  std::string title;
  std::string unit;     ///< for people
  double modelled = 0;  ///< the value that the surfaces have
  double least = 0;     ///< that the model can take
  double most = 0;
  std::optional<double> usual = std::nullopt;  ///< where its variant is chosen and no value is said
};

/// The values as "fat=12,bmi=31", in their order; resolve_patient reads it back to the same values.
[[nodiscard]] std::string to_text(const std::vector<PatientValue>& values);

/// Whose joint it is. `text` is made of terms between commas: the name of a profile of the bundled
/// patients, NAME=VALUE, or seed=N, by which all is drawn that the others leave open. Values for
/// which the joint has no parameter are dropped unless they say who it is (age, sex, BMI); profiles
/// and draws are held within what the joint can take. Empty text gives no values.
/// Errors: not_found (a name: lists what there is), invalid (a value beyond what the joint can
/// take), malformed.
[[nodiscard]] Result<std::vector<PatientValue>> resolve_patient(
    const std::string& text, const std::vector<JointParameter>& parameters);

}  // namespace artus
