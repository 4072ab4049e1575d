// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/control_law.h"

#include <array>
#include <string>

#include "artus/detail/core/known_names.h"
#include "artus/detail/haptics/actuator/backstepping_law.h"
#include "artus/detail/haptics/actuator/ipc_law.h"
#include "artus/detail/haptics/actuator/pid_law.h"

namespace artus {
namespace {

constexpr std::array<std::string_view, kControlLaws> kNames{"pid",
                                                            "admittance-pid",
                                                            "ipc",
                                                            "admittance-ipc",
                                                            "backstepping-one-valve",
                                                            "backstepping-two-valves"};

}  // namespace

const char* to_string(ControlLawKind kind) noexcept {
  return kNames[static_cast<std::size_t>(kind)].data();
}

Result<ControlLawKind> find_control_law(std::string_view name) {
  return find_name(kNames, name, "control law").map([](std::size_t at) {
    return static_cast<ControlLawKind>(at);
  });
}

bool needs_force_sensor(ControlLawKind kind) noexcept {
  return kind == ControlLawKind::admittance_pid || kind == ControlLawKind::admittance_ipc;
}

std::unique_ptr<ControlLaw> make_control_law(ControlLawKind kind, const ControlParams& control,
                                             const PneumaticParams& plant, const ValveMap& map) {
  ARTUS_REQUIRE(control.rate > 0, "the control rate must be positive");
  switch (kind) {
    case ControlLawKind::pid:
      return std::make_unique<PidLaw>(control, plant.valve, false);
    case ControlLawKind::admittance_pid:
      return std::make_unique<PidLaw>(control, plant.valve, true);
    case ControlLawKind::ipc:
      return std::make_unique<IpcLaw>(control, plant.valve, false);
    case ControlLawKind::admittance_ipc:
      return std::make_unique<IpcLaw>(control, plant.valve, true);
    case ControlLawKind::backstepping_one_valve:
      return std::make_unique<BacksteppingLaw>(control, plant, map, false);
    case ControlLawKind::backstepping_two_valves:
      return std::make_unique<BacksteppingLaw>(control, plant, map, true);
  }
  ARTUS_REQUIRE(false, "unknown control law");
  return nullptr;
}

}  // namespace artus
