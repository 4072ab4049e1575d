// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/construct.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "artus/detail/anatomy/compile/labels/gap.h"
#include "artus/detail/core/check.h"

namespace artus {
namespace {

using Function = std::function<double(const Vec3&)>;

constexpr double kRimThickness = 0.5;    // of a cap's thickness, where it ends
constexpr double kContactDepth = 1e-3;   // m, vertices this near the deepest one are its contact
constexpr double kContactReach = 10e-3;  // m, and this near it

const DistanceField& field_of(const NamedFields& fields, const std::string& name) {
  const auto found = fields.find(name);
  ARTUS_REQUIRE(found != fields.end(), "no field of '" + name + "'");
  return *found->second;
}

std::vector<const DistanceField*> fields_of(const NamedFields& fields,
                                            const std::vector<std::string>& names) {
  std::vector<const DistanceField*> found;
  found.reserve(names.size());
  for (const std::string& name : names) found.push_back(&field_of(fields, name));
  return found;
}

double nearest(const std::vector<const DistanceField*>& fields, const Vec3& p) {
  double d = std::numeric_limits<double>::infinity();
  for (const DistanceField* f : fields) d = std::min(d, f->value(p));
  return d;
}

Function make_function(const ShellConstruct& shell, const NamedFields& fields) {
  const DistanceField& inside = field_of(fields, shell.inside);
  return [&inside, t = shell.thickness](const Vec3& p) {
    const double d = inside.value(p);
    return std::max(d, -d - t);
  };
}

Function make_function(const CapConstruct& cap, const NamedFields& fields) {
  const DistanceField& on = field_of(fields, cap.on);
  return [&on, near = fields_of(fields, cap.near), cap](const Vec3& p) {
    const double d = on.value(p);
    const double gap = d + nearest(near, p);
    const double inner = std::clamp(2 * (1 - gap / cap.within), 0.0, 1.0);
    const double thickness = cap.thickness * (kRimThickness + (1 - kRimThickness) * inner);
    return std::max({-d, d - std::min(thickness, gap / 2), (gap - cap.within) / 2});
  };
}

Function make_function(const GapConstruct& /*gap*/, const NamedFields& /*fields*/) {
  ARTUS_REQUIRE(false, "a gap is made by make_gap_field");
  return {};
}

Function make_function(const EndConstruct& end, const NamedFields& fields) {
  ARTUS_REQUIRE(end.insertion.has_value(), "the insertion must be known");
  const DistanceField& of = field_of(fields, end.of);
  return [&of, insertion = *end.insertion, within = end.within](const Vec3& p) {
    return std::max(of.value(p), (p - insertion).norm() - within);
  };
}

Function make_function(const SurfaceFile& /*file*/, const NamedFields& /*fields*/) {
  ARTUS_REQUIRE(false, "a surface file is not a construct");
  return {};
}

}  // namespace

std::map<std::string, FarNeed> find_far_needs(const JointFile& joint) {
  std::map<std::string, FarNeed> needs;
  const Vec3 anywhere = Vec3::Constant(std::numeric_limits<double>::infinity());
  const auto need = [&needs](const std::string& name, double band, const Box& box) {
    const auto [at, is_new] = needs.try_emplace(name, FarNeed{band, box});
    if (is_new) return;
    FarNeed& known = at->second;
    known.band = std::max(known.band, band);
    known.box = {known.box.lower.cwiseMin(box.lower), known.box.upper.cwiseMax(box.upper)};
  };
  const Box all{-anywhere, anywhere};
  for (const Structure& s : joint.structures) {
    if (const auto* shell = std::get_if<ShellConstruct>(&s.shape)) {
      need(shell->inside, 1.5 * shell->thickness, all);
    } else if (const auto* cap = std::get_if<CapConstruct>(&s.shape)) {
      need(cap->on, 1.5 * cap->thickness, all);  // the cap ends there
      for (const std::string& name : cap->near) need(name, cap->within, all);
    } else if (const auto* gap = std::get_if<GapConstruct>(&s.shape)) {
      // Where both are within reach and no farther apart than it is thick, neither is farther.
      const double band = (gap->within + gap->thickness) / 2;
      const Vec3 reach = Vec3::Constant(gap->radius + 2 * gap->thickness);
      const Box box = gap->radius > 0 ? Box{gap->centre - reach, gap->centre + reach} : all;
      for (const std::string& name : gap->roof) need(name, band, box);
      for (const std::string& name : gap->floor) need(name, band, box);
    } else if (const auto* end = std::get_if<EndConstruct>(&s.shape)) {
      if (!end->insertion) need(end->toward, kContactReach, all);
    }
  }
  return needs;
}

DistanceField make_construct_field(const Structure& structure, const NamedFields& fields,
                                   const FieldSampling& sampling) {
  if (const auto* gap = std::get_if<GapConstruct>(&structure.shape))
    return make_gap_field(*gap, fields, {}, sampling).field;
  return DistanceField::compute(
      std::visit([&](const auto& shape) { return make_function(shape, fields); }, structure.shape),
      sampling);
}

Vec3 find_insertion(const SurfaceMesh& muscle, const DistanceField& bone) {
  Vec3 deepest = Vec3::Zero();
  double depth = std::numeric_limits<double>::infinity();
  for (const Vec3& v : muscle.vertices) {
    const double d = bone.value(v);
    if (d < depth) {
      depth = d;
      deepest = v;
    }
  }
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (const Vec3& v : muscle.vertices) {
    if ((v - deepest).norm() > kContactReach) continue;
    if (bone.value(v) > std::max(depth, 0.0) + kContactDepth) continue;
    sum += v;
    count += 1;
  }
  return count > 0 ? Vec3(sum / count) : deepest;
}

}  // namespace artus
