// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "anatomy/compiled_joint.h"
#include "core/check.h"
#include "core/geometry.h"
#include "core/result.h"

namespace artus {

/// Where a directed segment passes through an interface.
struct Crossing {
  double depth = 0;             ///< m from the segment's start
  Vec3 normal = Vec3::Zero();   ///< unit, against the direction of travel (dot <= 0)
  RegionId from = kOutside;     ///< region before the crossing
  RegionId to = kOutside;       ///< region after it
  std::uint32_t interface = 0;  ///< index into TetMesh::interfaces
};

/// A stretch of a segment inside one region.
struct TissueInterval {
  double entry = 0;  ///< m from the segment's start; 0 when it starts inside
  double exit = 0;   ///< m; the segment's length when it ends inside
  RegionId region = kOutside;
  Vec3 entry_normal = Vec3::Zero();  ///< unit, against travel; zero when it starts inside
  std::uint32_t entry_interface = std::numeric_limits<std::uint32_t>::max();
};

/// The nearest interface to a point.
struct NearestInterface {
  double distance = std::numeric_limits<double>::infinity();  ///< m; infinite when none in range
  Vec3 point = Vec3::Zero();                                  ///< on the interface
  Vec3 normal = Vec3::Zero();                                 ///< unit, from back to front
  std::uint32_t interface = 0;
};

/// How many results a query produced, and whether the caller's span was too small for all of them
/// (the nearest ones are kept).
struct QueryCount {
  std::size_t size = 0;
  bool truncated = false;
};

/// Where lines meet the body: the interfaces of one compiled joint, indexed. Immutable; any number
/// of threads may query one scene. Real-time forms write into the caller's span and never allocate.
class Scene {
 public:
  /// Builds the index. Requires: a joint from resolve or read_compiled_joint. Cost: about 0.3 us a
  /// triangle.
  explicit Scene(std::shared_ptr<const CompiledJoint> joint);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  [[nodiscard]] const CompiledJoint& joint() const noexcept;

  /// Every interface the segment passes through, sorted by depth; a crossing through a shared edge
  /// or vertex counts once.
  ARTUS_REALTIME QueryCount find_crossings(const Segment& segment,
                                           std::span<Crossing> out) const noexcept;

  /// The segment cut into stretches of one region each: sorted, contiguous, covering the whole
  /// segment (also its parts outside the body). At least one interval for a segment of any length.
  ARTUS_REALTIME QueryCount find_intervals(const Segment& segment,
                                           std::span<TissueInterval> out) const noexcept;

  /// The region at a point.
  [[nodiscard]] ARTUS_REALTIME RegionId region_at(const Vec3& p_J) const noexcept;

  /// The interface nearest to a point within `max_distance`.
  [[nodiscard]] ARTUS_REALTIME NearestInterface find_nearest(const Vec3& p_J,
                                                             double max_distance) const noexcept;

  /// Distance to the body's outer surface, m: negative inside, positive outside; +-infinity beyond
  /// `max_distance`.
  [[nodiscard]] ARTUS_REALTIME double signed_distance_to_skin(const Vec3& p_J,
                                                              double max_distance) const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One-shot form of find_intervals for a first try; allocates.
[[nodiscard]] std::vector<TissueInterval> tissue_intervals(const Scene& scene,
                                                           const Segment& segment);

}  // namespace artus
