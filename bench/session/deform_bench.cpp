// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: what do an image's step of the tissue and its picture cost, beside the rigid picture,
//           and how do they grow with the number of cubes?
// Command:  taskset -c 1 build/release/bench/session/bench_deform JOINT.artus [images] [cell_mm]
//           taskset -c 1 build/release/bench/session/bench_deform JOINT.artus plot OUT.png
// Reading:  ms of one thread's processor time, p50 and p99 over the images. "steps": two steps of
//           the solver; "snapshot": interfaces and inverse map; "scene": the index fitted to them;
//           "update": the three together. "pressed": the picture of that scene, "rigid" that of the
//           body at rest with the same probe, which then stands up to 4 mm inside the skin and
//           sees that much deeper, "unpressed" that of the body at rest with the probe on the skin;
//           "fixed" an arithmetic that
//           is always the same, which shows what the machine does meanwhile. The probe goes in and
//           out by 4 mm with 0.5 Hz; the factor of the tangent is made anew every 12 images by a
//           second thread. Pinned to one core Embree and TBB have no second one to help them.
//           "plot" draws the parts of the update, as medians of 60 images over those of "fixed",
//           against the number of cubes (no pictures are made).
// Peer:     the rigid picture; budget 1.25 of it for the pressed one (printed as a ratio of
//           medians). Budget: update 12 ms.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <numbers>
#include <vector>

#include "artus/detail/core/plot.h"
#include "artus/detail/core/units.h"
#include "artus/detail/raycast/moving_scene.h"
#include "artus/detail/soft/solver/soft_body.h"
#include "artus/echo/renderer.h"

namespace {

constexpr double kRate = 30;        // images a second
constexpr int kRefresh = 12;        // images
constexpr double kDistance = 4e-3;  // m

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// What one kind of work took, image by image.
struct Times {
  const char* what;
  std::vector<double> ms = {};

  template <class F>
  void add(F&& run) {
    const double begin = cpu_ms();
    run();
    ms.push_back(cpu_ms() - begin);
  }
  [[nodiscard]] double at(double share) const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(share * (static_cast<double>(sorted.size()) - 1))];
  }
  void print() const { std::printf("%-9s p50 %7.2f  p99 %7.2f ms\n", what, at(0.5), at(0.99)); }
};

volatile double sink = 0;

void fixed_work() {
  double x = 1;
  for (int i = 0; i < 1'000'000; ++i) x = std::sqrt(x + 1.0 / (i + 1));
  sink = x;
}

artus::Pose pressed_pose(const artus::Pose& X_JP, int image) {
  artus::Pose pose = X_JP;
  const double depth = kDistance / 2 * (1 - std::cos(2 * std::numbers::pi * 0.5 * image / kRate));
  pose.translation() += depth * pose.linear().col(2);
  return pose;
}

struct Bench {
  std::shared_ptr<const artus::CompiledJoint> joint;
  artus::SoftBody body;
  artus::MovingScene scenes = artus::MovingScene();
  Times steps{"steps"}, snapshot{"snapshot"}, scene{"scene"}, update{"update"};
  Times pressed{"pressed"}, rigid{"rigid"}, unpressed{"unpressed"}, fixed{"fixed"};

  void run(int images, bool pictures) {
    artus::ImageSettings settings;
    settings.n_threads = 1;
    const artus::Pose X_JP = joint->X_JP_default;
    body.solver().refresh();
    std::shared_ptr<const artus::DeformedBody> tissue = body.snapshot();
    std::shared_ptr<const artus::Scene> now = scenes.at(tissue);
    artus::Renderer at_rest(std::make_shared<const artus::Scene>(joint), artus::Transducer{},
                            settings);
    artus::Renderer moved(now, artus::Transducer{}, settings);
    for (int i = 0; i < images; ++i) {
      const artus::Pose pose = pressed_pose(X_JP, i);
      if (i % kRefresh == 0) body.solver().begin_refresh();
      if (i % kRefresh == kRefresh - 1) body.solver().end_refresh();
      steps.add([&] {
        for (int k = 0; k < 2; ++k) body.step(pose, 0.5 / kRate);
      });
      snapshot.add([&] { tissue = body.snapshot(tissue.get()); });
      scene.add([&] { now = scenes.at(tissue); });
      update.ms.push_back(steps.ms.back() + snapshot.ms.back() + scene.ms.back());
      fixed.add(fixed_work);
      if (!pictures) continue;
      pressed.add([&] {
        moved.set_scene(now);
        static_cast<void>(moved.render(pose));
      });
      rigid.add([&] { static_cast<void>(at_rest.render(pose)); });
      unpressed.add([&] { static_cast<void>(at_rest.render(X_JP)); });
    }
    if (body.solver().refreshing()) body.solver().end_refresh();
  }

