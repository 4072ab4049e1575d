// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "artus/detail/echo/display/scan_converter.h"
#include "artus/detail/echo/probe/beam_profile.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

class Renderer;
class ShownPlaces;

/// What lies in the probe's plane, pixel by pixel, at the scale of the B-mode image: where it truly
/// is, or where the picture shows it.
struct LabelImage {
  int width = 0;                     ///< pixels
  int height = 0;                    ///< pixels
  double pixel = 0;                  ///< m
  std::vector<RegionId> regions;     ///< (height, width), x fastest; kOutside off the sector
  std::vector<std::uint8_t> needle;  ///< as regions; 255 where the needle's shaft is in plane
};

/// Where the needle is with respect to the image.
struct NeedleTruth {
  PixelPoint tip;           ///< the tip projected into the plane, pixels; see Frame::tip_shown
  double tip_offset = 0;    ///< m, elevation of the tip; positive along +y of the probe
  double plane_angle = 0;   ///< rad between the needle and the image plane
  double face_angle = 0;    ///< rad between the needle and the probe's face
  bool in_picture = false;  ///< the tip, projected, lies between the outermost lines
  bool in_slice = false;    ///< the tip lies within the slice's thickness
  bool in_plane = false;    ///< tip and visible shaft lie within the slice's thickness
};

/// Makes the truth of one probe's images, again and again: keeps the tables of beam and pixels.
class LabelRenderer {
 public:
  /// Requires: valid transducer and settings (validate tells what is wrong). Cost: about 0.1 s.
  LabelRenderer(const Transducer& transducer, const ImageSettings& settings);

  /// Where everything truly is. Requires: a finite pose. Cost: one query per pixel column.
  [[nodiscard]] LabelImage render(const Scene& scene, const Pose& X_JP,
                                  const std::optional<NeedleView>& needle = std::nullopt) const;

  /// Where a picture shows everything; a needle with the half pulse by which its echo begins before
  /// its near wall. `places`: of a renderer of the same probe and settings at
  /// X_JP.
  [[nodiscard]] LabelImage render_shown(
      const ShownPlaces& places, const Pose& X_JP,
      const std::optional<NeedleView>& needle = std::nullopt) const;

  /// Tip position and angles of a needle.
  [[nodiscard]] NeedleTruth locate(const NeedleView& needle, const Pose& X_JP) const;

  /// m, half of the slice's thickness at a depth (m) below the face.
  [[nodiscard]] double half_slice(double depth) const noexcept;

  [[nodiscard]] const ScanConverter& converter() const noexcept { return converter_; }

 private:
  [[nodiscard]] LabelImage empty() const;
  template <class PlaceOf>
  void mark_needle(const NeedleView& needle, const Pose& X_JP, double more, const PlaceOf& place_P,
                   LabelImage& labels) const;

  ScanConverter converter_;
  BeamProfile profile_;
  double half_pulse_;  // m, of its echo's length
  double pixel_;       // m
};

/// One-shot forms for a first try.
[[nodiscard]] LabelImage render_labels(const Scene& scene, const Pose& X_JP,
                                       const Transducer& transducer, const ImageSettings& settings,
                                       const std::optional<NeedleView>& needle = std::nullopt);
[[nodiscard]] NeedleTruth locate_needle(const NeedleView& needle, const Pose& X_JP,
                                        const Transducer& transducer,
                                        const ImageSettings& settings);

/// Where a renderer's picture from X_JP shows everything.
[[nodiscard]] LabelImage render_shown_labels(
    const Renderer& renderer, const Pose& X_JP,
    const std::optional<NeedleView>& needle = std::nullopt);

/// A colour for each region (red, green, blue), by tissue with a shade per structure.
[[nodiscard]] std::vector<std::array<std::uint8_t, 3>> region_palette(const CompiledJoint& joint);

}  // namespace artus
