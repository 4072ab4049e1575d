// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <type_traits>

#include "artus/detail/core/fields.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"

namespace artus {

// The named members of all that an image is made by, for visit_fields (core/fields.h).

/// The knots of the curve, "at_0" to "at_8".
template <Like<GreyCurve> P, class F>
void fields_of(P& curve, F&& visit) {
  for (std::size_t k = 0; k < GreyCurve::kKnots; ++k)
    visit("at_" + std::to_string(k), curve.grey[k]);
}

ARTUS_FIELDS(LiveSettings, gain_db, dynamic_range_db, tgc_db_cm_mhz, tgc_limit_db, smoothing,
             persistence, clutter, speckle_reduction, grain, grey_curve);

ARTUS_FIELDS(TableSettings, look, depth, n_samples, n_planes, speckle_db, noise_db, gel_limit,
             pixel, compound_angles, compound_spread, doppler, doppler_limit, refraction,
             reverberation, frequency_downshift, texture, seed, n_threads);

template <Like<ImageSettings> P, class F>
void fields_of(P& settings, F&& visit) {
  using Live = std::conditional_t<std::is_const_v<P>, const LiveSettings, LiveSettings>;
  using Table = std::conditional_t<std::is_const_v<P>, const TableSettings, TableSettings>;
  fields_of(static_cast<Live&>(settings), visit);
  fields_of(static_cast<Table&>(settings), visit);
}

ARTUS_FIELDS(Transducer, width, radius, steering, n_lines, frequency, bandwidth, pulse_cycles,
             f_number, max_aperture, elevation_height, elevation_focus, transmit_focus);

ARTUS_FIELDS(NeedleShape, outer_diameter, bore, length, echogenic);

}  // namespace artus
