// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>

#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_fields.h"
#include "artus/haptics/device.h"

namespace artus {
namespace {

constexpr double kMillimetreInSi = 1e-3;

/// What a file says of one hand.
struct HandTable {
  double force = 0;        // N
  double torque = 0;       // N m
  double mass = 0.1;       // kg
  double damping = 1;      // N s/m
  double encoder = 10e-6;  // m
  Vec3 centre = Vec3::Zero();
  Vec3 half = Vec3::Constant(std::numeric_limits<double>::infinity());
};

// The most that FORCE carries: the client refuses more (ARTUS_SHM_MAX_FORCE, _TORQUE).
constexpr std::array<TomlField<HandTable>, 5> kFields{{
    {"force_n", &HandTable::force, 0.01, 100, 1, true},
    {"torque_nm", &HandTable::torque, 0, 10},
    {"mass_kg", &HandTable::mass, 1e-3, 50},
    {"damping_n_s_m", &HandTable::damping, 0, 1000},
    {"encoder_step_mm", &HandTable::encoder, 1e-6, 5, kMillimetreInSi},
}};

HandTable read_hand(const toml::table& table, const std::string& what, Problems& problems) {
  HandTable hand;
  TomlTable reader(table, what, problems);
  read_fields(reader, kFields, hand);
  const auto box = reader.vector("workspace_mm", kMillimetreInSi);
  const auto centre = reader.vector("centre_mm", kMillimetreInSi);
  if (box && !(box->minCoeff() > 0 && box->maxCoeff() <= 10))
    reader.problem_at("workspace_mm", "workspace_mm must be three edges above 0 and up to 10 m");
  if (centre && !box)
    reader.problem_at("centre_mm", "centre_mm is the middle of workspace_mm, which is missing");
  if (centre && !(centre->cwiseAbs().maxCoeff() <= 10))
    reader.problem_at("centre_mm", "centre_mm must be within 10 m");
  if (box) hand.half = *box / 2;
  if (centre) hand.centre = *centre;
  reader.finish();
  return hand;
}

DeviceLimits to_limits(const HandTable& needle, const HandTable& probe) {
  DeviceLimits device;
  device.force = needle.force;
  device.torque = needle.torque;
  device.mass = needle.mass;
  device.damping = needle.damping;
  device.encoder_step = needle.encoder;
  if (needle.half.allFinite()) device.workspace = 2 * needle.half;
  device.needle_centre = needle.centre;
  device.needle_half = needle.half;
  device.probe_force = probe.force;
  device.probe_torque = probe.torque;
  device.probe_centre = probe.centre;
  device.probe_half = probe.half;
  return device;
}

}  // namespace

Result<DeviceLimits> parse_device_file(std::string_view text, const std::string& name) {
  const auto table = parse_toml(text, name);
  ARTUS_TRY(table);
  Problems problems;
  TomlTable reader(*table, "device", problems);
  static_cast<void>(reader.required_number("format", 1, 1));
  const std::string called = reader.required_text("name");
  const toml::table* needle = reader.table("needle");
  const toml::table* probe = reader.table("probe");
  if (needle == nullptr)
    reader.problem("[needle] is missing: it has force_n, and torque_nm where the device has one");
  HandTable of_needle;
  if (needle != nullptr) of_needle = read_hand(*needle, "needle", problems);
  HandTable of_probe = of_needle;
  of_probe.centre = Vec3::Zero();
  of_probe.half = HandTable{}.half;
  if (probe != nullptr) of_probe = read_hand(*probe, "probe", problems);
  reader.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
  DeviceLimits device = to_limits(of_needle, of_probe);
  device.name = called;
  return device;
}

Result<DeviceLimits> read_device_file(const std::filesystem::path& file) {
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  return parse_device_file(*text, file.string());
}

}  // namespace artus
