// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/mesh/compile_measure.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>

#include <tbb/parallel_for.h>

#include "artus/detail/anatomy/compile/labels/compile_labels.h"
#include "artus/detail/anatomy/compile/mesh/tet_topology.h"
#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr double kFar = 0.1;  // m, no distance of an interface is larger

double smooth_inside(double distance, double width) {
  return std::clamp(0.5 - distance / width, 0.0, 1.0);
}

// The field's distance, infinite where the field only tells the side: its band may be narrower than
// the smoothed edge of another one.
double known_distance(const DistanceField& field, const Vec3& p) {
  constexpr double kRounding = 0.999;  // samples are kept in single precision
  const double d = field.value(p);
  return std::abs(d) < kRounding * field.band()
             ? d
             : std::copysign(std::numeric_limits<double>::infinity(), d);
}

// The share of a sample at `outside` of a layer (below 0: inside) that one at `other` of what comes
// before it leaves. The smoothed edge is that of the nearest boundary: where two touch (a shell and
// the skin it lines), a product of both would lose a sixth of a sample's width. Where two surfaces
// run the same way, one beside the other, what is between them is left, so nothing where they
// coincide: the nearest boundary alone would leave a quarter of a sample's width.
double share_left(double outside, double other, double width) {
  if (std::abs(outside - other) < std::abs(outside + other))
    return std::max(0.0, smooth_inside(outside, width) - smooth_inside(other, width));
  return smooth_inside(std::max(outside, -other), width);
}

// Volumes a layer has inside body and region of interest, and what higher layers leave of it.
void integrate_layer(const RegionLabels& labels, std::size_t layer, StructureReport& report) {
  const DistanceField& field = labels.layers[layer].field;
  const double h = field.spacing();
  const auto weights_in = [&](const Box& box) -> DistanceField::Weights {
    std::vector<const DistanceField*> before;
    for (std::size_t i = 0; i < layer; ++i)
      if (labels.layers[i].field.side_of(box) <= 0) before.push_back(&labels.layers[i].field);
    return [&labels, h, before = std::move(before)](const Vec3& p, double own) {
      double outside = std::max(own, known_distance(labels.body, p));
      if (labels.region_of_interest)
        outside = std::max(outside, signed_distance(*labels.region_of_interest, p));
      const double in_region = smooth_inside(outside, h);
      double taken = std::numeric_limits<double>::infinity();
      for (const DistanceField* other : before) taken = std::min(taken, known_distance(*other, p));
      return std::array<double, 2>{in_region, share_left(outside, taken, h)};
    };
  };
  const auto [in_region, rest] = field.integrate_blocks(weights_in);
  report.region_volume = in_region;
  report.lost_volume = in_region - rest;
}

// What a layer takes of another one, in whole numbers: the same whatever thread comes first.
struct Taken {
  std::atomic<std::int64_t> cells = 0;
  std::array<std::atomic<std::int64_t>, 3> sum{};  // of their middles, nm

  void add(const Vec3& p) {
    constexpr double kNanometre = 1e-9;  // m
    ++cells;
    for (std::size_t a = 0; a < 3; ++a)
      sum[a] += std::llround(p[static_cast<Eigen::Index>(a)] / kNanometre);
  }
  [[nodiscard]] Vec3 centre() const {
    return 1e-9 *
           Vec3(static_cast<double>(sum[0]), static_cast<double>(sum[1]),
                static_cast<double>(sum[2])) /
           static_cast<double>(cells);
  }
};

// Which earlier layer takes most of a layer, when all together take much.
void find_taker(const RegionLabels& labels, std::size_t layer, CompileReport& report) {
  StructureReport& mine = report.structures[labels.layers[layer].region - kFirstRegion];
  const bool is_told = mine.lost_volume > kMuchLost * mine.region_volume ||
                       (mine.is_hard && mine.lost_volume > kBoneLost);
  if (!is_told) return;
  const RegionId own_region = labels.layers[layer].region;
  std::vector<Taken> taken(kFirstRegion + report.structures.size());
  const DistanceField::Weights tally = [&](const Vec3& p, double own) {
    const RegionId region = own < 0 ? labels.at(p) : own_region;
    if (region > kFirstRegion && region != own_region) taken[region].add(p);
    return std::array<double, 2>{0, 0};
  };
  static_cast<void>(labels.layers[layer].field.integrate_blocks([&](const Box&) { return tally; }));
  const auto most = std::max_element(
      taken.begin(), taken.end(), [](const Taken& a, const Taken& b) { return a.cells < b.cells; });
  if (most->cells == 0) return;
  mine.lost_to =
      report.structures[static_cast<std::size_t>(most - taken.begin()) - kFirstRegion].name;
  mine.lost_at = most->centre();
}

