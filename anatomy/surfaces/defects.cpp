// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/defects.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "artus/detail/anatomy/surfaces/defects_cracks.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

std::string at(const Vec3& p) {
  return printed(" at (%.2f, %.2f, %.2f) mm", p.x() * 1e3, p.y() * 1e3, p.z() * 1e3);
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// Collects the defects of one mesh. Later checks look only at the faces the earlier ones left.
class Finder {
 public:
  Finder(const SurfaceMesh& mesh, const DefectOptions& options)
      : mesh_(mesh), options_(options), is_sound_(mesh.triangles.size(), true) {}

  std::vector<Defect> find() {
    if (mesh_.triangles.empty()) {
      add(DefectKind::empty, {}, Vec3::Zero(),
          "there is no triangle in it; export the surface, not points or lines", 1);
      return std::move(defects_);
    }
    check_vertices();
    check_faces();
    keep_sound();
    check_edges();
    check_cracks();
    check_pieces();
    if (options_.self_intersections) check_intersections();
    check_size();
    std::stable_sort(defects_.begin(), defects_.end(),
                     [](const Defect& a, const Defect& b) { return a.kind < b.kind; });
    return std::move(defects_);
  }

 private:
  void add(DefectKind kind, std::vector<std::size_t> elements, const Vec3& position,
           std::string message, std::size_t count = 0) {
    if (count == 0) count = elements.size();
    if (count > 0)
      defects_.push_back({kind, {}, count, std::move(elements), position, std::move(message)});
  }
  void add_faces(DefectKind kind, const std::vector<std::size_t>& faces, const char* one,
                 const char* many) {
    if (faces.empty()) return;
    const Vec3 p = centre_of(faces.front());
    add(kind, faces, p,
        counted(faces.size(), one, many) + ", the first is face " + std::to_string(faces.front()) +
            (p.allFinite() ? at(p) : ""));
  }
  [[nodiscard]] Vec3 centre_of(std::size_t face) const {
    Vec3 sum = Vec3::Zero();
    for (const auto v : mesh_.triangles[face])
      sum += v < mesh_.vertices.size() ? mesh_.vertices[v] : Vec3::Zero();
    return sum / 3;
  }

  void check_vertices() {
    std::vector<std::size_t> wild;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
      if (!mesh_.vertices[v].allFinite()) wild.push_back(v);
    if (!wild.empty())
      add(DefectKind::non_finite_coordinate, wild, Vec3::Zero(),
          counted(wild.size(), "vertex is", "vertices are") +
              " NaN or infinite, the first is vertex " + std::to_string(wild.front()));
  }

  [[nodiscard]] bool is_degenerate(const Triangle& t) const {
    const Vec3& a = mesh_.vertices[t[0]];
    const Vec3 u = mesh_.vertices[t[1]] - a;
    const Vec3 v = mesh_.vertices[t[2]] - a;
    const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
    return u.cross(v).norm() <= 1e-9 * longest;
  }

  void check_faces() {
    std::vector<std::size_t> outside;
    std::vector<std::size_t> degenerate;
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f) {
      const auto& t = mesh_.triangles[f];
      const bool is_inside =
          std::all_of(t.begin(), t.end(), [&](auto v) { return v < mesh_.vertices.size(); });
      if (!is_inside) {
        outside.push_back(f);
      } else if (std::all_of(t.begin(), t.end(),
                             [&](auto v) { return mesh_.vertices[v].allFinite(); })) {
        if (is_degenerate(t))
          degenerate.push_back(f);
        else
          continue;
      }
      is_sound_[f] = false;
    }
    add_faces(DefectKind::index_out_of_range, outside, "face names a vertex that is not there",
              "faces name vertices that are not there");
    add_faces(DefectKind::degenerate_face, degenerate, "triangle has no area",
              "triangles have no area");
  }

  /// Sound faces become sound_ (all vertices kept, so indices stay), duplicates by vertices go.
  void keep_sound() {
    sound_.vertices = mesh_.vertices;
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f) {
      if (!is_sound_[f]) continue;
      sound_.triangles.push_back(mesh_.triangles[f]);
      original_.push_back(f);
    }
    const auto pillows = pillow_faces();
    std::map<Triangle, std::size_t> seen;
    std::vector<std::size_t> twice;
    std::vector<bool> keep(sound_.triangles.size(), true);
    for (std::size_t i = 0; i < sound_.triangles.size(); ++i) {
      Triangle key = sound_.triangles[i];
      std::sort(key.begin(), key.end());
      if (pillows[i])
        keep[i] = false;
      else if (!seen.emplace(key, i).second) {
        keep[i] = false;
        twice.push_back(original_[i]);
      }
    }
    add_faces(DefectKind::duplicate_face, twice, "triangle is a duplicate",
              "triangles are duplicates");
    std::size_t n = 0;
    for (std::size_t i = 0; i < keep.size(); ++i) {
      if (!keep[i]) continue;
      sound_.triangles[n] = sound_.triangles[i];
      original_[n++] = original_[i];
    }
    sound_.triangles.resize(n);
    original_.resize(n);
    uses_ = make_edge_uses(sound_);
  }

  /// Marks the faces of pieces that enclose nothing and reports them.
  std::vector<bool> pillow_faces() {
    const auto uses = make_edge_uses(sound_);
    const auto pieces = find_pieces(sound_, uses);
    const auto measures = measure_pieces(sound_, uses, pieces);
    std::vector<bool> is_pillow(sound_.triangles.size(), false);
    std::vector<std::size_t> faces;
    std::size_t n_pillows = 0;
    for (const auto& m : measures) n_pillows += m.is_pillow() ? 1U : 0U;
    for (std::size_t i = 0; i < is_pillow.size(); ++i) {
      if (!measures[pieces.of_face[i]].is_pillow()) continue;
      is_pillow[i] = true;
      faces.push_back(original_[i]);
    }
    if (!faces.empty())
      add(DefectKind::pillow_component, faces, centre_of(faces.front()),
          counted(n_pillows, "closed piece encloses", "closed pieces enclose") +
              " nothing (faces back to back), the first" + at(centre_of(faces.front())),
          n_pillows);
    return is_pillow;
  }

  void check_edges() {
    std::vector<std::size_t> open;
    std::vector<std::size_t> crowded;
    std::vector<std::size_t> against;
    for_each_edge(uses_, [&](const EdgeUse* first, const EdgeUse* last) {
      const std::size_t face = original_[first->face];
      if (last - first == 1) open.push_back(face);
      if (last - first > 2) crowded.push_back(face);
      if (last - first == 2 && first->is_forward == (first + 1)->is_forward)
        against.push_back(face);
    });
    if (!open.empty()) {
      const auto n = find_rims(sound_, uses_).size();
      add(DefectKind::open_edge, open, centre_of(open.front()),
          counted(open.size(), "edge is", "edges are") + " open, around " +
              counted(n, "hole", "holes") + ", the first" + at(centre_of(open.front())));
    }
    add_faces(DefectKind::non_manifold_edge, crowded, "edge has more than two faces",
              "edges have more than two faces");
    add_faces(DefectKind::inconsistent_orientation, against,
              "edge joins faces of opposite orientation",
              "edges join faces of opposite orientation");
    const auto pinched = find_pinches(sound_, uses_);
    if (!pinched.empty())
      add(DefectKind::non_manifold_vertex, {pinched.begin(), pinched.end()},
          sound_.vertices[pinched.front()],
          counted(pinched.size(), "vertex joins", "vertices join") +
              " parts that touch only there, the first is vertex " +
              std::to_string(pinched.front()) + at(sound_.vertices[pinched.front()]));
  }

  void check_cracks() {
    const auto pairs = find_crack_pairs(sound_, uses_, options_.crack_width);
    std::vector<std::size_t> vertices;
    vertices.reserve(pairs.size());
    for (const auto& pair : pairs) vertices.push_back(pair.b);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    if (vertices.empty()) return;
    const Vec3& p = sound_.vertices[vertices.front()];
    add(DefectKind::unwelded_vertex, vertices, p,
        counted(vertices.size(), "vertex", "vertices") +
            " on open edges lie on or beside another one: a crack, the first is vertex " +
            std::to_string(vertices.front()) + at(p));
  }

  /// Pieces that repair sews to others or drops, whatever shape they have: most of their rim lies
  /// along a crack, or they are shreds.
  std::vector<bool> find_patches(const Pieces& pieces, const std::vector<PieceMeasure>& measures) {
    constexpr double kShred = 1e-3;  // of the whole area, as drop_fragments has it
    std::vector<bool> in_crack(sound_.vertices.size(), false);
    for (const auto& pair : find_crack_pairs(sound_, uses_, options_.crack_width))
      in_crack[pair.a] = in_crack[pair.b] = true;
    std::vector<std::size_t> n_rim(pieces.n, 0);
    std::vector<std::size_t> n_crack(pieces.n, 0);
    for_each_edge(uses_, [&](const EdgeUse* first, const EdgeUse* last) {
      if (last - first != 1) return;
      const auto piece = pieces.of_face[first->face];
      ++n_rim[piece];
      if (in_crack[first->lo] && in_crack[first->hi]) ++n_crack[piece];
    });
    const double area = surface_area(sound_);
    std::vector<bool> is_patch(pieces.n);
    for (std::size_t p = 0; p < is_patch.size(); ++p)
      is_patch[p] = 2 * n_crack[p] > n_rim[p] || measures[p].area < kShred * area;
    return is_patch;
  }

  void check_pieces() {
    const auto pieces = find_pieces(sound_, uses_);
    const auto measures = measure_pieces(sound_, uses_, pieces);
    if (pieces.n > 1)
      add(DefectKind::several_components, {}, Vec3::Zero(),
          std::to_string(pieces.n) + " separate pieces", pieces.n);
    const auto depth = nesting_depth(sound_, pieces);
    std::vector<std::size_t> inward;
    std::vector<std::size_t> sheets;
    const auto is_patch = find_patches(pieces, measures);
    std::vector<bool> told(pieces.n, false);
    for (std::size_t i = 0; i < sound_.triangles.size(); ++i) {
      const auto piece = pieces.of_face[i];
      if (told[piece]) continue;
      told[piece] = true;
      const auto& m = measures[piece];
      const bool is_cavity = depth[piece] % 2 == 1;
      if (m.is_sheet() && is_patch[piece]) continue;
      if (m.is_sheet())
        sheets.push_back(original_[i]);
      else if (m.is_consistent && (m.signed_volume < 0) != is_cavity)
        inward.push_back(original_[i]);
    }
    add_faces(DefectKind::inward_winding, inward, "piece is oriented inward",
              "pieces are oriented inward");
    add_faces(DefectKind::zero_thickness_sheet, sheets, "piece is a sheet without thickness",
              "pieces are sheets without thickness");
  }

  void check_intersections() {
    const auto pairs = find_self_intersections(sound_);
    if (pairs.empty()) return;
    std::vector<std::size_t> faces;
    for (const auto& [a, b] : pairs) {
      faces.push_back(original_[a]);
      faces.push_back(original_[b]);
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    add(DefectKind::self_intersection, faces, centre_of(faces.front()),
        counted(pairs.size(), "pair", "pairs") + " of faces cut through each other (" +
            std::to_string(faces.size()) + " faces), the first is face " +
            std::to_string(faces.front()) + at(centre_of(faces.front())),
        pairs.size());
  }

  void check_size() {
    Eigen::AlignedBox3d box;
    for (const auto& t : sound_.triangles)
      for (const auto v : t) box.extend(sound_.vertices[v]);
    if (box.isEmpty()) return;
    const double size = box.diagonal().norm();
    const double far = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
    if (far > options_.farthest) {
      add(DefectKind::implausible_size, {}, box.center(),
          printed("coordinates up to %.4g mm are too far from the origin "
                  "for any frame of a body; is it in another unit or frame?",
                  far / kMillimetre),
          1);
      return;
    }
    if (size >= options_.smallest && size <= options_.largest) return;
    add(DefectKind::implausible_size, {}, box.center(),
        printed("%.4g mm from corner to corner is not the size of a part of "
                "a body; is the unit of the file wrong (mm, cm, m)?",
                size / kMillimetre),
        1);
  }

  const SurfaceMesh& mesh_;
  const DefectOptions& options_;
  std::vector<bool> is_sound_;
  SurfaceMesh sound_;
  std::vector<std::size_t> original_;
  std::vector<EdgeUse> uses_;
  std::vector<Defect> defects_;
};

}  // namespace

