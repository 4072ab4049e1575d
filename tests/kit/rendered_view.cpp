// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/kit/rendered_view.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "artus/detail/devices/kit/marker_dictionary.h"

namespace artus::test {
namespace {

constexpr float kBlack = 0.04F;
constexpr float kWhite = 0.75F;

/// A flat thing: x right, y up and z towards who sees it; `shade` gives its light by place, or less
/// than 0 where it is not.
struct Plate {
  Pose X_CM;
  double half_width = 0;
  double half_height = 0;
  std::function<float(double, double)> shade;
};

class Canvas {
 public:
  Canvas(const kit::Lens& lens, const std::vector<Eigen::Vector2d>& looks)
      : lens_(lens), light_(lens.height, lens.width, 0.25F), looks_(looks) {}
  cv::Mat1f& light() { return light_; }

  void draw(const Plate& plate) {
    constexpr int kFine = 5;  // rays a pixel and direction
    const Vec3 centre = plate.X_CM.translation();
    if (plate.X_CM.linear().col(2).dot(centre) >= 0) return;
    double x0 = 1e9;
    double x1 = -1e9;
    double y0 = 1e9;
    double y1 = -1e9;
    for (const double sx : {-1.0, 0.0, 1.0})
      for (const double sy : {-1.0, 0.0, 1.0}) {
        const Vec3 corner = plate.X_CM * Vec3(sx * plate.half_width, sy * plate.half_height, 0);
        if (corner.z() < 0.05) return;
        const Eigen::Vector2d p = lens_.project(corner);
        x0 = std::min(x0, p.x());
        x1 = std::max(x1, p.x());
        y0 = std::min(y0, p.y());
        y1 = std::max(y1, p.y());
      }
    Eigen::Matrix3d to_picture;
    to_picture << plate.X_CM.linear().col(0), plate.X_CM.linear().col(1), centre;
    const Eigen::Matrix3d to_plate = to_picture.inverse();
    for (int j = std::max(0, static_cast<int>(y0) - 2);
         j <= std::min(light_.rows - 1, static_cast<int>(y1) + 2); ++j)
      for (int i = std::max(0, static_cast<int>(x0) - 2);
           i <= std::min(light_.cols - 1, static_cast<int>(x1) + 2); ++i) {
        const Eigen::Vector2d& look =
            looks_[static_cast<std::size_t>(j) * static_cast<std::size_t>(lens_.width) +
                   static_cast<std::size_t>(i)];
        const auto shade = [&](double u, double v) {
          const Vec3 hit = to_plate * Vec3(look.x() + u / lens_.fx, look.y() + v / lens_.fy, 1);
          const double x = hit.x() / hit.z();
          const double y = hit.y() / hit.z();
          if (std::abs(x) > plate.half_width || std::abs(y) > plate.half_height) return -1.0F;
          return plate.shade(x, y);
        };
        float& pixel = light_(j, i);
        const float first = shade(-0.5, -0.5);
        if (first == shade(0.5, -0.5) && first == shade(-0.5, 0.5) && first == shade(0.5, 0.5) &&
            first == shade(0, 0)) {
          if (first >= 0) pixel = first;
          continue;
        }
        float sum = 0;
        float hits = 0;
        for (int v = 0; v < kFine; ++v)
          for (int u = 0; u < kFine; ++u) {
            const float one = shade((u + 0.5) / kFine - 0.5, (v + 0.5) / kFine - 0.5);
            if (one < 0) continue;
            sum += one;
            hits += 1;
          }
        const float rays = kFine * kFine;
        pixel = (1 - hits / rays) * pixel + sum / rays;
      }
  }

