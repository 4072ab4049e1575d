// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>
#include <thread>

#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/session/session_thread.h"
#include "artus/detail/session/shm/shared_memory.h"

namespace artus {
namespace {

struct MonitorOptions {
  std::string prefix;
  double seconds = 0;
  double every = 0.5;
  bool clean = false;
  bool json = false;
};

struct Observed {
  std::string name;
  bool found = false;
  std::string trouble;
  std::uint64_t heartbeat = 0;
  std::uint64_t writer = 0;
};

Observed look_at(const std::string& prefix, const SegmentLayout& layout) {
  Observed seen;
  seen.name = prefix + layout.name;
  const auto segment = SharedSegment::open(prefix, layout, SegmentAccess::observer);
  seen.found = segment.has_value();
  if (!segment) {
    seen.trouble = segment.error().message;
    return seen;
  }
  seen.heartbeat = segment->heartbeat();
  seen.writer = segment->writer_pid();
  return seen;
}

nlohmann::json newest_force(const std::string& prefix) {
  const auto channel =
      SharedChannel<artus_shm_force>::open(prefix, kForceLayout, SegmentAccess::observer);
  artus_shm_force f{};
  if (!channel || !channel->read(f)) return nullptr;
  const auto age = monotonic_ns() - static_cast<std::int64_t>(f.time_ns);
  f.layer_name[sizeof f.layer_name - 1] = '\0';
  return {{"tick", f.tick},
          {"force_n", f.force},
          {"torque_nm", f.torque},
          {"status", f.status},
          {"contact", f.contact},
          {"layer", std::string(f.layer_name)},
          {"depth_m", f.depth},
          {"probe_force_n", f.probe_force},
          {"probe_torque_nm", f.probe_torque},
          {"probe_share", f.probe_share},
          {"probe_status", f.probe_status},
          {"tissue_age_ms", 1e-3 * f.tissue_age_us},
          {"pos_sample", f.pos_sample},
          {"probe_sample", f.probe_sample},
          {"age_ms", 1e-6 * static_cast<double>(age)}};
}

nlohmann::json newest_pos(const std::string& prefix, const SegmentLayout& layout) {
  const auto channel = SharedChannel<artus_shm_pos>::open(prefix, layout, SegmentAccess::observer);
  artus_shm_pos p{};
  if (!channel || !channel->read(p)) return nullptr;
  const auto age = monotonic_ns() - static_cast<std::int64_t>(p.time_ns);
  return {{"sample", p.sample},
          {"needle_position_m", p.needle_position},
          {"needle_rotation", p.needle_rotation},
          {"probe_position_m", p.probe_position},
          {"probe_rotation", p.probe_rotation},
          {"buttons", p.buttons},
          {"present", p.present},
          {"hold_ms", p.hold_ms},
          {"age_ms", 1e-6 * static_cast<double>(age)}};
}

nlohmann::json observe(const std::string& prefix) {
  auto segments = nlohmann::json::array();
  for (const SegmentLayout& layout : kAllLayouts) {
    const Observed seen = look_at(prefix, layout);
    segments.push_back({{"name", seen.name},
                        {"found", seen.found},
                        {"trouble", seen.trouble},
                        {"heartbeat", seen.heartbeat},
                        {"writer_pid", seen.writer}});
  }
  return {{"segments", segments},
          {"pos", newest_pos(prefix, kPosLayout)},
          {"pos_probe", newest_pos(prefix, kProbePosLayout)},
          {"force", newest_force(prefix)}};
}

void print(const nlohmann::json& seen) {
  for (const auto& s : seen["segments"]) {
    if (s["found"].get<bool>())
      std::printf("%-12s heartbeat %-12llu writer %llu\n", s["name"].get<std::string>().c_str(),
                  s["heartbeat"].get<unsigned long long>(),
                  s["writer_pid"].get<unsigned long long>());
    else
      std::printf("%-12s %s\n", s["name"].get<std::string>().c_str(),
                  s["trouble"].get<std::string>().c_str());
  }
  for (const char* part : {"pos", "pos_probe", "force"}) {
    if (!seen[part].is_null()) std::printf("%-12s %s\n", part, seen[part].dump().c_str());
  }
  std::printf("\n");
}

ExitCode run_monitor(const MonitorOptions& options) {
  if (options.clean) {
    for (const SegmentLayout& layout : kAllLayouts) SharedSegment::remove(options.prefix, layout);
    return ExitCode::ok;
  }
  const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(options.seconds * 1e9);
  for (;;) {
    const nlohmann::json seen = observe(options.prefix);
    if (options.json)
      std::cout << seen.dump() << std::endl;
    else
      print(seen);
    if (monotonic_ns() >= end) break;
    std::this_thread::sleep_for(std::chrono::duration<double>(options.every));
  }
  return ExitCode::ok;
}

}  // namespace

void add_shm_monitor_command(Command& serve, ExitCode& code) {
  auto options = std::make_shared<MonitorOptions>();
  Command* command =
      add_command(serve, "monitor",
                  "Look at the shared memory POS, POS-PROBE, FORCE and IMAGE without touching it",
                  "Examples:\n"
                  "  artus serve monitor                      once\n"
                  "  artus serve monitor --seconds 60 --json  a line every half second\n"
                  "  artus serve monitor --clean              remove what a crash left behind");
  add_prefix_option(command, options->prefix);
  command->add_option("--seconds", options->seconds, "go on for this time")
      ->check(number_in(0, 86400));
  command->add_option("--every", options->every, "s between two looks")
      ->check(number_in(0.01, 3600))
      ->capture_default_str();
  command->add_flag("--clean", options->clean, "remove the names; running programs keep theirs");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_monitor(*options); });
}

}  // namespace artus
