// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "artus/detail/anatomy/source/joint_parameter.h"

namespace artus {

/// How something is distributed among people. One of three: a normal distribution clipped at 2 SD
/// (`sd` set), `quantiles`, or yes and no (`chance`).
struct Quantity {
  std::string name;
  std::string title;
  std::string unit;
  bool person = false;                               ///< says who it is; no joint need have it
  std::array<double, 2> mean{};                      ///< of men, of women
  std::array<double, 2> sd{};                        ///< likewise; 0: not normal
  std::vector<std::pair<double, double>> quantiles;  ///< value, share of people below it
  std::vector<std::pair<double, double>> chance;     ///< from this age on, probability
  std::vector<std::string> unless;  ///< earlier yes or no: never yes together with any of these
  std::vector<std::pair<std::size_t, double>> along;  ///< earlier quantity, correlation
  std::string source;
};

/// A patient that has a name.
struct KnownPatient {
  std::string name;
  std::string title;
  std::vector<PatientValue> values;
  std::string source;
};

struct Population {
  std::vector<Quantity> quantities;  ///< in the order in which they are drawn
  std::vector<KnownPatient> profiles;
  /// Null where there is none.
  [[nodiscard]] const Quantity* find(std::string_view name) const;
};

/// Errors: malformed (with line), invalid: every problem in one message.
[[nodiscard]] Result<Population> parse_population(std::string_view text, const std::string& name);

/// The one that comes with artus (meshes/patients.toml, built in).
[[nodiscard]] Result<Population> read_bundled_population();

/// All quantities of a patient, those of `given` as they are, the others drawn given them: each has
/// a normal score z = sum of r z' over what it goes along with + sqrt(1 - sum r^2) e, with e of
/// `seed` and its name alone; then mean + sd z clipped at 2 SD, the quantile of z, or whether
/// z exceeds the chance's. Rounded to 0.01. Values of `given` that are no quantity are kept at the
/// end. Cost: microseconds.
[[nodiscard]] std::vector<PatientValue> draw_patient(const Population& population,
                                                     std::uint64_t seed,
                                                     const std::vector<PatientValue>& given = {});

}  // namespace artus
