// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>

#include "artus/core/result.h"
#include "artus/detail/haptics/plunger/plunger.h"

namespace artus {

/// What is put together before an injection: a person's choices, all with a default.
struct SyringeChoice {
  int gauge = 22;                 ///< of the needle
  double filled = 5e-6;           ///< m^3 of liquid drawn up
  double barrel = 0;              ///< m^3; 0: the smallest that holds `filled`
  double air = 0;                 ///< m^3 trapped behind the liquid
  double unbalanced = 0.05;       ///< see PlungerParams
  std::string liquid = "saline";  ///< of meshes/liquids.toml
  std::uint64_t seed = 1;         ///< of what happens by chance: grains that clog
};

/// Syringe, needle of `needle_length` (m) and liquids, ready for a Plunger. A barrel takes a fifth
/// more than its last mark says (assumed), so that a full one can be drawn. Errors: not_found
/// (gauge, liquid), invalid (a volume that is none, or more than the barrel holds).
[[nodiscard]] Result<PlungerParams> make_plunger_params(const SyringeChoice& choice,
                                                        double needle_length);

}  // namespace artus
