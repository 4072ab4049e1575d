// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/meshes/generate/shoulder.h"

namespace artus {

/// A length of the generated shoulder beside what was published of adults.
struct Measure {
  std::string what;
  double value = 0;  ///< mm
  double least = 0;  ///< mm, of adults
  double most = 0;   ///< mm
  std::string source;

  [[nodiscard]] bool is_within() const { return value >= least && value <= most; }
};

/// Lengths taken along lines through the solids of make_shoulder. Cost: some seconds.
[[nodiscard]] std::vector<Measure> measure_shoulder(const ShoulderSize& size);

/// They as a page: a table in Markdown.
[[nodiscard]] std::string to_markdown(const std::vector<Measure>& measures);

}  // namespace artus
