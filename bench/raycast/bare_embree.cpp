// SPDX-License-Identifier: AGPL-3.0-or-later
#include "bench/raycast/bare_embree.h"

#include <algorithm>

#include "artus/detail/raycast/embree_api.h"

namespace artus::bench {
namespace {

struct Query {
  EmbreeContext context;
  BareEmbree::Hits* out;
};

void note_hit(const RTCFilterFunctionNArguments* args) noexcept {
  args->valid[0] = 0;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): Embree's way to pass state.
  BareEmbree::Hits& out = *reinterpret_cast<const Query*>(args->context)->out;
  if (out.size == out.depths.size()) return;
  out.depths[out.size] = RTCRayN_tfar(args->ray, args->N, 0);
  out.primitives[out.size++] = RTCHitN_primID(args->hit, args->N, 0);
}

}  // namespace

BareEmbree::BareEmbree(const CompiledJoint& joint)
    : device_(rtcNewDevice("set_affinity=0,hugepages=1")), scene_(rtcNewScene(device_)) {
  const TetMesh& mesh = joint.mesh;
  for (const Vec3& v : mesh.vertices) centre_ += v / static_cast<double>(mesh.vertices.size());
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                             mesh.vertices.size()));
  for (const Vec3& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) *vertex++ = static_cast<float>(v[k] - centre_[k]);
  }
  auto* index = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.interfaces.size()));
  for (const Interface& face : mesh.interfaces) {
    index = std::copy_n(face.vertices.begin(), 3, index);
  }
  rtcSetGeometryOccludedFilterFunction(geometry, note_hit);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
}

BareEmbree::~BareEmbree() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void BareEmbree::all_hits(const Segment& segment, Hits& out) const noexcept {
  out.size = 0;
  Query query{{}, &out};
  init_context(query.context);
  const Vec3 start = segment.start - centre_;
  const Vec3 along = segment.end - segment.start;
  const double length = along.norm();
  const Vec3 direction = along / length;
  RTCRay ray{};
  ray.org_x = static_cast<float>(start.x());
  ray.org_y = static_cast<float>(start.y());
  ray.org_z = static_cast<float>(start.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tfar = static_cast<float>(length);
  ray.mask = ~0U;
  find_occluded(scene_, query.context, ray);
}

}  // namespace artus::bench
