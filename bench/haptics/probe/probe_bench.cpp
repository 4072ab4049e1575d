// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: how long do one control tick of the pneumatic mock (sensor checks, estimate, law, valve
// inversion) and one tick of the probe's contact take?
// Command: cmake --preset release -B build/release && ninja -C build/release bench_probe &&
//   build/release/bench/haptics/bench_probe [--busy] [--contact] [joint.artus ...]
// Reading: microseconds of wall time per tick, as a deadline sees them; the clock itself takes
// about 0.03 us. Percentiles, never means. On a busy machine interrupts are charged to the tick:
// --busy takes the least of three identical runs per tick, which keeps what the tick's own work
// costs; --contact leaves the control ticks out. Peer: none is known for the laws; the budget is
// p99.9 <= 10 us a control tick, and 1000 us for the contact's tick at 1 kHz, on nested spheres and
// on each compiled joint that is named.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "artus/detail/haptics/actuator/control_law_supervisor.h"
#include "artus/detail/haptics/actuator/pneumatic_plant.h"
#include "artus/detail/haptics/probe/probe_contact.h"
#include "tests/support/layered_body.h"

namespace {

using Clock = std::chrono::steady_clock;

double microseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

void print(const std::string& name, std::vector<double>& us) {
  std::sort(us.begin(), us.end());
  const auto at = [&us](double share) {
    return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  };
  std::printf("%-34s %8zu ticks  p50 %7.2f  p99 %7.2f  p99.9 %7.2f  max %8.2f us\n", name.c_str(),
              us.size(), at(0.5), at(0.99), at(0.999), us.back());
  std::fflush(stdout);
}

/// One run of the mock under a law; the same work tick by tick every time.
std::vector<double> run_law(artus::ControlLawKind kind) {
  constexpr std::size_t kTicks = 1000000;
  const artus::PneumaticParams params;
  artus::ControlSupervisor supervisor({}, params, {}, kind);
  artus::PneumaticPlant plant(params, artus::ValveLayout::two, 1e-4);
  artus::ProbeSensors sensors(params.sensors, 1);
  artus::ProbeTarget target;
  std::vector<double> us;
  us.reserve(kTicks);
  for (std::size_t i = 0; i < kTicks; ++i) {
    const artus::ProbeMeasurement measured = sensors.read(plant);
    target.stiffness = 800 + static_cast<double>(i % 20000) * 0.1;
    const auto start = Clock::now();
    const artus::ControlTick& tick = supervisor.step(measured, target);
    us.push_back(microseconds_since(start));
    artus::RodLoad load;
    load.force = static_cast<double>(i % 10000) * 1e-3;
    plant.step(tick.command, load, supervisor.period());
  }
  return us;
}

void bench_law(artus::ControlLawKind kind, bool busy) {
  std::vector<double> us = run_law(kind);
  for (int repeat = 0; busy && repeat < 2; ++repeat) {
    const std::vector<double> again = run_law(kind);
    for (std::size_t i = 0; i < us.size(); ++i) us[i] = std::min(us[i], again[i]);
  }
  print(artus::to_string(kind), us);
}

/// The skin below a probe that looks along +z of X_JP; X_JP itself when there is none.
artus::Pose seat(const artus::Scene& scene, artus::Pose X_JP) {
  constexpr double kReach = 0.06;  // m
  const artus::Vec3 z = X_JP.linear().col(2);
  const artus::Vec3 start = X_JP.translation() - kReach * z;
  for (const auto& s : artus::tissue_intervals(scene, {start, start + 2 * kReach * z})) {
    if (s.region == artus::kOutside) continue;
    X_JP.translation() = start + s.entry * z;
    break;
  }
  return X_JP;
}

/// Slides 30 mm to and fro over the skin around `rest`, pressed 0 to 6 mm in.
void bench_contact(const std::string& name,
                   const std::shared_ptr<const artus::CompiledJoint>& joint,
                   const artus::Pose& rest) {
  constexpr std::size_t kTicks = 50000;
  const auto scene = std::make_shared<const artus::Scene>(joint);
  artus::ProbeContactModel model(scene, {});
  std::vector<artus::Pose> path;
  for (std::size_t i = 0; i < kTicks; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    artus::Pose X_JP = rest;
    X_JP.translation() += 0.015 * (std::sin(2.1 * t) * rest.linear().col(0) +
                                   std::sin(1.3 * t) * rest.linear().col(1));
    X_JP = seat(*scene, X_JP);
    X_JP.translation() += 0.003 * (1 - std::cos(5 * t)) * rest.linear().col(2);
    path.push_back(X_JP);
  }
  std::vector<double> us;
  us.reserve(kTicks);
  double share = 0;
  double stiffest = 0;
  for (const artus::Pose& X_JP : path) {
    const auto start = Clock::now();
    const artus::ProbeContact& contact = model.step(X_JP);
    us.push_back(microseconds_since(start));
    share += contact.contact_share / static_cast<double>(kTicks);
    stiffest = std::max(stiffest, contact.stiffness);
  }
  print("probe contact, " + name, us);
  std::printf("  %zu triangles, %zu columns, mean contact share %.2f, K_c up to %.0f N/m\n",
              joint->mesh.interfaces.size(),
              model.params().footprint.columns_x * model.params().footprint.columns_y, share,
              stiffest);
}

void bench_spheres() {
  const std::vector<artus::test::SphereLayer> layers{
      {"skin", 0.060}, {"fat", 0.058}, {"muscle", 0.052}, {"bone", 0.030}};
  bench_contact("nested spheres",
                std::make_shared<const artus::CompiledJoint>(
                    artus::test::make_nested_spheres(layers, artus::Vec3::Zero(), 5)),
                artus::make_pose({0, 0, -0.060}, artus::Vec3::UnitZ(), artus::Vec3::UnitX()));
}

}  // namespace

int main(int argc, char** argv) {
  bool busy = false;
  bool laws = true;
  std::vector<std::string> joints;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--busy") == 0) {
      busy = true;
    } else if (std::strcmp(argv[i], "--contact") == 0) {
      laws = false;
    } else {
      joints.emplace_back(argv[i]);
    }
  }
  for (std::size_t i = 0; laws && i < artus::kControlLaws; ++i) {
    bench_law(static_cast<artus::ControlLawKind>(i), busy);
  }
  bench_spheres();
  for (const std::string& file : joints) {
    auto joint = artus::read_compiled_joint(file);
    if (!joint) {
      std::fprintf(stderr, "%s\n", joint.error().to_string().c_str());
      return 1;
    }
    const artus::Pose rest = joint->X_JP_default;
    const std::string name = joint->name;
    bench_contact(name, std::make_shared<const artus::CompiledJoint>(std::move(*joint)), rest);
  }
  return 0;
}
