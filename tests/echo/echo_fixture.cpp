// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/echo/echo_fixture.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace artus::test {

std::shared_ptr<const Scene> make_block_scene(std::span<const FlatLayer> layers,
                                              const std::function<void(CompiledJoint&)>& change) {
  auto joint = std::make_shared<CompiledJoint>(make_layered_block(layers, 80e-3, 60e-3));
  if (change) change(*joint);
  return std::make_shared<Scene>(joint);
}

Acoustic& acoustic_of(CompiledJoint& joint, const std::string& tissue) {
  const auto found = std::find_if(joint.tissues.begin(), joint.tissues.end(),
                                  [&](const Tissue& t) { return t.name == tissue; });
  ARTUS_REQUIRE(found != joint.tissues.end(), "no such tissue");
  return found->acoustic;
}

ImageSettings bare_settings() {
  ImageSettings settings;
  settings.tgc_db_cm_mhz = 0;
  settings.noise_db = -300;
  settings.texture = false;
  settings.reverberation = false;
  settings.frequency_downshift = false;
  settings.n_threads = 2;
  return settings;
}

Pose probe_at(double x, double y, double z) {
  return make_pose(Vec3(x, y, z), Vec3::UnitZ(), Vec3::UnitX());
}

NeedleView needle_at(const Pose& X_JP, const Vec3& tip_P, double angle) {
  NeedleView needle;
  const Vec3 along(std::cos(angle), 0, std::sin(angle));
  needle.X_JN = X_JP * make_pose(tip_P, along, Vec3::UnitY());
  return needle;
}

std::span<const float> envelope_line(const Frame& frame, int line) {
  const auto n = static_cast<std::size_t>(frame.n_samples);
  return {frame.envelope.data() + static_cast<std::size_t>(line) * n, n};
}

double mean_intensity(const Frame& frame, double from, double to) {
  const auto first = static_cast<std::size_t>(from / frame.sample_depth);
  const auto last = static_cast<std::size_t>(to / frame.sample_depth);
  double sum = 0;
  for (int l = 0; l < frame.n_lines; ++l) {
    const auto line = envelope_line(frame, l);
    for (std::size_t i = first; i < last; ++i) sum += static_cast<double>(line[i]) * line[i];
  }
  return sum / (static_cast<double>(last - first) * frame.n_lines);
}

int find_peak(const Frame& frame, int line, double from, double to) {
  const auto all = envelope_line(frame, line);
  const auto first = all.begin() + static_cast<int>(from / frame.sample_depth);
  const auto last = all.begin() + static_cast<int>(to / frame.sample_depth);
  return static_cast<int>(std::max_element(first, last) - all.begin());
}

double decibel(double amplitude) {
  return 20 * std::log10(amplitude);
}

}  // namespace artus::test
