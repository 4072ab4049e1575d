// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "artus/detail/echo/display/scan_converter.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "artus/echo/frame.h"

/// The test objects that are looked at as a sonographer would.
namespace artus {

/// The clinical look, two threads, 0.1 mm a pixel, 45 mm deep.
[[nodiscard]] ImageSettings screen_settings();

/// A picture and where bone's surface lies in it.
struct ScreenPicture {
  cv::Mat image;                ///< 8-bit grey
  std::vector<double> surface;  ///< (columns) row of bone's surface; -1: none
  double pixel = 0;             ///< m
};

/// A ball of bone of radius 14 mm below 18 mm of skin, fat and muscle, by a bundled transducer.
[[nodiscard]] ScreenPicture picture_of_bone(const std::string& transducer);

/// Skin, fat and muscle with its fibres 15 degrees to the face.
[[nodiscard]] std::shared_ptr<const Scene> long_axis_muscle();

/// Skin and 18 mm of fat over muscle.
[[nodiscard]] std::shared_ptr<const Scene> deep_fat();

/// A nerve of 4 mm and an artery of 5 mm beside each other in fat over muscle.
[[nodiscard]] std::shared_ptr<const Scene> nerve_beside_artery();

/// Muscle alone, without texture: what needles are measured in.
[[nodiscard]] std::shared_ptr<const Scene> needle_scene();

/// A needle in the plane that passes 15 mm below the face's middle.
struct ScreenNeedle {
  NeedleView view;
  Vec3 tip = Vec3::Zero();   ///< m, frame P
  Vec3 axis = Vec3::Zero();  ///< unit, toward the tip
  double from = 0;           ///< m from the tip, where it is looked at
  double to = 0;             ///< m, up to there
  double left = 0;           ///< m, of the picture
  double pixel = 0;          ///< m
  [[nodiscard]] PixelPoint pixel_of(const Vec3& p_P) const noexcept {
    return {(p_P.x() - left) / pixel - 0.5, p_P.z() / pixel - 0.5};
  }
};
[[nodiscard]] ScreenNeedle make_screen_needle(double angle);

/// Where the cyst of a phantom is, m.
struct LumenPlace {
  double x = 0;
  double z = 0;
  double radius = 0;
};
[[nodiscard]] LumenPlace lumen_of(const EchoPhantom& phantom);

/// Mean power of the compressed lines within `radius` (m) of a place, dB.
[[nodiscard]] double mean_level(const Frame& frame, double x, double z, double radius);

}  // namespace artus
