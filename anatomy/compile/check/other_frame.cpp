// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/anatomy/compile/check/misplaced.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr std::size_t kPoints = 200;          // of each surface
constexpr double kClear = 0.5 * kMillimetre;  // as find_misplaced
constexpr double kMisfit = 0.1;               // share of points; a structure that fits has less
constexpr double kFit = 0.02;                 // share of points
constexpr double kNearlyAll = 0.9;            // from here on the mistake is no question
constexpr double kSizeGain = 2;               // a unit that fits brings the size so much nearer

/// A mistake that exports make, and what undoes it.
struct Slip {
  double x, y, z;  ///< factors that undo it
  const char* name;
  [[nodiscard]] Vec3 scale() const { return {x, y, z}; }
};
constexpr Slip scaled(double factor, const char* name) {
  return {factor, factor, factor, name};
}
constexpr double kInch = 25.4;
constexpr std::array<Slip, 12> kSlips{{
    {-1, 1, 1, "mirrored along x"},
    {1, -1, 1, "mirrored along y"},
    {1, 1, -1, "mirrored along z"},
    {-1, -1, 1, "in RAS among LPS, or the other way round (x and y reversed)"},
    scaled(10, "10 times too small (cm read as mm: units = \"cm\")"),
    scaled(kInch, "25.4 times too small (inches read as mm)"),
    scaled(100, "100 times too small"),
    scaled(1000, "1000 times too small (m read as mm: units = \"m\")"),
    scaled(0.1, "10 times too large (mm read as cm: units = \"mm\")"),
    scaled(1 / kInch, "25.4 times too large (mm read as inches)"),
    scaled(0.01, "100 times too large"),
    scaled(0.001, "1000 times too large (mm read as m: units = \"mm\")"),
}};

class OtherFrames {
 public:
  OtherFrames(const JointFile& file, const PreparedSurfaces& surfaces)
      : file_(file), surfaces_(surfaces) {
    for (const Structure& s : file.structures)
      is_hard_.push_back(
          std::any_of(file.tissues.begin(), file.tissues.end(),
                      [&](const Tissue& t) { return t.name == s.tissue && t.haptic.hard; }));
  }

  std::vector<Finding> run() const {
    std::vector<Finding> found;
    for (std::size_t i = 0; i < file_.structures.size(); ++i) {
      if (!surfaces_.structures[i]) continue;
      const auto points = points_of(surfaces_.structures[i]->mesh);
      const double now = misfit(i, points, Vec3::Ones());
      if (now < kMisfit) continue;
      if (const auto* slip = find_slip(i, points)) found.push_back(tell(i, points, now, *slip));
    }
    return found;
  }

 private:
  static std::vector<Vec3> points_of(const SurfaceMesh& mesh) {
    std::vector<Vec3> points;
    const std::size_t step = mesh.vertices.size() / kPoints + 1;
    for (std::size_t i = 0; i < mesh.vertices.size(); i += step) points.push_back(mesh.vertices[i]);
    return points;
  }

  /// The share of points that lie clearly outside of the body or in a bone of another name.
  [[nodiscard]] double misfit(std::size_t i, const std::vector<Vec3>& points,
                              const Vec3& scale) const {
    std::size_t n = 0;
    for (const Vec3& p : points) n += is_astray(i, p.cwiseProduct(scale)) ? 1U : 0U;
    return static_cast<double>(n) / static_cast<double>(points.size());
  }

  [[nodiscard]] bool is_astray(std::size_t i, const Vec3& p) const {
    const DistanceTree& body = surfaces_.body.tree;
    if (body.winding_number(p) <= 0.5) return body.distance(p, kClear) >= kClear;
    for (std::size_t k = 0; k < file_.structures.size(); ++k) {
      if (k == i || !surfaces_.structures[k] || !is_hard_[k]) continue;
      const DistanceTree& bone = surfaces_.structures[k]->tree;
      if ((p.array() < bone.lower().array()).any() || (p.array() > bone.upper().array()).any())
        continue;
      if (bone.winding_number(p) > 0.5 && bone.distance(p, kClear) >= kClear) return true;
    }
    return false;
  }

  [[nodiscard]] double size_of(std::size_t k) const {
    const DistanceTree& tree = surfaces_.structures[k]->tree;
    return (tree.upper() - tree.lower()).norm();
  }

  /// The usual size of the others of its tissue, or of all others; 0: there are none.
  [[nodiscard]] double usual_size(std::size_t i) const {
    std::vector<double> like, all;
    for (std::size_t k = 0; k < file_.structures.size(); ++k) {
      if (k == i || !surfaces_.structures[k]) continue;
      all.push_back(size_of(k));
      if (file_.structures[k].tissue == file_.structures[i].tissue) like.push_back(all.back());
    }
    auto& sizes = like.empty() ? all : like;
    if (sizes.empty()) return 0;
    std::sort(sizes.begin(), sizes.end());
    return sizes[sizes.size() / 2];
  }

  [[nodiscard]] const Slip* find_slip(std::size_t i, const std::vector<Vec3>& points) const {
    const auto* surface = std::get_if<SurfaceFile>(&file_.structures[i].shape);
    const bool has_unit = surface != nullptr && surface->has_own_unit;
    const double usual = usual_size(i);
    const double off_now = usual > 0 ? std::abs(std::log(size_of(i) / usual)) : 0;
    const Slip* best = nullptr;
    double least = kFit;
    double best_size = 0;
    for (const Slip& slip : kSlips) {
      const double factor = std::abs(slip.x);
      const bool is_size = factor != 1;
      const double off = usual > 0 ? std::abs(std::log(factor * size_of(i) / usual)) : 0;
      if (is_size && (has_unit || !(off + std::log(kSizeGain) < off_now))) continue;
      const double share = misfit(i, points, slip.scale());
      const bool is_better =
          best == nullptr ? share <= least : share < least || (share == least && off < best_size);
      if (!is_better) continue;
      best = &slip;
      least = share;
      best_size = off;
    }
    return best;
  }

  [[nodiscard]] Finding tell(std::size_t i, const std::vector<Vec3>& points, double now,
                             const Slip& slip) const {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
    const double away = (middle.cwiseProduct(slip.scale()) - middle).norm();
    return {now < kNearlyAll ? Verdict::look : Verdict::refused, "other_frame",
            file_.structures[i].name, file_.structures[i].line,
            printed("%.0f %% of it lies outside of the skin or inside a bone, and none of it would "
                    "if it were not %s: its middle would lie %.0f mm from here; is that its "
                    "mistake? export it in the frame and unit of the others",
                    100 * now, slip.name, away / kMillimetre)};
  }

  const JointFile& file_;
  const PreparedSurfaces& surfaces_;
  std::vector<bool> is_hard_;
};

}  // namespace

std::vector<Finding> find_other_frames(const JointFile& file, const PreparedSurfaces& surfaces) {
  return OtherFrames(file, surfaces).run();
}

}  // namespace artus
