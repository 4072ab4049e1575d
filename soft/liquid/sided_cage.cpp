// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/sided_cage.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/check.h"
#include "artus/detail/core/disjoint_sets.h"

namespace artus {
namespace {

constexpr double kCubes = 40000;      // in the box, about
constexpr double kFinest = 0.4e-3;    // m, a cube's edge
constexpr double kCoarsest = 2.8e-3;  // m
constexpr double kNarrowest = 10e-3;  // m of tissue around the space
constexpr double kWidest = 25e-3;     // m
constexpr double kAirCubes = 4;       // cubes of air above the skin
constexpr double kFilm = 2.5e-3;      // m between walls that lie on each other
/// Of a spacing: no line of samples lies along a mesh's own grid.
Vec3 shift() {
  return {0.137, 0.211, 0.173};
}

}  // namespace

SidedCage::SidedCage(const CompiledJoint& joint, std::span<const RegionId> space)
    : in_space_(joint.regions.size(), false) {
  for (const RegionId region : space) in_space_[region] = true;
  find_box(joint, space);
  const auto n = static_cast<std::size_t>(cubes_[0] * cubes_[1] * cubes_[2]) *
                 (kSamples * kSamples * kSamples);
  region_.assign(n, kOutside);
  blocked_.assign(n, 0);
  for (int axis = 0; axis < 3; ++axis) scan(joint, axis);
  drop_air();
  make_copies();
  join_copies();
  place_films();
  file_walls();
  list_offsets();
}

std::size_t SidedCage::cube_index(const Index& c) const noexcept {
  return static_cast<std::size_t>((c[2] * cubes_[1] + c[1]) * cubes_[0] + c[0]);
}

std::size_t SidedCage::sample_index(const Index& s) const noexcept {
  const auto wide = static_cast<std::size_t>(cubes_[0] * kSamples);
  const auto high = static_cast<std::size_t>(cubes_[1] * kSamples);
  return (static_cast<std::size_t>(s[2]) * high + static_cast<std::size_t>(s[1])) * wide +
         static_cast<std::size_t>(s[0]);
}

Vec3 SidedCage::sample_at(const Index& s) const noexcept {
  return low_ + spacing() * (Vec3(s[0], s[1], s[2]) + Vec3::Constant(0.5));
}

bool SidedCage::is_sample(const Index& s) const noexcept {
  for (std::size_t a = 0; a < 3; ++a)
    if (s[a] < 0 || s[a] >= cubes_[a] * kSamples) return false;
  return true;
}

std::int32_t SidedCage::copy_of(const Index& s) const noexcept {
  const std::uint8_t part = part_[sample_index(s)];
  if (part == kNone) return -1;
  return first_[cube_index({s[0] / kSamples, s[1] / kSamples, s[2] / kSamples})] + part;
}

bool SidedCage::on_border(const Copy& copy, std::size_t corner) const noexcept {
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int32_t at = copy.cube[a] + ((corner >> a) & 1U ? 1 : 0);
    if (at == 0 || at == cubes_[a]) return true;
  }
  return false;
}

/// The space's walls, and the box around them with tissue to every side.
void SidedCage::find_box(const CompiledJoint& joint, std::span<const RegionId> space) {
  ARTUS_REQUIRE(!space.empty(), "a region");
  Eigen::AlignedBox3d box;
  for (const Interface& f : joint.mesh.interfaces) {
    if (in_space_[f.front] == in_space_[f.back]) continue;
    Wall wall;
    for (std::size_t k = 0; k < 3; ++k) {
      wall.p[k] = joint.mesh.vertices[f.vertices[k]];
      box.extend(wall.p[k]);
    }
    const Vec3 normal = (wall.p[1] - wall.p[0]).cross(wall.p[2] - wall.p[0]);
    if (!(normal.norm() > 0)) continue;
    wall.into = (in_space_[f.back] ? 1 : -1) * normal.normalized();
    walls_.push_back(wall);
  }
  ARTUS_REQUIRE(!walls_.empty(), "the region must have interfaces");
  extent_ = box.diagonal().norm();
  const Vec3 margin = Vec3::Constant(std::clamp(extent_, kNarrowest, kWidest));
  const Vec3 size = box.sizes() + 2 * margin;
  edge_ = std::clamp(std::cbrt(size.prod() / kCubes), kFinest, kCoarsest);
  for (int a = 0; a < 3; ++a)
    cubes_[static_cast<std::size_t>(a)] = static_cast<std::int32_t>(std::ceil(size[a] / edge_));
  const Vec3 all = edge_ * Vec3(cubes_[0], cubes_[1], cubes_[2]);
  low_ = box.center() - all / 2 + spacing() * shift();
}

