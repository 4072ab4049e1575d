// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/echo/medium/material_map.h"
#include "artus/detail/echo/medium/vessel.h"
#include "artus/echo/transducer.h"

namespace artus {

/// A region's acoustics at one transducer's frequency, ready for the tracer.
struct RegionAcoustics {
  TissueKind kind = TissueKind::plain;
  double speed = 1540;           ///< m/s
  double impedance = 1.54e6;     ///< Rayl
  double attenuation = 0;        ///< Np/m at the centre frequency, both ways together
  double attenuation_slope = 0;  ///< its derivative by frequency, Np/m/Hz, both ways
  double backscatter = 0;        ///< rms speckle amplitude, muscle across its fibres = 1
  double roughness = 0;          ///< 0 mirror .. 1 diffuse
  double fibre_phase = 0;        ///< rad per unit of |beam . fibre|, see specular_phase
  bool opaque = false;           ///< bone or gas: no sound returns from inside
  Vec3 fibre = Vec3::Zero();     ///< frame J, unit; zero: isotropic
  /// Frame J, unit, across `fibre`: the direction in which sheets and septa are stacked in a block
  /// without tetrahedra, whose skin faces the joint's usual probe.
  Vec3 sheet_normal = Vec3::UnitZ();
  /// Coordinates along curved fibres or septa; none: straight along `fibre` and `sheet_normal`.
  std::shared_ptr<const MaterialMap> course;
  /// Blood that runs in it, see colour Doppler; none: nothing does.
  std::shared_ptr<const Vessel> vessel;
  /// Muscle and its tendon: what the fibres go on as, and where (m, the course's third coordinate).
  RegionId continues_as = kOutside;
  double junction = 0;
  /// A suspension that settles: grains are missing above this height along `up_J`, m; see
  /// ClearLevels. Infinite: none are.
  double clear_above = std::numeric_limits<double>::infinity();
  double clear_blur = 0;  ///< m to either side over which they thin out
  Vec3 up_J = Vec3::UnitZ();
};

/// Factor on the speckle amplitude of a suspension at a height along its up_J, m: the root of the
/// share of grains that is left.
[[nodiscard]] inline float settled_share(const RegionAcoustics& region, double height) noexcept {
  const double below = region.clear_above + region.clear_blur - height;
  return static_cast<float>(std::sqrt(std::clamp(below / (2 * region.clear_blur), 0.0, 1.0)));
}

/// A region's own coordinates around a point: (across sheets, beside them, along fibres), m.
[[nodiscard]] MaterialPoint locate_in_material(const RegionAcoustics& region,
                                               const Vec3& p_J) noexcept;

/// One entry per region of the joint. The outside is coupling gel. Fibres are straight.
[[nodiscard]] std::vector<RegionAcoustics> make_region_acoustics(const CompiledJoint& joint,
                                                                 const Transducer& transducer);

/// Gives the regions with fibres or septa their course through the joint's tetrahedra, and vessels
/// their blood. Cost: some
/// 0.1 s for a joint of a few dozen structures, on all threads of the calling arena.
void add_courses(const CompiledJoint& joint, std::vector<RegionAcoustics>& regions);

/// Factor on a region's speckle amplitude when `cosine` = |beam direction . fibre|, 1 across the
/// fibres. Tendon is a bundle of mirrors that run straight farther than the beam is wide, so the
/// aperture makes its lobe (see specular_phase), over a diffuse floor 25 dB down (assumed;
/// [Crass1988] fainter than muscle beyond 2-7 degrees). Muscle and nerve change by 2 and 4 dB
/// (assumed).
[[nodiscard]] double fibre_backscatter(const RegionAcoustics& region, double cosine) noexcept;

/// Speckle amplitude of `region` at `along` (m, the third material coordinate) for the angle of
/// fibre_backscatter. Where muscle turns into tendon the two interlock: their powers blend over
/// some millimetres (assumed: 3 mm to either side), half and half where they meet.
[[nodiscard]] double local_backscatter(std::span<const RegionAcoustics> regions,
                                       const RegionAcoustics& region, double along,
                                       double cosine) noexcept;

/// Whether the interface that a beam crosses along `normal_J` is but the place where muscle turns
/// into tendon: the fibres run through it, nothing reflects and nothing bends.
[[nodiscard]] bool is_junction(const RegionAcoustics& from, RegionId from_id,
                               const RegionAcoustics& to, RegionId to_id,
                               const Vec3& normal_J) noexcept;

/// Factor on a tissue's attenuation for the same angle: the beam loses about twice as much along
/// muscle fibres as across them ([Topp2000]).
[[nodiscard]] double fibre_attenuation(TissueKind kind, double cosine) noexcept;

/// What an interface does to a plane wave.
struct InterfaceResponse {
  double reflection = 0;    ///< magnitude of the pressure reflection coefficient, 0..1
  double facing = 0;        ///< the same at perpendicular incidence
  double transmission = 1;  ///< two-way: through and back
  double cosine_out = 1;    ///< of the refracted direction against the normal; 0 when total
};

/// Cosine of the incidence below which the normal of a faceted surface says nothing more.
inline constexpr double kSteepestFacet = 0.12;

/// Fluid-fluid reflection at incidence `cosine` (0..1], with Snell's law. Cost: constant.
/// Source: [Kinsler2000] eq. 6.4.8.
[[nodiscard]] InterfaceResponse compute_interface(const RegionAcoustics& from,
                                                  const RegionAcoustics& to,
                                                  double cosine) noexcept;

/// What comes back to the probe of an amplitude reflected at incidence `cosine`. The two parts add
/// up to 1 at perpendicular incidence.
struct ReturnedShare {
  double specular = 0;  ///< a lobe as wide as the aperture
  double diffuse = 0;   ///< by roughness: from those facets that face the beam
};
[[nodiscard]] ReturnedShare returned_share(double roughness, double cosine) noexcept;

/// Two-way transmission of a whole beam: the mean over the directions of its aperture. A single ray
/// passes or is totally reflected; a focused beam fades on either side of the critical angle.
/// Cost: as compute_interface, where no direction is totally reflected.
[[nodiscard]] double beam_transmission(const RegionAcoustics& from, const RegionAcoustics& to,
                                       double cosine, const InterfaceResponse& central) noexcept;

/// Echo amplitude of the connective tissue between two regions, on top of their impedance step:
/// epimysium between muscles, the walls of a bursa, the sheath of a nerve. 0 for most pairs.
[[nodiscard]] double sheath_reflection(const RegionAcoustics& a, const RegionAcoustics& b) noexcept;

}  // namespace artus
