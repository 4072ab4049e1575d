// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/cage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr std::int32_t kNone = -1;
constexpr double kSlack = 1e-9;  // m, below any length that matters

std::array<std::int32_t, 3> shifted(const std::array<std::int32_t, 3>& p, int corner,
                                    std::int32_t step) noexcept {
  return {p[0] + (corner & 1) * step, p[1] + (corner >> 1 & 1) * step, p[2] + (corner >> 2) * step};
}

std::array<double, 8> trilinear(const Vec3& s) noexcept {
  std::array<double, 8> w{};
  for (int a = 0; a < 8; ++a) {
    w[static_cast<std::size_t>(a)] = ((a & 1) != 0 ? s.x() : 1 - s.x()) *
                                     ((a & 2) != 0 ? s.y() : 1 - s.y()) *
                                     ((a & 4) != 0 ? s.z() : 1 - s.z());
  }
  return w;
}

}  // namespace

Cage::Cage(const CageParams& params, const std::function<bool(const Vec3&, double)>& keep)
    : origin_(params.low) {
  ARTUS_REQUIRE((params.high - params.low).minCoeff() > 0 && params.cell > 0, "an empty box");
  int halvings = 0;
  for (const CageZone& zone : params.zones) {
    ARTUS_REQUIRE(zone.cell > 0, "a cell without size");
    while (params.cell * std::pow(0.5, halvings) > zone.cell * (1 + 1e-9)) ++halvings;
  }
  const std::int32_t span = 1 << halvings;
  step_ = params.cell / span;
  double places = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const double n = std::ceil((params.high[axis] - params.low[axis]) / params.cell - 1e-6);
    size_[k] = static_cast<std::int32_t>(n) * span;
    places *= size_[k];
  }
  ARTUS_REQUIRE(places <= 0x1p26, "too many cells: a larger cell or a smaller box");
  leaf_of_.assign(static_cast<std::size_t>(places), kNone);
  for (std::int32_t z = 0; z < size_[2]; z += span) {
    for (std::int32_t y = 0; y < size_[1]; y += span) {
      for (std::int32_t x = 0; x < size_[0]; x += span) cells_.push_back({{x, y, z}, span, {}});
    }
  }
  for (std::size_t i = 0; i < cells_.size(); ++i) fill(cells_[i], static_cast<std::int32_t>(i));
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    while (must_split(cells_[i], params.zones)) split(i);
  }
  balance();
  drop(keep);
  number_nodes();
  hang_nodes();
}

std::size_t Cage::index(const Lattice& p) const noexcept {
  return static_cast<std::size_t>(p[0]) +
         static_cast<std::size_t>(size_[0]) *
             (static_cast<std::size_t>(p[1]) +
              static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(p[2]));
}

bool Cage::inside(const Lattice& p) const noexcept {
  return p[0] >= 0 && p[1] >= 0 && p[2] >= 0 && p[0] < size_[0] && p[1] < size_[1] &&
         p[2] < size_[2];
}

std::int32_t Cage::leaf_at(const Lattice& p) const noexcept {
  return inside(p) ? leaf_of_[index(p)] : kNone;
}

Vec3 Cage::low_corner(const CageCell& cell) const noexcept {
  return origin_ + step_ * Vec3(cell.corner[0], cell.corner[1], cell.corner[2]);
}

bool Cage::must_split(const CageCell& leaf, std::span<const CageZone> zones) const noexcept {
  const Vec3 low = low_corner(leaf);
  const Vec3 high = low + Vec3::Constant(edge(leaf));
  return std::any_of(zones.begin(), zones.end(), [&](const CageZone& zone) {
    return edge(leaf) > zone.cell * (1 + 1e-9) && (high - zone.low).minCoeff() > kSlack &&
           (zone.high - low).minCoeff() > kSlack;
  });
}

void Cage::fill(const CageCell& leaf, std::int32_t id) noexcept {
  for (std::int32_t z = 0; z < leaf.span; ++z) {
    for (std::int32_t y = 0; y < leaf.span; ++y) {
      const std::size_t row = index({leaf.corner[0], leaf.corner[1] + y, leaf.corner[2] + z});
      std::fill_n(leaf_of_.begin() + static_cast<std::ptrdiff_t>(row), leaf.span, id);
    }
  }
}

/// The first eighth takes the leaf's place, the others stand at the end.
void Cage::split(std::size_t leaf) {
  const CageCell old = cells_[leaf];
  const std::int32_t half = old.span / 2;
  for (int a = 0; a < 8; ++a) {
    const CageCell part{shifted(old.corner, a, half), half, {}};
    if (a == 0) {
      cells_[leaf] = part;
      fill(part, static_cast<std::int32_t>(leaf));
    } else {
      cells_.push_back(part);
      fill(part, static_cast<std::int32_t>(cells_.size() - 1));
    }
  }
}

void Cage::balance() {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const CageCell leaf = cells_[i];
      for (int k = 0; k < 27; ++k) {
        const Lattice p{leaf.corner[0] + (k % 3 - 1) * leaf.span,
                        leaf.corner[1] + (k / 3 % 3 - 1) * leaf.span,
                        leaf.corner[2] + (k / 9 - 1) * leaf.span};
        const std::int32_t other = leaf_at(p);
        if (other == kNone) continue;
        if (cells_[static_cast<std::size_t>(other)].span > 2 * leaf.span) {
          split(static_cast<std::size_t>(other));
          changed = true;
        }
      }
    }
  }
}

