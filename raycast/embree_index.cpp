// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/raycast/embree_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "artus/detail/core/closest_point.h"
#include "artus/detail/raycast/embree_api.h"

namespace artus {
namespace {

/// Below this cosine a line lies in the facet's plane for all that rounding can tell.
constexpr double kCoplanar = 1e-12;
/// Below this cosine a depth is kept within the facet's own extent along the line.
constexpr double kGrazing = 0.05;
/// Barycentric distance to an edge above which single precision cannot have taken the wrong facet.
constexpr float kCleanBarycentric = 1e-4F;

double clamp_to_extent(const EmbreeIndex& index, std::uint32_t i, const Vec3& origin,
                       const Vec3& direction, double depth) noexcept {
  const std::array<Vec3, 3> corners = index.corners(i);
  const double a = direction.dot(corners[0] - origin);
  const double b = direction.dot(corners[1] - origin);
  const double c = direction.dot(corners[2] - origin);
  return std::clamp(depth, std::min({a, b, c}), std::max({a, b, c}));
}

struct Passage {
  double cosine = 0;  // of direction and normal
  double depth = 0;
};

Passage pass(const EmbreeIndex& index, std::uint32_t i, const Line& line,
             PlaneCache* planes = nullptr) noexcept {
  const FacetPlane plane = index.plane(i, planes);
  Passage passage;
  passage.cosine = plane.normal.dot(line.direction);
  passage.depth = (plane.offset - plane.normal.dot(line.origin)) / passage.cosine;
  if (std::abs(passage.cosine) < kGrazing) [[unlikely]] {
    passage.depth = clamp_to_extent(index, i, line.origin, line.direction, passage.depth);
  }
  return passage;
}

RTCRay make_ray(const Line& line) noexcept {
  RTCRay ray{};
  const Vec3 start = line.origin + line.near * line.direction;
  ray.org_x = static_cast<float>(start.x());
  ray.org_y = static_cast<float>(start.y());
  ray.org_z = static_cast<float>(start.z());
  ray.dir_x = static_cast<float>(line.direction.x());
  ray.dir_y = static_cast<float>(line.direction.y());
  ray.dir_z = static_cast<float>(line.direction.z());
  ray.tfar = static_cast<float>(line.far - line.near);
  ray.mask = std::numeric_limits<unsigned>::max();
  return ray;
}

/// Barycentric distance to an edge below which a neighbour's hit may be missing or double.
constexpr float kDoubtfulBarycentric = 3e-5F;

/// What the filter notes of a hit: enough to keep the nearest when there are too many.
struct Candidate {
  std::uint32_t interface;
  float depth;
};

/// A query's state; Embree hands the context back to the filter, so it must come first.
struct GatherQuery {
  EmbreeContext context;
  const EmbreeIndex* index;
  const PlaneCache* planes;
  std::size_t size;
  bool overflow;
  bool doubtful;
  std::array<Candidate, kMaxHits> candidates;
};

void keep_nearest(GatherQuery& query, const Candidate& candidate) noexcept {
  query.overflow = true;
  Candidate& farthest =
      *std::max_element(query.candidates.begin(), query.candidates.end(),
                        [](const Candidate& a, const Candidate& b) { return a.depth < b.depth; });
  if (candidate.depth < farthest.depth) farthest = candidate;
}

/// The interface of a filter's hit: through the list that its geometry carries, or the triangle's
/// own number.
std::uint32_t interface_of(const RTCFilterFunctionNArguments* args) noexcept {
  const auto* members = static_cast<const std::uint32_t*>(args->geometryUserPtr);
  const std::uint32_t triangle = RTCHitN_primID(args->hit, args->N, 0);
  return members == nullptr ? triangle : members[triangle];
}

/// Occlusion filter: notes the hit and lets the ray go on. The plane is only fetched here; it is
/// used when the traversal is over and it has arrived.
void gather_hit(const RTCFilterFunctionNArguments* args) noexcept {
  args->valid[0] = 0;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): Embree's way to pass state.
  auto& query = *reinterpret_cast<GatherQuery*>(args->context);
  const Candidate candidate{interface_of(args), RTCRayN_tfar(args->ray, args->N, 0)};
  query.index->prefetch_plane(
      candidate.interface,
      query.size > 0 ? query.candidates[query.size - 1].interface : candidate.interface,
      query.planes);
  const float u = RTCHitN_u(args->hit, args->N, 0);
  const float v = RTCHitN_v(args->hit, args->N, 0);
  query.doubtful |= std::min({u, v, 1 - u - v}) < kDoubtfulBarycentric;
  if (query.size < kMaxHits) [[likely]] {
    query.candidates[query.size++] = candidate;
  } else {
    keep_nearest(query, candidate);
  }
}

struct FirstHitQuery {
  EmbreeContext context;
  const EmbreeIndex* index;
  const Line* line;
};

/// Intersection filter: refuses facets at or before the line's origin, as double precision sees it.
void accept_beyond_origin(const RTCFilterFunctionNArguments* args) noexcept {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): Embree's way to pass state.
  const auto& query = *reinterpret_cast<const FirstHitQuery*>(args->context);
  const Passage passage = pass(*query.index, interface_of(args), *query.line);
  if (!(std::abs(passage.cosine) > kCoplanar && passage.depth > 0)) args->valid[0] = 0;
}

