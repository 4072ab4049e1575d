// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/mesh_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

/// The body's direction of a letter in the joint's frame.
Vec3 direction_of(const std::string& axes, char letter, char opposite) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const Vec3 axis = Vec3::Unit(static_cast<Eigen::Index>(k % 3));
    if (axes[k] == letter) return axis;
    if (axes[k] == opposite) return -axis;
  }
  return Vec3::UnitZ();
}

/// Maps the joint's frame to pixels.
class Projection {
 public:
  Projection(std::span<const ColouredMesh> meshes, const MeshView& view, cv::Size size)
      : view_(view), toward_(view.right.cross(view.up)) {
    Eigen::AlignedBox2d box;
    for (const ColouredMesh& m : meshes)
      for (const Triangle& t : m.mesh.triangles)
        for (const auto v : t) box.extend(flat(m.mesh.vertices[v]));
    if (box.isEmpty()) box.extend(Eigen::Vector2d::Zero());
    constexpr double kFilled = 0.9;
    const Eigen::Vector2d extent = box.sizes().cwiseMax(1e-6);
    scale_ = kFilled * std::min(size.width / extent.x(), size.height / extent.y());
    centre_ = box.center();
    middle_ = {size.width / 2.0, size.height / 2.0};
  }
  /// x, y in pixels, z toward the viewer in m.
  [[nodiscard]] Vec3 operator()(const Vec3& p) const {
    const Eigen::Vector2d q = scale_ * (flat(p) - centre_);
    return {middle_.x() + q.x(), middle_.y() - q.y(), p.dot(toward_)};
  }
  [[nodiscard]] double scale() const noexcept { return scale_; }
  [[nodiscard]] const Vec3& toward() const noexcept { return toward_; }

 private:
  [[nodiscard]] Eigen::Vector2d flat(const Vec3& p) const {
    return {p.dot(view_.right), p.dot(view_.up)};
  }
  MeshView view_;
  Vec3 toward_;
  Eigen::Vector2d centre_, middle_;
  double scale_ = 1;
};

/// Draws triangles over what lies behind them.
class Canvas {
 public:
  explicit Canvas(cv::Size size)
      : image_(size, CV_8UC3, cv::Scalar::all(255)),
        depth_(size, CV_64FC1, cv::Scalar::all(-std::numeric_limits<double>::infinity())) {}

  void draw(const std::array<Vec3, 3>& p, const cv::Vec3b& colour) {
    const double area = cross(p[1] - p[0], p[2] - p[0]);
    if (std::abs(area) < 1e-9) return;
    const auto [low_x, high_x] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
    const auto [low_y, high_y] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
    const int y_end = std::min(image_.rows - 1, static_cast<int>(std::floor(high_y)));
    const int x_end = std::min(image_.cols - 1, static_cast<int>(std::floor(high_x)));
    for (int y = std::max(0, static_cast<int>(std::floor(low_y))); y <= y_end; ++y)
      for (int x = std::max(0, static_cast<int>(std::floor(low_x))); x <= x_end; ++x) {
        const Vec3 q(x + 0.5, y + 0.5, 0);
        const double a = cross(p[1] - q, p[2] - q) / area;
        const double b = cross(p[2] - q, p[0] - q) / area;
        if (a < 0 || b < 0 || a + b > 1) continue;
        const double z = a * p[0].z() + b * p[1].z() + (1 - a - b) * p[2].z();
        if (z <= depth_.at<double>(y, x)) continue;
        depth_.at<double>(y, x) = z;
        image_.at<cv::Vec3b>(y, x) = colour;
      }
  }
  [[nodiscard]] cv::Mat& image() noexcept { return image_; }

 private:
  static double cross(const Vec3& a, const Vec3& b) { return a.x() * b.y() - a.y() * b.x(); }
  cv::Mat image_;
  cv::Mat depth_;
};

