// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/compile_labels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <mutex>

#include <tbb/parallel_for.h>

#include "artus/detail/anatomy/compile/labels/compiler_version.h"
#include "artus/detail/anatomy/compile/labels/construct.h"
#include "artus/detail/anatomy/compile/labels/cut_faces.h"
#include "artus/detail/anatomy/compile/labels/grown_field.h"
#include "artus/detail/anatomy/source/joint_structure.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

// Spacing of a field: fine enough that the trilinear surface strays less than the mesh does.
constexpr double kSpacingPerDistance = 5;      // of the facet distance
constexpr double kSpacingPerSize = 0.25;       // of the facet size
constexpr double kSpacingPerThickness = 0.16;  // of the structure's thickness
constexpr double kFinestPerDistance = 0.6;     // of the joint's facet distance
constexpr double kBandPerSpacing = 2.2;
constexpr double kExtendedBandPerSpacing = 4;  // where a coarser field takes over
constexpr double kFarSpacing = 0.4;  // of the joint's facet size, for what constructs see afar
// A triangle across a tube or plate must not be much longer than it is thick, and must stray from
// its surface by a small part of its thickness.
constexpr double kFacetPerThickness = 1.2;
constexpr double kDistancePerThickness = 0.12;
constexpr double kFinestFacet = 0.25;     // of the joint's facet size
constexpr double kFinestDistance = 0.25;  // of the joint's facet distance
constexpr double kGrowthKnown = 1.5;      // of a growth: how far distances are known
constexpr double kSkinKnown = 40e-3;      // m under the skin, where its normal is known

RegionSizing sizing_of(const JointFile& file, const Structure& s, double thickness) {
  RegionSizing size;
  size.facet_size = s.facet_size > 0 ? s.facet_size : file.facet_size;
  size.facet_distance = s.facet_distance > 0 ? s.facet_distance : file.facet_distance;
  size.cell_size = file.cell_size;
  if (thickness > 0) {
    size.facet_size = std::min(
        size.facet_size, std::max(kFinestFacet * file.facet_size, kFacetPerThickness * thickness));
    size.facet_distance = std::min(
        size.facet_distance,
        std::max(kFinestDistance * file.facet_distance, kDistancePerThickness * thickness));
  }
  return size;
}

double spacing_of(const JointFile& file, const RegionSizing& size, double thickness) {
  const double wanted =
      std::min({kSpacingPerDistance * size.facet_distance, kSpacingPerSize * size.facet_size,
                kSpacingPerThickness * thickness});
  return std::max(wanted, kFinestPerDistance * file.facet_distance);
}

Box intersection(const Box& a, const Box& b) {
  return {a.lower.cwiseMax(b.lower), a.upper.cwiseMin(b.upper)};
}

Box grown(const Vec3& lower, const Vec3& upper, double margin) {
  return {lower - Vec3::Constant(margin), upper + Vec3::Constant(margin)};
}

Box box_of(const RegionOfInterest& roi) {
  const Vec3 half = roi.half_extent.value_or(Vec3::Constant(roi.radius));
  return {roi.centre - half, roi.centre + half};
}

double growth_of(const Structure& s) {
  const auto* file = std::get_if<SurfaceFile>(&s.shape);
  return file != nullptr ? file->grow : 0;
}

double construct_thickness(const Structure& s) {
  if (const auto* shell = std::get_if<ShellConstruct>(&s.shape)) return shell->thickness;
  if (const auto* cap = std::get_if<CapConstruct>(&s.shape)) return cap->thickness;
  if (const auto* gap = std::get_if<GapConstruct>(&s.shape)) return gap->thickness;
  return 0;
}

void add(const FieldSampling& sampling, ContentDigest& digest) {
  for (Eigen::Index a = 0; a < 3; ++a) {
    digest.add_value(sampling.box.lower[a]);
    digest.add_value(sampling.box.upper[a]);
  }
  digest.add_value(sampling.spacing);
  digest.add_value(sampling.band);
}