// Exact distances of points one beside the other: none is farther than the one before by more than
// the way between them, which makes the search short.
class NearbyDistances {
 public:
  explicit NearbyDistances(const DistanceTree& tree) : tree_(&tree) {}
  double operator()(const Vec3& p) {
    constexpr double kRounding = 1e-9;  // m
    const double bound = std::min(kFar, distance_ + (p - last_).norm() + kRounding);
    distance_ = tree_->distance(p, bound);
    if (!(distance_ < bound)) distance_ = tree_->distance(p, kFar);
    last_ = p;
    return distance_;
  }

 private:
  const DistanceTree* tree_;
  Vec3 last_ = Vec3::Zero();
  double distance_ = kFar;  // of the last
};

// Exact distances of four points of a triangle.
std::array<DistanceSample, 4> measure(const TetMesh& mesh, const Interface& f,
                                      const DistanceTree& tree) {
  constexpr std::array<std::array<double, 3>, 4> kPoints{
      {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.6, 0.2, 0.2}, {0.2, 0.6, 0.2}, {0.2, 0.2, 0.6}}};
  const Vec3& a = mesh.vertices[f.vertices[0]];
  const Vec3& b = mesh.vertices[f.vertices[1]];
  const Vec3& c = mesh.vertices[f.vertices[2]];
  const double area = (b - a).cross(c - a).norm() / 2;
  std::array<DistanceSample, 4> samples{};
  NearbyDistances distance(tree);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& w = kPoints[i];
    samples[i] = {distance(w[0] * a + w[1] * b + w[2] * c), area / 4};
  }
  return samples;
}

// The surface an interface lies on: index of the structure whose field separates its regions, or
// none for constructs, the body and the region of interest.
class ShapedBy {
 public:
  ShapedBy(const RegionLabels& labels, const PreparedSurfaces& surfaces) : surfaces_(surfaces) {
    for (const auto& layer : labels.layers) {
      rank_.resize(std::max<std::size_t>(rank_.size(), layer.region + std::size_t{1}), kLast);
      rank_[layer.region] = static_cast<std::size_t>(&layer - labels.layers.data());
    }
  }
  [[nodiscard]] const DistanceTree* operator()(const Interface& f, std::size_t& structure) const {
    if (f.front < kFirstRegion) return nullptr;
    const RegionId first = rank(f.front) < rank(f.back) ? f.front : f.back;
    if (first <= kFirstRegion) return nullptr;
    structure = first - region_of_structure(0);
    const auto& surface = surfaces_.structures[structure];
    return surface ? &surface->tree : nullptr;
  }

 private:
  static constexpr std::size_t kLast = std::numeric_limits<std::size_t>::max();
  [[nodiscard]] std::size_t rank(RegionId r) const { return r < rank_.size() ? rank_[r] : kLast; }
  const PreparedSurfaces& surfaces_;
  std::vector<std::size_t> rank_;
};

using SamplesOf = std::vector<std::vector<DistanceSample>>;  // (n_structures)

// From the interfaces to the surfaces that shape them.
SamplesOf measure_interfaces(const TetMesh& mesh, const RegionLabels& labels,
                             const PreparedSurfaces& surfaces) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  const ShapedBy shaped_by(labels, surfaces);
  std::vector<std::array<DistanceSample, 4>> measured(mesh.interfaces.size());
  std::vector<std::size_t> owner(mesh.interfaces.size(), kNone);
  tbb::parallel_for(std::size_t{0}, mesh.interfaces.size(), [&](std::size_t i) {
    std::size_t structure = 0;
    const DistanceTree* tree = shaped_by(mesh.interfaces[i], structure);
    if (tree == nullptr) return;
    owner[i] = structure;
    measured[i] = measure(mesh, mesh.interfaces[i], *tree);
  });
  SamplesOf samples(surfaces.structures.size());
  for (std::size_t i = 0; i < owner.size(); ++i)
    if (owner[i] != kNone)
      samples[owner[i]].insert(samples[owner[i]].end(), measured[i].begin(), measured[i].end());
  return samples;
}

// Whether a point of a layer's surface is where its region ends: in the body and the region of
// interest, and clear of all that comes before it.
bool is_exposed(const RegionLabels& labels, std::size_t layer, const Vec3& p) {
  const double clear = labels.layers[layer].field.spacing();
  if (labels.body.value(p) > -clear) return false;
  if (labels.region_of_interest && signed_distance(*labels.region_of_interest, p) > -clear)
    return false;
  for (std::size_t i = 0; i < layer; ++i) {
    const DistanceField& other = labels.layers[i].field;
    if (other.value(p) < std::min(clear, 0.5 * other.band())) return false;
  }
  return true;
}

