// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "artus/detail/evidence/runs/injection_plan.h"
#include "artus/detail/evidence/runs/injection_run.h"
#include "artus/detail/evidence/runs/injection_view.h"

namespace artus {
namespace {

constexpr double kEnough = 1e-3;       // m in which a tip has room
constexpr double kNearlyBest = 0.75;   // of the best line's merit: worth a look
constexpr double kLineShare = 0.3;     // what the best line is worth beside a view
constexpr double kDeep = 30e-3;        // m of tissue before the tip that cost as much as all of it
constexpr std::size_t kLookedAt = 16;  // lines at most whose view is searched closely
constexpr double kFace = 38e-3;        // m, of a linear probe

/// Where a line from outside comes to `point` along `direction`: the skin; none where the way is
/// not free.
std::optional<Vec3> free_entry(const Scene& scene, const Vec3& point, const Vec3& direction) {
  constexpr double kLongest = 0.075;  // m
  const Vec3 start = point - kLongest * direction;
  std::optional<Vec3> entry;
  for (const TissueInterval& s : tissue_intervals(scene, {start, point})) {
    if (s.region == kOutside) {
      entry = start + s.exit * direction;
      continue;
    }
    if (s.region == kBeyond || bars_way(scene.joint().tissue_of(s.region))) return std::nullopt;
  }
  return entry;
}

struct Candidate {
  Vec3 entry;
  Vec3 target;
  double merit = 0;  // thick for its depth: room to stop in, and not far
};

/// Lines from the skin into `region` with nothing in their way that may not be.
std::vector<Candidate> free_lines(const Scene& scene, RegionId region) {
  constexpr int kPoints = 24;
  constexpr int kDirections = 200;
  const TetMesh& mesh = scene.joint().mesh;
  std::vector<Vec3> points;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (mesh.regions[t] != region) continue;
    Vec3 p = Vec3::Zero();
    for (const std::uint32_t v : mesh.tetrahedra[t]) p += mesh.vertices[v] / 4;
    points.push_back(p);
  }
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kPoints);
  std::vector<Candidate> lines;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    for (int k = 0; k < kDirections; ++k) {
      const double z = 1 - (2 * k + 1.0) / kDirections;
      const double turn = k * std::numbers::pi * (3 - std::sqrt(5.0));
      const double r = std::sqrt(1 - z * z);
      const Vec3 direction(r * std::cos(turn), r * std::sin(turn), z);
      const auto entry = free_entry(scene, points[i], direction);
      if (!entry) continue;
      const auto layer = find_layer(scene, *entry, direction, region);
      if (!layer) continue;
      const double room = std::min(layer->to - layer->from, 8e-3);
      lines.push_back({*entry, *entry + (layer->from + layer->to) / 2 * direction,
                       room / (15e-3 + (points[i] - *entry).norm())});
    }
  }
  return lines;
}

/// The `n` lines of most merit, their own and that of their view together.
void keep_best_seen(const Scene& scene, ViewSearch search, std::size_t n,
                    std::vector<Candidate>& lines) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Vec3 path = lines[i].target - lines[i].entry;
    const Pose X_JN = make_pose(lines[i].target, path, path.unitOrthogonal());
    const FoundView view = find_view_of(scene, X_JN, kFace, search);
    const double deep = (view.X_JP.inverse() * lines[i].target).z();
    order.emplace_back(deep / kDeep - view.merit - lines[i].merit, i);
  }
  std::sort(order.begin(), order.end());
  order.resize(std::min(n, order.size()));
  std::vector<Candidate> kept;
  for (const auto& [merit, i] : order) kept.push_back(lines[i]);
  lines = std::move(kept);
}

}  // namespace

std::optional<LineLayer> find_layer(const Scene& scene, const Vec3& entry, const Vec3& direction,
                                    RegionId region, std::optional<double> wanted) {
  const double before = kStartOutside;
  std::optional<LineLayer> roomy;
  std::optional<LineLayer> widest;
  for (const TissueInterval& s :
       tissue_intervals(scene, {entry - before * direction, entry + kSearch * direction})) {
    if (s.region != region) continue;
    const LineLayer layer{s.entry - before, s.exit - before};
    if (wanted && *wanted >= layer.from && *wanted <= layer.to) return layer;
    if (!roomy && layer.to - layer.from > kEnough) roomy = layer;
    if (!widest || layer.to - layer.from > widest->to - widest->from) widest = layer;
  }
  return roomy ? roomy : widest;
}

Result<std::pair<Vec3, Vec3>> find_line_into(const Scene& scene, RegionId region) {
  std::vector<Candidate> lines = free_lines(scene, region);
  if (lines.empty())
    return fail(ErrorCode::not_found,
                "no way from the skin into '" + scene.joint().regions[region].name +
                    "' without bone, nerve or vessel; give --entry and --target");
  double most = 0;
  for (const Candidate& line : lines) most = std::max(most, line.merit);
  std::erase_if(lines, [most](const Candidate& line) { return line.merit < kNearlyBest * most; });
  for (Candidate& line : lines) line.merit *= kLineShare / most;
  keep_best_seen(scene, ViewSearch::coarse, kLookedAt, lines);
  keep_best_seen(scene, ViewSearch::fine, 1, lines);
  return std::pair(lines.front().entry, lines.front().target);
}

}  // namespace artus
