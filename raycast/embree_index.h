// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "artus/detail/core/check.h"
#include "artus/detail/raycast/facet.h"
#include "artus/detail/raycast/indexed_surfaces.h"
#include "artus/detail/raycast/plane_cache.h"

struct RTCBufferTy;
struct RTCDeviceTy;
struct RTCGeometryTy;
struct RTCSceneTy;

namespace artus {

/// A piece of a line, p(t) = origin + t direction for t in [near, far], relative to the index's
/// centre.
struct Line {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::Zero();  ///< unit
  double near = 0;                ///< m
  double far = 0;                 ///< m
};

/// What one line met; filled by EmbreeIndex::gather. Large: keep it on the stack of one query.
struct HitBuffer {
  std::array<Hit, kMaxHits> hits;  ///< in the order of traversal, mostly along the line
  std::size_t size;
  bool overflow;  ///< more than kMaxHits were met; the nearest are kept
  bool doubtful;  ///< a hit lies so near to an edge that its neighbours' hits may be missing
};

/// The first facet a line meets beyond t = 0.
struct FirstHit {
  std::uint32_t interface = 0;
  RegionId from = kOutside;
  bool clean = false;  ///< well inside the facet and not grazing, so rounding cannot have chosen it
};

/// The point of a set of facets that is nearest to a given point.
struct NearestFacet {
  double squared_distance = 0;  ///< m^2
  Vec3 point = Vec3::Zero();    ///< relative to the index's centre
  std::uint32_t interface = 0;
};

/// Releases what Embree counts.
struct EmbreeRelease {
  void operator()(RTCBufferTy* buffer) const noexcept;
  void operator()(RTCDeviceTy* device) const noexcept;
  void operator()(RTCSceneTy* scene) const noexcept;
};
using EmbreeBuffer = std::unique_ptr<RTCBufferTy, EmbreeRelease>;
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, EmbreeRelease>;

/// A hierarchy over some of the interfaces, in one geometry or in one for each block.
struct EmbreeParts {
  EmbreeScene scene;
  const IndexedSurfaces::Members* members = nullptr;  ///< null: all interfaces, in their order
  std::vector<RTCGeometryTy*> geometries;             ///< owned by the scene; null: no triangle
  bool none = false;                                  ///< there is no triangle

  [[nodiscard]] std::uint32_t interface(unsigned block, unsigned triangle) const noexcept {
    return members == nullptr ? triangle : (*members)[block][triangle];
  }
};

/// Triangles in an Embree bounding volume hierarchy (version 3 or 4), with their planes in double
/// precision. Coordinates are taken relative to the centre of the triangles, so that a joint far
/// from its frame's origin loses nothing in Embree's single precision; every reported number is
/// recomputed in double. Traversal is robust (watertight at shared edges); hits do not depend on
/// the hierarchy, so neither do they on the number of threads that built it. Nothing changes but by
/// `move` and `fit`.
class EmbreeIndex {
 public:
  /// `isa` as in SceneOptions. Indices of the same surfaces share those. Errors:
  /// std::runtime_error when Embree refuses.
  EmbreeIndex(std::shared_ptr<const IndexedSurfaces> surfaces, const std::string& isa);

  /// Puts the vertices of a group to `places`, all of them, in its order, finite. Then `fit` fits
  /// the hierarchy to them, block by block: the triangles of a group, and those between it and
  /// others. What did not move costs nothing. No query runs meanwhile. Cost: 0.05 us a triangle of
  /// the blocks that moved.
  void move(std::size_t group, std::span<const Vec3> places);
  void fit();

  [[nodiscard]] const std::shared_ptr<const IndexedSurfaces>& surfaces() const noexcept {
    return surfaces_;
  }
  [[nodiscard]] const Vec3& centre() const noexcept { return centre_; }
  [[nodiscard]] double radius() const noexcept { return radius_; }  ///< m, of a ball around centre
  /// Once anything moved it is made of the corners anew: a picture asks for fewer than there are.
  [[nodiscard]] FacetPlane plane(std::uint32_t i, PlaneCache* planes = nullptr) const noexcept {
    if (!moved_) return facets_[i].plane;
    if (planes == nullptr) return make_plane(i);
    return planes->plane(i, [&] { return make_plane(i); });
  }
  /// As it was before anything moved.
  [[nodiscard]] const FacetPlane& first_plane(std::uint32_t i) const noexcept {
    return facets_[i].plane;
  }
  /// Fetches what `plane` and `sides` will need: of facet `i` the first of it, of `before`, which
  /// was fetched before, the rest.
  void prefetch_plane(std::uint32_t i, std::uint32_t before,
                      const PlaneCache* planes) const noexcept;
  [[nodiscard]] const FacetSides& sides(std::uint32_t i) const noexcept { return facets_[i].sides; }

  /// All facets the line meets, in any order, depths in double. `planes`: of this state.
  ARTUS_REALTIME void gather(const Line& line, HitBuffer& out,
                             PlaneCache* planes = nullptr) const noexcept;

  /// The nearest facet at t > 0 (decided in double) or none.
  [[nodiscard]] ARTUS_REALTIME std::optional<FirstHit> first_hit(const Line& line) const noexcept;

  /// Which facets a nearest query looks at.
  enum class Subset {
    all,
    boundary,  ///< of the meshed part: outside or beyond on one side
    skin       ///< outside on one side
  };

  /// The nearest facet of a subset within `max_distance` of `p` (relative to the centre). Where
  /// several share the nearest point, the one whose plane is farthest from `p`, which is the one
  /// that tells the side.
  [[nodiscard]] ARTUS_REALTIME std::optional<NearestFacet> nearest(const Vec3& p,
                                                                   double max_distance,
                                                                   Subset subset) const noexcept;

  /// The corners of facet `i`, relative to the centre.
  [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t i) const noexcept;

 private:
  [[nodiscard]] FacetPlane make_plane(std::uint32_t i) const noexcept {
    return plane_of(corners(i));
  }
  void fill_coordinates();
  [[nodiscard]] EmbreeParts make_parts(const IndexedSurfaces::Part& part) const;
  [[nodiscard]] RTCGeometryTy* make_geometry(
      std::span<const IndexedSurfaces::Corners> triangles) const;

  std::shared_ptr<const IndexedSurfaces> surfaces_;
  std::span<const std::array<std::uint32_t, 3>> triangles_;  // of the surfaces
  std::span<const Facet> facets_;                            // of the surfaces
  Vec3 centre_;
  double radius_;
  std::vector<Vec3> vertices_;  // relative to centre_, where they are now
  std::vector<double> radii_;   // (groups, and what never moves) m
  std::vector<bool> unfitted_;  // (blocks)
  bool moved_ = false;          // whether any vertex ever did
  EmbreeDevice device_;
  EmbreeBuffer coordinates_;  // (n_vertices, 3) float
  EmbreeParts all_;
  EmbreeParts boundary_;  // with the skin in it
};

}  // namespace artus
