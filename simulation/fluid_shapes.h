// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <future>
#include <memory>
#include <span>
#include <vector>

#include "artus/detail/anatomy/body/liquid.h"
#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/simulation/syringe_core.h"
#include "artus/detail/soft/liquid/injected_body.h"
#include "artus/detail/soft/liquid/opened_spaces.h"
#include "artus/detail/soft/solver/deformed_body.h"
#include "artus/detail/soft/solver/face_stress.h"
#include "artus/detail/soft/solver/soft_body.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Places as shapes are made of them: what went outside, or into a region that the body has not, is
/// left out. `spaces`: the joint's.
[[nodiscard]] std::vector<Injected> injected_of(const CompiledJoint& joint,
                                                const JointSpaces& spaces,
                                                std::span<const InjectedSite> sites);

/// Liquid that a shape was made of.
struct DrawnLiquid {
  double given = 0;     ///< m^3, all that there was as it was begun
  double left_out = 0;  ///< m^3 of it that the body has no room for (with_overflow)
};

/// A body with what was injected, at rest.
struct FluidShape {
  std::shared_ptr<const CompiledJoint> joint;
  std::shared_ptr<const Scene> scene;  ///< rigid; null: it gives way
  std::shared_ptr<const BodyMap> map;  ///< null: rigid
  double made = 1;                     ///< times what was given that its spaces were opened by
  DrawnLiquid liquid;
};

/// A shape, and what tissue takes of it as it is then.
struct MadeShape {
  std::shared_ptr<const FluidShape> shape;
  double more = 1;    ///< times what was given that the next one is opened by
  bool kept = false;  ///< see FluidState
};

/// What there is of it in one image: one shape, or one on its way to the next.
struct FluidState {
  std::shared_ptr<const FluidShape> shape;   ///< null: nothing was injected
  std::shared_ptr<const FluidShape> before;  ///< with the same vertices; null: it is all `shape`
  double part = 1;                           ///< of the way from `before`
  bool kept = false;  ///< tissue, as it was when the shape was last asked, leaves all of it

  /// What there is in it.
  [[nodiscard]] DrawnLiquid liquid() const {
    if (!shape) return {};
    if (!before) return shape->liquid;
    const auto mix = [this](double from, double to) {
      return (1 - part) * from + part * to;
    };
    return {mix(before->liquid.given, shape->liquid.given),
            mix(before->liquid.left_out, shape->liquid.left_out)};
  }
  /// Where vertices are at rest, for the skin that a face meets (SoftBody::lift_skin); empty where
  /// nothing was injected.
  [[nodiscard]] SoftBody::RestOf rest_of() const {
    if (!shape) return {};
    return [*this](std::uint32_t vertex) {
      const Vec3& now = shape->joint->mesh.vertices[vertex];
      return before ? Vec3((1 - part) * before->joint->mesh.vertices[vertex] + part * now) : now;
    };
  }
};

/// The shapes that liquid gives the body, image by image: spaces that open, squeezed by what the
/// probe puts on them, and tissue that parts, as with_injected says. Each shape is made on a thread
/// of its own and taken a fixed number of images later, never "when ready": a pure function of what
/// it was given. What presses on it is followed by a share a shape: a face that is held presses
/// more as the space opens below it, and less once it has gone aside. Tissue that moves takes
/// volume from an open space that liquid does not give: the next shape makes up for it
/// (kept_volume), also where tissue alone has moved. Where it gives way a space goes over into its
/// next shape as long as that is made. One thread.
class FluidShapes {
 public:
  /// `opened`: the joint's, shared with others; null: its own. Requires: a joint whose spaces are
  /// valid, an image rate above 0.
  FluidShapes(std::shared_ptr<const CompiledJoint> joint, Liquid liquid, double image_rate,
              std::shared_ptr<const OpenedSpaces> opened = {});

  /// Of the next image, before its tissue's step. Waits where a shape is due and not ready.
  [[nodiscard]] const FluidState& step(std::span<const InjectedSite> sites);
  /// After that step: begins a shape where there is more liquid, or the probe presses otherwise;
  /// where no more comes, one of all that there is, and where tissue has moved, one that makes up
  /// for what that takes.
  /// `tissue`: the body as it gives way in this image; null: rigid.
  void follow(std::span<const InjectedSite> sites,
              const std::shared_ptr<const DeformedBody>& tissue);

  /// Images from the first with liquid to the first that shows it; what is added takes 0.3 s.
  [[nodiscard]] std::uint64_t images_to_change() const noexcept { return images_to_change_; }

 private:
  /// How the probe presses, as far as a shape depends on it.
  struct Press {
    double force = 0;            // N
    Vec3 middle = Vec3::Zero();  // m, of the force
    Vec3 into = Vec3::UnitZ();
  };
  [[nodiscard]] static Press press_of(std::span<const PastContact> contacts);
  void remember(const ContactForce& contact);
  [[nodiscard]] bool has_changed(std::span<const InjectedSite> sites, const Press& press) const;
  [[nodiscard]] bool is_at_rest(std::span<const InjectedSite> sites) const;
  void take();
  void begin(const std::shared_ptr<const DeformedBody>& tissue, bool changed);

  std::shared_ptr<const CompiledJoint> joint_;
  JointSpaces spaces_;
  std::shared_ptr<const OpenedSpaces> opened_;  // begun with the session: it takes seconds
  Liquid liquid_;
  std::uint64_t images_to_change_;
  std::uint64_t images_to_grow_;
  std::uint64_t images_ = 0;
  std::uint64_t due_ = 0;
  std::uint64_t taken_ = 0;            // image of the present shape's first
  std::vector<InjectedSite> begun_;    // of the newest shape, made or being made
  std::vector<PastContact> contacts_;  // that it was shaped under, the newest first
  Press begun_under_;                  // what they are together
  std::vector<InjectedSite> seen_;     // of the image before
  int made_up_ = 0;                    // shapes in a row for what tissue takes alone
  std::uint64_t asked_ = 0;            // image from which on what tissue takes is asked anew
  std::shared_ptr<const DeformedBody> asked_in_;  // as it was then
  double more_ = 1;
  std::future<MadeShape> next_;
  FluidState state_;
};

}  // namespace artus
