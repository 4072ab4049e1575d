// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"

namespace artus {

/// How a liquid resists being sheared: Carreau's law, mu = mu_inf + (mu_0 - mu_inf) (1 + (lambda
/// g)^2)^((n - 1)/2). Newtonian: zero == infinite.
struct Viscosity {
  double zero = 1e-3;      ///< Pa s, mu_0
  double infinite = 1e-3;  ///< Pa s, mu_inf
  double relaxation = 0;   ///< s, lambda
  double power = 1;        ///< n
  [[nodiscard]] bool newtonian() const noexcept { return zero == infinite; }
  /// Pa s at shear rate `rate`, 1/s.
  [[nodiscard]] double at(double rate) const noexcept;
};

/// Something that may be in a syringe or come into one.
struct Liquid {
  std::string name;
  Viscosity viscosity;
  double density = 1000;    ///< kg/m^3
  std::string tissue;       ///< of the tissue library: what sound meets in it
  double backscatter = 0;   ///< rms speckle amplitude of its grains relative to muscle (1)
  double solids = 0;        ///< share of the volume that is grains
  double grain_radius = 0;  ///< m
  std::string source;       ///< reference or "assumed: why"
};

/// The liquids of a file in file order. Errors: not_found, malformed (with line), invalid (unknown
/// key, missing value, value out of its physical range).
[[nodiscard]] Result<std::vector<Liquid>> read_liquids(const std::filesystem::path& file);

/// The same from memory; `name` stands in messages.
[[nodiscard]] Result<std::vector<Liquid>> parse_liquids(std::string_view text,
                                                        const std::string& name);

/// The liquids that come with artus (meshes/liquids.toml, built in).
[[nodiscard]] Result<std::vector<Liquid>> read_bundled_liquids();

/// What the tissue of a region that holds an injected liquid is called, and whether a tissue is
/// such.
[[nodiscard]] std::string injected_tissue_name(const Liquid& liquid);
[[nodiscard]] bool is_injected(std::string_view tissue_name) noexcept;

/// Errors: not_found, with the names there are.
[[nodiscard]] Result<Liquid> find_liquid(std::span<const Liquid> liquids, std::string_view name);

}  // namespace artus
