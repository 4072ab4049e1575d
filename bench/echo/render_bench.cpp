// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: how long does one B-mode frame take, by stage, and how does it grow?
// Command:  build/release/bench/echo/bench_echo     (one core: the renderer gets one thread)
// Reading:  p50, p99 and max are milliseconds a frame over the run; lines, beam and display are the
//           median stages: tracing with scattering and needle; pulse shape, envelope; compression,
//           scan conversion. The probe moves from frame to frame, so no frame repeats.
// Peer:     PLUS UsSimulator, 256 x 1000 samples and 100 k triangles: 38-40 ms without slice
//           thickness, pulse shape or refraction (measured on a shared two-core machine).
// Budget:   256 lines x 1024 samples x 5 planes, refraction and needle on: p50 8 ms, p99 16 ms.
//           clinical 1.1, compound 1.5 times the raw look (.../look:NAME, p50_ratio, by turns).
//           With injected liquid, bubbles and a cloud that settles (fluid/...): 1.3 times the same
//           picture without, p50_ratio and p99_ratio; frames of both alternate, so what else runs
//           meets both alike.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "artus/detail/echo/acquire/liquid_plume.h"
#include "artus/detail/soft/liquid/injected_body.h"
#include "artus/echo/renderer.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

/// A body, and where probe and needle are.
struct View {
  std::shared_ptr<const Scene> scene;
  Pose X_JP = Pose::Identity();
  Pose X_JN = Pose::Identity();
};

/// Layers of a shoulder as nested spheres; each subdivision has four times the triangles.
View make_spheres(int subdivisions) {
  const std::array<SphereLayer, 6> layers{{{"skin", 60e-3},
                                           {"fat", 58e-3},
                                           {"muscle", 52e-3},
                                           {"bursa", 38e-3},
                                           {"tendon", 36.5e-3},
                                           {"bone", 30e-3}}};
  View view;
  view.scene = std::make_shared<Scene>(std::make_shared<CompiledJoint>(
      test::make_nested_spheres(layers, Vec3::Zero(), subdivisions)));
  view.X_JP = make_pose(Vec3(0, 0, -60e-3), Vec3::UnitZ(), Vec3::UnitX());
  view.X_JN = view.X_JP * make_pose(Vec3(0, 0, 18e-3), Vec3(0.9, 0, 0.4), Vec3::UnitY());
  return view;
}

/// Skin, fat and muscle all the way down: nothing is in shadow, so every sample scatters.
View make_block() {
  const std::array<test::FlatLayer, 3> layers{{{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 50e-3}}};
  View view;
  view.scene = std::make_shared<Scene>(
      std::make_shared<CompiledJoint>(test::make_layered_block(layers, 80e-3, 60e-3)));
  view.X_JP = make_pose(Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX());
  view.X_JN = view.X_JP * make_pose(Vec3(0, 0, 18e-3), Vec3(0.9, 0, 0.4), Vec3::UnitY());
  return view;
}