ContentDigest digest_of(const SurfaceMesh& mesh, const FieldSampling& near,
                        const std::optional<FieldSampling>& far) {
  ContentDigest digest(kCompilerVersion);
  ByteWriter surface;
  surface.put_array(mesh.vertices);
  surface.put_array(mesh.triangles);
  digest.add(surface.bytes());
  add(near, digest);
  if (far) add(*far, digest);
  return digest;
}

// Fields of all structures by index, surfaces first, then the constructs made from them.
class FieldMaker {
 public:
  FieldMaker(const JointFile& file, const PreparedSurfaces& surfaces, const Box& box,
             const Progress& progress, const PartCache& parts)
      : file_(file),
        progress_(progress),
        parts_(parts),
        surfaces_(surfaces),
        box_(box),
        needs_(find_far_needs(file)),
        fields_(file.structures.size()),
        sizing_(file.structures.size()),
        cuts_(file.structures.size()) {}

  void make_surfaces() {
    tell(file_.body.name);
    const RegionSizing size = sizing_of(file_, file_.body, 0);
    const DistanceField modelled = surface_field(surfaces_.body, file_.body, size);
    body_ = grown_body(modelled);
    named_[""] = &body_;
    // Beside each other: one by one, the second core waits at the end of each.
    tbb::parallel_for(std::size_t{0}, fields_.size(), [&](std::size_t i) {
      if (!surfaces_.structures[i]) return;
      const PreparedSurface& surface = *surfaces_.structures[i];
      const Structure& s = file_.structures[i];
      sizing_[i] = sizing_of(file_, s, surface.thickness);
      tell(s.name);
      fields_[i] = surface_field(surface, s, sizing_[i]);
      if (const double grow = growth_of(s); grow != 0)
        fields_[i] = swept_field(*fields_[i], modelled, grow, surface.thickness,
                                 room_for(surface, s.name, grow, *fields_[i]));
    });
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (fields_[i]) named_[file_.structures[i].name] = &*fields_[i];
  }

  // Constructs may name constructs: repeat until no further one can be made. Gaps wait for all
  // that can be made without them, since they take no place of others.
  void make_constructs() {
    while (make_next(false) || make_next(true)) continue;
  }

  // What was known from afar served the constructs alone.
  DistanceField take_body() { return take(body_); }
  [[nodiscard]] bool has_field(std::size_t i) const { return fields_[i].has_value(); }
  DistanceField take_field(std::size_t i) { return take(*fields_[i]); }
  std::vector<std::vector<GapCut>> take_cuts() { return std::move(cuts_); }
  [[nodiscard]] const RegionSizing& sizing(std::size_t i) const { return sizing_[i]; }

 private:
  static DistanceField take(DistanceField& field) {
    field.forget_far();
    return std::move(field);
  }

  // Each structure takes its share of this step.
  void tell(const std::string& name) {
    const std::scoped_lock lock(telling_);
    if (progress_)
      progress_("measuring distances: " + name,
                0.1 + 0.1 * n_told_++ / static_cast<double>(fields_.size() + 1));
  }

  DistanceField surface_field(const PreparedSurface& surface, const Structure& s,
                              const RegionSizing& size) const {
    const double spacing = spacing_of(file_, size, surface.thickness);
    const std::optional<FarNeed> needed = far_need_of(s);
    const double band = (needed ? kExtendedBandPerSpacing : kBandPerSpacing) * spacing;
    const Box near = grown(surface.tree.lower(), surface.tree.upper(), band);
    const FieldSampling sampling{intersection(box_, near), spacing, band};
    if (!needed) return kept_field(surface, sampling, {});
    const double coarse = kFarSpacing * file_.facet_size;
    const double reach = std::max(needed->band + 2 * coarse, band + coarse);
    const Box far = intersection(grown(surface.tree.lower(), surface.tree.upper(), reach),
                                 grown(needed->box.lower, needed->box.upper, 2 * coarse));
    return kept_field(surface, sampling, FieldSampling{intersection(box_, far), coarse, reach});
  }

