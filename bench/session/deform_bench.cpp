// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: what do an image's step of the tissue and its picture cost, beside the rigid picture?
// Command:  build/release/bench/session/bench_deform shoulder.artus [images] [threads]
// Reading:  ms, p50 and p99 over the images: "tissue" is two steps of the solver, snapshot and
// scene;
//           "pressed" the picture of that scene, "rigid" that of the body at rest in the same run,
//           and "fixed" an arithmetic that is always the same, which shows what the machine does
//           meanwhile. The probe goes in and out by 4 mm with 0.5 Hz.
// Peer:     the rigid picture; budget 1.25 of it for the pressed one (printed as a ratio of
// medians). Budget:   tissue 12 ms; tissue and picture together 33 ms.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <vector>

#include "artus/echo/renderer.h"
#include "artus/session/tissue_core.h"

namespace {

using Clock = std::chrono::steady_clock;
constexpr double kRate = 30;  // images a second

template <class F>
void time_into(std::vector<double>& times, F&& run) {
  const auto begin = Clock::now();
  run();
  times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
}

double percentile(std::vector<double> times, double share) {
  std::sort(times.begin(), times.end());
  return times[static_cast<std::size_t>(share * (static_cast<double>(times.size()) - 1))];
}

volatile double sink = 0;

void fixed_work() {
  double x = 1;
  for (int i = 0; i < 1'000'000; ++i) x = std::sqrt(x + 1.0 / (i + 1));
  sink = x;
}

int run(const char* file, int images, int threads) {
  auto loaded = artus::read_compiled_joint(file);
  if (!loaded) {
    std::fprintf(stderr, "%s\n", loaded.error().to_string().c_str());
    return 1;
  }
  const auto joint = std::make_shared<const artus::CompiledJoint>(std::move(*loaded));
  auto core = artus::TissueCore::make(joint, joint->X_JP_default, kRate);
  if (!core) {
    std::fprintf(stderr, "%s\n", core.error().to_string().c_str());
    return 1;
  }
  artus::ImageSettings settings;
  settings.n_threads = threads;
  artus::Renderer rigid(std::make_shared<const artus::Scene>(joint), artus::Transducer{}, settings);
  artus::Renderer pressed(core->scene(), artus::Transducer{}, settings);
  std::vector<double> tissue;
  std::vector<double> with;
  std::vector<double> without;
  std::vector<double> fixed;
  for (int i = 0; i < images; ++i) {
    artus::Pose pose = joint->X_JP_default;
    const double depth = 2e-3 * (1 - std::cos(2 * std::numbers::pi * 0.5 * i / kRate));
    pose.translation() += depth * pose.linear().col(2);
    time_into(tissue, [&] { core->step(pose); });
    pressed.set_scene(core->scene());
    time_into(with, [&] { static_cast<void>(pressed.render(pose)); });
    time_into(without, [&] { static_cast<void>(rigid.render(pose)); });
    time_into(fixed, fixed_work);
  }
  const auto line = [](const char* what, const std::vector<double>& times) {
    std::printf("%-8s p50 %7.2f  p99 %7.2f ms\n", what, percentile(times, 0.5),
                percentile(times, 0.99));
  };
  line("tissue", tissue);
  line("pressed", with);
  line("rigid", without);
  line("fixed", fixed);
  std::printf("pressed over rigid %.2f\n", percentile(with, 0.5) / percentile(without, 0.5));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "bench_deform JOINT.artus [images] [threads]\n");
    return 2;
  }
  return run(argv[1], argc > 2 ? std::atoi(argv[2]) : 240, argc > 3 ? std::atoi(argv[3]) : 1);
}
