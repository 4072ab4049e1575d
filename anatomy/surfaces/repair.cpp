// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/anatomy/surfaces/defects_cracks.h"
#include "artus/detail/anatomy/surfaces/repair_steps.h"
#include "artus/detail/anatomy/surfaces/surface_distance.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kSquareCentimetre = 1e-4;  // m^2
/// CGAL's untangling takes time that grows fast with these; above them only cutting out is tried.
constexpr std::size_t kFewTangledPairs = 30;
/// Above these the intersections stay: so many are no accident of a file but how it was modelled.
constexpr std::size_t kMaxTangledPairs = 500;
constexpr std::size_t kMaxUntangledFaces = 60'000;

std::string plural(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// Sums over the pieces of a surface.
struct Sums {
  double volume = 0;        ///< m^3, openings closed by fans
  double sized_volume = 0;  ///< m^3, whichever way a piece is wound
  double area = 0;          ///< m^2
  double opening_area = 0;  ///< m^2
  double opening_span = 0;  ///< m^2

  explicit Sums(const SurfaceMesh& mesh) {
    const auto uses = make_edge_uses(mesh);
    for (const auto& m : measure_pieces(mesh, uses, find_pieces(mesh, uses))) {
      volume += m.signed_volume;
      sized_volume += std::abs(m.signed_volume);
      area += m.area;
      opening_area += m.opening_area;
      opening_span += m.opening_span;
    }
  }
};

/// What to do with a surface that is refused, by what it is.
constexpr const char* kMendSheet =
    "say how thick it is (thicken = 1.0 in the joint file), model it as a closed solid, or leave "
    "it out (--skip-refused)";
constexpr const char* kMendSolid =
    "close the surface where it was made, wrap it (repair = \"wrap\" in the joint file), or leave "
    "it out (--skip-refused)";
constexpr const char* kMendElsewhere =
    "correct it where it was made, or leave it out (--skip-refused)";

/// Does the repair step by step and writes down what it did.
class Repair {
 public:
  Repair(const SurfaceMesh& mesh, const RepairOptions& options)
      : options_(options), original_(mesh) {
    outcome_.mesh = mesh;
  }

  Result<RepairOutcome> run() {
    if (mesh().triangles.size() > options_.max_triangles)
      return fail(ErrorCode::defective, std::to_string(mesh().triangles.size()) +
                                            " triangles are more than artus repairs (" +
                                            std::to_string(options_.max_triangles) +
                                            "); decimate the surface first");
    drop();
    if (mesh().triangles.empty())
      return fail(
          ErrorCode::defective,
          "no triangle is left when the bad ones are dropped; export it again, or leave it out "
          "(--skip-refused)");
    outcome_.volume_before = Sums(mesh()).volume;
    if (options_.wrap == WrapPolicy::always && options_.thicken == 0 && has_sheets()) {
      ARTUS_TRY(wrap_sheets());
      return finish();
    }
    ARTUS_TRY(close());
    if (options_.wrap == WrapPolicy::always) ARTUS_TRY(wrap());
    note(RepairKind::turned_pieces, turn_pieces(mesh()), 0,
         {"was oriented inward and is flipped", "were oriented inward and are flipped", "piece",
          "pieces"});
    untangle_faces();
    ARTUS_TRY(treat_crossings());
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
         {"was without area, duplicate or broken and is dropped",
          "were without area, duplicate or broken and are dropped", "face", "faces"});
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
         {"was oriented against its neighbours and is flipped",
          "were oriented against their neighbours and are flipped", "face", "faces"});
    note_split();
    weld_exactly();
    cap();
    sew();
    const std::size_t n_flaps = drop_flaps(mesh());
    note(RepairKind::dropped_fragments, n_flaps + drop_fragments(mesh()), 0,
         {"is dropped", "are dropped", "loose fragment", "loose fragments"});
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
           {"was oriented against its neighbours and is flipped",
            "were oriented against their neighbours and are flipped", "face", "faces"});
    split_pinches(mesh());
  }

  void cap() {
    constexpr double kWiderThanDeep = 0.75;   // of the area; half a ball has 0.5
    constexpr double kDeeperThanSheet = 0.9;  // of the area; a cap as deep as a third of its base
    const bool is_sheet = options_.thicken > 0;
    const Filling caps = cap_flat_ends(
        mesh(), {options_.crack_width, is_sheet ? options_.largest_fill_share : kWiderThanDeep,
                 is_sheet ? 0 : kDeeperThanSheet});
    const auto area = printed(" (%.3g cm2)", caps.area / kSquareCentimetre);
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
    const auto width = printed(" up to %.2g mm wide", widest / kMillimetre);
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
      const auto thickness = printed(" %.3g mm thick", options_.thicken / kMillimetre);
      note(RepairKind::thickened_sheets, n, options_.thicken,
           {"is made a plate" + thickness, "are made plates" + thickness, "sheet", "sheets"});
      return {};
    }
    const auto uses = make_edge_uses(mesh());
    const auto measures = measure_pieces(mesh(), uses, find_pieces(mesh(), uses));
    const auto n = static_cast<std::size_t>(std::count_if(
        measures.begin(), measures.end(), [](const PieceMeasure& m) { return m.is_sheet(); }));
    if (n == 0) return {};
    return fail(ErrorCode::defective, plural(n, "piece is a sheet", "pieces are sheets") +
                                          " without thickness; " + kMendSheet);
  }

  /// Closes all openings in rounds: a split may open what a fill had closed.
  Filling fill_all(bool flat_first) {
    constexpr int kMaxRounds = 4;
    Filling holes;
    for (int round = 0; round < kMaxRounds; ++round) {
      const Filling more = fill_holes(mesh(), flat_first);
      holes.n += more.n;
      holes.area += more.area;
      holes.doubtful_area += more.doubtful_area;
      holes.crossings += more.crossings;
      if (split_pinches(mesh()) == 0) break;
    }
    return holes;
  }

  Result<void> fill() {
    // A sheet's openings are as large as itself, and one bent half round spans 2 / pi of itself;
    // the teeth of a rim make the fan over it large, but not what it spans.
    constexpr double kLikeSheet = 0.9;
    constexpr double kSpansSheet = 0.5;
    if (count_edges(mesh()).open == 0) return {};
    const SurfaceMesh open = mesh();
    const Sums before(open);
    Filling holes = fill_all(false);
    const bool must_close = options_.wrap == WrapPolicy::always;
    if (!must_close && holes.doubtful_area > options_.largest_fill_share * before.area) {
      const bool encloses = before.opening_area < kLikeSheet * before.area ||
                            before.opening_span < kSpansSheet * before.area;
      return fail(ErrorCode::defective,
                  printed("its openings are too large to be closed safely (%.0f %% of the "
                          "surface's own area); ",
                          100 * holes.area / before.area)
                      .append(encloses ? kMendSolid : kMendSheet));
    }
    if (!keeps_volume(before)) {
      mesh() = open;
      holes = fill_all(true);
    }
    const auto area = printed(" (%.3g cm2)", holes.area / kSquareCentimetre);
    note(RepairKind::filled_holes, holes.n, holes.area,
         {"is filled" + area, "are filled" + area, "hole", "holes"});
    if (!must_close && !keeps_volume(before))
      return fail(ErrorCode::defective, "closing its openings changes its volume" +
                                            changed_volume(before.sized_volume) + "; " +
                                            kMendSolid);
    if (holes.crossings > 0) crossings_before_ = find_self_intersections(open).size();
    return {};
  }

  /// Whether the closed surface holds what the open one did.
  [[nodiscard]] bool keeps_volume(const Sums& before) {
    constexpr double kMaxChange = 0.1;
    const double change = Sums(mesh()).sized_volume - before.sized_volume;
    return std::abs(change) <= kMaxChange * before.sized_volume;
  }

  /// " from 84 to 101 cm3"
  [[nodiscard]] std::string changed_volume(double before) {
    return printed(" from %.4g to %.4g cm3", before / kCubicCentimetre,
                   Sums(mesh()).sized_volume / kCubicCentimetre);
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

  [[nodiscard]] bool has_sheets() {
    const auto uses = make_edge_uses(mesh());
    const auto measures = measure_pieces(mesh(), uses, find_pieces(mesh(), uses));
    return std::any_of(measures.begin(), measures.end(),
                       [](const PieceMeasure& m) { return m.is_sheet(); });
  }

  /// Plates, and open shells beside each other, are wrapped as they are: the body that they enclose
  /// where they stand around one (the finest wrap that does not enter by their gaps), else plates
  /// of 1 mm.
  Result<void> wrap_sheets() {
    constexpr double kHalfPlate = 0.5 * kMillimetre;
    constexpr double kFinest = 0.5 * kMillimetre;
    constexpr double kWhole = 0.8;  // of the coarsest wrap's volume
    const SurfaceMesh open = mesh();
    Eigen::AlignedBox3d box;
    for (const Vec3& p : open.vertices) box.extend(p);
    const double diagonal = box.diagonal().norm();
    auto wrapped =
        make_wrap(open, std::max(diagonal / 10, kFinest), kHalfPlate, WrapPlace::outside);
    if (!wrapped) return fail(ErrorCode::defective, wrapped.error().message);
    const double whole = signed_volume(*wrapped);
    for (const double details : {120, 60, 30}) {
      auto finer =
          make_wrap(open, std::max(diagonal / details, kFinest), kHalfPlate, WrapPlace::outside);
      if (!finer || signed_volume(*finer) < kWhole * whole) continue;
      wrapped = std::move(finer);
      break;
    }
    const DistanceStatistics moved = measure_distance(open, *wrapped);
    const std::string text = printed(
        "wrapped, being plates: 0.5 mm outside of them, %.3g mm away in the mean, 95 %% within "
        "%.3g mm, at most %.3g mm (both ways), volume %.4g cm3",
        moved.mean / kMillimetre, moved.percentile95 / kMillimetre, moved.max / kMillimetre,
        signed_volume(*wrapped) / kCubicCentimetre);
    mesh() = std::move(*wrapped);
    outcome_.actions.push_back({RepairKind::wrapped, 1, moved.max, text});
    outcome_.self_intersections = 0;
    return {};
  }

  Result<void> wrap() {
    constexpr double kMaxChange = 0.2;  // of the volume; more is another body
    Eigen::AlignedBox3d box;
    for (const Vec3& p : mesh().vertices) box.extend(p);
    const double before = Sums(mesh()).sized_volume;
    auto wrapped = find_wrap(box.diagonal().norm(), before);
    if (!wrapped) return fail(ErrorCode::defective, wrapped.error().message);
    const double after = signed_volume(*wrapped);
    if (!(std::abs(after - before) <= kMaxChange * before))
      return fail(ErrorCode::defective,
                  printed("a wrap of it holds %.4g cm3", after / kCubicCentimetre) +
                      printed(" where it holds %.4g cm3; ", before / kCubicCentimetre) +
                      kMendElsewhere);
    const DistanceStatistics moved = measure_distance(mesh(), *wrapped);
    const std::string text = printed(
        "wrapped: %.3g mm away in the mean, 95 %% within %.3g mm, at most %.3g mm (both ways), "
        "volume %.4g -> %.4g cm3 (%+.1f %%)",
        moved.mean / kMillimetre, moved.percentile95 / kMillimetre, moved.max / kMillimetre,
        before / kCubicCentimetre, after / kCubicCentimetre, 100 * (after / before - 1));
    mesh() = std::move(*wrapped);
    outcome_.actions.push_back({RepairKind::wrapped, 1, moved.max, text});
    outcome_.self_intersections = 0;
    return {};
  }

  /// Filling that made faces cross, and untangling did not part them: a wrap, or nothing.
  Result<void> treat_crossings() {
    constexpr std::size_t kFew = 10;  // more than there were; the winding number tolerates them
    if (!crossings_before_ || outcome_.self_intersections <= *crossings_before_ + kFew) return {};
    const std::string why = "closing its openings makes faces cross (" +
                            std::to_string(*crossings_before_) + " -> " +
                            std::to_string(outcome_.self_intersections) + " pairs)";
    if (options_.wrap == WrapPolicy::never)
      return fail(ErrorCode::defective, why + "; " + kMendSolid);
    if (auto ok = wrap(); !ok)
      return fail(ErrorCode::defective, why + ", and " + ok.error().message);
    return {};
  }

  void untangle_faces() {
    outcome_.self_intersections = find_self_intersections(mesh()).size();
    if (outcome_.self_intersections == 0 || !options_.remove_self_intersections ||
        outcome_.self_intersections > kMaxTangledPairs ||
        mesh().triangles.size() > kMaxUntangledFaces)
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
        return fail(ErrorCode::defective, plural(edges.open + edges.non_manifold, "edge", "edges") +
                                              " cannot be closed; " + kMendSolid);
      ARTUS_TRY(wrap());
    }
    outcome_.volume = signed_volume(mesh());
    if (!(outcome_.volume > 0))
      return fail(ErrorCode::defective,
                  "it encloses no volume; correct it where it was made, or leave it out "
                  "(--skip-refused)");
    if (outcome_.actions.empty()) outcome_.mesh = original_;
    return std::move(outcome_);
  }

  RepairOptions options_;
  const SurfaceMesh& original_;
  RepairOutcome outcome_;
  std::optional<std::size_t> crossings_before_;  // of the open surface, when filling added some
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