cv::Vec3b lit(const cv::Vec3b& colour, double facing) {
  const double light = 0.35 + 0.65 * std::abs(facing);
  cv::Vec3b out;
  for (int c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(std::lround(light * colour[c]));
  return out;
}

void draw_scale(cv::Mat& image, double pixels_per_m) {
  constexpr int kFromEdge = 8;  // pixels
  const int length = static_cast<int>(std::lround(10 * kMillimetre * pixels_per_m));
  if (length < 4 || length > image.cols / 2) return;
  const cv::Point left(kFromEdge, image.rows - kFromEdge);
  cv::line(image, left, left + cv::Point(length, 0), cv::Scalar::all(0), 2);
  cv::putText(image, "10 mm", left + cv::Point(0, -5), cv::FONT_HERSHEY_SIMPLEX, 0.35,
              cv::Scalar::all(0), 1, cv::LINE_AA);
}

}  // namespace

std::vector<MeshView> picture_views(const std::string& axes, const std::string& side) {
  const Vec3 left = direction_of(axes, 'L', 'R');
  const Vec3 front = direction_of(axes, 'A', 'P');
  const Vec3 up = direction_of(axes, 'S', 'I');
  if (side == "left") return {{"from the front", left, up}, {"from the left", Vec3(-front), up}};
  return {{"from the front", left, up}, {"from the right", front, up}};
}

SurfaceMesh region_surface(const CompiledJoint& joint, RegionId region) {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> index(joint.mesh.vertices.size(), UINT32_MAX);
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != region && f.back != region) continue;
    Triangle t{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& v = index[f.vertices[k]];
      if (v == UINT32_MAX) {
        v = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(joint.mesh.vertices[f.vertices[k]]);
      }
      t[k] = v;
    }
    if (f.front == region) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
  return mesh;
}

ColouredMesh coloured(const SurfaceMesh& mesh, const cv::Vec3b& colour) {
  ColouredMesh out;
  out.mesh.vertices = mesh.vertices;
  for (const Triangle& t : mesh.triangles)
    if (std::all_of(t.begin(), t.end(), [&](auto v) {
          return v < mesh.vertices.size() && mesh.vertices[v].allFinite();
        }))
      out.mesh.triangles.push_back(t);
  out.colours.assign(out.mesh.triangles.size(), colour);
  return out;
}

cv::Mat draw_meshes(std::span<const ColouredMesh> meshes, const MeshView& view, cv::Size size,
                    std::span<const Vec3> marks) {
  const Projection project(meshes, view, size);
  Canvas canvas(size);
  for (const ColouredMesh& m : meshes)
    for (std::size_t i = 0; i < m.mesh.triangles.size(); ++i) {
      const Triangle& t = m.mesh.triangles[i];
      const Vec3& a = m.mesh.vertices[t[0]];
      const Vec3& b = m.mesh.vertices[t[1]];
      const Vec3& c = m.mesh.vertices[t[2]];
      const Vec3 normal = (b - a).cross(c - a);
      const double facing = normal.norm() > 0 ? normal.normalized().dot(project.toward()) : 0;
      canvas.draw({project(a), project(b), project(c)}, lit(m.colours[i], facing));
    }
  for (const Vec3& mark : marks) {
    constexpr int kRadius = 8;  // pixels
    const Vec3 p = project(mark);
    cv::circle(canvas.image(), cv::Point(static_cast<int>(p.x()), static_cast<int>(p.y())), kRadius,
               cv::Scalar(40, 40, 220), 2, cv::LINE_AA);
  }
  draw_scale(canvas.image(), project.scale());
  return canvas.image();
}

cv::Vec3b distance_colour(double distance, double worst) {
  const double share = std::clamp(distance / worst, 0.0, 1.0);
  const auto level = [](double value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
  };
  return {level(0.25 * (1 - share)), level(2 - 2 * share), level(2 * share)};
}

}  // namespace artus
