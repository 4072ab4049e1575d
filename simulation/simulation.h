// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/simulation/imaged_body.h"
#include "artus/detail/simulation/records.h"
#include "artus/echo/frame.h"
#include "artus/raycast/scene.h"
#include "artus/simulation/session_params.h"

namespace artus {

class HapticCore;
class ImageCore;
class NeedleModel;

/// What both hands do in one tick, world frame W.
struct Hands {
  std::optional<Pose> X_WN;       ///< needle: origin at the tip, z from hub to tip; none: put down
  std::optional<Pose> X_WP;       ///< probe: origin on its face, z into the body; none: lifted off
  double thumb = 0;               ///< N on the plunger, positive in
  std::optional<double> plunger;  ///< m that the plunger stands in, in place of a thumb's force
  std::uint32_t command = 0;      ///< SessionCommand bits
};

/// What they feel of it, world frame W.
struct Felt {
  Vec3 force = Vec3::Zero();         ///< N on the needle's hand
  Vec3 torque = Vec3::Zero();        ///< N m
  Vec3 probe_force = Vec3::Zero();   ///< N on the probe's hand, at the face's centre
  Vec3 probe_torque = Vec3::Zero();  ///< N m
  double thumb_force = 0;            ///< N on the thumb, positive out of the barrel
  std::uint32_t status = 0;          ///< TickStatus and SessionStatus bits
  bool image_due = false;            ///< render() shows this instant
};

/// The choices of a first try. All others: SessionParams.
struct SimulationOptions {
  std::string device = "virtuose_6d_desktop";  ///< a name of device_table()
  double haptic_rate = 1000;                   ///< ticks a second
  double image_rate = 30;                      ///< images a second
  bool rigid = false;                          ///< tissue does not give way
};

/// One step of everything: hands in; forces, tissue, liquid and picture out. No clock, no thread of
/// its own that a result hangs on, no I/O: the same inputs give the same bytes. A session is this
/// with a clock, a device and threads; all that runs hands and pictures without a clock is a loop
/// over it.
///
/// A loop calls step() and, where it wants the picture of an image that is due, render(). The
/// tissue goes on at the image rate whether somebody looks or not, and what it answers is felt from
/// the tick after its image on. In a rigid body, where nobody feels it, what was injected has a
/// shape from the first picture on.
///
/// Who has threads calls the halves: tick() and take() in one, advance(input) in another,
/// render(input, body) in a third; they may run at the same time. What the tissue answers crosses
/// by the caller's hand, who knows at which tick it did.
class Simulation {
 public:
  /// Requires: a valid joint; a device of that name, rates in their ranges. Cost: some seconds when
  /// tissue gives way.
  explicit Simulation(CompiledJoint joint, const SimulationOptions& options = {});
  /// `extra_scene_holders` keep a drawn scene each while the next are made. `prepared`: of this
  /// joint and this probe; what is null is made.
  /// Requires: a scene, valid params. Cost: that of the tables; what gives way is made by the first
  /// image.
  Simulation(std::shared_ptr<const Scene> scene, const SessionParams& params,
             std::size_t extra_scene_holders = 0, PreparedBody prepared = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // ---- a loop in one thread
  /// One tick at the haptic rate. An image that is still due gives its tissue's step first.
  const Felt& step(const Hands& hands);
  /// The same with a device's sample as it is recorded.
  const HapticSnapshot& step(const TickInput& input);
  /// The next tick with what a device says, at that tick's time.
  [[nodiscard]] TickInput next_input(const DeviceSample& device) const noexcept;
  /// The image that is due since the last step: its input; null: none is.
  [[nodiscard]] const FrameInput* due() const noexcept { return due_ ? &*due_ : nullptr; }
  /// The tissue's step to the due image's instant, which the next tick feels. Requires: one is due.
  const ImagedBody& advance();
  /// The picture of the newest image, which is advanced to when it is due. Requires: an image was
  /// due. The frame stays valid until the next call. Cost: an image.
  const Frame& render();
  /// The input of the newest image that was advanced to.
  [[nodiscard]] const FrameInput& shown() const noexcept { return shown_; }
  /// Knobs of later images.
  void set_controls(const ImageControls& controls) noexcept { controls_ = controls; }

  // ---- the halves
  /// One tick. Errors: none; the status says what was wrong, and then the force is zero.
  ARTUS_REALTIME const HapticSnapshot& tick(const TickInput& input) noexcept;
  /// What the tissue answers the hands with from the next tick on.
  ARTUS_REALTIME void take(const TissuePacket& packet) noexcept;
  /// Makes now what the first advance() would: tables, and what gives way. Cost: some seconds.
  void prepare_imaging() { static_cast<void>(imaging()); }
  /// The tissue's step to an image's instant, what the hands feel of it, and what was injected. The
  /// first call makes what gives way. Cost: TissueCore::step; waits as FluidShapes::step does.
  [[nodiscard]] ImagedBody advance(const FrameInput& input);
  /// The picture of `body`, which is this input's. Requires: advance was called.
  const Frame& render(const FrameInput& input, const ImagedBody& body);
  /// Forgets the imaging half, which failed: the next advance() makes another.
  void restart_imaging() noexcept;

  /// Of the last image: what moves, see motion_picture; greys do not depend on it. Empty unless the
  /// controls want it, and for some images from then on, until tables are made for it.
  [[nodiscard]] std::vector<std::uint8_t> motion() const;

  // ---- what is so now
  [[nodiscard]] const SessionParams& params() const noexcept { return params_; }
  [[nodiscard]] const CompiledJoint& joint() const noexcept { return scene_->joint(); }
  /// The body at rest.
  [[nodiscard]] const std::shared_ptr<const Scene>& rest_scene() const noexcept { return scene_; }
  /// The body of the newest image, without what was injected; at rest before the first.
  [[nodiscard]] const std::shared_ptr<const Scene>& scene() const noexcept;
  /// The body that the last picture was drawn from, with what was injected.
  [[nodiscard]] const std::shared_ptr<const Scene>& drawn_scene() const noexcept;
  /// What was injected into it.
  [[nodiscard]] DrawnLiquid drawn_liquid() const noexcept;
  /// The probe of the last picture.
  [[nodiscard]] const Transducer& transducer() const noexcept;
  /// Why the body is rigid though it should give way; empty: it does, or should not.
  [[nodiscard]] const std::string& refusal() const noexcept;
  /// Volumes and places, between two ticks.
  [[nodiscard]] const SyringeCore& syringe() const noexcept;
  /// The needle's contact and laws, between two ticks.
  [[nodiscard]] const NeedleModel& needle() const noexcept;
  /// J given to the needle's hand since the start.
  [[nodiscard]] double energy_to_hand() const noexcept;
  [[nodiscard]] const HapticSnapshot& last() const noexcept;
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }
  [[nodiscard]] double time() const noexcept {  ///< s, of the last tick
    return static_cast<double>(ticks_) / params_.haptic_rate;
  }

 private:
  [[nodiscard]] ImageCore& imaging(const FrameInput* first = nullptr);

  std::shared_ptr<const Scene> scene_;
  SessionParams params_;
  std::size_t extra_scene_holders_;
  PreparedBody prepared_;
  std::unique_ptr<HapticCore> haptics_;
  std::unique_ptr<ImageCore> images_;  // empty: not yet
  ImageControls controls_;
  std::uint64_t ticks_ = 0;
  std::uint64_t n_images_ = 0;  // that were due so far
  std::optional<FrameInput> due_;
  FrameInput shown_;  // of body_
  ImagedBody body_;   // of the newest image that was advanced to
  Felt felt_;
  std::string no_refusal_;  // empty
};

}  // namespace artus
