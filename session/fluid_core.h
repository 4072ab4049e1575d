// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <future>
#include <memory>
#include <span>
#include <vector>

#include "artus/anatomy/body/liquid.h"
#include "artus/raycast/moving_scene.h"
#include "artus/session/syringe_core.h"
#include "artus/soft/deformed_body.h"
#include "artus/soft/injected_body.h"

namespace artus {

/// What a session's liquid makes of the body, image by image: spaces that open and tissue that
/// parts, as with_injected says. Each shape is made on a thread of its own and taken a fixed number
/// of images later, never "when ready": a pure function of what it was given. Where tissue gives
/// way to the probe, so does what was opened in it.
class FluidCore {
 public:
  /// Requires: a joint, an image rate above 0.
  FluidCore(std::shared_ptr<const CompiledJoint> joint, Liquid liquid, double image_rate);

  /// The scene of the next image; null: nothing was injected. `tissue`: the body as it gives way in
  /// this image; null: rigid. Cost: one refit of the scene with tissue; waits where a shape is due
  /// and not ready.
  [[nodiscard]] const std::shared_ptr<const Scene>& step(
      std::span<const InjectedSite> sites, const std::shared_ptr<const DeformedBody>& tissue);

  /// Images from the first with liquid to the first that shows it; what is added takes 0.3 s.
  [[nodiscard]] std::uint64_t images_to_change() const noexcept { return images_to_change_; }

 private:
  struct Shape {
    std::shared_ptr<const CompiledJoint> joint;
    std::shared_ptr<const Scene> scene;  // rigid; null: it gives way
    std::shared_ptr<const BodyMap> map;  // null: rigid
  };
  using Sites = std::vector<InjectedSite>;
  [[nodiscard]] bool has_changed(std::span<const InjectedSite> sites) const;
  void start(std::span<const InjectedSite> sites, const DeformedBody* tissue);
  void take(const DeformedBody* tissue);
  void place(const std::shared_ptr<const DeformedBody>& tissue);

  std::shared_ptr<const CompiledJoint> joint_;
  Liquid liquid_;
  FibreField fibres_;  // of joint_; asked by the thread that makes a shape alone
  std::uint64_t images_to_change_;
  std::uint64_t images_ = 0;
  std::uint64_t due_ = 0;
  Sites begun_;  // of the newest shape, made or being made
  std::future<Shape> next_;
  Shape shape_;
  MovingScene scenes_;
  std::shared_ptr<const DeformedBody> placed_;  // what scene_ is of
  std::shared_ptr<const Scene> scene_;
};

}  // namespace artus
