// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/core/units.h"

namespace artus {

/// An ultrasound probe: where its scanlines start, how it focuses and what pulse it sends. The
/// default is a linear probe of 40 mm x 6 mm and 6-18 MHz, as in [Alamilla2020].
struct Transducer {
  double width = 40e-3;            ///< m, footprint along x (the arc's length when curved)
  double radius = 0;               ///< m, curvature of a curvilinear face; 0: linear
  double steering = 0;             ///< rad, tilt of every scanline of a linear probe toward +x
  int n_lines = 256;               ///< scanlines, evenly spread over the footprint
  double frequency = 12e6;         ///< Hz, centre
  double bandwidth = 0.5;          ///< -6 dB width of the echo's spectrum over the centre frequency
  double pulse_cycles = 2;         ///< echo length: axial resolution is cycles * wavelength / 2
  double f_number = 2;             ///< receive depth over aperture, as far as the aperture reaches
  double max_aperture = 20e-3;     ///< m
  double elevation_height = 6e-3;  ///< m, element height
  double elevation_focus = 20e-3;  ///< m, of the acoustic lens
  /// m, depth at which the transmitted beam is focused, with the aperture that the F-number gives
  /// there; 0: focused at every depth, as scanners do with many foci or synthetic apertures.
  double transmit_focus = 0;

  friend bool operator==(const Transducer&, const Transducer&) = default;

  /// Distance between neighbouring scanlines at the face, m.
  [[nodiscard]] double pitch() const noexcept {
    return n_lines > 1 ? width / (n_lines - 1) : width;
  }
  /// In a medium of the display's speed of sound, m.
  [[nodiscard]] double wavelength() const noexcept { return kDisplaySpeedOfSound / frequency; }
  /// Standard deviation of the echo's spectrum, Hz, taken as a Gaussian.
  [[nodiscard]] double spectrum_sigma() const noexcept { return frequency * bandwidth / 2.355; }
};

/// What the face sends back of an echo that meets it again (matching layers and lens): -20 dB.
/// Assumed.
inline constexpr double kFaceReflection = 0.1;

/// Full width at half maximum of the two-way amplitude across a beam, in wavelengths per F-number
/// (wave model under dynamic aperture; between the 0.89 of a sinc^2 and a Gaussian's 1.0).
inline constexpr double kTwoWayWidth = 0.97;

/// How much of a mirror's echo returns when it is tilted by `sine` against the beam: exp(-p^2) with
/// p = specular_phase * sine. The beam's Gaussian profile of standard deviation s summed over the
/// mirror, whose echo runs ahead by 2 k sine a metre, k the wave number at `speed` (m/s): p =
/// sqrt(2) k s sine. A straight fibre longer than the beam is wide answers alike.
[[nodiscard]] double specular_phase(const Transducer& transducer, double speed) noexcept;

/// Errors: invalid, naming the value, its range and the field, when a probe cannot be built like
/// that (not finite, zero aperture, frequency outside 1-50 MHz, more than 4096 lines, ...).
[[nodiscard]] Result<void> validate(const Transducer& transducer);

/// A line along which the probe listens, in frame P; depth is measured along `direction`.
struct Scanline {
  Vec3 origin = Vec3::Zero();      ///< on the face, m
  Vec3 direction = Vec3::UnitZ();  ///< unit, in the plane y = 0
};

/// The `i`-th scanline. Requires: a valid transducer, 0 <= i < n_lines.
[[nodiscard]] Scanline scanline(const Transducer& transducer, int i) noexcept;

}  // namespace artus
