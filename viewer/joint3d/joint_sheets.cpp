// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/joint3d/joint_sheets.h"

#include <algorithm>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

/// A number for a pair of regions, whichever is in front.
std::uint64_t pair_of(const Interface& face) noexcept {
  const auto [low, high] = std::minmax(face.front, face.back);
  return static_cast<std::uint64_t>(low) << 32U | high;
}

/// Which of the six directions along the axes a normal points most along.
std::uint64_t direction_of(const Vec3& normal) noexcept {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * static_cast<std::uint64_t>(axis) + (normal[axis] > 0 ? 1 : 0);
}

/// Of each vertex from `first` on: points within a sheet by the way that the sheet faces, points of
/// an edge by the sheets that meet there.
std::vector<std::uint64_t> find_labels(const TetMesh& mesh, std::span<const Interface* const> faces,
                                       std::uint32_t first) {
  struct Seen {
    std::uint64_t first = 0;  // pair; 0: none yet
    Vec3 normal = Vec3::Zero();
  };
  std::vector<Seen> seen(mesh.vertices.size() - first);
  std::vector<std::vector<std::uint64_t>> others(seen.size());
  for (const Interface* at : faces) {
    const Interface& face = *at;
    const std::uint64_t pair = pair_of(face);
    const auto& p = mesh.vertices;
    const auto& v = face.vertices;
    Vec3 normal = (p[v[1]] - p[v[0]]).cross(p[v[2]] - p[v[0]]);
    if (face.front > face.back) normal = -normal;
    for (const std::uint32_t vertex : v) {
      Seen& s = seen[vertex - first];
      s.normal += normal;
      if (s.first == 0) {
        s.first = pair;
      } else if (s.first != pair) {
        auto& known = others[vertex - first];
        if (std::find(known.begin(), known.end(), pair) == known.end()) known.push_back(pair);
      }
    }
  }
  std::vector<std::uint64_t> labels(seen.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::uint64_t sum = mix_bits(seen[i].first);
    for (const std::uint64_t pair : others[i]) sum += mix_bits(pair);  // in any order
    labels[i] = others[i].empty() ? mix_bits(sum ^ direction_of(seen[i].normal)) : sum;
  }
  return labels;
}

}  // namespace

std::vector<Sheet> find_sheets(const CompiledJoint& joint, RegionId least) {
  const TetMesh& mesh = joint.mesh;
  std::vector<const Interface*> faces;
  auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Interface& face : mesh.interfaces) {
    if (std::max(face.front, face.back) < least) continue;
    faces.push_back(&face);
    for (const std::uint32_t v : face.vertices) first = std::min(first, v);
  }
  const std::vector<std::uint64_t> labels = find_labels(mesh, faces, first);
  std::map<std::pair<RegionId, RegionId>, std::size_t> sheet_of;
  std::vector<Sheet> sheets;
  std::vector<std::unordered_map<std::uint32_t, std::uint32_t>> renumbered;
  for (const Interface* of : faces) {
    const Interface& face = *of;
    const auto [at, fresh] = sheet_of.try_emplace({face.front, face.back}, sheets.size());
    if (fresh) {
      sheets.push_back({face.front, face.back, Vec3::Zero(), {}});
      renumbered.emplace_back();
    }
    Surface& surface = sheets[at->second].surface;
    for (const std::uint32_t v : face.vertices) {
      const auto [own, is_new] =
          renumbered[at->second].try_emplace(v, static_cast<std::uint32_t>(surface.points.size()));
      if (is_new) {
        surface.points.emplace_back(mesh.vertices[v].cast<float>());
        surface.labels.push_back(labels[v - first]);
        surface.sources.push_back(v);
      }
      surface.indices.push_back(own->second);
    }
  }
  for (Sheet& sheet : sheets) {
    for (const auto& p : sheet.surface.points) sheet.centre += p.cast<double>();
    sheet.centre /= static_cast<double>(sheet.surface.points.size());
  }
  return sheets;
}

}  // namespace artus
