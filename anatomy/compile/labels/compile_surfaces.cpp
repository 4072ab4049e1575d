// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/compile_surfaces.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include "artus/detail/anatomy/compile/labels/compiler_version.h"
#include "artus/detail/anatomy/compile/labels/cut_faces.h"
#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/anatomy/surfaces/enclosed_volume.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "artus/detail/core/byte_stream.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kSmallestBody =
    10 * kMillimetre;                // from corner to corner: a finger's tip has more
constexpr double kMuchTwice = 0.02;  // of a volume

Eigen::AlignedBox3d box_of(const SurfaceMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : mesh.triangles)
    for (const auto v : t)
      if (v < mesh.vertices.size() && mesh.vertices[v].allFinite()) box.extend(mesh.vertices[v]);
  return box;
}

/// Refuses what is too small or too large for a part of a body: a wrong unit.
Result<void> check_size(const SurfaceMesh& mesh, double smallest, const char* what) {
  const DefectOptions options;
  const Eigen::AlignedBox3d box = box_of(mesh);
  const double size = box.isEmpty() ? smallest : box.diagonal().norm();
  if (size >= smallest && size <= options.largest) return {};
  return fail(ErrorCode::defective, printed("%.4g mm from corner to corner is not the size of a "
                                            "%s; give the unit of its file (units = "
                                            "\"m\", \"cm\" or \"mm\")",
                                            size / kMillimetre, what));
}

/// Refuses what lies so far away that single precision leaves nothing of its shape.
Result<void> check_place(const SurfaceMesh& mesh) {
  const Eigen::AlignedBox3d box = box_of(mesh);
  if (box.isEmpty()) return {};
  const double far = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  if (far <= DefectOptions().farthest) return {};
  const Vec3 middle = box.center() / kMillimetre;
  return fail(
      ErrorCode::defective,
      printed("its coordinates go up to %.4g mm, too far from the origin for any frame of a "
              "body: export it in the frame of the others (its middle is at %.6g, %.6g, "
              "%.6g mm), or give the unit of its file (units = \"m\", \"cm\" or \"mm\")",
              far / kMillimetre, middle.x(), middle.y(), middle.z()));
}

/// A refusal of a surface with vertices that are nowhere begins with these.
Error told_with_lost_vertices(Error error, const SurfaceMesh& mesh) {
  const auto n = std::count_if(mesh.vertices.begin(), mesh.vertices.end(),
                               [](const Vec3& p) { return !p.allFinite(); });
  if (n > 0)
    error.message =
        printed(
            "%td of %zu vertices have coordinates that are not numbers; export it again. "
            "The rest: ",
            n, mesh.vertices.size()) +
        error.message;
  return error;
}

/// The structures by the size of their files, so that no large one is begun last.
std::vector<std::size_t> largest_first(const JointFile& file) {
  std::vector<std::uintmax_t> sizes(file.structures.size(), 0);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    order.push_back(i);
    std::error_code ignored;
    if (const auto* surface = std::get_if<SurfaceFile>(&file.structures[i].shape))
      sizes[i] = std::filesystem::file_size(file.surface_folder / surface->file, ignored);
    if (ignored) sizes[i] = 0;
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  return order;
}

/// The body cannot be left out, so that is not offered.
Error told_of_body(Error error, const JointFile& file) {
  constexpr std::string_view kOffer = ", or leave it out (--skip-refused)";
  if (const auto at = error.message.find(kOffer); at != std::string::npos)
    error.message.erase(at, kOffer.size());
  error.where = (file.folder / "joint.toml").string();
  return error;
}

/// What repairing made of a surface file.
struct RepairedSurface {
  SurfaceMesh mesh;
  std::vector<std::string> repairs;  ///< in words
  std::vector<std::uint8_t> is_cut;  ///< see PreparedSurface
  bool is_cropped = false;           ///< to the region of interest: true of this region alone
};

