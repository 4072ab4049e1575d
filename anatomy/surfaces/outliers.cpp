// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kSizeRatio = 15;
constexpr std::size_t kFewestOfKind = 3;

Eigen::AlignedBox3d box_of(const SurfaceMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& t : mesh.triangles)
    for (const auto v : t)
      if (v < mesh.vertices.size() && mesh.vertices[v].allFinite()) box.extend(mesh.vertices[v]);
  return box;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string describe_size(double size, double usual) {
  return printed(
      "is %.4g mm from corner to corner, similar structures about %.4g mm: %.4g times %s; if its "
      "unit is wrong, give this file its own 'units'; if it is right, give them too, to confirm it",
      size / kMillimetre, usual / kMillimetre, size > usual ? size / usual : usual / size,
      size > usual ? "too large" : "too small");
}

/// The usual size of what `surfaces[i]` should be like: the others of its tissue, or all others.
double usual_size(const std::vector<NamedSurface>& surfaces, const std::vector<double>& sizes,
                  std::size_t i) {
  std::vector<double> like;
  std::vector<double> others;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (k == i || sizes[k] <= 0) continue;
    others.push_back(sizes[k]);
    if (surfaces[k].tissue == surfaces[i].tissue) like.push_back(sizes[k]);
  }
  if (like.size() + 1 >= kFewestOfKind) return median(std::move(like));
  return others.empty() ? sizes[i] : median(std::move(others));
}

/// The middle of the others and how far they reach around it, robust against outliers.
struct Surroundings {
  Vec3 centre = Vec3::Zero();
  double reach = 0;
};

Surroundings surroundings_of(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t i) {
  Surroundings around;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> centres;
    for (std::size_t k = 0; k < boxes.size(); ++k)
      if (k != i && !boxes[k].isEmpty()) centres.push_back(boxes[k].center()[axis]);
    if (centres.empty()) return around;
    around.centre[axis] = median(std::move(centres));
  }
  std::vector<double> reaches;
  for (std::size_t k = 0; k < boxes.size(); ++k)
    if (k != i && !boxes[k].isEmpty())
      reaches.push_back((boxes[k].center() - around.centre).norm() +
                        boxes[k].diagonal().norm() / 2);
  std::sort(reaches.begin(), reaches.end());
  around.reach = reaches[reaches.size() * 9 / 10];
  return around;
}

}  // namespace

std::vector<Defect> find_outliers(const std::vector<NamedSurface>& surfaces) {
  std::vector<Eigen::AlignedBox3d> boxes;
  std::vector<double> sizes;
  for (const auto& s : surfaces) {
    boxes.push_back(box_of(s.mesh));
    sizes.push_back(boxes.back().isEmpty() ? 0 : boxes.back().diagonal().norm());
  }
  std::vector<Defect> defects;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (sizes[i] <= 0 || surfaces.size() < kFewestOfKind) continue;
    const double usual = usual_size(surfaces, sizes, i);
    if (!surfaces[i].has_own_unit && std::max(sizes[i] / usual, usual / sizes[i]) > kSizeRatio)
      defects.push_back({DefectKind::size_outlier,
                         surfaces[i].name,
                         1,
                         {},
                         boxes[i].center(),
                         describe_size(sizes[i], usual)});
    const auto around = surroundings_of(boxes, i);
    const double away = boxes[i].exteriorDistance(around.centre);
    if (away > 2 * around.reach) {
      const std::string text = printed(
          "lies %.4g mm from the middle of the others, which reach "
          "%.4g mm; is it in another unit or frame?",
          away / kMillimetre, around.reach / kMillimetre);
      defects.push_back(
          {DefectKind::place_outlier, surfaces[i].name, 1, {}, boxes[i].center(), text});
    }
  }
  return defects;
}

}  // namespace artus
