// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/anatomy/body/tissue.h"

namespace artus {

/// How one tissue gives way, quasi-statically: a stable neo-Hookean solid that hardens, with fibres
/// that resist being stretched. Energy per rest volume, J/m^3:
///   mu/b (exp(b psi) - 1) + lambda/2 (J - 1)^2 + lambda/(3 w) <1 - J - v>^3 + k/2 <e>^2,
///   psi = (I_C - 3)/2 - (J - 1) + (J - 1)^2/2, e = (|F a|^2 - 1)/2, <e> = max(e, 0), v = firm_from
///   and w = v/10: lambda is a numerical value far below water's, so that what has lost the share v
///   of its volume gives little more.
/// At small strain it is linear elasticity with Lame's mu and lambda. Source [Smith2018] for the
/// part without b; b is Fung's exponent.
struct SoftMaterial {
  double shear = 0;      ///< Pa, mu across the fibres
  double bulk = 0;       ///< Pa, Lame's lambda
  double firm_from = 0;  ///< share of its volume it loses before its bulk hardens; 0: never does
  double hardening = 0;  ///< b
  double fibre_modulus = 0;   ///< Pa, k
  Vec3 fibre = Vec3::Zero();  ///< unit, a; zero: no fibres
  bool hard = false;          ///< bone and metal: moves as a rigid body
  /// Pa under which its fluid leaves for where nothing presses (element.h); 0: it stays.
  double drain_pressure = 0;
};

/// The mechanical values of a tissue, with where they come from.
struct SoftTissue {
  std::string tissue;         ///< name in the tissue library
  double shear = 0;           ///< Pa
  double hardening = 0;       ///< b
  double fibre_modulus = 0;   ///< Pa
  double drain_pressure = 0;  ///< Pa
  std::string source;         ///< reference or "assumed: why"
};

/// Rows [soft.NAME] of a file, in its order. Errors: malformed (with line), invalid.
[[nodiscard]] Result<std::vector<SoftTissue>> parse_soft_tissues(std::string_view text,
                                                                 const std::string& name);

/// Those that come with artus (meshes/soft_tissues.toml, built in).
[[nodiscard]] Result<std::vector<SoftTissue>> read_bundled_soft_tissues();

/// lambda from mu and Poisson's ratio. Requires: 0 <= ratio < 0.5.
[[nodiscard]] double lame_lambda(double shear, double poisson_ratio);

/// The material of a tissue: its own row of `values` or, for a tissue without one, its Young's
/// modulus. `poisson_ratio` is numerical: tissue hardly changes its volume, and a ratio of
/// 0.47 keeps the equations well conditioned; lambda is 50 kPa at least. Requires: 0 <= ratio <
/// 0.5.
[[nodiscard]] SoftMaterial make_soft_material(const Tissue& tissue,
                                              std::span<const SoftTissue> values, const Vec3& fibre,
                                              double poisson_ratio);

inline constexpr int kNoMaterial = -1;      ///< air, gel: nothing there
inline constexpr int kBeyondMaterial = -2;  ///< of the body, but beyond what is meshed: held

/// Which material is where, in frame C of a cage.
struct MaterialField {
  std::vector<SoftMaterial> materials;
  std::function<int(const Vec3& p_C)> at;  ///< index into materials, kNoMaterial, kBeyondMaterial
};

}  // namespace artus
