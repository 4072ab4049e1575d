// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/detail/training/metrics/needle_course.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Where the tip should come: a point, or anywhere in a structure.
struct Target {
  std::string name;
  std::optional<Vec3> point;          ///< m, frame J
  std::shared_ptr<const Scene> body;  ///< make_region_body; null for a point alone
};

/// Where the tip should not come: a structure with a margin around it.
struct AvoidZone {
  std::string name;
  std::shared_ptr<const Scene> body;
  double margin = 0;  ///< m
  bool fatal = false;
};

/// What an attempt is measured against; all may be empty.
struct Goals {
  std::optional<Target> target;
  std::vector<AvoidZone> avoid;
  std::optional<Vec3> entry;        ///< m, frame J: where on the skin the needle should go in
  std::vector<std::string> sought;  ///< structures to be shown, one after another
};

/// m from a point to the target's point, or to its structure's surface: 0 inside.
[[nodiscard]] double distance_to(const Target& target, const Vec3& p_J) noexcept;

/// By region: whether liquid in it is in the place of `structure`; all regions of a space are one.
/// All false where the joint has no such structure.
[[nodiscard]] std::vector<bool> place_of(const std::string& structure, const CompiledJoint& joint);

/// What happened in one zone. Between points the tip is taken as going straight and looked at every
/// 0.25 mm or finer.
struct Intrusion {
  double time = 0;              ///< s inside structure and margin
  double depth = 0;             ///< m, deepest beyond the margin's edge
  int entries = 0;              ///< times that the tip came in
  std::optional<double> first;  ///< s, of the first entry
};
[[nodiscard]] Intrusion find_intrusion(const AvoidZone& zone, std::span<const CoursePoint> course);

}  // namespace artus