/// Over the file and all that its entry asks for; what cannot be read is told where it is read.
ContentDigest digest_of(const JointSources& sources, const SurfaceFile& surface, bool is_body) {
  ContentDigest digest(kCompilerVersion);
  digest.add_value(is_body);
  if (const auto of_file = sources.digest(surface)) digest.add(*of_file);
  if (SurfaceFile cuts = surface; is_body && !surface.cuts.empty()) {
    cuts.file = surface.cuts;
    if (const auto of_file = sources.digest(cuts)) digest.add(*of_file);
  }
  digest.add(std::filesystem::path(surface.file).extension().string());
  digest.add_value(surface.unit);
  digest.add_value(surface.has_own_unit);
  digest.add(surface.repair);
  digest.add_value(surface.thicken);
  return digest;
}

std::string to_bytes(const RepairedSurface& repaired) {
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(repaired.repairs.size()));
  for (const std::string& repair : repaired.repairs) out.put(std::string_view(repair));
  out.put_array(repaired.mesh.vertices);
  out.put_array(repaired.mesh.triangles);
  out.put_array(repaired.is_cut);
  return out.bytes();
}

std::optional<RepairedSurface> read_repaired(const std::optional<std::string>& bytes) {
  if (!bytes) return std::nullopt;
  ByteReader in(*bytes);
  RepairedSurface repaired;
  const std::uint32_t n = in.get_count(sizeof(std::uint32_t));
  for (std::uint32_t i = 0; i < n; ++i) repaired.repairs.push_back(in.get_text());
  repaired.mesh.vertices = in.get_array<Vec3>();
  repaired.mesh.triangles = in.get_array<Triangle>();
  repaired.is_cut = in.get_array<std::uint8_t>();
  if (!in.ok() || !in.at_end()) return std::nullopt;
  return repaired;
}

/// Faces that reach to within `beyond` of the region of interest.
SurfaceMesh cropped(const SurfaceMesh& mesh, const RegionOfInterest& roi, double beyond) {
  SurfaceMesh near = mesh;
  std::erase_if(near.triangles, [&](const Triangle& t) {
    return std::none_of(t.begin(), t.end(), [&](std::uint32_t v) {
      return v < mesh.vertices.size() && mesh.vertices[v].allFinite() &&
             signed_distance(roi, mesh.vertices[v]) <= beyond;
    });
  });
  return near;
}

/// About the area that openings in the region of interest span, m^2: rims are taken as circles.
double openings_within(const SurfaceMesh& mesh, const RegionOfInterest& roi) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      ++uses[{low, high}];
    }
  double length = 0;
  for (const auto& [edge, n] : uses) {
    if (n != 1 || edge.second >= mesh.vertices.size()) continue;
    const Vec3& a = mesh.vertices[edge.first];
    const Vec3& b = mesh.vertices[edge.second];
    if (signed_distance(roi, (a + b) / 2) <= 0) length += (a - b).norm();
  }
  return length * length / (4 * std::numbers::pi);
}

/// What cannot be mended where it is of no matter: a structure whose defect lies beyond the region
/// of interest is cut there first. nullopt: that is no help.
std::optional<RepairedSurface> repair_near(const SurfaceMesh& mesh, const SurfaceFile& surface,
                                           const JointFile& file, const Error& refusal) {
  constexpr double kLeastBeyond = 10 * kMillimetre;
  constexpr double kBeyond = 0.25;  // of the region's radius: what closes the cut bulges inward
  constexpr double kAnyShare = 10;  // of the area may be closed: it lies beyond
  if (!file.region_of_interest || !check_size(mesh, DefectOptions().smallest, "") ||
      !check_place(mesh))
    return std::nullopt;
  const RegionOfInterest& roi = *file.region_of_interest;
  const double reach = roi.half_extent ? roi.half_extent->norm() : roi.radius;
  const double beyond = std::max(kLeastBeyond, kBeyond * reach);
  const SurfaceMesh near = cropped(mesh, roi, beyond);
  if (near.triangles.empty() || near.triangles.size() == mesh.triangles.size()) return std::nullopt;
  RepairOptions options;
  options.thicken = surface.thicken;
  if (surface.repair == "wrap") options.wrap = WrapPolicy::always;
  // Openings within the region are as large as they may be elsewhere.
  options.largest_fill_share = kAnyShare;
  if (openings_within(near, roi) > RepairOptions().largest_fill_share * surface_area(near))
    return std::nullopt;
  auto outcome = repair_surface(near, options);
  if (!outcome) return std::nullopt;
  RepairedSurface repaired;
  repaired.mesh = std::move(outcome->mesh);
  repaired.is_cropped = true;
  repaired.repairs.push_back(
      printed("cut %.0f mm outside of the region of interest, since it cannot be mended there: ",
              beyond / kMillimetre) +
      refusal.message);
  for (const RepairAction& action : outcome->actions) repaired.repairs.push_back(action.message);
  return repaired;
}

