// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/image_settings.h"

#include "artus/detail/echo/probe/range_check.h"

namespace artus {

std::string grey_knot_name(std::size_t knot) {
  return "grey_curve.at_" + std::to_string(knot);
}

Result<void> validate(const ImageSettings& s) {
  RangeCheck check("image settings");
  check.in_range("depth", s.depth, ImageRanges::depth);
  check.in_range("n_samples", s.n_samples, ImageRanges::n_samples);
  check.in_range("n_planes", s.n_planes, ImageRanges::n_planes);
  check.in_range("dynamic_range_db", s.dynamic_range_db, ImageRanges::dynamic_range_db);
  check.in_range("gain_db", s.gain_db, ImageRanges::gain_db);
  check.in_range("tgc_db_cm_mhz", s.tgc_db_cm_mhz, ImageRanges::tgc_db_cm_mhz);
  check.in_range("tgc_limit_db", s.tgc_limit_db, ImageRanges::tgc_limit_db);
  check.in_range("speckle_db", s.speckle_db, ImageRanges::speckle_db);
  check.in_range("noise_db", s.noise_db, ImageRanges::noise_db);
  check.in_range("gel_limit", s.gel_limit, ImageRanges::gel_limit);
  check.in_range("pixel", s.pixel, ImageRanges::pixel);
  check.in_range("persistence", s.persistence, ImageRanges::persistence);
  check.in_range("smoothing", s.smoothing, ImageRanges::smoothing);
  check.in_range("compound_angles", s.compound_angles, ImageRanges::compound_angles);
  check.in_range("compound_angles modulo 2", s.compound_angles % 2, {1, 1});
  check.in_range("compound_spread", s.compound_spread, ImageRanges::compound_spread);
  check.in_range("doppler_limit", s.doppler_limit, ImageRanges::doppler_limit);
  check.in_range("look", static_cast<double>(s.look), ImageRanges::look);
  for (std::size_t k = 0; k < GreyCurve::kKnots; ++k) {
    const double least = k == 0 ? 0 : s.grey_curve.grey[k - 1];
    const std::string name = grey_knot_name(k);
    check.in_range(name.c_str(), s.grey_curve.grey[k], ImageRanges::grey);
    check.in_range((name + " over the one before").c_str(), s.grey_curve.grey[k] - least,
                   ImageRanges::grey);
  }
  check.in_range("n_threads", s.n_threads, ImageRanges::n_threads);
  return check.result();
}

}  // namespace artus
