// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

#include "artus/detail/core/check.h"

namespace artus {

/// One layer of the tissue column under a piece of the probe's face.
struct ColumnLayer {
  double thickness = 0;  ///< m, undeformed
  double modulus = 0;    ///< Pa at small strain
};

/// How a column stiffens and what it stands on.
struct ColumnParams {
  double strain_limit = 0.6;  ///< strain that no load exceeds; assumed: soft tissue under a probe
  double stop_stiffness =
      1e10;  ///< Pa/m of what the column stands on (bone); assumed: finite, far above any tissue
  double min_modulus = 100;  ///< Pa, for tissues without a value; assumed
};

/// The answer of a column.
struct ColumnResponse {
  double pressure = 0;   ///< Pa
  double stiffness = 0;  ///< Pa/m, d pressure / d indentation
  double energy = 0;     ///< J/m^2, the work of the pressure from no indentation on
};

/// J/m^3, the complementary energy of a layer per thickness under `pressure` (Pa): by how much the
/// energy stored at a given indentation falls per m that the layer gains.
[[nodiscard]] ARTUS_REALTIME double complementary_energy(const ColumnParams& params,
                                                         const ColumnLayer& layer,
                                                         double pressure) noexcept;

/// Compresses layers in series by `indentation` (m): all carry the same pressure s, each is
/// strained by (s/E) / (1 + s/(E e_max)), so at small strain the column is a series of springs of
/// E/thickness each, and a thin column over bone stiffens sharply. Indentation <= 0 gives nothing.
/// Cost: a few Newton steps, which converge monotonically; no allocation.
[[nodiscard]] ARTUS_REALTIME ColumnResponse compress_column(const ColumnParams& params,
                                                            std::span<const ColumnLayer> layers,
                                                            double indentation) noexcept;

}  // namespace artus
