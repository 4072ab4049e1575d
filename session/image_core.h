// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <future>
#include <memory>

#include "artus/echo/echo_pipeline.h"
#include "artus/echo/renderer.h"
#include "artus/session/session_core.h"

namespace artus {

/// The imaging half of a session as a pure function of its inputs: what runs live is what a replay
/// runs. Gain, range and time gain show in the next image. Depth, frequency and focus need new
/// tables: these are made on a thread of their own while the images go on, and are taken over a
/// fixed number of images later, never "when ready". Knobs that move on meanwhile are followed from
/// there.
class ImageCore {
 public:
  /// Requires: valid params, a scene.
  ImageCore(std::shared_ptr<const Scene> scene, const SessionParams& params);

  /// Controls that are not valid keep those before. The frame stays valid until the next call.
  /// Cost: an image; waits where new tables are due and not ready.
  const Frame& render(const FrameInput& input);

  [[nodiscard]] const Transducer& transducer() const noexcept { return renderer_.transducer(); }
  /// Images from the first with a knob in a new place to the first that new tables made.
  [[nodiscard]] std::uint64_t images_to_change() const noexcept { return images_to_change_; }

 private:
  void follow(const ImageControls& controls);
  void take_tables();
  void start_tables();

  Transducer probe_;  // by the newest valid controls, as the next
  ImageSettings image_;
  NeedleShape needle_shape_;
  ImageControls controls_;
  Renderer renderer_;
  std::uint64_t images_to_change_;
  std::uint64_t images_ = 0;                         // rendered so far
  std::uint64_t due_ = 0;                            // image that takes next_ over
  std::future<std::unique_ptr<EchoPipeline>> next_;  // being made, or empty
};

}  // namespace artus
