// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: does turning a knob of the scanner stop the picture?
// Command:  build/release/bench/session/bench_knobs     (one renderer thread, 40 images a second)
// Reading:  p50, p99 and max are milliseconds from asking for an image to having it, over 200
//           images; every fourth has the knob in a new place. "still" turns nothing.
//           "tables" is how long those of one place take on a thread of their own.
// Peer:     everything made anew whenever a knob moves: "anew".
// Budget:   max 25 ms, one image of 40 a second, with any knob.
#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "artus/detail/simulation/image_core.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

using Clock = std::chrono::steady_clock;

std::shared_ptr<const Scene> make_scene() {
  const std::array<test::FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 6e-3}, {"muscle", 14e-3}, {"bone", 40e-3}}};
  return std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 80e-3, 60e-3)));
}

SessionParams make_params() {
  SessionParams params;
  params.image.n_threads = 1;
  return params;
}

FrameInput input_of(const ImageControls& controls, std::uint64_t number) {
  FrameInput input;
  input.X_JP = to_plain(
      make_pose(Vec3(1e-5 * static_cast<double>(number), 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  input.controls = controls;
  input.number = number;
  input.has_probe = 1;
  return input;
}

using Turn = void (*)(ImageControls&, double);
using Show = std::function<void(const FrameInput&)>;

/// Renders at 40 Hz and reports how long each image took.
void measure(benchmark::State& state, Turn turn, const Show& show) {
  constexpr std::size_t kImages = 200;
  constexpr std::chrono::milliseconds kPeriod(25);
  ImageControls controls = controls_of(make_params());
  std::vector<double> times;
  for (auto _ : state) {
    auto due = Clock::now();
    for (std::uint64_t k = 0; k < kImages; ++k) {
      if (k % 4 == 3) turn(controls, 1 + 0.001 * static_cast<double>(k % 40));
      std::this_thread::sleep_until(due);
      const auto start = Clock::now();
      show(input_of(controls, k));
      times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
      due = std::max(due + kPeriod, Clock::now());
    }
  }
  std::sort(times.begin() + 1, times.end());  // the first one makes its buffers
  state.counters["p50_ms"] = times[times.size() / 2];
  state.counters["p99_ms"] = times[times.size() * 99 / 100];
  state.counters["max_ms"] = times.back();
}

void beside(benchmark::State& state, Turn turn) {
  ImageCore core(make_scene(), make_params());
  measure(state, turn, [&](const FrameInput& input) { core.render(input); });
}

void anew(benchmark::State& state, Turn turn) {
  const auto scene = make_scene();
  ImageControls shown = controls_of(make_params());
  auto core = std::make_unique<ImageCore>(scene, make_params());
  measure(state, turn, [&](const FrameInput& input) {
    if (!(input.controls == shown)) {
      SessionParams params = make_params();
      params.image.depth = input.controls.depth;
      params.image.gain_db = input.controls.gain_db;
      core = std::make_unique<ImageCore>(scene, params);
      shown = input.controls;
    }
    core->render(input);
  });
}

void tables(benchmark::State& state) {
  const SessionParams params = make_params();
  for (auto _ : state) {
    const EchoPipeline pipeline(params.transducer, params.image);
    benchmark::DoNotOptimize(pipeline.frame().image.data());
  }
}

void still(ImageControls& /*controls*/, double /*factor*/) {}
void turn_gain(ImageControls& controls, double factor) {
  controls.gain_db = 9 * factor;
}
void turn_depth(ImageControls& controls, double factor) {
  controls.depth = 40e-3 * factor;
}

void once(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)->Iterations(1)->UseRealTime();
}

BENCHMARK_CAPTURE(beside, still, still)->Apply(once);
BENCHMARK_CAPTURE(beside, gain, turn_gain)->Apply(once);
BENCHMARK_CAPTURE(beside, depth, turn_depth)->Apply(once);
BENCHMARK_CAPTURE(anew, gain, turn_gain)->Apply(once);
BENCHMARK_CAPTURE(anew, depth, turn_depth)->Apply(once);
BENCHMARK(tables)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace artus

BENCHMARK_MAIN();
