// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/check/compile_warnings.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/anatomy/compile/mesh/compile_measure.h"
#include "artus/detail/anatomy/source/joint_structure.h"
#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kMuchOutside = 0.02;       // of a structure's area
constexpr double kClearlyOutside = 0.5e-3;  // m
constexpr double kMuchCut = 0.01;           // of a gap's volume
constexpr double kLargestError = 0.03;      // of the volume its surface promises

std::string percent(double share) {
  return printed("%.0f %%", 100 * share);
}

std::string at(const Vec3& p) {
  return printed("(%.1f, %.1f, %.1f) mm", p.x() / kMillimetre, p.y() / kMillimetre,
                 p.z() / kMillimetre);
}

std::string cubic_centimetres(double volume) {
  return printed("%.2g cm3", volume / kCubicCentimetre);
}

void warn_of_outliers(const JointFile& file, const PreparedSurfaces& surfaces,
                      CompileReport& report) {
  std::vector<NamedSurface> named{
      {file.body.name, file.body.tissue, surfaces.body.mesh, false, {}}};
  for (std::size_t i = 0; i < file.structures.size(); ++i) {
    const Structure& s = file.structures[i];
    if (surfaces.structures[i])
      named.push_back({s.name,
                       s.tissue,
                       surfaces.structures[i]->mesh,
                       std::get<SurfaceFile>(s.shape).has_own_unit,
                       {}});
  }
  for (const Defect& defect : find_outliers(named)) {
    const auto at =
        std::find_if(report.structures.begin(), report.structures.end(),
                     [&](const StructureReport& r) { return r.name == defect.structure; });
    if (at != report.structures.end()) at->warnings.push_back(defect.message);
  }
}

/// The share of the surface's area in the region of interest that lies outside the body.
double share_outside(const RegionLabels& labels, const SurfaceMesh& mesh) {
  double all = 0;
  double outside = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 centre = triangle_centre(mesh, t);
    if (labels.region_of_interest && signed_distance(*labels.region_of_interest, centre) > 0)
      continue;
    const double area = triangle_area(mesh, t);
    all += area;
    if (labels.body.value(centre) > kClearlyOutside) outside += area;
  }
  return all > 0 ? outside / all : 0;
}

/// Why there is no tetrahedron of a structure.
std::string explain_nothing(const Structure& s, const CompileReport& report) {
  for (const std::string& name : names_of(s))
    for (const StructureReport& r : report.structures)
      if (r.name == name && (!r.refused.empty() || !(r.resolved_volume > 0)))
        return "none of it is in the joint, because it is made from '" + name +
               "', of which there is none";
  if (std::holds_alternative<SurfaceFile>(s.shape))
    return "none of it is in the joint: it lies outside the body or the region of interest, or "
           "structures before it in the file take all of it; check its units, frame and position";
  if (std::holds_alternative<GapConstruct>(s.shape))
    return "none of it is in the joint: nowhere are its roof and its floor both nearer than "
           "'within'; "
           "see in pictures whether the two face each other, with nothing but air or filler "
           "between them, and enlarge 'within' only if they do";
  return "none of it is in the joint: no place is near enough to the structures that it names; "
         "check "
         "that they lie where they should, and enlarge its lengths only if they do";
}

/// Whether a recess lies on that structure.
bool is_wall(const Structure& s, const std::string& name) {
  const auto* gap = std::get_if<GapConstruct>(&s.shape);
  return gap != nullptr &&
         (std::find(gap->roof.begin(), gap->roof.end(), name) != gap->roof.end() ||
          std::find(gap->floor.begin(), gap->floor.end(), name) != gap->floor.end());
}

/// Whether two structures fit each other by construction, so that what one seems to have of the
/// other is the grid's.
bool fit_each_other(const JointFile& file, const Structure& s, const std::string& name) {
  return !s.partition.empty() &&
         std::any_of(file.structures.begin(), file.structures.end(), [&](const Structure& o) {
           return o.name == name && o.partition == s.partition;
         });
}

