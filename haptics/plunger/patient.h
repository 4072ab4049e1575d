// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "artus/detail/haptics/plunger/plunger.h"

namespace artus {

/// What a patient feels of an injection, worst first.
enum class PatientFeeling { nothing, shoots, gave_way, racing, hurts, burns, pressed };

/// What it is made of: the place that has most of the bevel, and what the syringe does there.
struct PatientInput {
  std::string_view like;  ///< the place's profile, Space::like
  double stop = 0;        ///< Pa of the place above which nobody should push, SpaceLaw::stop
  double pressure = 0;    ///< Pa in it
  double volume = 0;      ///< m^3 put into it
  double flow = 0;        ///< m^3/s out of the needle
  bool open = false;      ///< it takes what comes
  bool torn = false;
};
/// assumed: the thresholds of pain by pressure and rate.
[[nodiscard]] PatientFeeling feeling_of(const PatientInput& input) noexcept;

/// What the patient says while something is put into a place; a line of text for a window, empty
/// for nothing. Pain follows pressure and rate; assumed: the thresholds and words.
/// `tip`: the place that has most of the bevel.
[[nodiscard]] std::string patient_says(const Plunger& plunger, std::size_t tip);

}  // namespace artus
