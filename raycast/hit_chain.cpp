// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/raycast/hit_chain.h"

#include <algorithm>
#include <optional>

namespace artus {
namespace {

/// Two hits nearer than this may be one in two guises; the common case has none, m.
constexpr double kTouch = 1e-9;

bool before(const Hit& a, const Hit& b) noexcept {
  return a.depth < b.depth || (a.depth == b.depth && a.interface < b.interface);
}

/// Region just after the gap's left end and just before its right end; the same but for a seam.
struct Gap {
  RegionId first = kOutside;
  RegionId last = kOutside;
};

using Cluster = std::span<const Hit>;

Cluster next_cluster(std::span<const Hit> sorted, std::size_t begin) noexcept {
  std::size_t end = begin + 1;
  while (end < sorted.size() && sorted[end].depth - sorted[end - 1].depth <= kClusterWidth) ++end;
  return sorted.subspan(begin, end - begin);
}

/// The region all hits of a cluster agree on, before (`member` = from) or after it (to).
std::optional<RegionId> agreed(Cluster cluster, RegionId Hit::*member) noexcept {
  if (cluster.empty()) return std::nullopt;
  const RegionId region = cluster.front().*member;
  const bool same = std::all_of(cluster.begin(), cluster.end(),
                                [&](const Hit& hit) { return hit.*member == region; });
  return same ? std::optional<RegionId>(region) : std::nullopt;
}

bool unmeshed(std::optional<RegionId> region) noexcept {
  return region.has_value() && *region < kFirstRegion;
}

/// A point inside the gap between two clusters (the range's end where there is no cluster); at the
/// golden section, because symmetric lines have touches in the middle.
double probe_depth(Cluster left, Cluster right, const TracedRange& range) noexcept {
  const double begin = left.empty() ? std::min(range.near, right.front().depth) : left.back().depth;
  const double end = right.empty() ? std::max(range.far, left.back().depth) : right.front().depth;
  return begin + 0.381966 * (end - begin);
}

Gap find_gap(Cluster left, Cluster right, const TracedRange& range,
             const RegionProbe& region_at) noexcept {
  const std::optional<RegionId> a = agreed(left, &Hit::to);
  const std::optional<RegionId> b = agreed(right, &Hit::from);
  const bool seam = unmeshed(a) && unmeshed(b);
  if (!range.doubtful) {
    if (a.has_value() && b.has_value() && (*a == *b || seam)) return {*a, *b};
    if (left.empty() && b.has_value()) return {*b, *b};
    if (right.empty() && a.has_value()) return {*a, *a};
  }
  const RegionId region = region_at(probe_depth(left, right, range));
  if (seam && unmeshed(region)) return {*a, *b};
  return {region, region};
}

void append(HitChain& out, const Hit& hit) noexcept {
  ARTUS_ASSERT(out.size < out.hits.size());  // no hit is appended twice, no gap more than once
  if (out.size < out.hits.size()) out.hits[out.size++] = hit;
}

/// Adds the cluster's passage from region `a` to region `b`.
void append_passage(Cluster cluster, RegionId a, RegionId b, HitChain& out) noexcept {
  if (a == b) return;
  for (const Hit& hit : cluster) {
    if (hit.from == a && hit.to == b) return append(out, hit);
  }
  for (const Hit& in : cluster) {
    if (in.from != a) continue;
    for (const Hit& onward : cluster) {
      if (onward.from != in.to || onward.to != b) continue;
      append(out, in);
      Hit second = onward;
      second.depth = std::max(in.depth, onward.depth);
      return append(out, second);
    }
  }
  const auto arriving =
      std::find_if(cluster.begin(), cluster.end(), [&](const Hit& hit) { return hit.to == b; });
  Hit forced = arriving != cluster.end() ? *arriving : cluster.front();
  forced.from = a;
  forced.to = b;
  append(out, forced);
}

}  // namespace

void sort_hits(std::span<Hit> hits) noexcept {
  constexpr std::size_t kSmall = 24;
  if (hits.size() > kSmall) {
    std::sort(hits.begin(), hits.end(), before);
    return;
  }
  for (std::size_t i = 1; i < hits.size(); ++i) {
    const Hit hit = hits[i];
    std::size_t j = i;
    for (; j > 0 && before(hit, hits[j - 1]); --j) hits[j] = hits[j - 1];
    hits[j] = hit;
  }
}

bool is_chain(std::span<const Hit> sorted) noexcept {
  bool consistent = true;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    consistent = consistent && sorted[i].from == sorted[i - 1].to &&
                 sorted[i].depth - sorted[i - 1].depth > kTouch;
  }
  return consistent;
}

void repair_chain(std::span<const Hit> sorted, const TracedRange& range,
                  const RegionProbe& region_at, HitChain& out) noexcept {
  ARTUS_ASSERT(sorted.size() <= kMaxHits);
  ARTUS_ASSERT(std::is_sorted(sorted.begin(), sorted.end(), before));
  out.size = 0;
  if (sorted.empty()) return;
  Cluster cluster = next_cluster(sorted, 0);
  RegionId region = find_gap({}, cluster, range, region_at).last;
  for (std::size_t end = cluster.size();; end += cluster.size()) {
    const Cluster next = end < sorted.size() ? next_cluster(sorted, end) : Cluster();
    const Gap gap = find_gap(cluster, next, range, region_at);
    append_passage(cluster, region, gap.first, out);
    region = gap.last;
    if (gap.first != gap.last) {
      const double middle = 0.5 * (cluster.back().depth + next.front().depth);
      append(out, {middle, kNoInterface, gap.first, gap.last});
    }
    if (next.empty()) return;
    cluster = next;
  }
}

}  // namespace artus
