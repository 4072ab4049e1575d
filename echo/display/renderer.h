// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/drifting_echo.h"
#include "artus/detail/echo/display/clear_level.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

class EchoPipeline;
class ScanConverter;
class ShownPlaces;

/// Turns a probe pose into a B-mode image, again and again: a body and the pipeline of tables and
/// buffers that one probe and its settings need. One thread at a time may render with one Renderer;
/// it uses several threads inside, and the image does not depend on how many.
class Renderer {
 public:
  /// Requires: valid transducer and settings (validate tells what is wrong). Cost: 0.1 to 0.3 s,
  /// and some 0.3 s more on one thread for the fibres of a joint of a few dozen structures.
  Renderer(std::shared_ptr<const Scene> scene, const Transducer& transducer,
           const ImageSettings& settings);
  /// The same with a pipeline that was made elsewhere.
  Renderer(std::shared_ptr<const Scene> scene, std::unique_ptr<EchoPipeline> pipeline);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// The image seen from X_JP, with `needle` when given. The frame stays valid until the next call.
  /// A probe that does not touch the body gives a black image below a reverberating line.
  /// Errors: none; a pose that cannot be used is noted in Frame::status, and its frame is black, or
  /// without the needle. Cost: a few ms a frame; allocates nothing after the first calls.
  const Frame& render(const Pose& X_JP, const std::optional<NeedleView>& needle = std::nullopt);

  /// What each sample of a picture from X_JP is the echo of, at any compounding the lines straight
  /// ahead. Requires: a rigid pose. Cost: 1 to 2 ms.
  [[nodiscard]] ShownPlaces shown_places(const Pose& X_JP) const;

  /// How well strips of the face couple to the skin in later frames: 0 (lifted, or no gel) .. 1,
  /// any number of equal strips from the -x to the +x edge. Below a lifted strip the image is black
  /// under the lens's ringing, as deep as no coupled part of the aperture reaches. Empty: only the
  /// gap between face and skin decides (gel_limit), which also holds on top of this.
  /// Allocates only when there are more strips than ever before.
  void set_contact(std::span<const float> coverage);

  /// Reflectors fixed in the body that later frames show.
  void set_point_reflectors(std::vector<PointReflector> reflectors);

  /// Tracks of withdrawn needles that later frames show.
  void set_needle_tracks(std::vector<NeedleTrack> tracks);

  /// What drifts in liquid in the next frame and later ones.
  void set_drifting_points(std::span<const DriftingPoint> points);

  /// How far the suspensions in the body have settled in the next frame and later ones. Cost: some
  /// passes over the interfaces for a body that is new.
  void set_settling(const Settling& settling);

  /// The time (s) of the next frame, at which colour Doppler looks for blood that runs and for
  /// tissue that moved since the frame before; none: it looks for the needle alone.
  void set_flow_time(std::optional<double> time);

  /// Gain, range, time gain, smoothing and persistence of the next frame on. Requires: valid.
  /// Cost: some 10 us.
  void set_live(const LiveSettings& live);

  /// Other probe, other settings from the next frame on: the body, its fibres' courses, reflectors,
  /// tracks and the contact stay. The pipeline may have been made on any thread while this one
  /// rendered. Cost: below 1 ms.
  void set_pipeline(std::unique_ptr<EchoPipeline> pipeline);

  /// The body from the next frame on: another state of its tissue (MovingScene), or another joint,
  /// whose fibres are then found anew. Cost: none for a state of the same joint.
  void set_scene(std::shared_ptr<const Scene> scene);
  /// The same body with liquid in it, or without again: fibres keep their courses, and a region
  /// that is new has none. Requires: the joint's regions first. Cost: below 1 ms.
  void set_filled_scene(std::shared_ptr<const Scene> scene);

  [[nodiscard]] const Transducer& transducer() const noexcept;
  [[nodiscard]] const ImageSettings& settings() const noexcept;
  /// From scanlines to pixels, as of the last frame.
  [[nodiscard]] const ScanConverter& converter() const noexcept;

  /// Of the last frame.
  [[nodiscard]] const StageTimes& stage_times() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One-shot form for a first try.
[[nodiscard]] Frame render_bmode(const std::shared_ptr<const Scene>& scene, const Pose& X_JP,
                                 const std::optional<NeedleView>& needle = std::nullopt,
                                 const Transducer& transducer = {},
                                 const ImageSettings& settings = {});

/// The pose of the probe in the joint when both are known in the world, rounded to a nanometre
/// (and a billionth in rotation) so that moving body and probe together leaves the image's bytes
/// unchanged.
[[nodiscard]] Pose probe_in_joint(const Pose& X_WJ, const Pose& X_WP);

}  // namespace artus