/// Keeps the body's cells, in the order of their place, so that neighbours are near in memory.
void Cage::drop(const std::function<bool(const Vec3&, double)>& keep) {
  std::vector<CageCell> kept;
  for (const CageCell& cell : cells_) {
    if (keep(low_corner(cell), edge(cell))) kept.push_back(cell);
  }
  std::sort(kept.begin(), kept.end(), [](const CageCell& a, const CageCell& b) {
    return std::array{a.corner[2], a.corner[1], a.corner[0]} <
           std::array{b.corner[2], b.corner[1], b.corner[0]};
  });
  std::fill(leaf_of_.begin(), leaf_of_.end(), kNone);
  cells_ = std::move(kept);
  for (std::size_t i = 0; i < cells_.size(); ++i) fill(cells_[i], static_cast<std::int32_t>(i));
}

void Cage::number_nodes() {
  std::unordered_map<std::uint64_t, std::uint32_t> known;
  for (CageCell& cell : cells_) {
    for (int a = 0; a < 8; ++a) {
      const Lattice p = shifted(cell.corner, a, cell.span);
      const std::uint64_t key = static_cast<std::uint64_t>(p[0]) |
                                static_cast<std::uint64_t>(p[1]) << 21U |
                                static_cast<std::uint64_t>(p[2]) << 42U;
      const auto [place, is_new] =
          known.try_emplace(key, static_cast<std::uint32_t>(nodes_.size()));
      if (is_new) {
        nodes_.push_back(origin_ + step_ * Vec3(p[0], p[1], p[2]));
        node_places_.push_back(p);
      }
      cell.nodes[static_cast<std::size_t>(a)] = place->second;
    }
  }
}

/// Direct masters first, then masters of masters until none hangs: each step leads to larger cells.
void Cage::hang_nodes() {
  std::vector<std::vector<NodeShare>> direct(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Lattice& p = node_places_[n];
    std::int32_t largest = kNone;
    for (int a = 0; a < 8; ++a) {
      const std::int32_t leaf = leaf_at(shifted({p[0] - 1, p[1] - 1, p[2] - 1}, a, 1));
      if (leaf == kNone) continue;
      const CageCell& cell = cells_[static_cast<std::size_t>(leaf)];
      if (std::find(cell.nodes.begin(), cell.nodes.end(), n) != cell.nodes.end()) continue;
      if (largest == kNone || cell.span > cells_[static_cast<std::size_t>(largest)].span)
        largest = leaf;
    }
    if (largest == kNone) continue;
    const CageCell& cell = cells_[static_cast<std::size_t>(largest)];
    const Vec3 s =
        Vec3(p[0] - cell.corner[0], p[1] - cell.corner[1], p[2] - cell.corner[2]) / cell.span;
    const auto weights = trilinear(s);
    for (std::size_t a = 0; a < 8; ++a) {
      if (weights[a] > 0) direct[n].push_back({cell.nodes[a], weights[a]});
    }
  }
  share_start_.assign(1, 0);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    std::vector<NodeShare> open = direct[n];
    std::vector<NodeShare> resolved;
    while (!open.empty()) {
      const NodeShare share = open.back();
      open.pop_back();
      if (!direct[share.node].empty()) {
        for (const NodeShare& d : direct[share.node])
          open.push_back({d.node, d.weight * share.weight});
        continue;
      }
      const auto same = std::find_if(resolved.begin(), resolved.end(),
                                     [&](const NodeShare& r) { return r.node == share.node; });
      if (same != resolved.end()) {
        same->weight += share.weight;
      } else {
        resolved.push_back(share);
      }
    }
    shares_.insert(shares_.end(), resolved.begin(), resolved.end());
    share_start_.push_back(static_cast<std::uint32_t>(shares_.size()));
  }
}

std::int32_t Cage::cell_around(const Vec3& p_C) const noexcept {
  const Vec3 s = (p_C - origin_) / step_;
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = s[static_cast<Eigen::Index>(k)];
    if (!(at >= 0 && at < size_[k])) return kNone;
  }
  return leaf_of_[index({static_cast<std::int32_t>(s.x()), static_cast<std::int32_t>(s.y()),
                         static_cast<std::int32_t>(s.z())})];
}

CagePlace Cage::locate(const Vec3& p_C, int reach) const noexcept {
  CagePlace place;
  const Vec3 s = (p_C - origin_) / step_;
  if (!s.allFinite() || s.cwiseAbs().maxCoeff() > 1e9) return place;
  Lattice p{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = s[static_cast<Eigen::Index>(k)];
    p[k] = static_cast<std::int32_t>(std::floor(at));
    if (p[k] == size_[k] && at <= size_[k] + 1e-6) --p[k];
  }
  std::int32_t best = leaf_at(p);
  double nearest = std::numeric_limits<double>::infinity();
  for (int r = 1; best == kNone && r <= reach; ++r) {
    for (int k = 0; k < (2 * r + 1) * (2 * r + 1) * (2 * r + 1); ++k) {
      const int n = 2 * r + 1;
      const Lattice q{p[0] + k % n - r, p[1] + k / n % n - r, p[2] + k / (n * n) - r};
      const std::int32_t leaf = leaf_at(q);
      if (leaf == kNone) continue;
      const CageCell& cell = cells_[static_cast<std::size_t>(leaf)];
      const Vec3 low(cell.corner[0], cell.corner[1], cell.corner[2]);
      const Vec3 inner = s.cwiseMax(low).cwiseMin(low + Vec3::Constant(cell.span));
      if ((s - inner).squaredNorm() < nearest) {
        nearest = (s - inner).squaredNorm();
        best = leaf;
      }
    }
  }
  if (best == kNone) return place;
  place.cell = best;
  const CageCell& cell = cells_[static_cast<std::size_t>(best)];
  const Vec3 low(cell.corner[0], cell.corner[1], cell.corner[2]);
  place.weights = trilinear(((s - low) / cell.span).cwiseMax(0).cwiseMin(1));
  return place;
}

}  // namespace artus
