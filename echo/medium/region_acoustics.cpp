// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/medium/region_acoustics.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/medium/fibre_course.h"

namespace artus {
namespace {

constexpr double kOpaqueAbove = 4e6;    // Rayl, between soft tissue (2) and cortical bone (6)
constexpr double kOpaqueBelow = 1e5;    // Rayl, gas
constexpr double kInterlock = 3e-3;     // m. assumed
constexpr double kThrough = 0.5;        // cosine to the normal from which fibres run through
constexpr double kTendonFloor = 0.056;  // -25 dB
constexpr double kLobe = 12;            // degrees, half the acceptance of an F/2 aperture
constexpr double kApertureHalf = 14 * kDegree;  // rad, of an F/2 aperture seen from its focus
constexpr double kApertureSine = 0.242;         // its sine
constexpr double kEpimysium = 0.06;   // -24 dB. assumed: a fascia shows like fat on muscle
constexpr double kBursaWall = 0.08;   // -22 dB. assumed: the walls show brighter than muscle
constexpr double kEpineurium = 0.05;  // -26 dB. assumed

/// Coupling gel, taken as water: what fills the gap between face and skin.
RegionAcoustics make_gel() {
  RegionAcoustics gel;
  gel.kind = TissueKind::fluid;
  gel.speed = 1490;
  gel.impedance = 1.49e6;
  return gel;
}

bool is_pair(const RegionAcoustics& a, const RegionAcoustics& b, TissueKind kind) {
  return a.kind == kind || b.kind == kind;
}

/// The direction nearest to `depth_axis` that is across `fibre`.
Vec3 sheet_normal(const Vec3& depth_axis, const Vec3& fibre) {
  if (fibre.squaredNorm() < 0.5) return depth_axis;
  const Vec3 across = depth_axis - fibre * fibre.dot(depth_axis);
  return across.norm() > 0.1 ? Vec3(across.normalized()) : Vec3(fibre.unitOrthogonal());
}

}  // namespace

std::vector<RegionAcoustics> make_region_acoustics(const CompiledJoint& joint,
                                                   const Transducer& transducer) {
  std::vector<RegionAcoustics> table;
  table.reserve(joint.regions.size());
  for (const Region& region : joint.regions) {
    const Tissue& tissue = joint.tissues[region.tissue];
    const Acoustic& a = tissue.acoustic;
    const double megahertz = transducer.frequency / 1e6;
    RegionAcoustics out;
    out.kind = a.kind;
    out.speed = a.speed_of_sound;
    out.impedance = a.impedance();
    out.attenuation = 2 * a.attenuation * std::pow(megahertz, a.attenuation_power);
    out.attenuation_slope = a.attenuation_power * out.attenuation / transducer.frequency;
    out.backscatter = a.backscatter;
    out.roughness = a.interface_roughness;
    out.opaque = out.impedance > kOpaqueAbove || out.impedance < kOpaqueBelow;
    out.fibre = region.fibre_axis;
    out.fibre_phase = specular_phase(transducer, out.speed);
    out.sheet_normal = sheet_normal(joint.X_JP_default.linear().col(2), out.fibre);
    table.push_back(out);
  }
  table[kOutside] = make_gel();
  return table;
}

namespace {

void add_fibres(const CompiledJoint& joint, RegionId id, const std::optional<MaterialMap>& depth,
                RegionAcoustics& region) {
  const auto course = fit_fibre_course(joint, id, depth);
  if (!course) return;
  region.course = std::make_shared<const MaterialMap>(*course);
  const Continuation next = find_continuation(joint, id);
  const MaterialPoint point = course->evaluate(next.p_J);
  const Vec3 fibre = Vec3(point.gradient.row(0)).cross(Vec3(point.gradient.row(1))).normalized();
  if (std::abs(fibre.dot(next.facing_J)) < kThrough) return;  // they only lie side by side
  region.continues_as = next.region;
  region.junction = point.place.z();
}

}  // namespace

void add_courses(const CompiledJoint& joint, std::vector<RegionAcoustics>& regions) {
  const std::optional<MaterialMap> depth = fit_skin_depth(joint);
  if (!depth) return;
  const auto skin = std::make_shared<const MaterialMap>(*depth);
  tbb::parallel_for(std::size_t{kFirstRegion}, regions.size(), [&](std::size_t i) {
    switch (regions[i].kind) {
      case TissueKind::fat:
        regions[i].course = skin;
        break;
      case TissueKind::muscle:
      case TissueKind::tendon:
      case TissueKind::nerve:
        add_fibres(joint, static_cast<RegionId>(i), depth, regions[i]);
        break;
      case TissueKind::fluid:
        if (const auto vessel = find_vessel(joint, static_cast<RegionId>(i)))
          regions[i].vessel = std::make_shared<const Vessel>(*vessel);
        break;
      default:
        break;
    }
  });
}

MaterialPoint locate_in_material(const RegionAcoustics& region, const Vec3& p_J) noexcept {
  if (region.course) return region.course->evaluate(p_J);
  MaterialPoint point;
  const Vec3 along =
      region.fibre.squaredNorm() > 0.5 ? region.fibre : Vec3(region.sheet_normal.unitOrthogonal());
  point.gradient.row(0) = region.sheet_normal;
  point.gradient.row(1) = along.cross(region.sheet_normal);
  point.gradient.row(2) = along;
  point.place = point.gradient * p_J;
  return point;
}

double fibre_backscatter(const RegionAcoustics& region, double cosine) noexcept {
  switch (region.kind) {
    case TissueKind::tendon: {
      const double phase = region.fibre_phase * cosine;
      return std::sqrt(kTendonFloor * kTendonFloor + std::exp(-2 * phase * phase));
    }
    case TissueKind::muscle:
      return std::pow(10.0, -2.0 * cosine * cosine / 20);
    case TissueKind::nerve:
      return std::pow(10.0, -4.0 * cosine * cosine / 20);
    default:
      return 1;
  }
}

double local_backscatter(std::span<const RegionAcoustics> regions, const RegionAcoustics& region,
                         double along, double cosine) noexcept {
  const double own = region.backscatter * fibre_backscatter(region, cosine);
  if (region.continues_as == kOutside) return own;
  const RegionAcoustics& next = regions[region.continues_as];
  const double other = next.backscatter * fibre_backscatter(next, cosine);
  const double share = 0.5 * std::exp(-std::abs(along - region.junction) / kInterlock);
  return std::sqrt((1 - share) * own * own + share * other * other);
}

bool is_junction(const RegionAcoustics& from, RegionId from_id, const RegionAcoustics& to,
                 RegionId to_id, const Vec3& normal_J) noexcept {
  const auto continues = [](const RegionAcoustics& region, RegionId as) {
    return region.continues_as != kOutside && region.continues_as == as;
  };
  if (!continues(from, to_id) && !continues(to, from_id)) return false;
  return std::abs(normal_J.dot(from.fibre)) > kThrough ||
         std::abs(normal_J.dot(to.fibre)) > kThrough;
}

double fibre_attenuation(TissueKind kind, double cosine) noexcept {
  switch (kind) {
    case TissueKind::muscle:
      return 1 + 0.8 * cosine * cosine;
    case TissueKind::tendon:
      return 1 + 0.5 * cosine * cosine;
    default:
      return 1;
  }
}

InterfaceResponse compute_interface(const RegionAcoustics& from, const RegionAcoustics& to,
                                    double cosine) noexcept {
  const double cos_in = std::clamp(cosine, kSteepestFacet, 1.0);
  const double sin_out = to.speed / from.speed * std::sqrt(1 - cos_in * cos_in);
  const double facing = std::abs(to.impedance - from.impedance) / (to.impedance + from.impedance);
  if (sin_out >= 1) return {1, facing, 0, 0};
  const double cos_out = std::sqrt(1 - sin_out * sin_out);
  const double a = to.impedance * cos_in;
  const double b = from.impedance * cos_out;
  const double r = (a - b) / (a + b);
  return {std::abs(r), facing, 1 - r * r, cos_out};
}

ReturnedShare returned_share(double roughness, double cosine) noexcept {
  const double c = std::clamp(cosine, 0.0, 1.0);
  const double x = 1 - c;  // the angle's square by its series: no arc cosine
  const double square = x * (2 + x * (1.0 / 3 + x * (4.0 / 45)));
  constexpr double kNarrow = 1 / (kLobe * kLobe * kDegree * kDegree);
  return {(1 - roughness) * std::exp(-kNarrow * square), roughness * c};
}

double beam_transmission(const RegionAcoustics& from, const RegionAcoustics& to, double cosine,
                         const InterfaceResponse& central) noexcept {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double critical = from.speed / to.speed;
  // the outermost direction: sin(a + b) <= sin a + sin b
  if (sine + kApertureSine < critical) return central.transmission;
  const double angle = std::atan2(sine, cosine);
  double sum = central.transmission;
  for (const double part : {-1.0, -0.5, 0.5, 1.0})
    sum += compute_interface(from, to, std::cos(angle + part * kApertureHalf)).transmission;
  return sum / 5;
}

double sheath_reflection(const RegionAcoustics& a, const RegionAcoustics& b) noexcept {
  if (a.opaque || b.opaque) return 0;
  if (a.kind == TissueKind::muscle && b.kind == TissueKind::muscle) return kEpimysium;
  if (is_pair(a, b, TissueKind::nerve)) return kEpineurium;
  if (a.kind == TissueKind::fluid && b.kind == TissueKind::fluid) return 0;
  if (is_pair(a, b, TissueKind::fluid) && !is_pair(a, b, TissueKind::skin)) return kBursaWall;
  return 0;
}

}  // namespace artus
