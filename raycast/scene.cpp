// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/raycast/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "artus/detail/raycast/embree_index.h"
#include "artus/detail/raycast/hit_chain.h"
#include "artus/detail/soft/solver/deformed_body.h"

namespace artus {
namespace {

/// A line is traced this much beyond both ends of its segment, so that double precision, not
/// Embree, decides about surfaces at the ends, m.
constexpr double kMargin = 1e-6;

/// Directions of a point's probing rays: general, so that no mesh is likely to be aligned with
/// one, and far from each other. The first decides but for rays near an edge.
std::array<Vec3, 6> probe_directions() noexcept {
  const Vec3 a = Vec3(0.5377, 0.2691, 0.7991).normalized();
  const Vec3 b = Vec3(-0.6313, 0.7459, 0.2123).normalized();
  const Vec3 c = a.cross(b).normalized();
  return {a, b, c, -a, -b, -c};
}

/// A segment as the queries use it, relative to the index's centre.
struct Track {
  Line line;          // clipped to the body's surroundings
  double length = 0;  // m, of the whole segment
  bool valid = false;
};

/// Inlined: storing and loading a track again would delay the ray.
[[gnu::always_inline]] inline Track make_track(const EmbreeIndex& index,
                                               const Segment& segment) noexcept {
  Track track;
  const Vec3 along = segment.end - segment.start;
  track.length = along.norm();
  track.line.origin = segment.start - index.centre();
  track.valid = std::isfinite(track.length) && track.line.origin.allFinite();
  if (!track.valid || !(track.length > 0)) return track;
  track.line.direction = along / track.length;
  // Not by the direction, which is not there yet when this can be worked out.
  const double middle = -track.line.origin.dot(along) / track.length;
  const double reach = index.radius() + kMargin;
  track.line.near = std::max(-kMargin, middle - reach);
  track.line.far = std::min(track.length + kMargin, middle + reach);
  return track;
}

/// Room for the hits of one line; lives on the stack of one query and is never cleared.
struct Trace {
  HitBuffer buffer;
  HitChain chain;
};

}  // namespace

struct Scene::Impl {
  Impl(std::shared_ptr<const CompiledJoint> shared, const SceneOptions& options,
       std::shared_ptr<const IndexedSurfaces> surfaces)
      : joint(std::move(shared)),
        index(std::move(surfaces), options.isa),
        directions(probe_directions()),
        has_beyond(std::any_of(joint->mesh.interfaces.begin(), joint->mesh.interfaces.end(),
                               [](const Interface& interface) {
                                 return interface.front == kBeyond || interface.back == kBeyond;
                               })) {}

  /// Outside the meshed part: what the nearest piece of its boundary has on the side of `p`.
  [[nodiscard]] RegionId unmeshed_region_at(const Vec3& p) const noexcept {
    if (!has_beyond) return kOutside;
    const auto nearest =
        index.nearest(p, std::numeric_limits<double>::infinity(), EmbreeIndex::Subset::boundary);
    if (!nearest) return kOutside;
    const FacetSides& sides = index.sides(nearest->interface);
    return std::min(sides.front, sides.back);
  }

  /// The region at `p`, relative to the centre.
  [[nodiscard]] RegionId region_at(const Vec3& p) const noexcept {
    const double reach = index.radius() + kMargin;
    if (p.squaredNorm() > reach * reach) return unmeshed_region_at(p);
    RegionId fallback = kOutside;
    bool has_fallback = false;
    for (const Vec3& direction : directions) {
      const auto hit = index.first_hit({p, direction, -kMargin, 2 * reach});
      if (!hit) return unmeshed_region_at(p);
      if (hit->clean) return hit->from < kFirstRegion ? unmeshed_region_at(p) : hit->from;
      if (!has_fallback) fallback = hit->from;
      has_fallback = true;
    }
    return fallback;
  }

  /// Unit normal of a hit's interface against the line's direction.
  [[nodiscard]] Vec3 normal_against(const Hit& hit, const Line& line,
                                    PlaneCache* planes = nullptr) const noexcept {
    if (hit.interface == kNoInterface) return Vec3::Zero();
    const Vec3 normal = index.plane(hit.interface, planes).normal;
    return normal.dot(line.direction) > 0 ? Vec3(-normal) : normal;
  }