  // What constructs and growth must know of a structure from afar.
  [[nodiscard]] std::optional<FarNeed> far_need_of(const Structure& s) const {
    const bool is_body = &s == &file_.body;
    std::optional<FarNeed> need;
    if (const auto at = needs_.find(is_body ? "" : s.name); at != needs_.end()) need = at->second;
    double band = std::abs(growth_of(s)) * kGrowthKnown;
    if (is_body && std::any_of(file_.structures.begin(), file_.structures.end(),
                               [](const Structure& other) { return growth_of(other) != 0; }))
      band = std::max(band, kSkinKnown);
    constexpr double kFar = std::numeric_limits<double>::infinity();
    if (band == 0) return need;
    return FarNeed{band + (need ? need->band : 0), {Vec3::Constant(-kFar), Vec3::Constant(kFar)}};
  }

  // The body with its skin moved; it tells from afar what the modelled one does.
  [[nodiscard]] DistanceField grown_body(const DistanceField& modelled) const {
    const double grow = growth_of(file_.body);
    if (grow == 0) return modelled;
    return offset_field(modelled, grow, room_for(surfaces_.body, "", grow, modelled));
  }

  // A grown field's samples: as far from it as constructs must know it.
  [[nodiscard]] FieldSampling room_for(const PreparedSurface& surface, const std::string& name,
                                       double grow, const DistanceField& field) const {
    const auto needed = needs_.find(name);
    const double far = needed == needs_.end() ? 0 : needed->second.band;
    const double band = far + kExtendedBandPerSpacing * field.spacing();
    const Box box = grown(surface.tree.lower(), surface.tree.upper(), std::abs(grow) + band);
    return {intersection(box_, box), field.spacing(), band};
  }

  // The field of a surface and, where one is given, its coarser one from afar.
  [[nodiscard]] DistanceField kept_field(const PreparedSurface& surface, const FieldSampling& near,
                                         const std::optional<FieldSampling>& far) const {
    const ContentDigest digest =
        parts_.keeps() ? digest_of(surface.mesh, near, far) : ContentDigest(0);
    if (const auto bytes = parts_.find(digest)) {
      ByteReader in(*bytes);
      if (auto field = DistanceField::read(in); field && in.at_end()) return std::move(*field);
    }
    DistanceField field = DistanceField::compute(surface.tree, near);
    if (far) field.extend(surface.tree, *far);
    if (parts_.keeps()) {
      ByteWriter out;
      field.write(out);
      parts_.keep(digest, out.bytes());
    }
    return field;
  }

  [[nodiscard]] bool is_ready(const Structure& s) const {
    if (std::holds_alternative<SurfaceFile>(s.shape)) return false;
    const auto names = names_of(s);
    return std::all_of(names.begin(), names.end(),
                       [&](const std::string& n) { return named_.count(n) > 0; });
  }

