// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/echo/realism_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/core/check.h"
#include "artus/detail/core/units.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"
#include "artus/echo/transducer_file.h"

namespace artus {
namespace {

constexpr double kTopOfBone = 18e-3;   // m
constexpr double kBoneRadius = 14e-3;  // m
constexpr int kCoarse = 3;             // 1280 triangles
constexpr double kDeepFat = 18e-3;     // m

std::shared_ptr<const Scene> scene_of(CompiledJoint joint) {
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(joint)));
}

CompiledJoint arm(double fibre_degrees, double fat = 4e-3) {
  const std::array<FlatLayer, 3> layers{{{"skin", 1.5e-3}, {"fat", fat}, {"muscle", 80e-3}}};
  CompiledJoint joint = make_layered_block(make_phantom_tissues(), layers, 160e-3, 60e-3);
  joint.regions.back().fibre_axis =
      Vec3(std::cos(fibre_degrees * kDegree), 0, std::sin(fibre_degrees * kDegree));
  return joint;
}

}  // namespace

ImageSettings screen_settings() {
  ImageSettings settings;
  settings.depth = 45e-3;
  settings.n_threads = 2;
  return settings;
}

ScreenPicture picture_of_bone(const std::string& transducer) {
  const auto preset = find_transducer(transducer);
  ARTUS_REQUIRE(preset.has_value(), "the bundled transducer is missing");
  CompiledJoint joint = arm(5);
  add_ball(joint, {"bone", Vec3(0, 0, kTopOfBone + kBoneRadius), kBoneRadius},
           region_named(joint, "muscle"), kCoarse);
  const ImageSettings settings = screen_settings();
  Renderer renderer(scene_of(std::move(joint)), preset->transducer, settings);
  const Frame& frame = renderer.render(Pose::Identity());
  ScreenPicture shown{grey_image(frame).clone(), {}, frame.pixel};
  const ScanConverter& converter = renderer.converter();
  for (int x = 0; x < frame.width; ++x) {
    const double beside = converter.point_of(x, 0).x();
    const double half = kBoneRadius * kBoneRadius - beside * beside;
    const double z = kTopOfBone + kBoneRadius - std::sqrt(std::max(0.0, half));
    shown.surface.push_back(half > 0 ? converter.pixel_of(Vec3(beside, 0, z)).y : -1);
  }
  return shown;
}

std::shared_ptr<const Scene> long_axis_muscle() {
  return scene_of(arm(15));
}

std::shared_ptr<const Scene> deep_fat() {
  return scene_of(arm(5, kDeepFat));
}

std::shared_ptr<const Scene> nerve_beside_artery() {
  CompiledJoint joint = arm(5, kDeepFat);
  const RegionId fat = region_named(joint, "fat");
  add_ball(joint, {"nerve", Vec3(-7e-3, 0, 12e-3), 2e-3}, fat, kCoarse + 1);
  add_ball(joint, {"artery", Vec3(2e-3, 0, 11e-3), 2.5e-3}, fat, kCoarse + 1);
  return scene_of(std::move(joint));
}

std::shared_ptr<const Scene> needle_scene() {
  const std::array<FlatLayer, 1> layers{{{"muscle", 80e-3}}};
  return make_block_scene(layers);
}

ScreenNeedle make_screen_needle(double angle) {
  constexpr double kPastMiddle = 8e-3;  // m of shaft beyond the middle
  constexpr double kLookedAt = 6e-3;    // m of shaft
  ScreenNeedle needle;
  needle.axis = Vec3(std::cos(angle), 0, std::sin(angle));
  needle.tip = Vec3(0, 0, 15e-3) + kPastMiddle * needle.axis;
  needle.view = needle_in_plane(Pose::Identity(), needle.tip, angle);
  needle.from = kPastMiddle - kLookedAt / 2;
  needle.to = kPastMiddle + kLookedAt / 2;
  const ImageSettings settings = screen_settings();
  needle.pixel = settings.pixel;
  needle.left = -Transducer{}.width / 2;
  return needle;
}

LumenPlace lumen_of(const EchoPhantom& phantom) {
  const auto& centre = phantom.truth.at("centre_mm");
  return {centre.at(0).get<double>() * kMillimetre, centre.at(2).get<double>() * kMillimetre,
          phantom.truth.at("radius_mm").get<double>() * kMillimetre};
}

double mean_level(const Frame& frame, double x, double z, double radius) {
  const double pitch = Transducer{}.pitch();
  double sum = 0;
  int n = 0;
  for (int l = 0; l < frame.n_lines; ++l) {
    const double beside = (l - 0.5 * (frame.n_lines - 1)) * pitch - x;
    for (int i = 0; i < frame.n_samples; ++i) {
      if (std::hypot(beside, i * frame.sample_depth - z) > radius) continue;
      sum += std::pow(
          10.0, static_cast<double>(frame.decibel[static_cast<std::size_t>(l) *
                                                      static_cast<std::size_t>(frame.n_samples) +
                                                  static_cast<std::size_t>(i)]) /
                    10);
      ++n;
    }
  }
  return 10 * std::log10(sum / n);
}

}  // namespace artus
