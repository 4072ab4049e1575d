// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/detail/echo/acquire/liquid_plume.h"
#include "artus/detail/echo/display/echo_pipeline.h"
#include "artus/detail/simulation/fluid_scene.h"
#include "artus/detail/simulation/imaged_body.h"
#include "artus/detail/simulation/records.h"
#include "artus/detail/simulation/tissue_core.h"
#include "artus/echo/renderer.h"

namespace artus {

/// The imaging half of a session as a pure function of its inputs: what runs live is what a replay
/// runs. Gain, range and time gain show in the next image. Depth, frequency and focus need new
/// tables: these are made on a thread of their own while the images go on, and are taken over a
/// fixed number of images later, never "when ready". Knobs that move on meanwhile are followed from
/// there. What the syringe put into the body opens it in the picture, and what
/// drifts in it is seen: see FluidShapes and LiquidPlume.
class ImageCore {
 public:
  /// `extra_scene_holders` keep a drawn scene each while the next are made. What gives way is made
  /// around the probe at `X_JP`; none: the joint's default; in the cage of `prepared` where that
  /// is around it, too. Requires: valid params, a scene.
  ImageCore(std::shared_ptr<const Scene> scene, const SessionParams& params,
            std::size_t extra_scene_holders = 0, const std::optional<Pose>& X_JP = {},
            const PreparedBody& prepared = {});

  /// The tissue's step to this image's instant, when it gives way: what the hands feel need not
  /// wait for the picture. Skin that liquid lifts is where the probe meets it. May run beside
  /// render() of an image before. Cost: TissueCore::step; waits as FluidShapes::step does.
  [[nodiscard]] ImagedBody advance(const FrameInput& input);

  /// The picture of `body`, which is this input's. Controls that are not valid keep those before.
  /// The frame stays valid until the next call. Cost: an image; waits where new tables are due and
  /// not ready.
  const Frame& render(const FrameInput& input, const ImagedBody& body);
  /// Both.
  const Frame& render(const FrameInput& input) { return render(input, advance(input)); }

  /// Of the last image: what moves, see motion_picture; greys do not depend on it. Needle and
  /// tissue move as they did since the image before. Empty unless the controls want it, and until
  /// the tables for it are made.
  [[nodiscard]] std::vector<std::uint8_t> motion() const;

  /// Of the last step: what the tissue answers the hands with; null: the body is rigid.
  [[nodiscard]] const TissuePacket* packet() const noexcept {
    return tissue_ ? &tissue_->packet() : nullptr;
  }
  /// The body of the last step, without what was injected.
  [[nodiscard]] const std::shared_ptr<const Scene>& scene() const noexcept {
    return tissue_ ? tissue_->scene() : rest_;
  }
  /// The body that the last image was drawn from, with what was injected.
  [[nodiscard]] const std::shared_ptr<const Scene>& drawn_scene() const noexcept { return drawn_; }
  /// What was injected into that body.
  [[nodiscard]] const DrawnLiquid& drawn_liquid() const noexcept { return drawn_liquid_; }
  /// Why the body is rigid though it should give way; empty: it does, or should not.
  [[nodiscard]] const std::string& refusal() const noexcept { return refusal_; }

  /// Of the last picture, or the first that will be.
  [[nodiscard]] const Transducer& transducer() const noexcept {
    return renderer_ ? renderer_->transducer() : probe_;
  }
  /// Images from the first with a knob in a new place to the first that new tables made.
  [[nodiscard]] std::uint64_t images_to_change() const noexcept { return images_to_change_; }

 private:
  void update_scene(const FrameInput& input, const ImagedBody& body);
  void follow(const ImageControls& controls);
  [[nodiscard]] Vec3 velocity_of_needle(const FrameInput& input) const noexcept;
  void update_particles(const FrameInput& input, const Scene* filled);
  void take_tables();
  void start_tables();

  Transducer probe_;  // by the newest valid controls, as the next
  ImageSettings image_;
  NeedleShape needle_shape_;
  ImageControls controls_;
  std::optional<Renderer> renderer_;  // empty: nothing was drawn yet
  std::optional<TissueCore> tissue_;  // empty: rigid
  std::string refusal_;
  std::shared_ptr<const Scene> rest_;
  std::shared_ptr<const Scene> drawn_;
  DrawnLiquid drawn_liquid_;
  FluidShapes shapes_;
  FluidScene fluid_;
  LiquidPlume plume_;
  bool filled_ = false;  // the last image had liquid in the body
  double image_time_;    // s
  std::uint64_t images_to_change_;
  std::uint64_t images_ = 0;                         // rendered so far
  std::uint64_t due_ = 0;                            // image that takes next_ over
  std::future<std::unique_ptr<EchoPipeline>> next_;  // being made, or empty
  FrameInput before_;                                // of the last image
  const Frame* frame_ = nullptr;                     // the last
};

}  // namespace artus
