// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/echo/echo_muscle_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/core/units.h"
#include "artus/detail/evidence/validation/echo/echo_patch.h"

namespace artus {
namespace {

constexpr double kSteepest = 20 * kDegree;  // rad, of fibres to the face
constexpr double kSlide = 10e-3;            // m
constexpr int kSlides = 4;
constexpr double kAbove = 60e-3;    // m, from where the skin is looked for, and how far below
constexpr double kPress = 0.5e-3;   // m, face outside the skin
constexpr double kMaxTilt = 0.5;    // cosine between the skin's normal and the old axis
constexpr std::size_t kRoom = 256;  // intervals

}  // namespace

MuscleFinder::MuscleFinder(const Scene& scene, const Transducer& transducer,
                           const ImageSettings& settings)
    : scene_(&scene),
      transducer_(transducer),
      gel_limit_(settings.gel_limit),
      labels_(transducer, settings),
      regions_(make_region_acoustics(scene.joint(), transducer)) {
  add_courses(scene.joint(), regions_);
}

/// Mean angle of the fibres to the face in a patch, rad.
double MuscleFinder::fibre_slope(const Pose& X_JP, const LabelImage& labels,
                                 const cv::Rect& patch) const {
  constexpr int kParts = 6;
  double sum = 0;
  for (int j = 0; j < kParts; ++j) {
    for (int i = 0; i < kParts; ++i) {
      const int x = patch.x + (2 * i + 1) * patch.width / (2 * kParts);
      const int y = patch.y + (2 * j + 1) * patch.height / (2 * kParts);
      const RegionAcoustics& region =
          regions_[labels.regions[static_cast<std::size_t>(y) *
                                      static_cast<std::size_t>(labels.width) +
                                  static_cast<std::size_t>(x)]];
      if (!region.course && region.fibre.squaredNorm() < 0.5) continue;
      const MaterialPoint place =
          locate_in_material(region, X_JP * labels_.converter().point_of(x, y));
      const Vec3 across = place.gradient.row(0);
      const Vec3 beside = place.gradient.row(1);
      const Vec3 fibre_P = X_JP.linear().transpose() * across.cross(beside).normalized();
      sum += std::asin(std::min(1.0, std::abs(fibre_P.z())));
    }
  }
  return sum / (kParts * kParts);
}

std::vector<cv::Rect> MuscleFinder::find_patches(const Pose& X_JP, int size,
                                                 std::size_t count) const {
  const LabelImage labels = labels_.render(*scene_, X_JP);
  std::vector<cv::Rect> patches = find_muscle_patches(labels, scene_->joint(), size, count);
  const auto is_steep = [&](const cv::Rect& patch) {
    return fibre_slope(X_JP, labels, patch) > kSteepest;
  };
  patches.erase(std::remove_if(patches.begin(), patches.end(), is_steep), patches.end());
  return patches;
}

/// The pose on the skin below or above `X_JP`, its axis along the skin's normal.
std::optional<Pose> MuscleFinder::stand_on_skin(const Pose& X_JP) const {
  std::array<TissueInterval, kRoom> intervals;
  const Vec3 from = X_JP * Vec3(0, 0, -kAbove);
  const Vec3 down = X_JP.linear().col(2);
  const QueryCount count = scene_->find_intervals({from, from + 2 * kAbove * down}, intervals);
  for (std::size_t i = 1; i < count.size; ++i) {
    if (intervals[i].region < kFirstRegion) continue;
    const Vec3 into = -intervals[i].entry_normal;
    if (into.dot(down) < kMaxTilt) return std::nullopt;
    return make_pose(from + intervals[i].entry * down - kPress * into, into, X_JP.linear().col(0));
  }
  return std::nullopt;
}

/// Whether the whole face couples to the skin.
bool MuscleFinder::touches(const Pose& X_JP) const {
  constexpr int kParts = 4;
  std::array<TissueInterval, kRoom> intervals;
  for (int k = 0; k <= kParts; ++k) {
    const double x = transducer_.width * (static_cast<double>(k) / kParts - 0.5);
    const Vec3 from = X_JP * Vec3(x, 0, 0);
    const QueryCount count =
        scene_->find_intervals({from, from + kAbove * X_JP.linear().col(2)}, intervals);
    if (count.size == 0 || (intervals[0].region == kOutside && intervals[0].exit > gel_limit_))
      return false;
  }
  return true;
}

std::optional<Pose> MuscleFinder::slide_to_muscle(const Pose& X_JP, int size) const {
  if (!find_patches(X_JP, size, 1).empty()) return X_JP;
  for (int step = 1; step <= kSlides; ++step) {
    for (const Vec3& direction : {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 1, 0)}) {
      auto pose = stand_on_skin(X_JP * Eigen::Translation3d(step * kSlide * direction));
      if (pose && touches(*pose) && !find_patches(*pose, size, 1).empty()) return pose;
    }
  }
  return std::nullopt;
}

}  // namespace artus
