// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <future>
#include <optional>
#include <vector>

#include "artus/detail/haptics/needle/needle_packet.h"
#include "artus/detail/soft/solver/soft_body.h"
#include "artus/raycast/scene.h"

namespace artus {

/// A needle in the tissue of one image: where it is now and what it loads the cubes with
/// (NeedleCoupling::cube_load).
struct NeedleGrip {
  Pose X_JN = Pose::Identity();
  NeedleLoad load;
};

/// The needle's side of a session's tissue: its forces as loads on the cage, where they are drawn,
/// and what its fast loop needs to know of the tissue. The compliance of a track is computed on a
/// thread of its own and taken a fixed number of images after it was begun, never "when ready".
class NeedleTissue {
 public:
  /// Requires: image_rate > 0 Hz.
  explicit NeedleTissue(double image_rate);

  /// Loads for the body's next step, at the material points where the needle lies now. True when
  /// they are others than before.
  bool load(SoftBody& body, const DeformedBody& tissue, const std::optional<NeedleGrip>& needle);
  /// After the step, once an image: `scene` of the instant, which carries its tissue. Cost: some
  /// us.
  void step(const SoftBody& body, const Scene& scene, const std::optional<NeedleGrip>& needle);

  /// The body is in another cage. The compliance stays until there is one of the new cage: the
  /// tissue is the same.
  void forget();
  /// The factor is another one: the compliance is computed anew.
  void renew() noexcept { old_ = true; }

  [[nodiscard]] const NeedlePacket& packet() const noexcept { return packet_; }

 private:
  [[nodiscard]] std::optional<NeedleLine> find_track(const SoftBody& body, const Scene& scene,
                                                     const Pose& X_JN) const;

  double dt_;              // s between images
  std::uint64_t to_take_;  // images from a compliance's beginning to its use
  std::uint64_t images_ = 0;
  std::uint64_t due_ = 0;
  bool old_ = true;
  NeedleLine track_;  // of the newest compliance, begun or taken
  std::future<NeedleCompliance> next_;
  std::vector<PointLoad> loads_;
  double pushed_ = 0;  // m by which the needle's load moved the tissue at its tip
  NeedlePacket packet_;
};

}  // namespace artus
