// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/core/check.h"

namespace artus {

class DeformedBody;
class PlaneCache;
struct IndexedSurfaces;

/// Interface index of what no interface marks.
inline constexpr std::uint32_t kNoInterface = std::numeric_limits<std::uint32_t>::max();

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
  std::uint32_t entry_interface = kNoInterface;
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

/// How a scene is built.
struct SceneOptions {
  /// Instruction set Embree may use: "sse2", "sse4.2", "avx", "avx2", "avx512"; empty: the best of
  /// this machine. Pin it where results must agree to the byte between machines.
  std::string isa;
};

/// Where lines meet the body: the interfaces of one compiled joint, indexed. Immutable; any number
/// of threads may query one scene. Real-time forms write into the caller's span and never allocate.
///
/// Depths are exact to about 1e-9 m for joints of human size anywhere within metres of the frame's
/// origin; within 10 nm of an edge the neighbour's plane may be taken (about 1e-8 m). A line that
/// runs within 10 nm of an interface's plane across several facets is given one of the adjoining
/// regions, and may miss a change between regions that meet in that plane. A line through a shared
/// edge or vertex, along an interface or touching one still gives a consistent answer: each
/// crossing leaves the region that the one before entered. A crossing at depth d counts when 0 <= d
/// < length: a segment that starts on an interface crosses it, one that ends on it does not, and
/// two halves of a cut segment share no crossing. A touch that leads back into the same region is
/// no crossing.
///
/// A body that gives way is one such scene for each of its states (MovingScene): lines then meet
/// the surfaces where they are, `joint` stays what was compiled, and `tissue` leads from one to the
/// other.
///
/// The body is meshed only inside its region of interest. A line that leaves it as "beyond" may
/// return as "outside" (or the reverse) though no interface lies between; the intervals then
/// change region in the middle of the gap with entry_interface = kNoInterface, the crossings show
/// only the surfaces. A query with a coordinate that is not finite finds nothing.
class Scene {
 public:
  /// Builds the index. Requires: a joint from resolve or read_compiled_joint (indices in range,
  /// finite vertices, different regions on the two sides of each interface; std::invalid_argument
  /// otherwise), a known `isa`. Errors: std::runtime_error when Embree refuses (no memory, a CPU
  /// without the instruction set). Cost: about 0.3 us a triangle.
  explicit Scene(std::shared_ptr<const CompiledJoint> joint, const SceneOptions& options = {});
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// The joint, at rest whatever the tissue does.
  [[nodiscard]] const CompiledJoint& joint() const noexcept;
  /// The same as a share of it.
  [[nodiscard]] const std::shared_ptr<const CompiledJoint>& shared_joint() const noexcept;
  /// How the body gives way in this scene: from it the scene has its surfaces. Null: it is at rest.
  [[nodiscard]] const std::shared_ptr<const DeformedBody>& tissue() const noexcept;

  /// Unit normal of an interface from back to front as the body lies at rest; zero for a triangle
  /// without area.
  [[nodiscard]] ARTUS_REALTIME Vec3 normal_at_rest(std::uint32_t interface) const noexcept;

  /// Every interface the segment passes through, sorted by depth; a crossing through a shared edge
  /// or vertex counts once.
  ARTUS_REALTIME QueryCount find_crossings(const Segment& segment,
                                           std::span<Crossing> out) const noexcept;

  /// The segment cut into stretches of one region each: sorted, contiguous, covering the whole
  /// segment (also its parts outside the body). At least one interval for a segment of any length,
  /// also zero; no interval of zero length otherwise. `planes`: what queries of this
  /// scene by this thread left, which makes one near by cheaper where the body gives way.
  ARTUS_REALTIME QueryCount find_intervals(const Segment& segment, std::span<TissueInterval> out,
                                           PlaneCache* planes = nullptr) const noexcept;

  /// The region at a point; on an interface one of its two regions, always the same. Outside the
  /// meshed part: the one of outside and beyond that the nearest surface has on this side.
  [[nodiscard]] ARTUS_REALTIME RegionId region_at(const Vec3& p_J) const noexcept;

  /// The interface nearest to a point within `max_distance`.
  [[nodiscard]] ARTUS_REALTIME NearestInterface find_nearest(const Vec3& p_J,
                                                             double max_distance) const noexcept;

  /// Distance to the body's outer surface (interfaces with "outside" on one side), m: negative
  /// inside, positive outside; +-infinity beyond `max_distance`.
  [[nodiscard]] ARTUS_REALTIME double signed_distance_to_skin(const Vec3& p_J,
                                                              double max_distance) const noexcept;

 private:
  friend class MovingScene;
  struct Impl;
  /// A scene whose surfaces `move` with states of the tissue that have the same map. `surfaces`: of
  /// another such scene, or null.
  Scene(const DeformedBody& tissue, const SceneOptions& options,
        std::shared_ptr<const IndexedSurfaces> surfaces);
  [[nodiscard]] const std::shared_ptr<const IndexedSurfaces>& surfaces() const noexcept;
  void move(std::shared_ptr<const DeformedBody> tissue);
  std::unique_ptr<Impl> impl_;
};

/// One-shot form of find_intervals for a first try; allocates.
[[nodiscard]] std::vector<TissueInterval> tissue_intervals(const Scene& scene,
                                                           const Segment& segment);

}  // namespace artus