SurfaceMesh interfaces_of(const TetMesh& mesh, RegionId region) {
  SurfaceMesh surface;
  surface.vertices = mesh.vertices;
  for (const Interface& f : mesh.interfaces)
    if (f.front == region || f.back == region)
      surface.triangles.push_back({f.vertices[0], f.vertices[1], f.vertices[2]});
  return surface;
}

// From the surfaces, where they should show, to the interfaces of their regions.
SamplesOf measure_surfaces(const TetMesh& mesh, const RegionLabels& labels,
                           const PreparedSurfaces& surfaces) {
  constexpr double kSpacings = 3;  // of the field's, between samples
  SamplesOf measured(surfaces.structures.size());
  tbb::parallel_for(std::size_t{0}, labels.layers.size(), [&](std::size_t layer) {
    const RegionId region = labels.layers[layer].region;
    const std::size_t structure = region - region_of_structure(0);
    const auto& surface = surfaces.structures[structure];
    if (!surface) return;
    const DistanceTree tree(interfaces_of(mesh, region));
    if (tree.empty()) return;
    const double spacing = kSpacings * labels.layers[layer].field.spacing();
    std::vector<SurfaceSample> samples;
    NearbyDistances distance(tree);
    for (const Triangle& t : surface->mesh.triangles) {
      samples.clear();
      const auto& v = surface->mesh.vertices;
      append_samples({v[t[0]], v[t[1]], v[t[2]]}, spacing, samples);
      const Vec3 across = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
      const double length = across.norm();
      if (!(length > 0)) continue;
      const Vec3 inward = -labels.layers[layer].field.spacing() / 2 / length * across;
      for (const SurfaceSample& s : samples)
        if (is_exposed(labels, layer, s.position) && labels.at(s.position + inward) == region)
          measured[structure].push_back({distance(s.position), s.area});
    }
  });
  return measured;
}

DistanceStatistics compute_all(const SamplesOf& samples) {
  std::vector<DistanceSample> all;
  for (const auto& some : samples) all.insert(all.end(), some.begin(), some.end());
  return compute_statistics(std::move(all));
}

}  // namespace

void measure_labels(const RegionLabels& labels, CompileReport& report) {
  for (std::size_t layer = 0; layer < labels.layers.size(); ++layer) {
    integrate_layer(labels, layer, report.structures[labels.layers[layer].region - kFirstRegion]);
    find_taker(labels, layer, report);
  }
}

void measure_distances(const TetMesh& mesh, const RegionLabels& labels,
                       const PreparedSurfaces& surfaces, CompileReport& report) {
  const SamplesOf there = measure_interfaces(mesh, labels, surfaces);
  const SamplesOf back = measure_surfaces(mesh, labels, surfaces);
  for (std::size_t i = 0; i < there.size(); ++i)
    report.structures[i + 1].distance =
        worse_of(compute_statistics(there[i]), compute_statistics(back[i]));
  report.distance = worse_of(compute_all(there), compute_all(back));
}

void measure_mesh(const TetMesh& mesh, const TetNeighbours& neighbours, CompileReport& report) {
  const std::size_t n_regions = kFirstRegion + report.structures.size();
  const std::vector<double> volumes = region_volumes(mesh, n_regions);
  for (std::size_t i = 0; i < report.structures.size(); ++i) {
    report.structures[i].resolved_volume = volumes[kFirstRegion + i];
  }
  for (const RegionId r : mesh.regions) ++report.structures[r - kFirstRegion].tetrahedra;
  for (const RegionId r : find_tet_parts(mesh, neighbours).region)
    ++report.structures[r - kFirstRegion].parts;
  report.quality = compute_quality(mesh);
  report.vertices = mesh.vertices.size();
  report.tetrahedra = mesh.tetrahedra.size();
  report.interfaces = mesh.interfaces.size();
}

void measure_joint(const TetMesh& mesh, const RegionLabels& labels,
                   const PreparedSurfaces& surfaces, CompileReport& report) {
  measure_labels(labels, report);
  measure_distances(mesh, labels, surfaces, report);
  const auto neighbours = find_tet_neighbours(mesh);
  ARTUS_REQUIRE(neighbours.has_value(), "the mesh has a face of more than two tetrahedra");
  measure_mesh(mesh, *neighbours, report);
}

}  // namespace artus
