// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/joint3d/body_mark.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace artus {
namespace {

constexpr std::uint8_t kSkin = 70;
constexpr std::uint8_t kBone = 165;
constexpr int kMargin = 2;  // pixels round the body

}  // namespace

BodyMark make_body_mark(const CompiledJoint& joint, int size) {
  BodyMark mark;
  mark.size = size;
  mark.X_JM = joint.X_JP_default;
  const Pose X_MJ = mark.X_JM.inverse();
  Vec3 low = Vec3::Constant(1e9);
  Vec3 high = -low;
  std::vector<Vec3> skin;  // corners of triangles, frame of the usual probe
  std::vector<Vec3> bone;
  for (const Interface& face : joint.mesh.interfaces) {
    const auto is_bone = [&joint](RegionId region) {
      return region >= kFirstRegion && joint.tissue_of(region).haptic.hard;
    };
    const bool outer = face.front == kOutside || face.back == kOutside;
    if (!outer && !is_bone(face.front) && !is_bone(face.back)) continue;
    for (const std::uint32_t v : face.vertices) {
      const Vec3 p = X_MJ * joint.mesh.vertices[v];
      (outer ? skin : bone).push_back(p);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  const Vec3 middle = skin.empty() && bone.empty() ? Vec3(Vec3::Zero()) : Vec3((low + high) / 2);
  const double widest = std::max({1e-3, high.x() - low.x(), high.y() - low.y()});
  mark.pixel = widest / (size - 2 * kMargin);
  mark.X_JM.translation() = mark.X_JM * Vec3(middle.x(), middle.y(), 0);
  const auto map_of = [&](const std::vector<Vec3>& corners) {
    cv::Mat map(size, size, CV_8UC1, cv::Scalar(0));
    std::array<cv::Point, 3> triangle;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3 p = (corners[i] - middle) / mark.pixel;
      triangle[i % 3] = {static_cast<int>(std::floor(p.x() + size / 2.0)),
                         static_cast<int>(std::floor(p.y() + size / 2.0))};
      if (i % 3 == 2) cv::fillConvexPoly(map, triangle.data(), 3, cv::Scalar(255));
    }
    return map;
  };
  const cv::Mat bones = map_of(bone);
  cv::Mat all = map_of(skin) / 255 * kSkin;
  all.setTo(kBone, bones);
  mark.grey.assign(all.begin<std::uint8_t>(), all.end<std::uint8_t>());
  return mark;
}

MarkLine probe_on_mark(const BodyMark& mark, const Pose& X_JP, double probe_width) {
  const Pose X_MP = mark.X_JM.inverse() * X_JP;
  const auto at = [&](double x) {
    const Vec3 p = X_MP * Vec3(x, 0, 0);
    const auto on_map = [&mark](double v) {
      return static_cast<float>(std::clamp(v / mark.pixel + mark.size / 2.0, 0.0, 1.0 * mark.size));
    };
    return std::pair(on_map(p.x()), on_map(p.y()));
  };
  const auto [x0, y0] = at(-probe_width / 2);
  const auto [x1, y1] = at(probe_width / 2);
  return {x0, y0, x1, y1};
}

}  // namespace artus