/// What lies on the lines of samples along an axis.
void SidedCage::scan(const CompiledJoint& joint, int axis) {
  const auto d = static_cast<std::size_t>(axis);
  const std::size_t a = (d + 1) % 3;
  const std::size_t b = (d + 2) % 3;
  const int na = cubes_[a] * kSamples;
  const int nb = cubes_[b] * kSamples;
  std::vector<std::vector<Hit>> lines(static_cast<std::size_t>(na) * static_cast<std::size_t>(nb));
  for (const Interface& f : joint.mesh.interfaces) {
    const bool wall = in_space_[f.front] != in_space_[f.back];
    if (axis != 2 && !wall) continue;
    std::array<Vec3, 3> p;  // in samples: a, b, along the axis
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 q = (joint.mesh.vertices[f.vertices[k]] - low_) / spacing() - Vec3::Constant(0.5);
      p[k] = Vec3(q[static_cast<int>(a)], q[static_cast<int>(b)], q[axis]);
    }
    const Vec3 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]);
    const Vec3 high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    const Vec3 ab = p[1] - p[0];
    const Vec3 ac = p[2] - p[0];
    const double det = ab.x() * ac.y() - ab.y() * ac.x();
    if (det == 0) continue;
    for (int j = std::max(0, static_cast<int>(std::ceil(low.y()))); j < nb && j <= high.y(); ++j)
      for (int i = std::max(0, static_cast<int>(std::ceil(low.x()))); i < na && i <= high.x();
           ++i) {
        const double x = i - p[0].x();
        const double y = j - p[0].y();
        const double u = (x * ac.y() - y * ac.x()) / det;
        const double v = (ab.x() * y - ab.y() * x) / det;
        if (u < 0 || v < 0 || u + v > 1) continue;
        // det > 0: the normal looks along the line.
        lines[static_cast<std::size_t>(j) * static_cast<std::size_t>(na) +
              static_cast<std::size_t>(i)]
            .push_back({p[0].z() + u * ab.z() + v * ac.z(), det > 0 ? f.back : f.front,
                        det > 0 ? f.front : f.back, wall, std::abs(det) / ab.cross(ac).norm()});
      }
  }
  for (int j = 0; j < nb; ++j)
    for (int i = 0; i < na; ++i) {
      Index first{};
      first[a] = i;
      first[b] = j;
      read_line(axis, first,
                lines[static_cast<std::size_t>(j) * static_cast<std::size_t>(na) +
                      static_cast<std::size_t>(i)]);
    }
}

void SidedCage::read_line(int axis, const Index& first, std::vector<Hit>& hits) {
  std::sort(hits.begin(), hits.end(), [](const Hit& x, const Hit& y) { return x.at < y.at; });
  const auto d = static_cast<std::size_t>(axis);
  Index s = first;
  std::size_t k = 0;
  RegionId region = hits.empty() ? kOutside : hits.front().before;
  for (s[d] = 0; s[d] < cubes_[d] * kSamples; ++s[d]) {
    bool wall = false;
    for (; k < hits.size() && hits[k].at <= s[d]; ++k) {
      region = hits[k].behind;
      wall = wall || hits[k].wall;
    }
    if (axis == 2) region_[sample_index(s)] = region;
    if (!wall || s[d] == 0) continue;
    Index before = s;
    --before[d];
    blocked_[sample_index(before)] |= static_cast<std::uint8_t>(1U << d);
  }
  find_films(axis, first, hits);
}

