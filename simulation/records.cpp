// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/records.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>

#include "artus/detail/core/noise.h"

namespace artus {

ImageControls controls_of(const SessionParams& params) noexcept {
  ImageControls controls;
  controls.depth = params.image.depth;
  controls.gain_db = params.image.gain_db;
  controls.tgc_db_cm_mhz = params.image.tgc_db_cm_mhz;
  controls.dynamic_range_db = params.image.dynamic_range_db;
  controls.frequency = params.transducer.frequency;
  controls.elevation_focus = params.transducer.elevation_focus;
  controls.persistence = params.image.persistence;
  controls.grey_curve = params.image.grey_curve;
  controls.look = params.image.look;
  controls.compound_angles = static_cast<std::uint32_t>(params.image.compound_angles);
  return controls;
}

FrameInput frame_input(const HapticSnapshot& snapshot, const ImageControls& controls,
                       std::uint64_t number) noexcept {
  FrameInput input;
  input.X_JP = snapshot.X_JP;
  input.X_JN = snapshot.X_JN;
  input.controls = controls;
  input.sample_time_ns = snapshot.input.device.time_ns;
  input.number = number;
  input.tick = snapshot.input.tick;
  input.has_needle = snapshot.input.device.has_needle;
  input.has_probe = snapshot.input.device.has_probe;
  input.load = snapshot.load;
  input.n_sites = snapshot.n_sites;
  std::copy_n(std::begin(snapshot.sites), snapshot.n_sites, std::begin(input.sites));
  return input;
}

std::uint64_t digest_of(const TissuePacket& packet) noexcept {
  const ProbePacket& probe = packet.probe;
  std::uint64_t digest = mix_bits(probe.number);
  const auto add = [&digest](double value) {
    digest = mix_bits(digest ^ std::bit_cast<std::uint64_t>(value));
  };
  const auto add_all = [&add](const auto& values) {
    std::for_each(values.begin(), values.end(), add);
  };
  digest = mix_bits(digest ^ probe.tick);
  add_all(probe.X_JF);
  add_all(probe.z);
  const double numbers[] = {probe.spacing_x,     probe.spacing_y,       probe.length,
                            probe.width,         probe.curve.stiffness, probe.curve.hardening,
                            probe.curve.slope_x, probe.curve.slope_y};
  std::for_each(std::begin(numbers), std::end(numbers), add);
  const NeedlePacket& needle = packet.needle;
  add_all(needle.carried);
  add(static_cast<double>(needle.compliance.points));
  add(needle.compliance.spacing);
  for (const auto& column : needle.compliance.by_load) add_all(column);
  add_all(needle.compliance.near_field);
  add(needle.compliance_scale);
  return digest;
}

std::uint64_t digest_of(const Frame& frame) noexcept {
  std::uint64_t digest = mix_bits(static_cast<std::uint64_t>(frame.width) << 32U |
                                  static_cast<std::uint64_t>(frame.height));
  for (std::size_t i = 0; i < frame.image.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, frame.image.data() + i, std::min<std::size_t>(8, frame.image.size() - i));
    digest = mix_bits(digest ^ word);
  }
  return digest;
}

}  // namespace artus
