// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/transducer.h"

#include <cmath>
#include <numbers>

#include "artus/detail/echo/probe/gaussian.h"
#include "artus/detail/echo/probe/range_check.h"

namespace artus {

Result<void> validate(const Transducer& t) {
  RangeCheck check("transducer");
  check.in_range("width", t.width, TransducerRanges::width);
  check.in_range("steering", t.steering, TransducerRanges::steering);
  check.in_range("n_lines", t.n_lines, TransducerRanges::n_lines);
  check.in_range("frequency", t.frequency, TransducerRanges::frequency);
  check.in_range("bandwidth", t.bandwidth, TransducerRanges::bandwidth);
  check.in_range("pulse_cycles", t.pulse_cycles, TransducerRanges::pulse_cycles);
  check.in_range("f_number", t.f_number, TransducerRanges::f_number);
  check.in_range("max_aperture", t.max_aperture, TransducerRanges::max_aperture);
  check.in_range("elevation_height", t.elevation_height, TransducerRanges::elevation_height);
  check.in_range("elevation_focus", t.elevation_focus, TransducerRanges::elevation_focus);
  if (t.transmit_focus != 0)
    check.in_range("transmit_focus", t.transmit_focus, TransducerRanges::transmit_focus);
  if (t.radius != 0) {
    check.in_range("radius", t.radius, TransducerRanges::radius);
    check.in_range("width over radius", t.width / t.radius, TransducerRanges::width_over_radius);
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
