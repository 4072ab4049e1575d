// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/compile/compile_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "artus/anatomy/compile/compile_labels.h"
#include "artus/anatomy/compile/tet_topology.h"

namespace artus {
namespace {

struct Sample {
  double distance;
  double area;
};

double smooth_inside(double distance, double width) {
  return std::clamp(0.5 - distance / width, 0.0, 1.0);
}

DistanceStatistics statistics(std::vector<Sample> samples) {
  DistanceStatistics s;
  if (samples.empty()) return s;
  std::sort(samples.begin(), samples.end(),
            [](const Sample& a, const Sample& b) { return a.distance < b.distance; });
  double area = 0;
  for (const Sample& x : samples) {
    area += x.area;
    s.mean += x.area * x.distance;
  }
  s.mean /= area;
  s.max = samples.back().distance;
  double sum = 0;
  for (const Sample& x : samples) {
    sum += x.area;
    s.percentile95 = x.distance;
    if (sum >= 0.95 * area) break;
  }
  return s;
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

// Volumes a layer has inside body and region of interest, and what higher layers leave of it. The
// smoothed edge is that of the nearest boundary: where two coincide (a shell and the skin it
// lines), a product of both would lose a sixth of a sample's width.
void integrate_layer(const RegionLabels& labels, std::size_t layer, StructureReport& report) {
  const DistanceField& field = labels.layers[layer].field;
  const double h = field.spacing();
  const auto outside_region = [&](const Vec3& p) {
    const double body = known_distance(labels.body, p);
    if (!labels.region_of_interest) return body;
    return std::max(body, signed_distance(*labels.region_of_interest, p));
  };
  const auto outside_rest = [&](const Vec3& p) {
    double outside = outside_region(p);
    for (std::size_t i = 0; i < layer; ++i)
      outside = std::max(outside, -known_distance(labels.layers[i].field, p));
    return outside;
  };
  const auto volume = [&](const auto& outside) {
    return field.integrate([&](const Vec3& p) {
      const double own = field.value(p);
      return smooth_inside(std::max(own, outside(p)), h) / smooth_inside(own, h);
    });
  };
  report.region_volume = volume(outside_region);
  report.lost_volume = report.region_volume - volume(outside_rest);
}

// Exact distances of four points of a triangle.
std::array<Sample, 4> measure(const TetMesh& mesh, const Interface& f, const DistanceTree& tree) {
  constexpr std::array<std::array<double, 3>, 4> kPoints{
      {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.6, 0.2, 0.2}, {0.2, 0.6, 0.2}, {0.2, 0.2, 0.6}}};
  constexpr double kFar = 0.1;  // m
  const Vec3& a = mesh.vertices[f.vertices[0]];
  const Vec3& b = mesh.vertices[f.vertices[1]];
  const Vec3& c = mesh.vertices[f.vertices[2]];
  const double area = (b - a).cross(c - a).norm() / 2;
  std::array<Sample, 4> samples{};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& w = kPoints[i];
    samples[i] = {tree.distance(w[0] * a + w[1] * b + w[2] * c, kFar), area / 4};
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

void measure_distances(const TetMesh& mesh, const RegionLabels& labels,
                       const PreparedSurfaces& surfaces, CompileReport& report) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  const ShapedBy shaped_by(labels, surfaces);
  std::vector<std::array<Sample, 4>> measured(mesh.interfaces.size());
  std::vector<std::size_t> owner(mesh.interfaces.size(), kNone);
  tbb::parallel_for(std::size_t{0}, mesh.interfaces.size(), [&](std::size_t i) {
    std::size_t structure = 0;
    const DistanceTree* tree = shaped_by(mesh.interfaces[i], structure);
    if (tree == nullptr) return;
    owner[i] = structure;
    measured[i] = measure(mesh, mesh.interfaces[i], *tree);
  });
  std::vector<std::vector<Sample>> by_structure(surfaces.structures.size());
  std::vector<Sample> all;
  for (std::size_t i = 0; i < owner.size(); ++i) {
    if (owner[i] == kNone) continue;
    auto& mine = by_structure[owner[i]];
    mine.insert(mine.end(), measured[i].begin(), measured[i].end());
    all.insert(all.end(), measured[i].begin(), measured[i].end());
  }
  for (std::size_t i = 0; i < by_structure.size(); ++i) {
    report.structures[i + 1].distance = statistics(std::move(by_structure[i]));
  }
  report.distance = statistics(std::move(all));
}

}  // namespace

void measure_joint(const TetMesh& mesh, const RegionLabels& labels,
                   const PreparedSurfaces& surfaces, CompileReport& report) {
  const std::size_t n_regions = kFirstRegion + report.structures.size();
  const std::vector<double> volumes = region_volumes(mesh, n_regions);
  for (std::size_t i = 0; i < report.structures.size(); ++i) {
    report.structures[i].resolved_volume = volumes[kFirstRegion + i];
  }
  for (const RegionId r : mesh.regions) ++report.structures[r - kFirstRegion].tetrahedra;
  if (const auto neighbours = find_tet_neighbours(mesh)) {
    for (const RegionId r : find_tet_parts(mesh, *neighbours).region) {
      ++report.structures[r - kFirstRegion].parts;
    }
  }
  for (std::size_t layer = 0; layer < labels.layers.size(); ++layer) {
    integrate_layer(labels, layer, report.structures[labels.layers[layer].region - kFirstRegion]);
  }
  measure_distances(mesh, labels, surfaces, report);
  report.quality = compute_quality(mesh);
  report.vertices = mesh.vertices.size();
  report.tetrahedra = mesh.tetrahedra.size();
  report.interfaces = mesh.interfaces.size();
}

}  // namespace artus