/// A structure that gives much to what stands before it; a bone that gives anything to tissue.
void warn_of_losses(const JointFile& file, const Structure& s, const CompileReport& report,
                    StructureReport& mine) {
  const auto taker = std::find_if(report.structures.begin(), report.structures.end(),
                                  [&](const StructureReport& o) { return o.name == mine.lost_to; });
  const bool of_bone = mine.is_hard && taker != report.structures.end() && !taker->is_hard &&
                       mine.lost_volume > kBoneLost && !fit_each_other(file, s, mine.lost_to);
  if (of_bone) {
    mine.warnings.push_back(printed("%.2g cm3 of this bone goes to '%s', which stands before it in "
                                    "the file, around ",
                                    mine.lost_volume / kCubicCentimetre, mine.lost_to.c_str()) +
                            at(mine.lost_at) + "; a bone keeps its shape: put the bone before it");
    return;
  }
  if (!(mine.lost_volume > kMuchLost * mine.region_volume)) return;
  const std::string lost = percent(mine.lost_volume / mine.region_volume);
  if (is_wall(s, mine.lost_to))
    mine.warnings.push_back(lost + " of it would lie in its own wall '" + mine.lost_to +
                            "', which stands before it and keeps its shape, around " +
                            at(mine.lost_at) +
                            "; a recess lies half in each of two walls that touch: where it is "
                            "too thin, double its 'thickness', and leave the order as it is");
  else
    mine.warnings.push_back(lost + " of it goes to structures before it in the file, most to '" +
                            mine.lost_to + "' around " + at(mine.lost_at) +
                            "; if that is not meant, put it before them");
}

void warn_of_volumes(const JointFile& file, const Structure& s, const CompileReport& report,
                     StructureReport& mine) {
  if (!(mine.resolved_volume > 0)) {
    mine.warnings.push_back(explain_nothing(s, report));
    return;
  }
  warn_of_losses(file, s, report, mine);
  if (mine.kind == "gap" && mine.parts > 1)
    mine.warnings.push_back("it is in " + std::to_string(mine.parts) +
                            " separate pieces, since structures before it in the file lie "
                            "between them: liquid in one does not reach the other");
  if (mine.kind == "surface" && std::abs(mine.volume_error()) > kLargestError)
    mine.warnings.push_back("its tetrahedra hold " + percent(std::abs(mine.volume_error())) +
                            (mine.volume_error() > 0 ? " more" : " less") +
                            " than its surface; give it a smaller facet_size and facet_distance");
}

}  // namespace

void append_gap_cuts(const JointFile& file, const LabelledSpace& space, CompileReport& report) {
  for (std::size_t i = 0; i < file.structures.size(); ++i) {
    if (space.cuts[i].empty()) continue;
    StructureReport& mine = report.structures[i + 1];  // behind the filler
    FieldPart apart;
    for (const GapCut& cut : space.cuts[i]) {
      if (cut.by.empty()) {
        if (apart.volume == 0) apart.centre = cut.part.centre;
        apart.volume += cut.part.volume;
      } else if (cut.part.volume > kMuchCut * mine.region_volume) {
        mine.warnings.push_back(
            cubic_centimetres(cut.part.volume) + " between its roof and its floor is '" + cut.by +
            "', around " + at(cut.part.centre) +
            ", and remains so; where fluid is meant on it, name '" + cut.by +
            "' as roof or floor, too, and double 'thickness': the recess lies half in each wall");
      }
    }
    if (apart.volume > kMuchCut * mine.region_volume)
      mine.warnings.push_back(cubic_centimetres(apart.volume) +
                              " of it is not joined to the rest and is left out, the most around " +
                              at(apart.centre) +
                              "; if it is meant, make 'within' or 'edge' larger, or add a "
                              "second gap there");
  }
}

void append_warnings(const JointFile& file, const RegionLabels& labels,
                     const PreparedSurfaces& surfaces, CompileReport& report) {
  warn_of_outliers(file, surfaces, report);
  for (std::size_t i = 0; i < file.structures.size(); ++i) {
    StructureReport& mine = report.structures[i + 1];  // behind the filler
    if (!mine.refused.empty()) continue;
    warn_of_volumes(file, file.structures[i], report, mine);
    if (!surfaces.structures[i]) continue;
    const double outside = share_outside(labels, surfaces.structures[i]->mesh);
    if (outside > kMuchOutside)
      mine.warnings.push_back(percent(outside) +
                              " of its surface lies outside the body; that part is cut off");
  }
}

}  // namespace artus
