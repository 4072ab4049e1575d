// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/joint3d/surface_detail.h"

#include <cmath>
#include <limits>
#include <unordered_map>

#include "artus/detail/core/noise.h"

namespace artus {

namespace {

/// The source of the point that is nearest to each mean; `moved`: the mean of each point.
std::vector<std::uint32_t> nearest_sources(const Surface& surface,
                                           const std::vector<std::uint32_t>& moved,
                                           const std::vector<Eigen::Vector3f>& means) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  std::vector<std::uint32_t> sources(means.size());
  std::vector<float> least(means.size(), kNone);
  for (std::size_t i = 0; i < surface.sources.size(); ++i) {
    const std::uint32_t m = moved[i];
    const float distance = (surface.points[i] - means[m]).squaredNorm();
    if (distance > least[m]) continue;
    if (distance == least[m] && surface.sources[i] >= sources[m]) continue;  // alike in all sheets
    least[m] = distance;
    sources[m] = surface.sources[i];
  }
  return sources;
}

}  // namespace

Surface decimated(const Surface& surface, double cell) {
  if (cell <= 0) return surface;
  std::unordered_map<std::uint64_t, std::uint32_t> cube_of;  // by a number of cube and label
  std::vector<std::uint32_t> moved;
  std::vector<float> counts;
  Surface out;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Eigen::Vector3f& p = surface.points[i];
    std::uint64_t key = surface.labels.empty() ? 0 : mix_bits(surface.labels[i]);
    for (int k = 0; k < 3; ++k)
      key = mix_bits(key ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(
                               std::floor(p[k] / static_cast<float>(cell)))));
    const auto [at, fresh] =
        cube_of.try_emplace(key, static_cast<std::uint32_t>(out.points.size()));
    if (fresh) {
      out.points.emplace_back(Eigen::Vector3f::Zero());
      counts.push_back(0);
    }
    out.points[at->second] += p;
    counts[at->second] += 1;
    moved.push_back(at->second);
  }
  for (std::size_t i = 0; i < out.points.size(); ++i) out.points[i] /= counts[i];
  if (!surface.sources.empty()) out.sources = nearest_sources(surface, moved, out.points);
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    const std::uint32_t a = moved[surface.indices[i]];
    const std::uint32_t b = moved[surface.indices[i + 1]];
    const std::uint32_t c = moved[surface.indices[i + 2]];
    if (a != b && b != c && c != a) out.indices.insert(out.indices.end(), {a, b, c});
  }
  return out;
}

void DetailChooser::note(double seconds) noexcept {
  took_[level_] = seconds;
  slow_ = seconds > requested_ ? slow_ + 1 : 0;
  fast_ = seconds < requested_ / 3 ? fast_ + 1 : 0;
  constexpr int kSlowEnough = 2;
  constexpr int kFastEnough = 30;
  if (slow_ >= kSlowEnough && level_ + 1 < kLevels) {
    ++level_;
    slow_ = 0;
  } else if (fast_ >= kFastEnough && level_ > 0 && took_[level_ - 1] < 3 * requested_) {
    --level_;
    fast_ = 0;
  }
}

}  // namespace artus