struct NearestQuery {
  const EmbreeIndex* index;
  const EmbreeParts* parts;
  bool skin_alone;
  Vec3 p;
  double max_squared;
  NearestFacet best;
  double side;  // |distance of p to best's plane|
};

/// Single-precision search radius that surely holds everything within `distance` of the rounded
/// query point.
float search_radius(double distance) noexcept {
  return static_cast<float>(distance * (1 + 1e-6) + 1e-7);
}

bool consider_facet(RTCPointQueryFunctionArguments* args) noexcept {
  auto& query = *static_cast<NearestQuery*>(args->userPtr);
  const std::uint32_t i = query.parts->interface(args->geomID, args->primID);
  if (query.skin_alone && !touches(query.index->sides(i), kOutside)) return false;
  const Vec3 q = closest_point_on_triangle(query.p, query.index->corners(i));
  const double squared = (query.p - q).squaredNorm();
  if (squared > query.max_squared) return false;
  const FacetPlane plane = query.index->plane(i);
  const double side = std::abs(plane.normal.dot(query.p) - plane.offset);
  const double tie = 1e-12 * query.best.squared_distance + 1e-26;
  const double gain = query.best.squared_distance - squared;
  const bool nearer = gain > tie;
  const bool same = std::abs(gain) <= tie;
  const bool clearer =
      same && (side > query.side || (side == query.side && i < query.best.interface));
  if (!nearer && !clearer) return false;
  query.best = {std::min(squared, query.best.squared_distance), q, i};
  query.side = side;
  args->query->radius = search_radius(std::sqrt(query.best.squared_distance));
  return true;
}

void throw_on_error(RTCDevice device, const char* what) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  throw std::runtime_error(std::string("Embree cannot ") + what + " (error " +
                           std::to_string(static_cast<int>(error)) + ")");
}

EmbreeDevice make_device(const std::string& isa) {
  constexpr std::array<const char*, 6> kKnown = {"", "sse2", "sse4.2", "avx", "avx2", "avx512"};
  ARTUS_REQUIRE(std::find(kKnown.begin(), kKnown.end(), isa) != kKnown.end(),
                "unknown instruction set: " + isa);
  // Embree's own thread count stays alone: setting it would limit TBB in the whole process.
  // Huge pages spare random queries the page walks.
  std::string config = "set_affinity=0,hugepages=1";
  if (!isa.empty()) config += ",isa=" + isa;
  EmbreeDevice device(rtcNewDevice(config.c_str()));
  if (device == nullptr) throw_on_error(nullptr, ("make a device with " + config).c_str());
  return device;
}

}  // namespace

