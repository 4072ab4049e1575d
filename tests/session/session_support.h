// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <memory>
#include <sstream>
#include <string>

#include "artus/detail/session/injecting_device.h"
#include "artus/detail/simulation/records.h"
#include "artus/session/recording.h"
#include "tests/support/layered_body.h"

namespace artus::test {

inline constexpr std::int64_t kTickTime = 1'000'000;  // ns, at 1 kHz

/// Six flat layers from skin to bone, 31 mm, `width` m wide, entry at the origin, +z into the body.
inline std::shared_ptr<const Scene> make_layered_scene(double width = 0.12) {
  const std::array<FlatLayer, 6> layers{{{"skin", 2e-3},
                                         {"fat", 5e-3},
                                         {"muscle", 15e-3},
                                         {"bursa", 2e-3},
                                         {"tendon", 5e-3},
                                         {"bone", 10e-3}}};
  return std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(make_layered_block(layers, width, width)));
}

/// A session small enough for a test: narrow probe, few lines, no texture.
inline SessionParams make_small_session() {
  SessionParams params;
  params.device = *find_device("virtuose_6d_desktop");
  params.transducer.n_lines = 32;
  params.image.n_samples = 256;
  params.image.n_planes = 1;
  params.image.pixel = 0.4e-3;
  params.image.n_threads = 1;
  params.image_rate = 30;
  return params;
}

/// A hand that injects at the origin, 20 mm along +z, again and again.
inline std::unique_ptr<InputDevice> make_injecting_hand() {
  InjectionPlan plan;
  plan.X_WP = make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX());
  plan.target = 20e-3;
  plan.deepest = 20e-3;
  plan.speed = 0.06;
  const SessionParams params = make_small_session();
  return std::make_unique<InjectingDevice>(plan, params.device, params.haptic_rate);
}

/// A device sample with a needle along +z whose tip is at depth `z`, and a probe at the origin.
inline DeviceSample sample_at(double z, std::int64_t time_ns, std::uint64_t number) {
  DeviceSample sample;
  sample.X_WN = to_plain(make_pose(Vec3(0, 0, z), Vec3::UnitZ(), Vec3::UnitX()));
  sample.X_WP = to_plain(make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  sample.time_ns = time_ns;
  sample.number = number;
  sample.state = PeerState::alive;
  sample.has_needle = 1;
  sample.has_probe = 1;
  return sample;
}

/// Tissue that gives way alike at all depths, less far from where it is pushed.
inline NeedleCompliance make_even_compliance(double by = 2e-3) {
  NeedleCompliance c;
  c.points = NeedleCompliance::kMax;
  for (std::size_t i = 0; i < c.points; ++i) {
    for (std::size_t j = 0; j < c.points; ++j)
      c.by_load[i][j] = by * std::exp(-std::abs(static_cast<double>(i) - static_cast<double>(j)));
  }
  return c;
}

inline Result<Recording> parse_recording(const std::string& bytes) {
  std::istringstream in(bytes);
  return read_recording(in, "here");
}

inline void sleep_us(std::int64_t us) {
  const timespec pause{us / 1'000'000, us % 1'000'000 * 1000};
  nanosleep(&pause, nullptr);
}

}  // namespace artus::test