/// The compiled joint of a file in its own probe pose, the needle in the plane above the middle.
View read_view(const char* file) {
  auto joint = read_compiled_joint(file);
  if (!joint) {
    std::fprintf(stderr, "%s\n", joint.error().to_string().c_str());
    std::exit(1);
  }
  View view;
  view.X_JP = joint->X_JP_default;
  view.X_JN = view.X_JP * make_pose(Vec3(0, 0, 15e-3), Vec3(0.9, 0, 0.4), Vec3::UnitY());
  view.scene = std::make_shared<Scene>(std::make_shared<CompiledJoint>(std::move(*joint)));
  return view;
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Renders frames whose probe sways by a few millimetres, and reports their times.
void render_frames(benchmark::State& state, const View& view, const Transducer& transducer,
                   const ImageSettings& settings) {
  Renderer renderer(view.scene, transducer, settings);
  std::vector<double> frames;
  std::vector<double> lines;
  std::vector<double> beam;
  std::vector<double> display;
  const Pose X_PN = view.X_JP.inverse() * view.X_JN;
  int step = 0;
  for (auto _ : state) {
    const double sway = 3e-3 * std::sin(0.05 * ++step);
    const Pose X_JP = view.X_JP * Eigen::Translation3d(sway, 0.3 * sway, 0);
    const NeedleView needle{X_JP * X_PN, NeedleShape{}};
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
  state.counters["triangles"] = static_cast<double>(view.scene->joint().mesh.interfaces.size());
}

/// The view with a suspension in it that flowed for 3 s and came to rest for a minute.
struct Filled {
  std::shared_ptr<const Scene> scene;
  LiquidPlume plume;
};

Filled fill(const View& view, const std::vector<Injected>& places) {
  Liquid liquid;
  liquid.name = "suspension";
  liquid.backscatter = 0.3;
  liquid.solids = 0.03;
  liquid.grain_radius = 10e-6;
  Filled filled{std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(
                    with_injected(view.scene->joint(), places, liquid))),
                LiquidPlume(liquid)};
  PlumeSource source;
  source.p_J = places.front().tip;
  const Vec3 up = -view.X_JP.linear().col(2);
  for (int k = 0; k < 600; ++k) {
    if (k < 90) source.given += 1e-7 / 30;
    filled.plume.step(*filled.scene, source, up, k < 90 ? 1.0 / 30 : 0.1);
  }
  return filled;
}

/// Frames of the same view without and with liquid, by turns.
void render_by_turns(benchmark::State& state, const View& view, const Filled& filled) {
  ImageSettings settings;
  settings.look = Look::raw;
  settings.n_threads = 1;
  Renderer dry(view.scene, Transducer{}, settings);
  Renderer wet(view.scene, Transducer{}, settings);
  wet.set_filled_scene(filled.scene);
  const Pose X_PN = view.X_JP.inverse() * view.X_JN;
  std::array<std::vector<double>, 2> times;
  int step = 0;
  for (auto _ : state) {
    const double sway = 3e-3 * std::sin(0.05 * ++step);
    const Pose X_JP = view.X_JP * Eigen::Translation3d(sway, 0.3 * sway, 0);
    const NeedleView needle{X_JP * X_PN, NeedleShape{}};
    for (const bool is_wet : {false, true}) {
      const auto start = std::chrono::steady_clock::now();
      if (is_wet) {
        wet.set_drifting_points(filled.plume.points());
        wet.set_settling({-view.X_JP.linear().col(2), filled.plume.fallen()});
      }
      benchmark::DoNotOptimize((is_wet ? wet : dry).render(X_JP, needle).image.data());
      const std::chrono::duration<double, std::milli> time =
          std::chrono::steady_clock::now() - start;
      times[is_wet ? 1 : 0].push_back(time.count());
    }
  }
  for (const double share : {0.5, 0.99}) {
    const std::string name = share == 0.5 ? "p50" : "p99";
    state.counters[name + "_dry_ms"] = percentile(times[0], share);
    state.counters[name + "_ms"] = percentile(times[1], share);
    state.counters[name + "_ratio"] = percentile(times[1], share) / percentile(times[0], share);
  }
  state.counters["points"] = static_cast<double>(filled.plume.points().size());
}

/// Frames of the same view in the raw look and in another, by turns.
void render_looks(benchmark::State& state, const View& view, Look look) {
  std::array<std::unique_ptr<Renderer>, 2> renderers;
  for (const std::size_t k : {0U, 1U}) {
    ImageSettings settings;
    settings.look = k == 0 ? Look::raw : look;
    settings.n_threads = 1;
    renderers[k] = std::make_unique<Renderer>(view.scene, Transducer{}, settings);
  }
  const Pose X_PN = view.X_JP.inverse() * view.X_JN;
  std::array<std::vector<double>, 2> times;
  int step = 0;
  for (auto _ : state) {
    const double sway = 3e-3 * std::sin(0.05 * ++step);
    const Pose X_JP = view.X_JP * Eigen::Translation3d(sway, 0.3 * sway, 0);
    const NeedleView needle{X_JP * X_PN, NeedleShape{}};
    for (const std::size_t k : {0U, 1U}) {
      const auto start = std::chrono::steady_clock::now();
      benchmark::DoNotOptimize(renderers[k]->render(X_JP, needle).image.data());
      const std::chrono::duration<double, std::milli> time =
          std::chrono::steady_clock::now() - start;
      times[k].push_back(time.count());
    }
  }
  for (const double share : {0.5, 0.99}) {
    const std::string name = share == 0.5 ? "p50" : "p99";
    state.counters[name + "_raw_ms"] = percentile(times[0], share);
    state.counters[name + "_ms"] = percentile(times[1], share);
    state.counters[name + "_ratio"] = percentile(times[1], share) / percentile(times[0], share);
  }
}

void add_looks(const std::string& body, const View& view) {
  for (const Look look : {Look::clinical, Look::compound}) {
    benchmark::RegisterBenchmark(
        (body + "/look:" + look_name(look)).c_str(),
        [view, look](benchmark::State& state) { render_looks(state, view, look); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->Iterations(300);
  }
}

void add_filled(const std::string& name, const View& view, const std::vector<Injected>& places) {
  const Filled filled = fill(view, places);
  benchmark::RegisterBenchmark(
      ("fluid/" + name).c_str(),
      [view, filled](benchmark::State& state) { render_by_turns(state, view, filled); })
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->Iterations(300);
}

/// 5 ml where the joint's first injection ends, 1 ml where its needle crosses the first muscle, and
/// both.
void add_filled_joint(const View& view) {
  const CompiledJoint& joint = view.scene->joint();
  const PlannedInjection& plan = joint.injections.front();
  std::vector<Injected> places;
  for (const TissueInterval& s : tissue_intervals(*view.scene, {plan.entry, plan.target})) {
    if (joint.tissue_of(s.region).acoustic.kind != TissueKind::muscle) continue;
    const Vec3 path = (plan.target - plan.entry).normalized();
    places.push_back(
        {joint.regions[s.region].name, 1e-6, false, plan.entry + (s.entry + s.exit) / 2 * path});
    add_filled("muscle", view, places);
    break;
  }
  const std::string& target = joint.regions[view.scene->region_at(plan.target)].name;
  const Injected end{target, 5e-6, true, plan.target};
  add_filled(target, view, {end});
  places.push_back(end);
  add_filled("both", view, places);
}

/// One benchmark: how many of each.
struct Case {
  int lines = 256;
  int samples = 1024;
  int planes = 5;
  int threads = 1;
};

void add_case(const std::string& body, const View& view, const Case& c) {
  const std::string name =
      body + "/lines:" + std::to_string(c.lines) + "/samples:" + std::to_string(c.samples) +
      "/planes:" + std::to_string(c.planes) + "/threads:" + std::to_string(c.threads);
  const auto run = [view, c](benchmark::State& state) {
    Transducer transducer;
    transducer.n_lines = c.lines;
    ImageSettings settings;
    settings.look = Look::raw;
    settings.n_samples = c.samples;
    settings.n_planes = c.planes;
    settings.n_threads = c.threads;
    render_frames(state, view, transducer, settings);
  };
  benchmark::RegisterBenchmark(name.c_str(), run)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->Iterations(300);
}

/// --joint FILE: a compiled joint instead of the spheres.
const char* take_joint_flag(int& argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::strcmp(argv[i], "--joint") != 0) continue;
    const char* file = argv[i + 1];
    std::copy(argv + i + 2, argv + argc + 1, argv + i);
    argc -= 2;
    return file;
  }
  return nullptr;
}

void add_cases(const std::string& body, const View& view) {
  for (const Case& c : std::vector<Case>{{},
                                         {256, 1024, 5, 2},
                                         {128, 1024, 5, 1},
                                         {512, 1024, 5, 1},
                                         {256, 512, 5, 1},
                                         {256, 2048, 5, 1},
                                         {256, 1024, 1, 1},
                                         {256, 1024, 9, 1}}) {
    add_case(body, view, c);
  }
  add_looks(body, view);
}

}  // namespace
}  // namespace artus

int main(int argc, char** argv) {
  const char* file = artus::take_joint_flag(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  if (file != nullptr) {
    const artus::View view = artus::read_view(file);
    artus::add_filled_joint(view);
    artus::add_cases("joint", view);
  } else {
    const std::array<artus::View, 4> bodies{artus::make_spheres(3), artus::make_spheres(4),
                                            artus::make_spheres(5), artus::make_spheres(6)};
    artus::add_cases("spheres", bodies[2]);
    artus::add_case("block", artus::make_block(), {});
    const artus::Vec3 muscle(0, 0, -45e-3);
    const artus::Vec3 bursa(0, 0, -37e-3);
    artus::add_filled("muscle", bodies[2], {{"muscle", 1e-6, false, muscle}});
    artus::add_filled("bursa", bodies[2], {{"bursa", 5e-6, true, bursa}});
    for (const std::size_t k : {0U, 1U, 3U}) {
      const std::size_t triangles = bodies[k].scene->joint().mesh.interfaces.size();
      artus::add_case("spheres-of-" + std::to_string(triangles), bodies[k], {});
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
