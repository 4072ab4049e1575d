// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/acquisition.h"
#include "artus/detail/echo/acquire/beam_shape.h"
#include "artus/detail/echo/acquire/block_workers.h"
#include "artus/detail/echo/acquire/line_shaping.h"
#include "artus/detail/echo/display/compound.h"
#include "artus/detail/echo/display/display.h"
#include "artus/echo/frame.h"

namespace artus {

/// The three stages of an image with their tables and buffers, made from probe and settings alone:
/// acquire, shape, display. The body comes with each frame, so the pipeline of other settings can
/// be made on any thread beside a renderer that runs, which then takes it over.
class EchoPipeline {
 public:
  /// Requires: valid transducer and settings. Cost: 0.1 to 0.3 s on one thread.
  EchoPipeline(const Transducer& transducer, const ImageSettings& settings);
  EchoPipeline(const EchoPipeline&) = delete;
  EchoPipeline& operator=(const EchoPipeline&) = delete;
  EchoPipeline(EchoPipeline&&) = delete;
  EchoPipeline& operator=(EchoPipeline&&) = delete;
  ~EchoPipeline() = default;

  [[nodiscard]] const Transducer& transducer() const noexcept { return transducer_; }
  [[nodiscard]] const ImageSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const StageTimes& stage_times() const noexcept { return times_; }
  [[nodiscard]] const Frame& frame() const noexcept { return frame_; }
  [[nodiscard]] const ScanConverter& converter() const noexcept { return display_.converter(); }
  [[nodiscard]] BlockWorkers& workers() noexcept { return workers_; }

  /// From the next frame on. Requires: valid.
  void set_live(const LiveSettings& live);
  /// See Renderer::set_contact.
  void set_contact(std::span<const float> coverage) { acquisition_.set_contact(coverage); }

  /// One image. Requires: rigid poses. Cost: see Renderer::render.
  void render(const EchoBody& body, const Pose& X_JP, const std::optional<NeedleView>& needle);
  /// A black one: nothing heard, nothing shown. `status` says why.
  void render_nothing(std::uint32_t status) noexcept;
  /// Notes what was wrong with the last frame's input.
  void set_status(std::uint32_t status) noexcept { frame_.status = status; }

 private:
  void hear(const EchoBody& body, const EchoView& view);

  Transducer transducer_;
  ImageSettings settings_;
  BlockWorkers workers_;
  BeamShape shape_;
  Acquisition acquisition_;
  LineShaping shaping_;
  CompoundMean compound_;
  Display display_;
  Frame frame_;
  StageTimes times_;
};

}  // namespace artus
