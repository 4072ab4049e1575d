// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: what does it cost to measure an attempt while it runs, and afterwards?
// Command:  build/release/bench/training/bench_training
// Reading:  tick: us to add one tick of both hands and the force, p50 and p99 over batches of 1000
//           (one tick is shorter than the clock's step). image: us to look at one picture of 256
//           lines. measure: ms for all numbers of ten minutes at 1 kHz.
// Peer:     the tick itself, some 5 us (bench_haptics).
// Budget:   0.5 us a tick, 500 us a picture, 5 s for ten minutes.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "artus/detail/training/session_meter.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

using Clock = std::chrono::steady_clock;

double us_since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

void report(benchmark::State& state, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  state.counters["p50"] = values[values.size() / 2];
  state.counters["p99"] = values[values.size() * 99 / 100];
}

std::shared_ptr<const Scene> make_scene() {
  const std::array<test::FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 6e-3}, {"muscle", 30e-3}, {"bone", 20e-3}}};
  return std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 80e-3, 60e-3)));
}

/// A needle that goes in and out every ten seconds, trembling.
HapticSnapshot snapshot_at(std::uint64_t n) {
  HapticSnapshot s;
  const double t = 1e-3 * static_cast<double>(n);
  s.input.tick = n;
  s.input.device.state = PeerState::alive;
  s.input.device.has_needle = s.input.device.has_probe = 1;
  s.X_JN = to_plain(
      make_pose(Vec3(2e-3 * std::sin(t), 1e-3 * std::cos(3 * t), 15e-3 - 18e-3 * std::cos(0.6 * t)),
                Vec3(0.5, 0, 0.8), Vec3::UnitY()));
  s.feedback.region = 4;
  s.axial[1] = -0.3;
  return s;
}

void tick(benchmark::State& state) {
  AttemptMeter meter(make_scene(), {});
  std::vector<HapticSnapshot> snapshots;
  for (std::uint64_t n = 0; n < 1000; ++n) snapshots.push_back(snapshot_at(n));
  std::vector<double> us;
  std::uint64_t n = 0;
  for (auto _ : state) {
    for (HapticSnapshot& s : snapshots) s.input.tick = n++;
    const auto start = Clock::now();
    for (const HapticSnapshot& s : snapshots) add_tick(meter, s, 1e-3);
    us.push_back(us_since(start) / 1000);
  }
  report(state, us);
}
BENCHMARK(tick)->Iterations(600);

void image(benchmark::State& state) {
  const Transducer transducer;
  const Frame frame =
      render_bmode(make_scene(), make_pose(Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX()));
  std::vector<double> us;
  for (auto _ : state) {
    const auto start = Clock::now();
    benchmark::DoNotOptimize(tip_contrast(frame, transducer, 1e-3, 20e-3));
    us.push_back(us_since(start));
  }
  report(state, us);
}
BENCHMARK(image)->Iterations(2000);

void measure(benchmark::State& state) {
  AttemptMeter meter(make_scene(), {});
  for (std::uint64_t n = 0; n < 600'000; ++n) add_tick(meter, snapshot_at(n), 1e-3);
  std::vector<double> ms;
  for (auto _ : state) {
    const auto start = Clock::now();
    benchmark::DoNotOptimize(meter.measure());
    ms.push_back(us_since(start) / 1000);
  }
  report(state, ms);
}
BENCHMARK(measure)->Iterations(5);

}  // namespace
}  // namespace artus

BENCHMARK_MAIN();