EmbreeIndex::EmbreeIndex(std::shared_ptr<const IndexedSurfaces> surfaces, const std::string& isa)
    : surfaces_(std::move(surfaces)),
      triangles_(surfaces_->triangles),
      facets_(surfaces_->facets),
      centre_(surfaces_->centre),
      radius_(surfaces_->radius),
      vertices_(surfaces_->vertices),
      radii_(surfaces_->radii),
      unfitted_(surfaces_->n_blocks, false),
      device_(make_device(isa)) {
  coordinates_.reset(rtcNewBuffer(device_.get(), 3 * sizeof(float) * vertices_.size() + 16));
  throw_on_error(device_.get(), "store the interfaces");
  fill_coordinates();
  all_ = make_parts(surfaces_->all);
  boundary_ = make_parts(surfaces_->boundary);
  throw_on_error(device_.get(), "index the interfaces");
}

void EmbreeRelease::operator()(RTCBufferTy* buffer) const noexcept {
  rtcReleaseBuffer(buffer);
}

void EmbreeRelease::operator()(RTCDeviceTy* device) const noexcept {
  rtcReleaseDevice(device);
}

void EmbreeRelease::operator()(RTCSceneTy* scene) const noexcept {
  rtcReleaseScene(scene);
}

void EmbreeIndex::fill_coordinates() {
  auto* coordinates = static_cast<float*>(rtcGetBufferData(coordinates_.get()));
  for (const Vec3& v : vertices_) {
    for (int k = 0; k < 3; ++k) *coordinates++ = static_cast<float>(v[k]);
  }
}

/// Members count where they are not all interfaces in their order.
EmbreeParts EmbreeIndex::make_parts(const IndexedSurfaces::Part& part) const {
  const IndexedSurfaces::Members& members = part.members;
  EmbreeParts parts;
  const bool whole = !surfaces_->can_move() && members[0].size() == triangles_.size();
  if (!whole) parts.members = &members;
  parts.none = std::all_of(members.begin(), members.end(), [](const auto& m) { return m.empty(); });
  const bool moves = surfaces_->can_move();
  parts.scene.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(parts.scene.get(),
                   moves ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(parts.scene.get(),
                          moves ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
  parts.geometries.resize(members.size());
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (members[k].empty()) continue;
    RTCGeometry geometry = make_geometry(part.corners[k]);
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): Embree hands it back, no more.
    if (!whole) rtcSetGeometryUserData(geometry, const_cast<std::uint32_t*>(members[k].data()));
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(parts.scene.get(), geometry, static_cast<unsigned>(k));
    rtcReleaseGeometry(geometry);
    parts.geometries[k] = geometry;
  }
  rtcCommitScene(parts.scene.get());
  return parts;
}

/// Of triangles that the surfaces keep.
RTCGeometryTy* EmbreeIndex::make_geometry(
    std::span<const IndexedSurfaces::Corners> triangles) const {
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, coordinates_.get(),
                       0, 3 * sizeof(float), vertices_.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(),
                             0, sizeof(IndexedSurfaces::Corners), triangles.size());
  if (surfaces_->can_move()) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
  rtcSetGeometryOccludedFilterFunction(geometry, gather_hit);
  rtcSetGeometryIntersectFilterFunction(geometry, accept_beyond_origin);
  return geometry;
}

void EmbreeIndex::move(std::size_t group, std::span<const Vec3> places) {
  const std::vector<std::uint32_t>& begins = surfaces_->begins;
  ARTUS_REQUIRE(group + 1 < begins.size() && places.size() == begins[group + 1] - begins[group],
                "a group of an index that can move");
  Vec3* at = &vertices_[begins[group]];
  auto* coordinates =
      static_cast<float*>(rtcGetBufferData(coordinates_.get())) + 3 * std::size_t{begins[group]};
  double squared = 0;
  for (const Vec3& p : places) {
    const Vec3 place = p - centre_;
    *at++ = place;
    for (int k = 0; k < 3; ++k) *coordinates++ = static_cast<float>(place[k]);
    squared = std::max(squared, place.squaredNorm());
  }
  radii_[group] = std::sqrt(squared);
  for (const std::uint32_t block : surfaces_->blocks_at[group]) unfitted_[block] = true;
  moved_ = true;
}

