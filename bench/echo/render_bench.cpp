// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: how long does one B-mode frame take, by stage, and how does it grow?
// Command:  build/release/bench/echo/bench_echo     (one core: the renderer gets one thread)
// Reading:  p50, p99 and max are milliseconds a frame over the run; lines, beam and display are the
//           median stages: tracing with scattering and needle; pulse shape, envelope, compression;
//           scan conversion. The probe moves from frame to frame, so no frame repeats.
// Peer:     PLUS UsSimulator, 256 x 1000 samples and 100 k triangles: 38-40 ms without slice
//           thickness, pulse shape or refraction (measured on a shared two-core machine).
// Budget:   256 lines x 1024 samples x 5 planes, refraction and needle on: p50 8 ms, p99 16 ms.
#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "echo/renderer.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

/// Seven layers of a shoulder as nested spheres of about 100 k triangles.
std::shared_ptr<const Scene> make_body() {
  const std::array<test::SphereLayer, 6> layers{{{"skin", 60e-3},
                                                 {"fat", 58e-3},
                                                 {"muscle", 52e-3},
                                                 {"bursa", 38e-3},
                                                 {"tendon", 36.5e-3},
                                                 {"bone", 30e-3}}};
  return std::make_shared<Scene>(
      std::make_shared<CompiledJoint>(test::make_nested_spheres(layers, Vec3::Zero(), 5)));
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Arguments: lines, samples, planes.
void render_frame(benchmark::State& state) {
  Transducer transducer;
  transducer.n_lines = static_cast<int>(state.range(0));
  ImageSettings settings;
  settings.n_samples = static_cast<int>(state.range(1));
  settings.n_planes = static_cast<int>(state.range(2));
  settings.n_threads = 1;
  Renderer renderer(make_body(), transducer, settings);
  std::vector<double> frames;
  std::vector<double> lines;
  std::vector<double> beam;
  std::vector<double> display;
  double shift = 0;
  for (auto _ : state) {
    shift += 0.05e-3;
    const Pose X_JP = make_pose(Vec3(shift, 0, -60e-3), Vec3::UnitZ(), Vec3::UnitX());
    NeedleView needle;
    needle.X_JN = X_JP * make_pose(Vec3(0, 0, 18e-3), Vec3(0.9, 0, 0.4), Vec3::UnitY());
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(renderer.render(X_JP, needle).image.data());
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    frames.push_back(time.count());
    lines.push_back(renderer.stage_times().lines * 1e3);
    beam.push_back(renderer.stage_times().beam * 1e3);
    display.push_back(renderer.stage_times().display * 1e3);
  }
  state.counters["p50_ms"] = percentile(frames, 0.5);
  state.counters["p99_ms"] = percentile(frames, 0.99);
  state.counters["max_ms"] = percentile(frames, 1);
  state.counters["lines_ms"] = percentile(lines, 0.5);
  state.counters["beam_ms"] = percentile(beam, 0.5);
  state.counters["display_ms"] = percentile(display, 0.5);
}
BENCHMARK(render_frame)
    ->Args({256, 1024, 5})
    ->Args({128, 1024, 5})
    ->Args({512, 1024, 5})
    ->Args({256, 512, 5})
    ->Args({256, 2048, 5})
    ->Args({256, 1024, 1})
    ->Args({256, 1024, 9})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(100);

}  // namespace
}  // namespace artus

BENCHMARK_MAIN();
