// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: how long do one control tick of the pneumatic mock (sensor checks, estimate, law, valve
// inversion) and one tick of the probe's contact take?
// Command: cmake --preset release -B build/release && ninja -C build/release bench_probe &&
//   build/release/bench/haptics/bench_probe
// Reading: microseconds of this thread's own processor time per tick; the clock itself takes about
// 0.3 us of each. Percentiles, never means. On a busy machine interrupts and cold caches are
// charged to the thread all the same; the runs are deterministic, so the least of three per tick
// takes them away and keeps what the tick's own work costs. Peer: none is known for the laws; the
// budget is p99.9 <= 10 us a control tick, and 1000 us for the contact's tick at 1 kHz.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

#include "haptics/control_law_supervisor.h"
#include "haptics/pneumatic_plant.h"
#include "haptics/probe_contact.h"
#include "tests/support/layered_body.h"

namespace {

double thread_time() {
  std::timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

void print(const char* name, std::vector<double>& us) {
  std::sort(us.begin(), us.end());
  const auto at = [&us](double share) {
    return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  };
  std::printf("%-26s %9zu ticks  p50 %7.2f  p99 %7.2f  p99.9 %7.2f  max %8.2f us\n", name,
              us.size(), at(0.5), at(0.99), at(0.999), us.back());
}

/// One run of the mock under a law; the same work tick by tick every time.
std::vector<double> run_law(artus::ControlLawKind kind) {
  constexpr std::size_t kTicks = 1000000;
  const artus::PneumaticParams params;
  artus::ControlSupervisor supervisor({}, params, {}, kind);
  artus::PneumaticPlant plant(params, artus::ValveLayout::two);
  artus::ProbeSensors sensors(params.sensors, 1);
  artus::ProbeTarget target;
  std::vector<double> us;
  us.reserve(kTicks);
  for (std::size_t i = 0; i < kTicks; ++i) {
    const artus::ProbeMeasurement measured = sensors.read(plant);
    target.stiffness = 800 + static_cast<double>(i % 20000) * 0.1;
    const double start = thread_time();
    const artus::ControlTick& tick = supervisor.step(measured, target);
    us.push_back(thread_time() - start);
    artus::RodLoad load;
    load.force = static_cast<double>(i % 10000) * 1e-3;
    plant.step(tick.command, load, supervisor.period());
  }
  return us;
}

void bench_law(artus::ControlLawKind kind) {
  std::vector<double> us = run_law(kind);
  std::vector<double> least = us;
  for (int repeat = 0; repeat < 2; ++repeat) {
    const std::vector<double> again = run_law(kind);
    for (std::size_t i = 0; i < least.size(); ++i) least[i] = std::min(least[i], again[i]);
  }
  print(artus::to_string(kind), us);
  print("  least of three runs", least);
}

void bench_contact() {
  constexpr std::size_t kTicks = 20000;
  const std::vector<artus::test::SphereLayer> layers{
      {"skin", 0.060}, {"fat", 0.058}, {"muscle", 0.052}, {"bone", 0.030}};
  auto joint = std::make_shared<const artus::CompiledJoint>(
      artus::test::make_nested_spheres(layers, artus::Vec3::Zero(), 5));
  const std::size_t triangles = joint->mesh.interfaces.size();
  artus::ProbeContactModel model(std::make_shared<const artus::Scene>(joint), {});
  std::vector<double> us;
  us.reserve(kTicks);
  for (std::size_t i = 0; i < kTicks; ++i) {
    const double turn = 1e-4 * static_cast<double>(i);
    const artus::Vec3 out(std::sin(turn), 0, -std::cos(turn));
    const double push = 2e-3 + 1e-6 * static_cast<double>(i % 2000);
    const artus::Pose X_JP = artus::make_pose((0.060 - push) * out, -out, artus::Vec3::UnitX());
    const double start = thread_time();
    static_cast<void>(model.step(X_JP));
    us.push_back(thread_time() - start);
  }
  std::printf("%zu triangles, %zu columns\n", triangles,
              model.params().footprint.columns_x * model.params().footprint.columns_y);
  print("probe contact", us);
}

}  // namespace

int main() {
  for (std::size_t i = 0; i < artus::kControlLaws; ++i) {
    bench_law(static_cast<artus::ControlLawKind>(i));
  }
  bench_contact();
  return 0;
}