std::vector<Defect> find_defects(const SurfaceMesh& mesh, const DefectOptions& options) {
  return Finder(mesh, options).find();
}

const char* to_string(DefectKind kind) noexcept {
  constexpr std::array<const char*, 21> kNames{"empty",
                                               "index_out_of_range",
                                               "non_finite_coordinate",
                                               "degenerate_face",
                                               "duplicate_face",
                                               "unwelded_vertex",
                                               "open_edge",
                                               "non_manifold_edge",
                                               "non_manifold_vertex",
                                               "inconsistent_orientation",
                                               "inward_winding",
                                               "self_intersection",
                                               "several_components",
                                               "pillow_component",
                                               "zero_thickness_sheet",
                                               "implausible_size",
                                               "unreadable_file",
                                               "unknown_tissue",
                                               "crossing_layers",
                                               "size_outlier",
                                               "place_outlier"};
  static_assert(kNames.size() == static_cast<std::size_t>(kLastDefect) + 1);
  return kNames[static_cast<std::size_t>(kind)];
}

DefectSeverity severity_of(DefectKind kind) noexcept {
  switch (kind) {
    case DefectKind::several_components:
    case DefectKind::self_intersection:
    case DefectKind::crossing_layers:
      return DefectSeverity::note;
    case DefectKind::zero_thickness_sheet:
    case DefectKind::size_outlier:
    case DefectKind::place_outlier:
      return DefectSeverity::doubtful;
    case DefectKind::empty:
    case DefectKind::implausible_size:
    case DefectKind::unreadable_file:
    case DefectKind::unknown_tissue:
      return DefectSeverity::fatal;
    default:
      return DefectSeverity::repairable;
  }
}

const char* to_string(DefectSeverity severity) noexcept {
  switch (severity) {
    case DefectSeverity::note:
      return "note";
    case DefectSeverity::repairable:
      return "repairable";
    case DefectSeverity::doubtful:
      return "doubtful";
    case DefectSeverity::fatal:
      return "fatal";
  }
  return "fatal";
}

}  // namespace artus