 private:
  const kit::Lens& lens_;
  cv::Mat1f light_;
  const std::vector<Eigen::Vector2d>& looks_;
};

Plate plate_of(const kit::Marker& marker, const Pose& X_CB, double margin, float lit) {
  const double half = marker.side / 2;
  const double outer = half + margin * marker.side;
  const auto cells = kit::cells_of_marker(marker.id);
  return {X_CB * kit::pose_of_marker(marker), outer, outer, [half, cells, lit](double x, double y) {
            if (std::abs(x) >= half || std::abs(y) >= half) return lit * kWhite;
            const auto column = static_cast<std::size_t>((x + half) / (2 * half) * 6);
            const auto row = static_cast<std::size_t>((half - y) / (2 * half) * 6);
            return lit * (cells[std::min<std::size_t>(row, 5)][std::min<std::size_t>(column, 5)]
                              ? kWhite
                              : kBlack);
          }};
}

void draw_clutter(cv::Mat1f& light, int n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(0, 1);
  for (int k = 0; k < n; ++k) {
    const cv::Point at(static_cast<int>(any(random) * light.cols),
                       static_cast<int>(any(random) * light.rows));
    const int size = 6 + static_cast<int>(any(random) * 90);
    const auto grey = static_cast<float>(0.02 + 0.75 * any(random));
    const double kind = any(random);
    if (kind < 0.35)
      cv::rectangle(light, {at.x, at.y, size, static_cast<int>(size * (0.3 + any(random)))}, grey,
                    kind < 0.15 ? 3 : -1);
    else if (kind < 0.5)
      cv::circle(light, at, size / 2, grey, -1);
    else if (kind < 0.7)
      cv::putText(light, "artus 4711", at, cv::FONT_HERSHEY_SIMPLEX, size / 40.0, grey, 2);
    else if (kind < 0.85)
      for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 5; ++column)
          cv::rectangle(light,
                        {at.x + column * size / 5, at.y + row * size / 5, size / 5, size / 5},
                        any(random) < 0.5 ? kBlack : kWhite, -1);
    else
      cv::line(light, at, {at.x + 2 * size, at.y + size}, grey, 4);
  }
}

void draw_board(Canvas& canvas, const ShownBoard& board) {
  const double half_width = board.columns * board.square / 2;
  const double half_height = board.rows * board.square / 2;
  canvas.draw({board.X_CB, half_width + 5e-3, half_height + 5e-3,
               [board, half_width, half_height](double x, double y) {
                 if (std::abs(x) >= half_width || std::abs(y) >= half_height) return kWhite;
                 const int column = static_cast<int>((x + half_width) / board.square);
                 const int row = static_cast<int>((half_height - y) / board.square);
                 return (column + row) % 2 == 0 ? kBlack : kWhite;
               }});
}

void draw_finger(Canvas& canvas, const kit::Marker& marker, const Pose& X_CB,
                 std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  Pose X_CM = X_CB * kit::pose_of_marker(marker);
  const double radius = 7e-3;
  X_CM.translation() += X_CM.linear() * Vec3(any(random), any(random), 0) * marker.side / 2 +
                        2e-3 * X_CM.linear().col(2);
  canvas.draw({X_CM, radius, 3 * radius, [radius](double x, double y) {
                 return x * x + y * y / 9 < radius * radius ? 0.35F : -1.0F;
               }});
}

cv::Mat develop(cv::Mat1f light, const ViewFlaws& flaws, std::mt19937_64& random) {
  std::uniform_real_distribution<float> any(0, 1);
  const float tilt_x = any(random) * 2 - 1;
  const float tilt_y = any(random) * 2 - 1;
  for (int j = 0; j < light.rows; ++j)
    for (int i = 0; i < light.cols; ++i) {
      const float x = 2.0F * static_cast<float>(i) / static_cast<float>(light.cols) - 1;
      const float y = 2.0F * static_cast<float>(j) / static_cast<float>(light.rows) - 1;
      light(j, i) *= static_cast<float>(flaws.light) *
                     (1 - static_cast<float>(flaws.uneven) *
                              (0.5F + 0.25F * (tilt_x * x + tilt_y * y) + 0.2F * x * x));
    }
  if (flaws.blur > 0) cv::GaussianBlur(light, light, {}, flaws.blur);
  cv::Mat1f noise(light.size());
  cv::RNG rng(random() + flaws.picture);
  rng.fill(noise, cv::RNG::NORMAL, 0, flaws.noise);
  light += noise;
  cv::max(light, 0, light);
  cv::min(light, 1, light);
  cv::Mat1f shown;
  cv::pow(light, 1 / flaws.gamma, shown);
  if (flaws.sharpening > 0) {
    cv::Mat1f soft;
    cv::GaussianBlur(shown, soft, {}, 1.0);
    shown = shown + flaws.sharpening * (shown - soft);
  }
  cv::Mat grey;
  shown.convertTo(grey, CV_8U, 255);
  if (flaws.jpeg > 0) {
    std::vector<unsigned char> bytes;
    cv::imencode(".jpg", grey, bytes, {cv::IMWRITE_JPEG_QUALITY, flaws.jpeg});
    grey = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
  }
  return grey;
}

}  // namespace

ViewRenderer::ViewRenderer(const kit::Lens& lens) : lens_(lens) {
  for (int j = 0; j < lens.height; ++j)
    for (int i = 0; i < lens.width; ++i) looks_.push_back(lens.looks_at({i, j}));
}

cv::Mat ViewRenderer::render(const std::vector<ShownBody>& bodies, const ViewFlaws& flaws,
                             std::uint64_t seed, const ShownBoard* board) const {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  Canvas canvas(lens_, looks_);
  draw_clutter(canvas.light(), flaws.clutter, random);
  if (board != nullptr) draw_board(canvas, *board);
  std::vector<const ShownBody*> order;
  for (const ShownBody& body : bodies) order.push_back(&body);
  std::sort(order.begin(), order.end(), [](const ShownBody* a, const ShownBody* b) {
    return a->X_CB.translation().z() > b->X_CB.translation().z();
  });
  for (const ShownBody* shown : order) {
    if (shown->paper.x() > 0)
      canvas.draw({shown->X_CB, shown->paper.x(), shown->paper.y(), [](double, double) {
                     return kWhite;
                   }});
    for (const kit::Marker& marker : shown->body.markers) {
      const Vec3 normal = shown->X_CB.linear() * marker.normal();
      const auto lit = static_cast<float>(0.75 - 0.25 * normal.y());
      canvas.draw(plate_of(marker, shown->X_CB, shown->margin, lit));
    }
  }
  for (const ShownBody* shown : order)
    for (const kit::Marker& marker : shown->body.markers)
      if (any(random) < flaws.hidden) draw_finger(canvas, marker, shown->X_CB, random);
  return develop(canvas.light(), flaws, random);
}

}  // namespace artus::test
