// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "artus/detail/haptics/probe/skin_surface.h"
#include "artus/detail/raycast/moving_scene.h"
#include "artus/detail/simulation/needle_tissue.h"
#include "artus/detail/simulation/tissue_packet.h"
#include "artus/detail/soft/solver/soft_body.h"

namespace artus {

/// The body of a session as it gives way to probe and needle, image by image: one step of the
/// tissue, one scene of that instant, and what the hands feel of it. A pure function of the poses
/// it was given: factors and cages are made on threads of their own and taken a fixed number of
/// images later, never "when ready", or at once where nobody has a clock.
class TissueCore {
 public:
  /// The cage is made around `X_JP`, for a probe with `face`. `waits`: another cage or
  /// factor is made and used in the image that needs it, which takes its seconds.
  /// `extra_scene_holders` keep a scene each while the next are made. Errors: those of
  /// SoftBody::make. Cost: some seconds.
  [[nodiscard]] static Result<TissueCore> make(std::shared_ptr<const CompiledJoint> joint,
                                               const Pose& X_JP, double image_rate,
                                               const ProbeFace& face = {}, bool waits = false,
                                               std::size_t extra_scene_holders = 0);
  /// The same in the cage of a body that was made for such a face, at rest. Cost: of a factor and
  /// of the scenes' indices.
  [[nodiscard]] static TissueCore make_beside(const SoftBody& other, double image_rate,
                                              const ProbeFace& face, bool waits,
                                              std::size_t extra_scene_holders);

  /// The next image's instant, with the probe at `X_JP` or without one, and so the needle. A probe
  /// that stays outside of what the cage reaches gets a cage of its own, unless it is back by then;
  /// until that is there the tissue does not feel it, and the hand feels the skin by what was
  /// learned before. `rest_of`: SoftBody::lift_skin. Cost: see
  /// docs/deformation.md.
  void step(const std::optional<Pose>& X_JP, const std::optional<NeedleGrip>& needle = {},
            const SoftBody::RestOf& rest_of = {});

  [[nodiscard]] const std::shared_ptr<const Scene>& scene() const noexcept { return scene_; }
  [[nodiscard]] const std::shared_ptr<const DeformedBody>& tissue() const noexcept {
    return tissue_;
  }
  /// Number 1 after the first step.
  [[nodiscard]] const TissuePacket& packet() const noexcept { return packet_; }
  [[nodiscard]] std::uint32_t status() const noexcept { return status_; }  ///< SoftStatus bits
  /// Whether a cage made around `X_JC` is made for a face at `X_JP`; this one.
  [[nodiscard]] static bool is_within_reach(const Pose& X_JC, const Pose& X_JP);
  [[nodiscard]] bool reaches(const Pose& X_JP) const {
    return is_within_reach(body_.cage_pose(), X_JP);
  }

 private:
  TissueCore(SoftBody body, double image_rate, const ProbeFace& face, bool waits,
             std::size_t scenes);
  /// Another cage, and the tissue as it lay in it a while before that cage is taken.
  struct NextCage {
    SoftBody body;
    MovingScene scenes;
    std::shared_ptr<const DeformedBody> tissue;
    [[nodiscard]] static NextCage make(SoftBody body, const DeformedBody& before, std::size_t n);
  };
  void follow(const std::optional<Pose>& X_JP);
  [[nodiscard]] bool is_wanted(const Pose& X_JC, const std::optional<Pose>& X_JP) const;
  void make_ready(const std::optional<Pose>& X_JP);
  void change_cage(const Pose& X_JP);
  void take(NextCage next);
  void refresh(const std::optional<Pose>& X_JP);
  void keep_state_of_factor();
  [[nodiscard]] bool has_moved_since_factor(const std::optional<Pose>& X_JP) const;
  void describe(const std::optional<Pose>& X_JP, const SoftBody::RestOf& rest_of);
  [[nodiscard]] TissueCurve learn(const Pose& X_JP, const ProbePacket& skin);

  SoftBody body_;
  ProbeFace face_;
  std::size_t n_scenes_;         // that go round
  bool waits_ = false;           // for its cages and factors
  double dt_;                    // s between images
  std::uint64_t factor_images_;  // from the start of a factor to its use
  std::uint64_t cage_images_;    // from the start of a cage to its being made
  std::uint64_t ready_images_;   // from then to its use
  std::uint64_t images_ = 0;
  std::uint64_t factor_due_ = 0;
  std::uint64_t cage_due_ = 0;
  int outside_ = 0;                      // images in a row
  Pose X_JP_factor_ = Pose::Identity();  // of the newest factor, or the one that is begun
  std::vector<Vec3> u_factor_;           // (n_nodes) the same
  std::optional<Pose> X_JP_before_;
  bool still_ = false;  // nothing moved in the last step
  std::future<Result<SoftBody>> cage_;
  std::future<NextCage> next_;
  SkinSurface skin_;
  TissueCurve curve_;               // of the newest press, or of one that was tried
  std::optional<Pose> X_JP_tried_;  // where
  NeedleTissue needle_;             // after body_: it ends before what it works on
  MovingScene scenes_;
  std::shared_ptr<const DeformedBody> tissue_;
  std::shared_ptr<const Scene> scene_;
  TissuePacket packet_;
  std::uint32_t status_ = 0;
};

}  // namespace artus
