// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace artus {

std::vector<CurvePoint> thinned(const std::vector<CurvePoint>& curve) {
  std::vector<CurvePoint> kept;
  for (std::size_t first = 0; first < curve.size();) {
    std::size_t low = first;
    std::size_t high = first;
    std::size_t end = first;
    for (; end < curve.size() && std::floor(curve[end].x) == std::floor(curve[first].x); ++end) {
      if (curve[end].y < curve[low].y) low = end;
      if (curve[end].y > curve[high].y) high = end;
    }
    std::array<std::size_t, 4> of_column{first, low, high, end - 1};
    std::sort(of_column.begin(), of_column.end());
    for (std::size_t i = 0; i < of_column.size(); ++i)
      if (i == 0 || of_column[i] != of_column[i - 1]) kept.push_back(curve[of_column[i]]);
    first = end;
  }
  return kept;
}

}  // namespace artus