Result<RepairedSurface> read_and_repair(const JointSources& sources, const SurfaceFile& surface,
                                        bool is_body) {
  const auto read = sources.mesh(surface);
  ARTUS_TRY(read);
  const SurfaceMesh& mesh = **read;
  if (is_body && !surface.has_own_unit) ARTUS_TRY(check_size(mesh, kSmallestBody, "body"));
  Result<RepairOutcome> outcome = repair_as_declared(mesh, surface);
  if (!outcome && !is_body && outcome.error().code == ErrorCode::defective)
    if (auto near = repair_near(mesh, surface, sources.joint(), outcome.error()))
      return std::move(*near);
  ARTUS_TRY(outcome);
  RepairedSurface repaired;
  repaired.mesh = std::move(outcome->mesh);
  for (const RepairAction& action : outcome->actions) repaired.repairs.push_back(action.message);
  if (is_body && !surface.cuts.empty()) {
    SurfaceFile file = surface;
    file.file = surface.cuts;
    const auto cuts = sources.mesh(file);
    ARTUS_TRY(cuts);
    repaired.is_cut = find_given_cuts(repaired.mesh, **cuts);
  } else if (is_body && !repaired.repairs.empty())
    repaired.is_cut = find_cut_faces(mesh, repaired.mesh);
  return repaired;
}

/// As prepare_surface; a body's cuts are found, too.
Result<PreparedSurface> prepare(const JointSources& sources, const SurfaceFile& surface,
                                bool is_body, StructureReport& report, const PartCache& parts) {
  const ContentDigest digest =
      parts.keeps() ? digest_of(sources, surface, is_body) : ContentDigest(0);
  std::optional<RepairedSurface> repaired = read_repaired(parts.find(digest));
  if (!repaired) {
    Result<RepairedSurface> made = read_and_repair(sources, surface, is_body);
    ARTUS_TRY(made);
    repaired = std::move(*made);
    if (parts.keeps() && !repaired->is_cropped) parts.keep(digest, to_bytes(*repaired));
  }
  report.repairs = std::move(repaired->repairs);
  PreparedSurface prepared;
  prepared.mesh = std::move(repaired->mesh);
  prepared.is_cut = std::move(repaired->is_cut);
  const double volume = signed_volume(prepared.mesh);
  const double area = surface_area(prepared.mesh);
  if (!(volume > 0 && area > 0)) {
    return fail(ErrorCode::defective,
                "it encloses no volume; correct it where it was made, or leave it out "
                "(--skip-refused)",
                report.name);
  }
  report.surface_volume = volume;
  if (std::string overlap = describe_overlap(prepared.mesh); !overlap.empty()) {
    report.surface_volume = enclosed_volume(prepared.mesh);
    prepared.warnings.push_back(std::move(overlap));
  }
  prepared.thickness = 2 * volume / area;
  prepared.tree = DistanceTree(prepared.mesh);
  return prepared;
}

}  // namespace

