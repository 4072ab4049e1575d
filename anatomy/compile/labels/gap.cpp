// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/gap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

using Fields = std::vector<const DistanceField*>;

constexpr double kOpposed = -0.5;  // cosine; gradients more opposed than this have full thickness
constexpr double kFarOut = 2;      // rims; the path to an edge is told no farther

Fields fields_of(const NamedFields& fields, const std::vector<std::string>& names) {
  Fields found;
  for (const std::string& name : names) {
    const auto at = fields.find(name);
    ARTUS_REQUIRE(at != fields.end(), "no field of '" + name + "'");
    found.push_back(at->second);
  }
  return found;
}

double nearest(const Fields& fields, const Vec3& p) {
  double d = std::numeric_limits<double>::infinity();
  for (const DistanceField* f : fields) d = std::min(d, f->value(p));
  return d;
}

/// Direction in which the distance to the nearest of `fields` grows; zero in a fold's middle.
Vec3 gradient(const Fields& fields, const Vec3& p, double step) {
  constexpr double kFlat = 0.1;  // a distance that grows no faster than this has no direction
  Vec3 g;
  for (Eigen::Index a = 0; a < 3; ++a)
    g[a] = nearest(fields, p + step * Vec3::Unit(a)) - nearest(fields, p - step * Vec3::Unit(a));
  const double length = g.norm();
  return length > kFlat * 2 * step ? Vec3(g / length) : Vec3(Vec3::Zero());
}

/// The cleft by itself, as if nothing else were there.
class Cleft {
 public:
  Cleft(const GapConstruct& gap, const NamedFields& fields, double spacing)
      : gap_(gap),
        roof_(fields_of(fields, gap.roof)),
        floor_(fields_of(fields, gap.floor)),
        edge_(gap.edge > 0 ? gap.edge : gap.thickness),
        step_(spacing) {}

  double operator()(const Vec3& p) const {
    const double beyond_ball =
        gap_.radius > 0 ? (p - gap_.centre).norm() - gap_.radius : -kFarOut * edge_;
    if (beyond_ball > gap_.thickness) return beyond_ball;
    const double to_roof = nearest(roof_, p);
    const double to_floor = nearest(floor_, p);
    const double beyond_walls = (std::abs(to_roof - to_floor) - gap_.thickness) / 2;
    const double beyond_reach = (to_roof + to_floor - gap_.within) / 2;
    const double limit = std::max({beyond_walls, beyond_reach, beyond_ball});
    if (limit > 2 * step_) return limit;  // no rim can matter here
    const double rim = std::max(
        {0.0, beyond_reach / edge_ + 1, beyond_ball / edge_ + 1, beside(p, to_roof, to_floor)});
    const double half_width = std::abs(to_roof - to_floor) / gap_.thickness;
    return std::max(limit, std::min(gap_.thickness / 2, edge_) * (std::hypot(half_width, rim) - 1));
  }

 private:
  /// How far beyond the edge of roof or floor a point is, in `edge_`: 0 between, 1 at the rim's
  /// end.
  [[nodiscard]] double beside(const Vec3& p, double to_roof, double to_floor) const {
    const Vec3 from_roof = gradient(roof_, p, step_);
    const Vec3 from_floor = gradient(floor_, p, step_);
    const double turned = from_roof.dot(from_floor) / -kOpposed + 1;  // 0 opposed .. 1 across
    // Across the line between the nearest points; where roof and floor overlap it has no length.
    const double away = std::abs(to_roof + to_floor) / 4 * (from_roof + from_floor).norm();
    return std::clamp(std::max(turned, 2 * away / edge_), 0.0, kFarOut);
  }

  GapConstruct gap_;
  Fields roof_;
  Fields floor_;
  double edge_;
  double step_;
};

/// The others that may have something of the cleft, each with what it has.
NamedFields find_takers(const DistanceField& cleft, const NamedFields& others,
                        std::vector<GapCut>& cuts) {
  NamedFields takers;
  for (const auto& [name, field] : others) {
    const FieldPart part =
        cleft.integrate_part([&f = *field](const Vec3& p) { return f.value(p) < 0 ? 1.0 : 0.0; });
    if (!(part.volume > 0)) continue;
    takers[name] = field;
    cuts.push_back({name, part});
  }
  return takers;
}

FieldSampling cut_to_ball(const GapConstruct& gap, const FieldSampling& sampling) {
  FieldSampling cut = sampling;
  if (!(gap.radius > 0)) return cut;
  const Vec3 reach = Vec3::Constant(gap.radius + 2 * sampling.spacing);
  cut.box.lower = cut.box.lower.cwiseMax(gap.centre - reach);
  cut.box.upper = cut.box.upper.cwiseMin(gap.centre + reach);
  return cut;
}

}  // namespace

GapField make_gap_field(const GapConstruct& gap, const NamedFields& fields,
                        const NamedFields& others, const FieldSampling& sampling) {
  const Cleft cleft(gap, fields, sampling.spacing);
  const FieldSampling cut = cut_to_ball(gap, sampling);
  GapField made;
  made.field = DistanceField::compute(cleft, cut);
  const NamedFields takers = find_takers(made.field, others, made.cuts);
  if (!takers.empty()) {
    Fields taken;
    for (const auto& taker : takers) taken.push_back(taker.second);
    const DistanceField whole = std::move(made.field);
    made.field = DistanceField::compute(
        [&](const Vec3& p) { return std::max(whole.value(p), -nearest(taken, p)); }, cut);
  }
  const auto parts = made.field.keep_largest_part();
  for (std::size_t i = 1; i < parts.size(); ++i) made.cuts.push_back({"", parts[i]});
  return made;
}

}  // namespace artus