void SidedCage::find_films(int axis, const Index& first, const std::vector<Hit>& hits) {
  const auto d = static_cast<std::size_t>(axis);
  const Hit* enters = nullptr;
  for (const Hit& hit : hits) {
    if (!hit.wall) continue;
    if (in_space_[hit.behind]) {
      enters = &hit;
      continue;
    }
    if (enters == nullptr) continue;
    Pair pair{first, first, 0};
    pair.here[d] = static_cast<std::int32_t>(std::ceil(enters->at)) - 1;
    pair.there[d] = static_cast<std::int32_t>(std::floor(hit.at)) + 1;
    pair.area = (enters->facing + hit.facing) / 2 * spacing() * spacing();
    const bool thin = (hit.at - enters->at) * spacing() < kFilm;
    enters = nullptr;
    if (thin && is_sample(pair.here) && is_sample(pair.there)) pairs_.push_back(pair);
  }
}

void SidedCage::place_films() {
  for (const Pair& pair : pairs_) {
    const Place here{sample_at(pair.here), copy_of(pair.here)};
    const Place there{sample_at(pair.there), copy_of(pair.there)};
    if (here.copy >= 0 && there.copy >= 0) films_.push_back({here, there, pair.area});
  }
  pairs_.clear();
}

/// Leaves a few cubes of air over the skin, which moves out into it; the rest is none of it.
void SidedCage::drop_air() {
  std::vector<int> far(static_cast<std::size_t>(cubes_[0] * cubes_[1] * cubes_[2]),
                       static_cast<int>(kAirCubes) + 1);
  Index s{};
  for (s[2] = 0; s[2] < cubes_[2] * kSamples; ++s[2])
    for (s[1] = 0; s[1] < cubes_[1] * kSamples; ++s[1])
      for (s[0] = 0; s[0] < cubes_[0] * kSamples; ++s[0])
        if (region_[sample_index(s)] != kOutside)
          far[cube_index({s[0] / kSamples, s[1] / kSamples, s[2] / kSamples})] = 0;
  for (int pass = 0; pass < static_cast<int>(kAirCubes); ++pass) {
    const std::vector<int> before = far;
    Index c{};
    for (c[2] = 0; c[2] < cubes_[2]; ++c[2])
      for (c[1] = 0; c[1] < cubes_[1]; ++c[1])
        for (c[0] = 0; c[0] < cubes_[0]; ++c[0])
          for (std::size_t a = 0; a < 3; ++a)
            for (const int step : {-1, 1}) {
              Index n = c;
              n[a] += step;
              if (n[a] < 0 || n[a] >= cubes_[a]) continue;
              far[cube_index(c)] = std::min(far[cube_index(c)], before[cube_index(n)] + 1);
            }
  }
  part_.assign(region_.size(), kNone);
  for (s[2] = 0; s[2] < cubes_[2] * kSamples; ++s[2])
    for (s[1] = 0; s[1] < cubes_[1] * kSamples; ++s[1])
      for (s[0] = 0; s[0] < cubes_[0] * kSamples; ++s[0]) {
        const std::size_t i = sample_index(s);
        const bool air = far[cube_index({s[0] / kSamples, s[1] / kSamples, s[2] / kSamples})] >
                         static_cast<int>(kAirCubes);
        if (!in_space_[region_[i]] && !air) part_[i] = 0;
      }
}

/// In each cube, the parts that no wall crosses.
void SidedCage::make_copies() {
  constexpr int kAll = kSamples * kSamples * kSamples;
  constexpr std::array<int, 3> kStep{1, kSamples, kSamples * kSamples};
  first_.assign(1, 0);
  Index c{};
  for (c[2] = 0; c[2] < cubes_[2]; ++c[2])
    for (c[1] = 0; c[1] < cubes_[1]; ++c[1])
      for (c[0] = 0; c[0] < cubes_[0]; ++c[0]) {
        std::array<std::size_t, kAll> at{};
        for (int i = 0; i < kAll; ++i)
          at[static_cast<std::size_t>(i)] = sample_index({c[0] * kSamples + i % kSamples,
                                                          c[1] * kSamples + i / kSamples % kSamples,
                                                          c[2] * kSamples + i / kStep[2]});
        DisjointSets sets(kAll);
        for (int i = 0; i < kAll; ++i)
          for (std::size_t a = 0; a < 3; ++a) {
            if (i / kStep[a] % kSamples == kSamples - 1) continue;
            const std::size_t here = at[static_cast<std::size_t>(i)];
            const std::size_t there = at[static_cast<std::size_t>(i + kStep[a])];
            if (part_[here] == kNone || part_[there] == kNone) continue;
            if ((blocked_[here] >> a) & 1U) continue;
            sets.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + kStep[a]));
          }
        std::array<std::int32_t, kAll> number{};
        std::int32_t n = 0;
        for (int i = 0; i < kAll; ++i) {
          const auto k = static_cast<std::size_t>(i);
          if (part_[at[k]] == kNone) continue;
          const std::uint32_t root = sets.find(static_cast<std::uint32_t>(i));
          if (root == static_cast<std::uint32_t>(i)) {
            number[k] = n++;
            copies_.emplace_back();
            copies_.back().cube = c;
          }
          part_[at[k]] = static_cast<std::uint8_t>(number[root]);
          copies_[static_cast<std::size_t>(first_.back() + number[root])].samples.push_back(
              region_[at[k]]);
        }
        first_.push_back(first_.back() + n);
      }
}

