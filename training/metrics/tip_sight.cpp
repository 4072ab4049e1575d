// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/tip_sight.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kMaxAir = 5e-3;    // m, as ImageSettings::gel_limit
constexpr double kMinContrast = 6;  // dB
constexpr double kSpeed = kDisplaySpeedOfSound;

double decibels(double amplitude) {
  return 20 * std::log10(std::max(amplitude, 1e-9));
}

bool stops_sound(const Tissue& tissue) {
  return tissue.haptic.hard;
}

}  // namespace

const char* to_string(SightLoss loss) noexcept {
  switch (loss) {
    case SightLoss::none:
      return "seen";
    case SightLoss::no_contact:
      return "no contact";
    case SightLoss::off_plane:
      return "off plane";
    case SightLoss::off_sector:
      return "off sector";
    case SightLoss::shadow:
      return "shadow";
    case SightLoss::angle:
      return "angle";
  }
  return "?";
}

TipSightFinder::TipSightFinder(const Transducer& transducer, double depth, const NeedleShape& shape,
                               Look look, double speckle_db)
    : transducer_(transducer),
      depth_(depth),
      shape_(shape),
      look_(look),
      speckle_db_(speckle_db),
      beam_(transducer, depth),
      flat_db_(echo_db(0)) {}

double TipSightFinder::echo_db(double face_angle) const noexcept {
  return decibels(look_ == Look::raw
                      ? needle_reflectivity(shape_, face_angle, specular_phase(transducer_, kSpeed))
                      : needle_on_screen(shape_, face_angle));
}

bool TipSightFinder::in_sector(const Vec3& tip_P) const noexcept {
  if (transducer_.radius > 0) {
    const double along = tip_P.z() + transducer_.radius;
    const double range = std::hypot(tip_P.x(), along) - transducer_.radius;
    const double angle = std::abs(std::atan2(tip_P.x(), along));
    return range > 0 && range < depth_ && angle <= transducer_.width / 2 / transducer_.radius;
  }
  const double x = tip_P.x() - tip_P.z() * std::tan(transducer_.steering);
  return tip_P.z() > 0 && tip_P.z() < depth_ && std::abs(x) <= transducer_.width / 2;
}

TipSight TipSightFinder::look(const Scene& scene, const Pose& X_JP, const Pose& X_JN) const {
  const Pose X_PN = X_JP.inverse() * X_JN;
  const Vec3 tip = X_PN.translation();
  const Vec3 axis = X_PN.linear().col(2);
  TipSight sight;
  sight.offset = tip.y();
  sight.half_width = beam_.elevation_width(std::clamp(tip.z(), 0.0, depth_)) / 2;
  sight.plane_angle = std::asin(std::clamp(axis.y(), -1.0, 1.0));
  sight.face_angle = std::asin(std::min(1.0, std::abs(axis.z())));
  const double echo = echo_db(sight.face_angle);
  sight.contrast_db = echo - speckle_db_;
  sight.angle_db = flat_db_ - echo;
  const bool curved = transducer_.radius > 0;
  const Vec3 centre(0, 0, -transducer_.radius);
  const Vec3 face =
      curved ? Vec3(centre + transducer_.radius * (Vec3(tip.x(), 0, tip.z()) - centre).normalized())
             : Vec3(tip.x() - tip.z() * std::tan(transducer_.steering), 0, 0);
  std::array<TissueInterval, 64> layers;
  const QueryCount count =
      scene.find_intervals({X_JP * face, X_JP * Vec3(tip.x(), 0, tip.z())}, layers);
  double air = 0;
  for (std::size_t i = 0; i < count.size; ++i) {
    if (layers[i].region == kOutside) air += layers[i].exit - layers[i].entry;
    if (layers[i].region >= kFirstRegion && sight.shadow == kOutside &&
        stops_sound(scene.joint().tissue_of(layers[i].region)))
      sight.shadow = layers[i].region;
  }
  const double heard = beam_.elevation_share(sight.offset, std::clamp(tip.z(), 0.0, depth_),
                                             shape_.outer_diameter / 2);
  const double aside_db = decibels(heard);
  sight.tip_db = sight.contrast_db + aside_db;
  sight.in_picture = in_sector(tip);
  const bool faint = sight.tip_db < kMinContrast;
  if (air > kMaxAir)
    sight.loss = SightLoss::no_contact;
  else if (faint && aside_db < -kMinContrast)
    sight.loss = SightLoss::off_plane;
  else if (!sight.in_picture)
    sight.loss = SightLoss::off_sector;
  else if (sight.shadow != kOutside)
    sight.loss = SightLoss::shadow;
  else if (faint)
    sight.loss = SightLoss::angle;
  return sight;
}

}  // namespace artus
