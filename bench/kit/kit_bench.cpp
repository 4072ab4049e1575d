// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: what does a picture of the hands' camera cost, from grey pixels to both poses?
// Command:  build/release/bench/kit/bench_kit
// Reading:  processor time of a picture of 1280 x 720 with sheet, probe, syringe and clutter, on
// one
//           core; `search` is the part that finds markers, `corners` that with corners by edges.
// Budget:   15 ms, of 33 ms that a picture of 30 a second has, beside a live session.
#include <opencv2/core.hpp>

#include <benchmark/benchmark.h>

#include "artus/detail/devices/kit/marker_dictionary.h"
#include "artus/detail/devices/kit/tracker.h"
#include "tests/kit/scenes.h"

namespace artus::kit {
namespace {

/// Eight scenes at several distances.
std::vector<cv::Mat> make_views(const Kit& kit) {
  const test::ViewRenderer renderer(kit.lens);
  std::vector<cv::Mat> views;
  for (std::uint64_t k = 0; k < 8; ++k) {
    std::mt19937_64 random(k);
    const auto scene = test::make_scene(random, 0.4 + 0.04 * static_cast<double>(k), 0.01);
    views.push_back(renderer.render(test::bodies_of(scene, kit), {}, k));
  }
  return views;
}

template <class Work>
void time_work(benchmark::State& state, Work work) {
  cv::setNumThreads(1);
  const Kit kit;
  const auto views = make_views(kit);
  std::size_t i = 0;
  for (auto _ : state) work(kit, views[i++ % views.size()]);
}

void search(benchmark::State& state) {
  time_work(state,
            [](const Kit&, const cv::Mat& view) { benchmark::DoNotOptimize(find_markers(view)); });
}

void corners(benchmark::State& state) {
  time_work(state,
            [](const Kit&, const cv::Mat& view) { benchmark::DoNotOptimize(see_markers(view)); });
}

void picture(benchmark::State& state) {
  std::optional<Tracker> tracker;
  double time = 0;
  time_work(state, [&](const Kit& kit, const cv::Mat& view) {
    if (!tracker) tracker.emplace(kit);
    benchmark::DoNotOptimize(tracker->take(view, time += 1.0 / 30));
  });
}

BENCHMARK(search)->Unit(benchmark::kMillisecond);
BENCHMARK(corners)->Unit(benchmark::kMillisecond);
BENCHMARK(picture)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace artus::kit

BENCHMARK_MAIN();