/// Copies whose tissue goes on over the face between them share that face's nodes.
void SidedCage::join_copies() {
  DisjointSets sets(8 * copies_.size());
  Index s{};
  for (std::size_t a = 0; a < 3; ++a)
    for (s[2] = 0; s[2] < cubes_[2] * kSamples; ++s[2])
      for (s[1] = 0; s[1] < cubes_[1] * kSamples; ++s[1])
        for (s[0] = 0; s[0] < cubes_[0] * kSamples; ++s[0]) {
          if (s[a] % kSamples != kSamples - 1 || s[a] + 1 == cubes_[a] * kSamples) continue;
          if ((blocked_[sample_index(s)] >> a) & 1U) continue;
          Index t = s;
          ++t[a];
          const std::int32_t here = copy_of(s);
          const std::int32_t there = copy_of(t);
          if (here < 0 || there < 0) continue;
          const auto link = [&](std::int32_t from, std::size_t face, std::int32_t to) {
            std::int32_t& next = copies_[static_cast<std::size_t>(from)].next[face];
            next = next == kNoCopy || next == to ? to : kSeveral;
          };
          link(here, 2 * a + 1, there);
          link(there, 2 * a, here);
          for (std::uint32_t corner = 0; corner < 8; ++corner) {
            if (!((corner >> a) & 1U)) continue;
            sets.join(8 * static_cast<std::uint32_t>(here) + corner,
                      8 * static_cast<std::uint32_t>(there) + (corner & ~(1U << a)));
          }
        }
  std::vector<std::uint32_t> number(8 * copies_.size());
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    Copy& copy = copies_[i / 8];
    const std::uint32_t root = sets.find(i);
    if (root == i) {
      number[i] = static_cast<std::uint32_t>(nodes_.size());
      const Vec3 corner(copy.cube[0] + static_cast<int>(i & 1U),
                        copy.cube[1] + static_cast<int>((i >> 1U) & 1U),
                        copy.cube[2] + static_cast<int>((i >> 2U) & 1U));
      nodes_.emplace_back(low_ + edge_ * corner);
    }
    copy.nodes[i % 8] = number[root];
  }
}

/// The walls in and around each cube.
void SidedCage::file_walls() {
  walls_near_.resize(first_.size() - 1);
  const double around = kReach * spacing();
  for (std::uint32_t w = 0; w < walls_.size(); ++w) {
    const auto& p = walls_[w].p;
    const Vec3 low = (p[0].cwiseMin(p[1]).cwiseMin(p[2]) - low_).array() - around;
    const Vec3 high = (p[0].cwiseMax(p[1]).cwiseMax(p[2]) - low_).array() + around;
    Index from{};
    Index to{};
    for (int a = 0; a < 3; ++a) {
      const auto k = static_cast<std::size_t>(a);
      from[k] = std::clamp(static_cast<std::int32_t>(std::floor(low[a] / edge_)), 0, cubes_[k] - 1);
      to[k] = std::clamp(static_cast<std::int32_t>(std::floor(high[a] / edge_)), 0, cubes_[k] - 1);
    }
    Index c{};
    for (c[2] = from[2]; c[2] <= to[2]; ++c[2])
      for (c[1] = from[1]; c[1] <= to[1]; ++c[1])
        for (c[0] = from[0]; c[0] <= to[0]; ++c[0]) walls_near_[cube_index(c)].push_back(w);
  }
}

}  // namespace artus