void EmbreeIndex::fit() {
  radius_ = *std::max_element(radii_.begin(), radii_.end());
  for (EmbreeParts* parts : {&all_, &boundary_}) {
    bool some = false;
    for (std::size_t k = 0; k < parts->geometries.size(); ++k) {
      RTCGeometry geometry = parts->geometries[k];
      if (!unfitted_[k] || geometry == nullptr) continue;
      rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(geometry);
      some = true;
    }
    if (some) rtcCommitScene(parts->scene.get());
  }
  unfitted_.assign(unfitted_.size(), false);
  throw_on_error(device_.get(), "move the interfaces");
}

void EmbreeIndex::prefetch_plane(std::uint32_t i, std::uint32_t before,
                                 const PlaneCache* planes) const noexcept {
  __builtin_prefetch(&facets_[i]);
  if (!moved_ || (planes != nullptr && planes->has(i) && planes->has(before))) return;
  __builtin_prefetch(&triangles_[i]);
  for (const std::uint32_t v : triangles_[before]) __builtin_prefetch(&vertices_[v]);
}

std::array<Vec3, 3> EmbreeIndex::corners(std::uint32_t i) const noexcept {
  const auto& [a, b, c] = triangles_[i];
  return {vertices_[a], vertices_[b], vertices_[c]};
}

void EmbreeIndex::gather(const Line& line, HitBuffer& out, PlaneCache* planes) const noexcept {
  out.size = 0;
  out.overflow = false;
  out.doubtful = false;
  if (!(line.far > line.near)) return;
  GatherQuery query;  // NOLINT(cppcoreguidelines-pro-type-member-init): written before read
  query.index = this;
  query.planes = planes;
  query.size = 0;
  query.overflow = false;
  query.doubtful = false;
  init_context(query.context);
  RTCRay ray = make_ray(line);
  find_occluded(all_.scene.get(), query.context, ray);
  out.overflow = query.overflow;
  out.doubtful = query.doubtful;
  for (std::size_t k = 0; k < query.size; ++k) {
    const std::uint32_t i = query.candidates[k].interface;
    const Passage passage = pass(*this, i, line, planes);
    if (!(std::abs(passage.cosine) > kCoplanar)) [[unlikely]]
      continue;
    const FacetSides sides = this->sides(i);
    const bool inward = passage.cosine < 0;
    out.hits[out.size++] = {passage.depth, i, inward ? sides.front : sides.back,
                            inward ? sides.back : sides.front};
  }
}

std::optional<FirstHit> EmbreeIndex::first_hit(const Line& line) const noexcept {
  if (!(line.far > line.near)) return std::nullopt;
  FirstHitQuery query{{}, this, &line};
  init_context(query.context);
  RTCRayHit ray{};
  ray.ray = make_ray(line);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  find_intersection(all_.scene.get(), query.context, ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  FirstHit first;
  first.interface = all_.interface(ray.hit.geomID, ray.hit.primID);
  const FacetSides& sides = this->sides(first.interface);
  const double cosine = plane(first.interface).normal.dot(line.direction);
  first.from = cosine < 0 ? sides.front : sides.back;
  first.clean = std::min({ray.hit.u, ray.hit.v, 1 - ray.hit.u - ray.hit.v}) > kCleanBarycentric &&
                std::abs(cosine) > kGrazing;
  return first;
}

std::optional<NearestFacet> EmbreeIndex::nearest(const Vec3& p, double max_distance,
                                                 Subset subset) const noexcept {
  const EmbreeParts& parts = subset == Subset::all ? all_ : boundary_;
  NearestQuery query{this, &parts, subset == Subset::skin, p, max_distance * max_distance, {}, 0};
  if (parts.none) return std::nullopt;
  constexpr double kNone = std::numeric_limits<double>::max();
  query.best.squared_distance = kNone;
  RTCPointQuery point{};
  point.x = static_cast<float>(p.x());
  point.y = static_cast<float>(p.y());
  point.z = static_cast<float>(p.z());
  point.radius = search_radius(std::min(max_distance, p.norm() + radius_));
  RTCPointQueryContext context;  // NOLINT(cppcoreguidelines-pro-type-member-init): init follows
  rtcInitPointQueryContext(&context);
  rtcPointQuery(parts.scene.get(), &point, &context, consider_facet, &query);
  if (query.best.squared_distance == kNone) return std::nullopt;
  return query.best;
}

}  // namespace artus
