// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/detail/echo/probe/beam_profile.h"
#include "artus/detail/training/metrics/image_sight.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Why a tip is not seen; the first that holds.
enum class SightLoss { none, no_contact, off_plane, off_sector, shadow, angle };
[[nodiscard]] const char* to_string(SightLoss loss) noexcept;

/// How a needle lies in the picture, from geometry alone but for `shown_db`.
struct TipSight {
  SightLoss loss = SightLoss::none;
  double offset = 0;           ///< m, of the tip from the image plane, along +y of the probe
  double half_width = 0;       ///< m, half the slice's thickness at the tip's depth
  double plane_angle = 0;      ///< rad, asin of shaft . normal, signed
  double face_angle = 0;       ///< rad, between the shaft and the probe's face
  double contrast_db = 0;      ///< of the shaft's echo over muscle's speckle
  double angle_db = 0;         ///< of that echo, lost to the angle beside a shaft that lies flat
  RegionId shadow = kOutside;  ///< the region that shadows the tip
  bool in_picture = false;     ///< the tip lies between the outermost lines, within the depth
  double tip_db = 0;           ///< of the tip's echo over muscle's speckle, off the plane as it is
  /// dB by which the tip stands out in the pictures of that moment; empty where there were none.
  std::optional<double> shown_db;
  /// What the picture shows, and geometry where there was none. Something bright where a tip gives
  /// no echo is not the tip.
  [[nodiscard]] bool seen() const noexcept {
    if (!shown_db) return loss == SightLoss::none;
    return *shown_db >= kVisibleContrast && tip_db >= kHeard;
  }
  static constexpr double kHeard = -12;  ///< dB, of which speckle hides all
};

/// Tells whether a tip can be seen: the face couples (less than 5 mm of air on the beam to the
/// tip), the tip lies between the outermost lines, no bone lies between face and tip, and the
/// shaft's echo, less by its angle (the law of the look: [VanDeBerg2019] as scanners show it, or
/// [SchafhalterZoppoth2004] in the raw one) and by how far the tip is from
/// the plane (the beam's two-way profile), stands 6 dB above muscle's speckle. It is the truth that
/// simulated hands, metrics and causes of faults share.
class TipSightFinder {
 public:
  /// Requires: valid transducer. `depth`: m of the picture. `speckle_db`: as ImageSettings.
  TipSightFinder(const Transducer& transducer, double depth, const NeedleShape& shape,
                 Look look = Look::clinical, double speckle_db = -40);

  /// Requires: rigid poses. Cost: one query.
  [[nodiscard]] TipSight look(const Scene& scene, const Pose& X_JP, const Pose& X_JN) const;

 private:
  [[nodiscard]] bool in_sector(const Vec3& tip_P) const noexcept;
  [[nodiscard]] double echo_db(double face_angle) const noexcept;

  Transducer transducer_;
  double depth_;
  NeedleShape shape_;
  Look look_;
  double speckle_db_;
  BeamProfile beam_;
  double flat_db_;  // echo of a shaft along the face
};

}  // namespace artus
