// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/meshes/generate/solids/surfacing.h"

namespace artus {

/// A length, angle or area of a generated joint beside what was published of adults.
struct Measure {
  std::string what;
  double value = 0;  ///< mm, or degrees or mm2 where `what` says so
  double least = 0;  ///< of adults, in the same unit
  double most = 0;
  std::string source;

  [[nodiscard]] bool is_within() const { return value >= least && value <= most; }
};

/// m between the places of a line that are looked at.
inline constexpr double kMeasureStep = 0.02e-3;

/// Requires: one of the solids has that name.
[[nodiscard]] Field field_of(const std::vector<Solid>& solids, const std::string& name);

/// What of a line from `from` over `length` lies in a solid and in none of those before it, m.
/// Requires: `along` has length 1.
[[nodiscard]] double length_inside(const Vec3& from, const Vec3& along, double length,
                                   const Field& solid, const std::vector<Field>& before);

/// The last point of a line out of `from` that lies in the solid, m from `from`; 0: none does.
/// Requires: `along` has length 1.
[[nodiscard]] double last_inside(const Vec3& from, const Vec3& along, double length,
                                 const Field& solid);

/// How wide the solid is along `axis`, as far as it lies within `half` of `centre` along all three
/// axes, m, to `step`.
[[nodiscard]] double width_along(const Field& solid, const Vec3& centre, const Vec3& half, int axis,
                                 double step = 1e-3);

/// The area of what of a plane through `centre`, across `normal` and within `reach` of it, lies in
/// the solid, m2. Requires: `normal` has length 1.
[[nodiscard]] double area_across(const Field& solid, const Vec3& centre, const Vec3& normal,
                                 double reach);

/// Measures as a page: a table in Markdown of the joint called so on the command line.
[[nodiscard]] std::string to_markdown(const std::string& joint,
                                      const std::vector<Measure>& measures);

}  // namespace artus
