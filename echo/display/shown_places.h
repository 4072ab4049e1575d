// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/detail/soft/solver/smooth_gradient.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// What each sample of a picture is the echo of. A scanner takes sound to go straight and at one
/// speed; tissue bends it and is faster or slower, so a picture shows things beside where they are.
/// Here each line's sound is followed, so that what lies at a sample is what is seen there. Where
/// no sound comes, behind bone or without contact, the line goes on straight at the scanner's
/// speed. Immutable.
class ShownPlaces {
 public:
  /// A straight piece of a line in one region.
  struct Piece {
    double begin = 0;             ///< sample
    double path = 0;              ///< m along the sound from the face to `begin`
    Vec3 p_J = Vec3::Zero();      ///< m, at `begin`
    Vec3 step_J = Vec3::UnitZ();  ///< m per sample
    RegionId region = kOutside;
    double path_step = 1;  ///< m of `path` per sample
    double lifted = 0;     ///< m that tissue at `begin` lies deeper than a flat skin shows it
  };

  /// Follows the lines of a probe at `X_JP`. `tissue`: how the scene's gives way; null: it is at
  /// rest. Requires: regions of the scene's joint, a rigid pose. Cost: one query per bend and line.
  ShownPlaces(const Scene& scene, const SmoothGradient* tissue,
              std::span<const RegionAcoustics> regions, const Transducer& transducer,
              const ImageSettings& settings, const Pose& X_JP);

  /// By rising sample; the last has no end. Never empty.
  [[nodiscard]] std::span<const Piece> line(int index) const noexcept;
  /// m, frame J, of what a sample shows.
  [[nodiscard]] Vec3 place(int index, double sample) const noexcept;
  /// m, frame J, where a needle is that a sample shows: a flat skin lifts tissue, no needle.
  [[nodiscard]] Vec3 needle_place(int index, double sample) const noexcept;
  [[nodiscard]] RegionId region(int index, double sample) const noexcept;
  /// The sample that shows what lies `depth` m along the sound of a line.
  [[nodiscard]] double sample_of(int index, double depth) const noexcept;

 private:
  [[nodiscard]] const Piece& piece_at(int index, double sample) const noexcept;

  std::vector<Piece> pieces_;       // line by line
  std::vector<std::size_t> first_;  // (n_lines + 1), into pieces_
};

}  // namespace artus
