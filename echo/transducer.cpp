// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/transducer.h"

#include <cmath>
#include <numbers>

#include "artus/echo/gaussian.h"
#include "artus/echo/range_check.h"

namespace artus {

Result<void> validate(const Transducer& t) {
  RangeCheck check("transducer");
  check.in_range("width", t.width, 1e-3, 0.2);
  check.in_range("steering", t.steering, -0.7, 0.7);
  check.in_range("n_lines", t.n_lines, 1, 4096);
  check.in_range("frequency", t.frequency, 1e6, 50e6);
  check.in_range("bandwidth", t.bandwidth, 0.05, 1.5);
  check.in_range("pulse_cycles", t.pulse_cycles, 0.5, 20);
  check.in_range("f_number", t.f_number, 0.5, 20);
  check.in_range("max_aperture", t.max_aperture, 0.5e-3, 0.2);
  check.in_range("elevation_height", t.elevation_height, 0.5e-3, 0.05);
  check.in_range("elevation_focus", t.elevation_focus, 2e-3, 0.5);
  if (t.transmit_focus != 0) check.in_range("transmit_focus", t.transmit_focus, 2e-3, 0.5);
  if (t.radius != 0) {
    check.in_range("radius", t.radius, 5e-3, 0.2);
    check.in_range("width over radius", t.width / t.radius, 0, 2.5);
  }
  return check.result();
}

double specular_phase(const Transducer& t, double speed) noexcept {
  const double sigma = kTwoWayWidth * t.wavelength() * t.f_number * kSigmaPerWidth;
  return std::numbers::sqrt2 * 2 * std::numbers::pi * t.frequency / speed * sigma;
}

Scanline scanline(const Transducer& t, int i) noexcept {
  const double x = t.n_lines > 1 ? -t.width / 2 + t.pitch() * i : 0;
  if (t.radius == 0) {
    return {Vec3(x, 0, 0), Vec3(std::sin(t.steering), 0, std::cos(t.steering))};
  }
  const double angle = x / t.radius;
  const Vec3 direction(std::sin(angle), 0, std::cos(angle));
  return {t.radius * (direction - Vec3::UnitZ()), direction};
}

}  // namespace artus
