// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/measures.h"

#include <algorithm>

#include "artus/detail/core/check.h"
#include "artus/detail/core/printed.h"

namespace artus {

Field field_of(const std::vector<Solid>& solids, const std::string& name) {
  const auto at =
      std::find_if(solids.begin(), solids.end(), [&](const Solid& s) { return s.name == name; });
  ARTUS_REQUIRE(at != solids.end(), "the joint has no such solid");
  return at->field;
}

double length_inside(const Vec3& from, const Vec3& along, double length, const Field& solid,
                     const std::vector<Field>& before) {
  double sum = 0;
  for (double t = 0; t < length; t += kMeasureStep) {
    const Vec3 p = from + t * along;
    if (solid(p) >= 0) continue;
    const bool taken =
        std::any_of(before.begin(), before.end(), [&](const Field& f) { return f(p) < 0; });
    if (!taken) sum += kMeasureStep;
  }
  return sum;
}

double last_inside(const Vec3& from, const Vec3& along, double length, const Field& solid) {
  double at = 0;
  for (double t = 0; t < length; t += kMeasureStep)
    if (solid(from + t * along) < 0) at = t;
  return at;
}

double width_along(const Field& solid, const Vec3& centre, const Vec3& half, int axis,
                   double step) {
  double least = 1;
  double most = -1;
  Vec3 d = Vec3::Zero();
  for (d.x() = -half.x(); d.x() <= half.x(); d.x() += step)
    for (d.y() = -half.y(); d.y() <= half.y(); d.y() += step)
      for (d.z() = -half.z(); d.z() <= half.z(); d.z() += step) {
        const double at = d[axis];
        if ((at > least && at < most) || solid(centre + d) >= 0) continue;
        least = std::min(least, at);
        most = std::max(most, at);
      }
  return most - least;
}

double area_across(const Field& solid, const Vec3& centre, const Vec3& normal, double reach) {
  constexpr double kCell = 0.05e-3;  // m
  const Vec3 a = normal.unitOrthogonal();
  const Vec3 b = normal.cross(a);
  int inside = 0;
  for (double u = -reach; u < reach; u += kCell)
    for (double v = -reach; v < reach; v += kCell)
      inside += solid(centre + u * a + v * b) < 0 ? 1 : 0;
  return inside * kCell * kCell;
}

std::string to_markdown(const std::string& joint, const std::vector<Measure>& measures) {
  std::string page = "# The bundled " + joint +
                     " beside published adults\n\nWritten by `artus_generate_meshes " + joint +
                     " --measures FILE`; a test of `tests/meshes` holds what is within its range "
                     "and what is not.\n\n| length | is, mm | adults, mm | within | source |\n"
                     "|---|---|---|---|---|\n";
  for (const Measure& m : measures)
    page += printed("| %s | %.1f | %.1f - %.1f | %s | %s |\n", m.what.c_str(), m.value, m.least,
                    m.most, m.is_within() ? "yes" : "no", m.source.c_str());
  return page;
}

}  // namespace artus