  /// The crossings of the whole line in order, with the margins at both ends.
  [[nodiscard]] std::span<const Hit> trace(const Track& track, Trace& scratch,
                                           PlaneCache* planes = nullptr) const noexcept;

  std::shared_ptr<const CompiledJoint> joint;
  std::shared_ptr<const DeformedBody> tissue;
  std::vector<std::shared_ptr<const DeformedBody::Moved>> fitted;  // what `index` was fitted to
  EmbreeIndex index;
  std::array<Vec3, 6> directions;
  bool has_beyond;
};

std::span<const Hit> Scene::Impl::trace(const Track& track, Trace& scratch,
                                        PlaneCache* planes) const noexcept {
  HitBuffer& buffer = scratch.buffer;
  index.gather(track.line, buffer, planes);
  const std::span<Hit> hits(buffer.hits.data(), buffer.size);
  if (!buffer.doubtful && is_chain(hits)) [[likely]]
    return hits;
  sort_hits(hits);
  if (!buffer.doubtful && is_chain(hits)) return hits;
  struct State {
    const Impl* impl;
    const Line* line;
  };
  const State state{this, &track.line};
  const RegionProbe probe{
      [](const void* opaque, double depth) noexcept {
        const auto& self = *static_cast<const State*>(opaque);
        return self.impl->region_at(self.line->origin + depth * self.line->direction);
      },
      &state};
  repair_chain(hits, {track.line.near, track.line.far, buffer.doubtful}, probe, scratch.chain);
  return std::span<const Hit>(scratch.chain.hits).first(scratch.chain.size);
}

Scene::Scene(std::shared_ptr<const CompiledJoint> joint, const SceneOptions& options) {
  ARTUS_REQUIRE(joint != nullptr, "a joint is needed");
  auto surfaces =
      std::make_shared<const IndexedSurfaces>(joint->mesh.vertices, joint->mesh.interfaces);
  impl_ = std::make_unique<Impl>(std::move(joint), options, std::move(surfaces));
}
Scene::Scene(const DeformedBody& tissue, const SceneOptions& options,
             std::shared_ptr<const IndexedSurfaces> surfaces) {
  auto joint = indexed(tissue.mapped()).joint;
  if (!surfaces) {
    std::vector<IndexedSurfaces::Group> groups;
    for (const VertexGroup& group : tissue.map().groups) groups.emplace_back(group.vertices);
    surfaces = std::make_shared<const IndexedSurfaces>(joint->mesh.vertices, joint->mesh.interfaces,
                                                       groups);
  }
  impl_ = std::make_unique<Impl>(std::move(joint), options, std::move(surfaces));
  impl_->fitted.resize(tissue.groups().size());
}

const std::shared_ptr<const IndexedSurfaces>& Scene::surfaces() const noexcept {
  return impl_->index.surfaces();
}

void Scene::move(std::shared_ptr<const DeformedBody> tissue) {
  if (tissue) {
    for (std::size_t g = 0; g < impl_->fitted.size(); ++g) {
      if (impl_->fitted[g] == tissue->groups()[g]) continue;
      impl_->fitted[g] = tissue->groups()[g];
      impl_->index.move(g, impl_->fitted[g]->vertices);
    }
    impl_->index.fit();
    impl_->joint = tissue->shared_joint();
  }
  impl_->tissue = std::move(tissue);
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

const CompiledJoint& Scene::joint() const noexcept {
  return *impl_->joint;
}

const std::shared_ptr<const CompiledJoint>& Scene::shared_joint() const noexcept {
  return impl_->joint;
}

const std::shared_ptr<const DeformedBody>& Scene::tissue() const noexcept {
  return impl_->tissue;
}

Vec3 Scene::normal_at_rest(std::uint32_t interface) const noexcept {
  if (!impl_->tissue || !impl_->tissue->map().first.map)
    return impl_->index.first_plane(interface).normal;
  const TetMesh& mesh = impl_->joint->mesh;
  const auto& [a, b, c] = mesh.interfaces[interface].vertices;
  return (mesh.vertices[b] - mesh.vertices[a])
      .cross(mesh.vertices[c] - mesh.vertices[a])
      .normalized();
}

QueryCount Scene::find_crossings(const Segment& segment, std::span<Crossing> out) const noexcept {
  QueryCount count;
  const Track track = make_track(impl_->index, segment);
  if (!track.valid || !(track.length > 0)) return count;
  Trace scratch;  // NOLINT(cppcoreguidelines-pro-type-member-init): 12 KB, written before read
  for (const Hit& hit : impl_->trace(track, scratch)) {
    if (hit.depth < 0 || hit.interface == kNoInterface) continue;
    if (hit.depth >= track.length) break;
    if (count.size == out.size()) return {count.size, true};
    out[count.size++] = {hit.depth, impl_->normal_against(hit, track.line), hit.from, hit.to,
                         hit.interface};
  }
  count.truncated = scratch.buffer.overflow;
  return count;
}

QueryCount Scene::find_intervals(const Segment& segment, std::span<TissueInterval> out,
                                 PlaneCache* planes) const noexcept {
  QueryCount count;
  const Track track = make_track(impl_->index, segment);
  if (!track.valid) return count;
  if (out.empty()) return {0, true};
  Trace scratch;  // NOLINT(cppcoreguidelines-pro-type-member-init): 12 KB, written before read
  scratch.buffer.overflow = false;
  std::span<const Hit> hits;
  if (track.length > 0) hits = impl_->trace(track, scratch, planes);
  TissueInterval* current = &out[count.size++];
  *current = {};
  current->region =
      hits.empty() ? impl_->region_at(0.5 * (segment.start + segment.end) - impl_->index.centre())
                   : hits.front().from;
  for (const Hit& hit : hits) {
    if (hit.depth >= track.length) break;
    if (hit.depth < 0) {
      current->region = hit.to;
      continue;
    }
    ARTUS_ASSERT(hit.depth >= current->entry && hit.from == current->region);
    if (hit.depth > current->entry) {
      current->exit = hit.depth;
      if (count.size == out.size()) return {count.size, true};
      current = &out[count.size++];
    }
    current->entry = hit.depth;
    current->region = hit.to;
    current->entry_normal = impl_->normal_against(hit, track.line, planes);
    current->entry_interface = hit.interface;
  }
  ARTUS_ASSERT(current->entry <= track.length);
  current->exit = track.length;
  count.truncated = scratch.buffer.overflow;
  return count;
}

RegionId Scene::region_at(const Vec3& p_J) const noexcept {
  const Vec3 p = p_J - impl_->index.centre();
  return p.allFinite() ? impl_->region_at(p) : kOutside;
}

NearestInterface Scene::find_nearest(const Vec3& p_J, double max_distance) const noexcept {
  NearestInterface result;
  const Vec3 p = p_J - impl_->index.centre();
  if (!p.allFinite() || !(max_distance >= 0)) return result;
  const auto nearest = impl_->index.nearest(p, max_distance, EmbreeIndex::Subset::all);
  if (!nearest) return result;
  result.distance = std::sqrt(nearest->squared_distance);
  result.point = nearest->point + impl_->index.centre();
  result.normal = impl_->index.plane(nearest->interface).normal;
  result.interface = nearest->interface;
  return result;
}

double Scene::signed_distance_to_skin(const Vec3& p_J, double max_distance) const noexcept {
  const Vec3 p = p_J - impl_->index.centre();
  if (!p.allFinite()) return std::numeric_limits<double>::infinity();
  const auto nearest = max_distance >= 0
                           ? impl_->index.nearest(p, max_distance, EmbreeIndex::Subset::skin)
                           : std::nullopt;
  if (!nearest) {
    const double infinity = std::numeric_limits<double>::infinity();
    return impl_->region_at(p) == kOutside ? infinity : -infinity;
  }
  const FacetPlane plane = impl_->index.plane(nearest->interface);
  const FacetSides& sides = impl_->index.sides(nearest->interface);
  const double side = plane.normal.dot(p) - plane.offset;
  const double distance = std::sqrt(nearest->squared_distance);
  return (side >= 0) == (sides.front == kOutside) ? distance : -distance;
}

std::vector<TissueInterval> tissue_intervals(const Scene& scene, const Segment& segment) {
  std::vector<TissueInterval> intervals(2 * kMaxHits + 2);
  intervals.resize(scene.find_intervals(segment, intervals).size);
  return intervals;
}

}  // namespace artus
