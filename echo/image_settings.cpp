// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/image_settings.h"

#include "artus/echo/range_check.h"

namespace artus {

Result<void> validate(const ImageSettings& s) {
  RangeCheck check("image settings");
  check.in_range("depth", s.depth, 5e-3, 0.3);
  check.in_range("n_samples", s.n_samples, 16, 16384);
  check.in_range("n_planes", s.n_planes, 1, 33);
  check.in_range("dynamic_range_db", s.dynamic_range_db, 10, 150);
  check.in_range("gain_db", s.gain_db, -60, 100);
  check.in_range("tgc_db_cm_mhz", s.tgc_db_cm_mhz, 0, 3);
  check.in_range("tgc_limit_db", s.tgc_limit_db, 0, 200);
  check.in_range("speckle_db", s.speckle_db, -150, 0);
  check.in_range("noise_db", s.noise_db, -300, 0);
  check.in_range("gel_limit", s.gel_limit, 0, 0.1);
  check.in_range("pixel", s.pixel, 0.02e-3, 2e-3);
  check.in_range("persistence", s.persistence, 0, 0.99);
  check.in_range("smoothing", s.smoothing, 0, 1);
  check.in_range("compound_angles", s.compound_angles, 1, 9);
  check.in_range("compound_angles modulo 2", s.compound_angles % 2, 1, 1);
  check.in_range("compound_spread", s.compound_spread, 0, 0.7);
  check.in_range("doppler_limit", s.doppler_limit, 1e-3, 10);
  check.in_range("n_threads", s.n_threads, 0, 1024);
  return check.result();
}

}  // namespace artus