std::string describe_overlap(const SurfaceMesh& mesh) {
  const Pieces pieces = find_pieces(mesh, make_edge_uses(mesh));
  if (pieces.n < 2) return {};
  const double each = signed_volume(mesh);
  const double together = enclosed_volume(mesh);
  if (each - together <= kMuchTwice * each) return {};
  return printed(
      "its %u pieces lie inside each other: %.3g cm3 added up, %.3g cm3 together, which "
      "is what counts; where a surface is there twice, remove one copy from the file",
      pieces.n, each / kCubicCentimetre, together / kCubicCentimetre);
}

Result<PreparedSurface> prepare_surface(const JointSources& sources, const SurfaceFile& surface,
                                        StructureReport& report, const PartCache& parts) {
  return prepare(sources, surface, false, report, parts);
}

Result<PreparedSurface> prepare_body(const JointSources& sources, StructureReport& report,
                                     const PartCache& parts) {
  const JointFile& file = sources.joint();
  Result<PreparedSurface> body =
      prepare(sources, std::get<SurfaceFile>(file.body.shape), true, report, parts);
  if (!body) {
    if (body.error().code != ErrorCode::defective) return body;
    return tl::unexpected(told_of_body(body.error(), file));
  }
  if (!body->is_cut.empty()) {
    double area = 0;
    for (std::size_t i = 0; i < body->is_cut.size(); ++i)
      if (body->is_cut[i] != 0) area += triangle_area(body->mesh, body->mesh.triangles[i]);
    body->warnings.push_back(printed(
        "%.3g cm2 of it close a flat cut and are not skin: no probe or needle is placed there, "
        "and a shell ends there",
        area / (1e-4)));
  }
  return body;
}

Result<RepairOutcome> repair_as_declared(const SurfaceMesh& mesh, const SurfaceFile& surface) {
  if (!surface.has_own_unit)
    ARTUS_TRY(check_size(mesh, DefectOptions().smallest, "part of a body"));
  ARTUS_TRY(check_place(mesh));
  if (surface.repair == "none") {
    RepairOutcome untouched;
    untouched.mesh = mesh;
    untouched.volume = signed_volume(mesh);
    return untouched;
  }
  RepairOptions options;
  options.thicken = surface.thicken;
  if (surface.repair == "wrap") options.wrap = WrapPolicy::always;
  Result<RepairOutcome> outcome = repair_surface(mesh, options);
  if (!outcome) return tl::unexpected(told_with_lost_vertices(outcome.error(), mesh));
  return outcome;
}

Result<PreparedSurfaces> prepare_surfaces(const JointSources& sources,
                                          std::vector<StructureReport>& reports,
                                          const PartCache& parts) {
  const JointFile& file = sources.joint();
  PreparedSurfaces prepared;
  prepared.structures.resize(file.structures.size());
  std::optional<Result<PreparedSurface>> body;
  tbb::task_group beside;  // the body is one of the largest
  beside.run([&] {
    StructureReport report;
    report.name = "body";
    body = prepare_body(sources, report, parts);
  });
  std::vector<std::optional<Error>> errors(file.structures.size());
  const std::vector<std::size_t> order = largest_first(file);
  const auto prepare_one = [&](std::size_t i) {
    const auto* surface = std::get_if<SurfaceFile>(&file.structures[i].shape);
    if (surface == nullptr) return;
    Result<PreparedSurface> result = prepare_surface(sources, *surface, reports[i], parts);
    if (result) {
      reports[i].warnings = result->warnings;
      prepared.structures[i] = std::move(*result);
    } else {
      errors[i] = result.error();
    }
  };
  using Range = tbb::blocked_range<std::size_t>;
  tbb::parallel_for(
      Range(0, order.size(), 1),
      [&](const Range& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) prepare_one(order[k]);
      },
      tbb::simple_partitioner());
  beside.wait();
  if (!*body) {
    Error error = body->error();
    if (error.code == ErrorCode::defective) error.message = "body: " + error.message;
    return tl::unexpected(error);
  }
  prepared.body = std::move(**body);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!errors[i]) continue;
    if (errors[i]->code != ErrorCode::defective) return tl::unexpected(*errors[i]);
    reports[i].refused = errors[i]->message;
  }
  return prepared;
}

}  // namespace artus
