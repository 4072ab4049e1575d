// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <type_traits>

#include "artus/detail/core/fields.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"

namespace artus {

// The named members of all that an image is made by, for visit_fields (core/fields.h).

template <Like<LiveSettings> P, class F>
void fields_of(P& settings, F&& visit) {
  auto& [gain, range, tgc, tgc_limit, smoothing, persistence] = settings;
  visit("gain_db", gain);
  visit("dynamic_range_db", range);
  visit("tgc_db_cm_mhz", tgc);
  visit("tgc_limit_db", tgc_limit);
  visit("smoothing", smoothing);
  visit("persistence", persistence);
}

template <Like<TableSettings> P, class F>
void fields_of(P& settings, F&& visit) {
  auto& [depth, n_samples, n_planes, speckle, noise, gel_limit, pixel, compound_angles,
         compound_spread, doppler, doppler_limit, refraction, reverberation, downshift, texture,
         seed, n_threads] = settings;
  visit("depth", depth);
  visit("n_samples", n_samples);
  visit("n_planes", n_planes);
  visit("speckle_db", speckle);
  visit("noise_db", noise);
  visit("gel_limit", gel_limit);
  visit("pixel", pixel);
  visit("compound_angles", compound_angles);
  visit("compound_spread", compound_spread);
  visit("doppler", doppler);
  visit("doppler_limit", doppler_limit);
  visit("refraction", refraction);
  visit("reverberation", reverberation);
  visit("frequency_downshift", downshift);
  visit("texture", texture);
  visit("seed", seed);
  visit("n_threads", n_threads);
}

template <Like<ImageSettings> P, class F>
void fields_of(P& settings, F&& visit) {
  using Live = std::conditional_t<std::is_const_v<P>, const LiveSettings, LiveSettings>;
  using Table = std::conditional_t<std::is_const_v<P>, const TableSettings, TableSettings>;
  fields_of(static_cast<Live&>(settings), visit);
  fields_of(static_cast<Table&>(settings), visit);
}

template <Like<Transducer> P, class F>
void fields_of(P& transducer, F&& visit) {
  auto& [width, radius, steering, n_lines, frequency, bandwidth, pulse_cycles, f_number,
         max_aperture, elevation_height, elevation_focus, transmit_focus] = transducer;
  visit("width", width);
  visit("radius", radius);
  visit("steering", steering);
  visit("n_lines", n_lines);
  visit("frequency", frequency);
  visit("bandwidth", bandwidth);
  visit("pulse_cycles", pulse_cycles);
  visit("f_number", f_number);
  visit("max_aperture", max_aperture);
  visit("elevation_height", elevation_height);
  visit("elevation_focus", elevation_focus);
  visit("transmit_focus", transmit_focus);
}

template <Like<NeedleShape> P, class F>
void fields_of(P& shape, F&& visit) {
  auto& [outer_diameter, bore, length, echogenic] = shape;
  visit("outer_diameter", outer_diameter);
  visit("bore", bore);
  visit("length", length);
  visit("echogenic", echogenic);
}

}  // namespace artus
