// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>
#include <vector>

#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// What of a structure is in the picture.
struct StructureSight {
  bool in_picture = false;
  double x = 0;  ///< m, the middle of what is seen of it, along the face from the beam's middle
};

/// What of `region` the picture from `X_JP` shows down to `depth`, m, from geometry alone: the face
/// touches the skin (5 mm of gel at most), and nothing hard lies before. Requires: a rigid pose.
/// Cost: some 20 queries.
[[nodiscard]] StructureSight see_structure(const Scene& scene, const Transducer& transducer,
                                           double depth, const Pose& X_JP, RegionId region);

/// One of the structures that are asked for, as far as it was found.
struct Sought {
  std::string name;
  RegionId region = kOutside;
  double found = -1;  ///< s; negative: it was not
  double seen = 0;    ///< s that it was in the picture while it was asked for
};

/// Follows someone who shows structures with a probe, one after another as they are asked for. One
/// is found when it was in the picture, its middle within `kMiddle` of the beam's middle, for
/// `kHold` on end (both assumed).
class StructureSearch {
 public:
  static constexpr double kMiddle = 4e-3;  ///< m
  static constexpr double kHold = 1.5;     ///< s
  /// s after which someone is told so: measured poses are smoothed, and must agree.
  static constexpr double kTold = 1.8;

  /// Names that the joint does not have are never found.
  StructureSearch(const CompiledJoint& joint, std::span<const std::string> names,
                  const Transducer& transducer, double depth, double hold = kHold);

  /// Times must not fall.
  void look(const Scene& scene, double time, const Pose& X_JP);

  [[nodiscard]] std::span<const Sought> sought() const noexcept { return sought_; }
  [[nodiscard]] std::size_t found() const noexcept { return asked_; }
  [[nodiscard]] bool done() const noexcept { return asked_ == sought_.size(); }

 private:
  Transducer transducer_;
  double depth_;
  double hold_;
  std::vector<Sought> sought_;
  std::size_t asked_ = 0;
  double since_ = -1;  // s, when it came into the middle; negative: it is not there
  double last_ = -1;   // s
};

}  // namespace artus
