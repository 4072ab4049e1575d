// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/core/geometry.h"
#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/core/check.h"

namespace artus {

/// What the hand felt in one tick.
struct FeltTick {
  double time = 0;          ///< s
  RegionId region = 0;      ///< at the tip
  double tissue = 0;        ///< N, cutting and friction along the needle, magnitude
  double hard = 0;          ///< N, all of it along the needle, a tap on bone too; magnitude
  bool on_bone = false;     ///< the tip stands on a hard layer
  Vec3 tip = Vec3::Zero();  ///< m
};

/// Force of one layer over an attempt.
struct LayerForce {
  double time = 0;     ///< s with the tip in it
  double peak = 0;     ///< N
  double impulse = 0;  ///< N s; over time: the mean
};

/// One touch of bone.
struct FeltTouch {
  double time = 0;     ///< s
  double peak = 0;     ///< N
  double speed = 0;    ///< m/s of the tip when it came, by the last pose that moved it
  double scratch = 0;  ///< m that the tip moved while it stood on bone
};

/// Sums forces by layer and counts touches of bone, tick by tick. A touch is a rising edge after at
/// least 0.3 s without.
class ForceLayers {
 public:
  /// Memory for all regions and for so many touches is taken here; later ones are counted alone.
  explicit ForceLayers(std::size_t n_regions, std::size_t max_touches = 1000);

  /// Cost: constant.
  ARTUS_REALTIME void add(const FeltTick& tick) noexcept;

  [[nodiscard]] const std::vector<LayerForce>& layers() const noexcept { return layers_; }
  [[nodiscard]] const std::vector<FeltTouch>& touches() const noexcept { return touches_; }
  [[nodiscard]] std::size_t touch_count() const noexcept { return count_; }
  [[nodiscard]] bool empty() const noexcept { return !started_; }

 private:
  std::vector<LayerForce> layers_;
  std::vector<FeltTouch> touches_;
  std::size_t count_ = 0;
  FeltTick last_;
  double speed_ = 0;         // m/s between the last two poses that differ
  double moved_at_ = 0;      // s
  double off_since_ = -1e9;  // s, when the last touch ended
  bool started_ = false;
};

}  // namespace artus