  [[nodiscard]] std::size_t cubes() const { return body.solver().model().cage().cells().size(); }

  void print() const {
    print_update();
    for (const Times* times : {&pressed, &rigid, &unpressed}) times->print();
    std::printf("pressed over rigid %.2f, over unpressed %.2f\n", pressed.at(0.5) / rigid.at(0.5),
                pressed.at(0.5) / unpressed.at(0.5));
  }

  void print_update() const {
    std::printf("%zu cubes, %zu unknowns\n", cubes(), 3 * body.solver().model().n_unknowns());
    for (const Times* times : {&steps, &snapshot, &scene, &update, &fixed}) times->print();
    std::printf("update over fixed %.2f\n", update.at(0.5) / fixed.at(0.5));
  }
};

/// All cubes larger or smaller by one factor.
artus::SoftBodyParams scaled(double cell_mm) {
  artus::SoftBodyParams params;
  const double factor = cell_mm * artus::kMillimetre / params.fine_cell;
  for (double* cell : {&params.fine_cell, &params.near_cell, &params.far_cell, &params.coarse_cell})
    *cell *= factor;
  return params;
}

artus::Result<Bench> make_bench(std::shared_ptr<const artus::CompiledJoint> joint, double cell_mm) {
  auto body = artus::SoftBody::make(joint, joint->X_JP_default, scaled(cell_mm));
  ARTUS_TRY(body);
  return Bench{std::move(joint), std::move(*body)};
}

artus::Result<void> run(const std::shared_ptr<const artus::CompiledJoint>& joint, int images,
                        double cell_mm) {
  auto bench = make_bench(joint, cell_mm);
  ARTUS_TRY(bench);
  bench->run(images, true);
  bench->print();
  return {};
}

artus::Result<void> plot(const std::shared_ptr<const artus::CompiledJoint>& joint,
                         const char* png) {
  std::vector<artus::PlotSeries> parts;
  for (const char* label : {"update", "two steps", "snapshot", "scene"})
    parts.push_back({label, {}, {}, artus::PlotStyle::line_points});
  for (const double cell_mm : {5.0, 4.0, 3.0, 2.5, 2.0}) {
    auto bench = make_bench(joint, cell_mm);
    ARTUS_TRY(bench);
    bench->run(60, false);
    std::printf("cubes of %.1f mm: ", cell_mm);
    bench->print_update();
    std::size_t k = 0;
    for (const Times* times : {&bench->update, &bench->steps, &bench->snapshot, &bench->scene}) {
      parts[k].x.push_back(static_cast<double>(bench->cubes()));
      parts[k++].y.push_back(times->at(0.5) / bench->fixed.at(0.5));
    }
  }
  artus::Plot picture;
  picture.title = "An image's update of the tissue of " + joint->name;
  picture.panels.push_back({"cubes", "processor time over that of the fixed work", parts});
  return artus::write_plot(png, picture);
}

int report(const artus::Result<void>& done) {
  if (!done) std::fprintf(stderr, "%s\n", done.error().to_string().c_str());
  return done ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "bench_deform JOINT.artus [images] [cell_mm] | plot OUT.png\n");
    return 2;
  }
  auto loaded = artus::read_compiled_joint(argv[1]);
  if (!loaded) {
    std::fprintf(stderr, "%s\n", loaded.error().to_string().c_str());
    return 1;
  }
  const auto joint = std::make_shared<const artus::CompiledJoint>(std::move(*loaded));
  if (argc > 3 && std::strcmp(argv[2], "plot") == 0) return report(plot(joint, argv[3]));
  return report(
      run(joint, argc > 2 ? std::atoi(argv[2]) : 240, argc > 3 ? std::atof(argv[3]) : 3.0));
}