  bool make_next(bool gaps) {
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const Structure& s = file_.structures[i];
      if (fields_[i] || surfaces_.structures[i] || !is_ready(s) ||
          std::holds_alternative<GapConstruct>(s.shape) != gaps)
        continue;
      make_construct(i);
      return true;
    }
    return false;
  }

  void make_construct(std::size_t i) {
    Structure s = file_.structures[i];
    tell(s.name);
    const double thickness = construct_thickness(s);
    sizing_[i] = sizing_of(file_, s, thickness);
    if (auto* end = std::get_if<EndConstruct>(&s.shape)) {
      if (!end->insertion) end->insertion = insertion_of(*end);
    }
    const double spacing =
        spacing_of(file_, sizing_[i], thickness > 0 ? thickness : file_.facet_size);
    const FieldSampling sampling{box_, spacing, kBandPerSpacing * spacing};
    if (const auto* gap = std::get_if<GapConstruct>(&s.shape)) {
      GapField made = make_gap_field(*gap, named_, others_than(*gap), sampling);
      fields_[i] = std::move(made.field);
      cuts_[i] = std::move(made.cuts);
    } else {
      fields_[i] = make_construct_field(s, named_, sampling);
      const auto* shell = std::get_if<ShellConstruct>(&s.shape);
      if (shell != nullptr && shell->inside.empty()) end_at_cuts(*shell, sampling, *fields_[i]);
    }
    named_[s.name] = &*fields_[i];
  }

  // A shell of the body lines its skin alone, not where the body was cut.
  void end_at_cuts(const ShellConstruct& shell, const FieldSampling& sampling,
                   DistanceField& field) const {
    if (surfaces_.body.is_cut.empty()) return;
    const double far = shell.thickness + 2 * kFarSpacing * file_.facet_size + sampling.band;
    const DistanceTree skin(part_near(grown(sampling.box.lower, sampling.box.upper, far),
                                      without_cuts(surfaces_.body.mesh, surfaces_.body.is_cut)));
    const DistanceField whole = std::move(field);
    field = DistanceField::compute(
        [&](const Vec3& p) {
          return std::max(whole.value(p), skin.distance(p, far) - shell.thickness);
        },
        sampling);
  }

  // What a gap takes no place of: all but its roof and floor, what is a part of these, and gaps.
  [[nodiscard]] NamedFields others_than(const GapConstruct& gap) const {
    const auto is_wall = [&gap](const std::string& name) {
      return std::find(gap.roof.begin(), gap.roof.end(), name) != gap.roof.end() ||
             std::find(gap.floor.begin(), gap.floor.end(), name) != gap.floor.end();
    };
    NamedFields others;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const Structure& s = file_.structures[i];
      if (!fields_[i] || is_wall(s.name) || std::holds_alternative<GapConstruct>(s.shape)) continue;
      if (const auto* end = std::get_if<EndConstruct>(&s.shape))
        if (is_wall(end->of)) continue;
      if (const auto* shell = std::get_if<ShellConstruct>(&s.shape))
        if (is_wall(shell->inside)) continue;
      others[s.name] = &*fields_[i];
    }
    return others;
  }

  [[nodiscard]] Vec3 insertion_of(const EndConstruct& end) const {
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (file_.structures[i].name == end.of && surfaces_.structures[i]) {
        return find_insertion(surfaces_.structures[i]->mesh, *named_.at(end.toward));
      }
    }
    return Vec3::Zero();
  }

  const JointFile& file_;
  const Progress& progress_;
  const PartCache& parts_;
  std::mutex telling_;
  double n_told_ = 0;
  const PreparedSurfaces& surfaces_;
  Box box_;
  std::map<std::string, FarNeed> needs_;
  DistanceField body_;
  std::vector<std::optional<DistanceField>> fields_;
  std::vector<RegionSizing> sizing_;
  std::vector<std::vector<GapCut>> cuts_;
  NamedFields named_;
};

// Priority order: the file's, but what takes its share from a structure comes before it.
std::vector<std::size_t> priority_order(const JointFile& file) {
  std::vector<std::size_t> order;
  const auto is_placed = [&order](std::size_t i) {
    return std::find(order.begin(), order.end(), i) != order.end();
  };
  for (std::size_t i = 0; i < file.structures.size(); ++i) {
    for (std::size_t j = i + 1; j < file.structures.size(); ++j) {
      const auto* end = std::get_if<EndConstruct>(&file.structures[j].shape);
      if (end != nullptr && end->of == file.structures[i].name && !is_placed(j)) {
        order.push_back(j);
      }
    }
    if (!is_placed(i)) order.push_back(i);
  }
  return order;
}

/// The area of a surface in a box, m^2.
double area_in(const Box& box, const SurfaceMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 centre = triangle_centre(mesh, t);
    if ((centre.array() < box.lower.array()).any() || (centre.array() > box.upper.array()).any())
      continue;
    area += triangle_area(mesh, t);
  }
  return area;
}

