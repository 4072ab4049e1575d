// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/closed_body.h"

#include <unordered_map>
#include <utility>

namespace artus {
namespace {

constexpr RegionId kInside = kFirstRegion;

CompiledJoint empty_body(const std::string& name) {
  CompiledJoint joint;
  joint.name = name;
  joint.tissues.resize(1);
  joint.regions = {{"outside", 0, Vec3::Zero()},
                   {"beyond", 0, Vec3::Zero()},
                   {name.empty() ? "inside" : name, 0, Vec3::Zero()}};
  return joint;
}

}  // namespace

std::shared_ptr<const Scene> make_closed_body(
    std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles,
    const std::string& name) {
  CompiledJoint joint = empty_body(name);
  joint.mesh.vertices.assign(vertices.begin(), vertices.end());
  for (const auto& t : triangles) joint.mesh.interfaces.push_back({t, kOutside, kInside});
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(joint)));
}

std::shared_ptr<const Scene> make_region_body(const CompiledJoint& joint, RegionId region) {
  CompiledJoint body = empty_body(joint.regions[region].name);
  std::unordered_map<std::uint32_t, std::uint32_t> moved;
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != region && f.back != region) continue;
    Interface own{
        {}, f.front == region ? kInside : kOutside, f.back == region ? kInside : kOutside};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [at, fresh] =
          moved.try_emplace(f.vertices[k], static_cast<std::uint32_t>(body.mesh.vertices.size()));
      if (fresh) body.mesh.vertices.push_back(joint.mesh.vertices[f.vertices[k]]);
      own.vertices[k] = at->second;
    }
    body.mesh.interfaces.push_back(own);
  }
  if (body.mesh.interfaces.empty()) return nullptr;
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(body)));
}

std::optional<Vec3> find_entry(const Scene& scene, const Vec3& tip, const Vec3& axis) noexcept {
  constexpr std::size_t kMax = 64;
  std::array<Crossing, kMax> crossings;
  const Segment back{tip, tip - kEntryReach * axis};
  const QueryCount count = scene.find_crossings(back, crossings);
  for (std::size_t i = 0; i < count.size; ++i)
    if (crossings[i].to == kOutside) return Vec3(tip - crossings[i].depth * axis);
  return std::nullopt;
}

RegionId region_of_tip(const Scene& scene, const Vec3& tip, const Vec3& axis) noexcept {
  const RegionId region = scene.region_at(tip);
  return region == kBeyond && !find_entry(scene, tip, axis) ? kOutside : region;
}

}  // namespace artus
