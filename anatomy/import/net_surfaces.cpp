// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>

#include <tbb/parallel_for.h>

#include "artus/detail/anatomy/import/surface_nets.h"
#include "artus/detail/core/disjoint_sets.h"

namespace artus {
namespace {

/// A side of a face: its two vertices in order, and where it is.
struct Side {
  std::uint64_t key = 0;
  std::uint32_t face = 0;
  std::uint8_t corner = 0;
  bool operator<(const Side& o) const { return std::tie(key, face) < std::tie(o.key, o.face); }
};

/// What a surface encloses: one label, or with kAnyLabel all that has one.
constexpr std::uint16_t kAnyLabel = 0;

/// The faces around one label, in the order of the net.
class LabelFaces {
 public:
  LabelFaces(const SurfaceNet& net, std::span<const Vec3> places,
             std::span<const std::uint32_t> faces, std::uint16_t label, bool mirrored)
      : net_(net), places_(places), faces_(faces), label_(label), mirrored_(mirrored) {}

  LabelSurface run() {
    DisjointSets sets(4 * faces_.size());
    join_sides(sets);
    std::vector<std::uint32_t> vertex(4 * faces_.size(), kNoVertex);
    LabelSurface& out = out_;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      const NetFace& face = net_.faces[faces_[f]];
      for (std::uint32_t k = 0; k < 4; ++k) {
        std::uint32_t& v = vertex[sets.find(4 * f + k)];
        if (v == kNoVertex) {
          v = static_cast<std::uint32_t>(out.mesh.vertices.size());
          out.mesh.vertices.push_back(places_[face.vertices[k]]);
        }
      }
      const bool turn = is_below(face) == mirrored_;
      for (const auto& t : triangles_of(face, places_)) {
        Triangle triangle{};
        for (std::size_t k = 0; k < 3; ++k) triangle[k] = vertex[sets.find(4 * f + t[k])];
        if (turn) std::swap(triangle[1], triangle[2]);
        out.mesh.triangles.push_back(triangle);
        out.is_cut.push_back(face.cut ? 1 : 0);
      }
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] bool is_below(const NetFace& face) const {
    return label_ == kAnyLabel ? face.below != 0 : face.below == label_;
  }
  /// The voxel of the label that a face bounds.
  [[nodiscard]] std::uint32_t solid_of(const NetFace& face) const {
    if (is_below(face)) return face.voxel;
    const auto nx = static_cast<std::uint32_t>(net_.size[0] + 2);
    const auto ny = static_cast<std::uint32_t>(net_.size[1] + 2);
    const std::array<std::uint32_t, 3> step{1, nx, nx * ny};
    return face.voxel + step.at(face.axis);
  }

  /// Corners that meet at sides become one. Four faces at a side belong in pairs to two voxels.
  void join_sides(DisjointSets& sets) {
    std::vector<Side> sides;
    sides.reserve(4 * faces_.size());
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      const auto& v = net_.faces[faces_[f]].vertices;
      for (std::uint8_t k = 0; k < 4; ++k) {
        const auto a = v.at(k);
        const auto b = v.at((k + 1U) % 4);
        sides.push_back({std::uint64_t{std::min(a, b)} << 32U | std::max(a, b), f, k});
      }
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size();) {
      std::size_t j = i;
      while (j < sides.size() && sides[j].key == sides[i].key) ++j;
      if (j - i > 2) ++out_.n_split;
      for (std::size_t a = i; a < j; ++a)
        for (std::size_t b = a + 1; b < j; ++b)
          if (j - i == 2 || solid_of(net_.faces[faces_[sides[a].face]]) ==
                                solid_of(net_.faces[faces_[sides[b].face]]))
            join(sides[a], sides[b], sets);
      i = j;
    }
  }

  void join(const Side& a, const Side& b, DisjointSets& sets) const {
    const auto& v = net_.faces[faces_[a.face]].vertices;
    const auto& w = net_.faces[faces_[b.face]].vertices;
    for (std::uint32_t i = 0; i < 2; ++i)
      for (std::uint32_t k = 0; k < 2; ++k) {
        const std::uint32_t m = (a.corner + i) % 4;
        const std::uint32_t n = (b.corner + k) % 4;
        if (v.at(m) == w.at(n)) sets.join(4 * a.face + m, 4 * b.face + n);
      }
  }

  const SurfaceNet& net_;
  std::span<const Vec3> places_;
  std::span<const std::uint32_t> faces_;
  std::uint16_t label_;
  bool mirrored_;
  LabelSurface out_;
};

}  // namespace

std::vector<LabelSurface> make_label_surfaces(const SurfaceNet& net, std::size_t n_labels,
                                              const IndexFrame& X_LI) {
  const auto places = places_of(net, X_LI);
  std::vector<std::vector<std::uint32_t>> faces(n_labels + 1);
  for (std::uint32_t f = 0; f < net.faces.size(); ++f) {
    for (const std::size_t label : {net.faces[f].below, net.faces[f].above})
      if (label != 0 && label <= n_labels) faces[label].push_back(f);
  }
  const bool mirrored = X_LI.linear().determinant() < 0;
  std::vector<LabelSurface> surfaces(n_labels);
  tbb::parallel_for(std::size_t{0}, n_labels, [&](std::size_t i) {
    surfaces[i] =
        LabelFaces(net, places, faces[i + 1], static_cast<std::uint16_t>(i + 1), mirrored).run();
  });
  return surfaces;
}

LabelSurface make_outer_surface(const SurfaceNet& net, const IndexFrame& X_LI) {
  const auto places = places_of(net, X_LI);
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < net.faces.size(); ++f)
    if (net.faces[f].below == 0 || net.faces[f].above == 0) faces.push_back(f);
  return LabelFaces(net, places, faces, kAnyLabel, X_LI.linear().determinant() < 0).run();
}

}  // namespace artus