/// Refuses sizes that would take hours and more memory than there is, before they do.
Result<void> check_sizes(const JointFile& file, const PreparedSurfaces& surfaces, const Box& box) {
  constexpr double kMaxElements = 2e7;  // tetrahedra, and interface triangles
  constexpr double kMaxFieldBytes = 4e9;
  constexpr double kVolumePerCell = 0.2;  // of the cube of its circumradius, usually
  constexpr double kAreaPerFacet = 0.65;  // of the square of its circumradius, usually
  constexpr double kBytesPerSample = 4;
  constexpr double kLayersOfBlocks = 4 * 8;  // samples across a surface's band
  const double extent = (surfaces.body.tree.upper() - surfaces.body.tree.lower()).maxCoeff();
  if (file.facet_size > extent / 2) {
    const std::string text = printed(
        "facet_size of [mesh] is %.4g mm, but the whole body measures %.4g mm; give it in the "
        "unit of the file: a few millimetres",
        file.facet_size / kMillimetre, extent / kMillimetre);
    return fail(ErrorCode::invalid, text, file.name);
  }
  const double volume = std::min((box.upper - box.lower).prod(), signed_volume(surfaces.body.mesh));
  const double cells = volume / (kVolumePerCell * std::pow(file.cell_size, 3));
  double facets = 0;
  double bytes = 0;
  const auto add = [&](const Structure& s, const PreparedSurface& surface, double thickness) {
    const RegionSizing size = sizing_of(file, s, thickness);
    const double area = area_in(box, surface.mesh);
    facets += area / (kAreaPerFacet * size.facet_size * size.facet_size);
    const double spacing = spacing_of(file, size, surface.thickness);
    bytes += kBytesPerSample * kLayersOfBlocks * area / (spacing * spacing);
  };
  add(file.body, surfaces.body, 0);
  for (std::size_t i = 0; i < file.structures.size(); ++i)
    if (const auto& surface = surfaces.structures[i])
      add(file.structures[i], *surface, surface->thickness);
  const auto refuse = [&](double count, const char* of_what, const char* key) {
    const std::string text = printed(
        "the sizes in [mesh] need about %.1e %s, more than can be compiled; enlarge %s, or set "
        "a smaller [region_of_interest]",
        count, of_what, key);
    return fail(ErrorCode::invalid, text, file.name);
  };
  if (cells > kMaxElements) return refuse(cells, "tetrahedra", "cell_size");
  if (facets > kMaxElements) return refuse(facets, "interface triangles", "facet_size");
  if (bytes > kMaxFieldBytes) return refuse(bytes, "bytes of distances", "facet_distance");
  return {};
}

}  // namespace

Result<LabelledSpace> make_labelled_space(const JointFile& file, const PreparedSurfaces& surfaces,
                                          const Progress& progress, const PartCache& parts) {
  LabelledSpace space;
  const double margin = file.facet_size + std::max(growth_of(file.body), 0.0);
  Box box = grown(surfaces.body.tree.lower(), surfaces.body.tree.upper(), margin);
  if (file.region_of_interest) {
    const Box roi = box_of(*file.region_of_interest);
    box = intersection(box, grown(roi.lower, roi.upper, margin));
  }
  if (!((box.upper - box.lower).minCoeff() > 0)) {
    return fail(ErrorCode::failed, "the region of interest lies outside the body", file.name);
  }
  ARTUS_TRY(check_sizes(file, surfaces, box));
  FieldMaker maker(file, surfaces, box, progress, parts);
  maker.make_surfaces();
  maker.make_constructs();
  space.resolve.box = box;
  space.resolve.sizing.resize(region_of_structure(file.structures.size()),
                              sizing_of(file, file.body, 0));
  double finest = file.facet_size;
  for (const std::size_t i : priority_order(file)) {
    if (!maker.has_field(i)) continue;
    const RegionId region = region_of_structure(i);
    space.resolve.sizing[region] = maker.sizing(i);
    finest = std::min(finest, maker.sizing(i).facet_size);
    const auto [partition, film] = partition_of(file, file.structures[i]);
    space.labels.layers.push_back({region, maker.take_field(i), partition, film});
  }
  space.cuts = maker.take_cuts();
  space.labels.body = maker.take_body();
  space.labels.region_of_interest = file.region_of_interest;
  space.labels.make_index(box);
  const double per_seed = (box.upper - box.lower).prod() / 6e7;  // m^3, so many at most
  space.resolve.seed_spacing = std::max(finest / 2, std::cbrt(per_seed));
  return space;
}

}  // namespace artus
