// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/surfaces/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "artus/anatomy/surfaces/defects.h"
#include "artus/anatomy/surfaces/defects_cracks.h"
#include "artus/anatomy/surfaces/repair_steps.h"
#include "artus/anatomy/surfaces/surface_topology.h"
#include "artus/core/units.h"

namespace artus {
namespace {

constexpr double kSquareCentimetre = 1e-4;  // m^2
/// CGAL's untangling takes time that grows fast with these; above them only cutting out is tried.
constexpr std::size_t kFewTangledPairs = 30;
/// Above these the intersections stay: so many are no accident of a file but how it was modelled.
constexpr std::size_t kMostTangledPairs = 500;
constexpr std::size_t kMostUntangledFaces = 60'000;

std::string with_number(const char* format, double value) {
  std::array<char, 160> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), format, value));
  return text.data();
}

std::string plural(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// Volume with the openings closed by fans.
double fanned_volume(const SurfaceMesh& mesh) {
  const auto uses = make_edge_uses(mesh);
  double volume = 0;
  for (const auto& m : measure_pieces(mesh, uses, find_pieces(mesh, uses)))
    volume += m.signed_volume;
  return volume;
}

/// Does the repair step by step and writes down what it did.
class Repair {
 public:
  Repair(const SurfaceMesh& mesh, const RepairOptions& options)
      : options_(options), original_(mesh) {
    outcome_.mesh = mesh;
  }

  Result<RepairOutcome> run() {
    if (mesh().triangles.size() > options_.most_triangles)
      return fail(ErrorCode::defective, std::to_string(mesh().triangles.size()) +
                                            " triangles are more than artus repairs (" +
                                            std::to_string(options_.most_triangles) +
                                            "); decimate the surface first");
    drop();
    if (mesh().triangles.empty())
      return fail(ErrorCode::defective, "no triangle is left when the bad ones are dropped");
    outcome_.volume_before = fanned_volume(mesh());
    if (auto ok = close(); !ok) return tl::unexpected(ok.error());
    if (options_.wrap == WrapPolicy::always)
      if (auto ok = wrap(); !ok) return tl::unexpected(ok.error());
    note(RepairKind::turned_pieces, turn_pieces(mesh()), 0,
         {"was wound inward and is turned", "were wound inward and are turned", "piece", "pieces"});
    untangle_faces();
    return finish();
  }

 private:
  SurfaceMesh& mesh() { return outcome_.mesh; }

  /// What happened to one, and to several, and what these are.
  struct Words {
    std::string did_one;
    std::string did_many;
    const char* one;
    const char* many;
  };

  void note(RepairKind kind, std::size_t count, double amount, const Words& words) {
    if (count == 0) return;
    outcome_.actions.push_back({kind, count, amount,
                                plural(count, words.one, words.many) + " " +
                                    (count == 1 ? words.did_one : words.did_many)});
  }

  void drop() {
    note(
        RepairKind::dropped_pillows, drop_safe_pillows(), 0,
        {"enclosed nothing and is dropped", "enclosed nothing and are dropped", "piece", "pieces"});
    note(RepairKind::dropped_faces, drop_bad_faces(mesh()), 0,
         {"was without area, twice there or broken and is dropped",
          "were without area, twice there or broken and are dropped", "face", "faces"});
  }

  /// Pillows go before duplicates (a pillow is a face and its duplicate), broken faces before both.
  std::size_t drop_safe_pillows() {
    const auto is_broken = [&](const Triangle& t) {
      return std::any_of(t.begin(), t.end(), [&](auto v) {
        return v >= mesh().vertices.size() || !mesh().vertices[v].allFinite();
      });
    };
    if (std::any_of(mesh().triangles.begin(), mesh().triangles.end(), is_broken)) return 0;
    return drop_pillows(mesh());
  }

  Result<void> close() {
    const auto turned = turn_faces(mesh());
    if (!turned)
      return fail(ErrorCode::defective,
                  "it has only one side (as a Moebius strip has): inside and outside are not "
                  "defined; model it again as a closed solid");
    note(RepairKind::turned_faces, *turned, 0,
         {"ran against its neighbours and is turned", "ran against their neighbours and are turned",
          "face", "faces"});
    note_split();
    weld_exactly();
    cap();
    sew();
    const std::size_t n_flaps = drop_flaps(mesh());
    note(RepairKind::dropped_fragments, n_flaps + drop_fragments(mesh()), 0,
         {"is dropped", "are dropped", "loose shred", "loose shreds"});
    ARTUS_TRY(treat_sheets());
    return fill();
  }

  void note_split() {
    note(RepairKind::split_vertices, split_pinches(mesh()), 0,
         {"is split where parts touched only there", "are split where parts touched only there",
          "vertex", "vertices"});
  }

  void weld_exactly() {
    const std::size_t n = weld_cracks(mesh(), 0);
    note(
        RepairKind::welded_vertices, n, 0,
        {"lay on another one and is welded", "lay on others and are welded", "vertex", "vertices"});
    if (n > 0) reorient();
  }

  /// After sewing, pieces that were apart may run against each other.
  void reorient() {
    if (const auto turned = turn_faces(mesh()))
      note(RepairKind::turned_faces, *turned, 0,
           {"ran against its neighbours and is turned",
            "ran against their neighbours and are turned", "face", "faces"});
    split_pinches(mesh());
  }

  void cap() {
    constexpr double kWiderThanDeep = 0.75;  // of the area; half a ball has 0.5
    const Filling caps =
        cap_flat_ends(mesh(), options_.crack_width,
                      options_.thicken > 0 ? options_.largest_fill_share : kWiderThanDeep);
    const auto area = with_number(" (%.3g cm2)", caps.area / kSquareCentimetre);
    note(RepairKind::capped_ends, caps.n, caps.area,
         {"is capped" + area, "are capped" + area, "flat opening", "flat openings"});
  }

  /// Sews cracks of growing width and stops when nothing is open any more.
  void sew() {
    std::size_t n = 0;
    double widest = 0;
    for (const double share : {0.04, 0.1, 0.2, 0.4, 1.0}) {
      if (count_edges(mesh()).open == 0) break;
      const double width = share * options_.crack_width;
      for (std::size_t more = weld_cracks(mesh(), width); more > 0;
           more = weld_cracks(mesh(), width)) {
        n += more;  // each weld takes a vertex away, so this ends; pinches are split afterwards
        widest = width;
      }
    }
    const auto width = with_number(" up to %.2g mm wide", widest / kMillimetre);
    note(RepairKind::welded_vertices, n, widest,
         {"is sewn over a crack" + width, "are sewn over cracks" + width, "vertex", "vertices"});
    if (n > 0) {
      reorient();
      drop_pillows(mesh());
    }
  }

  Result<void> treat_sheets() {
    if (options_.thicken > 0) {
      const std::size_t n = thicken_sheets(mesh(), options_.thicken, options_.largest_fill_share);
      const auto thickness = with_number(" %.3g mm thick", options_.thicken / kMillimetre);
      note(RepairKind::thickened_sheets, n, options_.thicken,
           {"is made a plate" + thickness, "are made plates" + thickness, "sheet", "sheets"});
      return {};
    }
    const auto uses = make_edge_uses(mesh());
    const auto measures = measure_pieces(mesh(), uses, find_pieces(mesh(), uses));
    const auto n = static_cast<std::size_t>(std::count_if(
        measures.begin(), measures.end(), [](const PieceMeasure& m) { return m.is_sheet(); }));
    if (n == 0) return {};
    return fail(ErrorCode::defective,
                plural(n, "piece is a sheet", "pieces are sheets") +
                    " without thickness; say how thick it is (thicken = 1.0 in the joint file) "
                    "or model it as a closed solid");
  }

  Result<void> fill() {
    const double area_before = surface_area(mesh());
    constexpr int kMostRounds = 4;
    Filling holes;
    for (int round = 0; round < kMostRounds; ++round) {  // a split may open what a fill had closed
      const Filling more = fill_holes(mesh());
      holes.n += more.n;
      holes.area += more.area;
      if (split_pinches(mesh()) == 0) break;
    }
    if (holes.area > options_.largest_fill_share * area_before)
      return fail(ErrorCode::defective,
                  with_number("its openings are too large to be closed safely (%.0f %% of the ",
                              100 * holes.area / area_before)
                      .append("surface's own area); close the surface where it was made, or, if it "
                              "is a sheet, say how thick it is (thicken = 1.0 in the joint file)"));
    const auto area = with_number(" (%.3g cm2)", holes.area / kSquareCentimetre);
    note(RepairKind::filled_holes, holes.n, holes.area,
         {"is filled" + area, "are filled" + area, "hole", "holes"});
    return {};
  }

  /// The finest wrap that stays outside: one that enters by an opening is hollow and loses volume.
  Result<SurfaceMesh> find_wrap(double diagonal, double volume) {
    constexpr double kHollow = 0.9;
    constexpr double kFinest = 0.25 * kMillimetre;
    Result<SurfaceMesh> wrapped = fail(ErrorCode::failed, "the surface cannot be wrapped");
    for (const double details : {120, 60}) {
      const double detail = std::max(diagonal / details, kFinest);
      wrapped = make_wrap(mesh(), detail, detail / 20);
      if (wrapped && signed_volume(*wrapped) > kHollow * std::abs(volume)) break;
    }
    return wrapped;
  }

  Result<void> wrap() {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : mesh().vertices) box.extend(p);
    const double before = fanned_volume(mesh());
    auto wrapped = find_wrap(box.diagonal().norm(), before);
    if (!wrapped) return fail(ErrorCode::defective, wrapped.error().message);
    const double moved = largest_distance(*wrapped, mesh());
    std::array<char, 160> text{};
    static_cast<void>(std::snprintf(
        text.data(), text.size(), "wrapped: at most %.3g mm away, volume %.4g -> %.4g cm3",
        moved / kMillimetre, before * 1e6, signed_volume(*wrapped) * 1e6));
    mesh() = std::move(*wrapped);
    outcome_.actions.push_back({RepairKind::wrapped, 1, moved, text.data()});
    return {};
  }

  void untangle_faces() {
    outcome_.self_intersections = find_self_intersections(mesh()).size();
    if (outcome_.self_intersections == 0 || !options_.remove_self_intersections ||
        outcome_.self_intersections > kMostTangledPairs ||
        mesh().triangles.size() > kMostUntangledFaces)
      return;
    const bool few = outcome_.self_intersections <= kFewTangledPairs;
    if (!(few && untangle(mesh())) && !cut_out_tangles(mesh())) return;
    note(RepairKind::untangled_faces, outcome_.self_intersections, 0,
         {"of crossing faces is untangled", "of crossing faces are untangled", "pair", "pairs"});
    outcome_.self_intersections = 0;
  }

  Result<RepairOutcome> finish() {
    const auto edges = count_edges(mesh());
    if (edges.open > 0 || edges.non_manifold > 0) {
      if (options_.wrap == WrapPolicy::never)
        return fail(ErrorCode::defective,
                    plural(edges.open + edges.non_manifold, "edge", "edges") +
                        " cannot be closed; allow wrapping (repair = \"wrap\" in the joint file)");
      if (auto ok = wrap(); !ok) return tl::unexpected(ok.error());
      outcome_.self_intersections = 0;
    }
    outcome_.volume = signed_volume(mesh());
    if (!(outcome_.volume > 0)) return fail(ErrorCode::defective, "it encloses no volume");
    if (outcome_.actions.empty()) outcome_.mesh = original_;
    return std::move(outcome_);
  }

  RepairOptions options_;
  const SurfaceMesh& original_;
  RepairOutcome outcome_;
};

}  // namespace

Result<RepairOutcome> repair_surface(const SurfaceMesh& mesh, const RepairOptions& options) {
  return Repair(mesh, options).run();
}

const char* to_string(RepairKind kind) noexcept {
  constexpr std::array<const char*, 12> kNames{
      "dropped_faces",  "dropped_pillows",  "dropped_fragments", "welded_vertices",
      "split_vertices", "turned_faces",     "turned_pieces",     "capped_ends",
      "filled_holes",   "thickened_sheets", "untangled_faces",   "wrapped"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace artus
