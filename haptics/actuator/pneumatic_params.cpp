// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/pneumatic_params.h"

#include <array>

#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_fields.h"
#include "artus/detail/haptics/actuator/pneumatic_bundled.h"

namespace artus {
namespace {

constexpr std::array<TomlField<CylinderParams>, 10> kCylinderFields{{
    {"moving_mass_kg", &CylinderParams::moving_mass, 1e-3, 100},
    {"area_p_m2", &CylinderParams::area_P, 1e-7, 0.1},
    {"area_n_m2", &CylinderParams::area_N, 1e-7, 0.1},
    {"dry_friction_n", &CylinderParams::dry_friction, 0, 1000},
    {"viscous_friction_n_s_m", &CylinderParams::viscous_friction, 0, 1e5},
    {"stroke_m", &CylinderParams::stroke, 1e-3, 2},
    {"travel_m", &CylinderParams::travel, 1e-4, 1},
    {"polytropic", &CylinderParams::polytropic, 1, 5.0 / 3},
    {"gas_constant_j_kg_k", &CylinderParams::gas_constant, 10, 5000},
    {"temperature_k", &CylinderParams::temperature, 200, 400},
}};
constexpr std::array<TomlField<ServovalveParams>, 9> kValveFields{{
    {"sonic_conductance_m3_s_pa", &ServovalveParams::sonic_conductance, 1e-12, 1e-5},
    {"critical_ratio", &ServovalveParams::critical_ratio, 0, 0.9},
    {"laminar_ratio", &ServovalveParams::laminar_ratio, 0.9, 0.9999},
    {"centre_opening", &ServovalveParams::centre_opening, 1e-4, 0.2},
    {"spool_frequency_hz", &ServovalveParams::spool_frequency, 1, 5000},
    {"centre_voltage_v", &ServovalveParams::centre_voltage, 0, 24},
    {"voltage_span_v", &ServovalveParams::voltage_span, 0.1, 24},
    {"supply_pa", &ServovalveParams::supply, 1e4, 2e6},
    {"exhaust_pa", &ServovalveParams::exhaust, 1e3, 2e6},
}};
constexpr std::array<TomlField<SensorParams>, 4> kSensorFields{{
    {"noise", &SensorParams::noise, 0, 1e6},
    {"step", &SensorParams::step, 0, 1e6},
    {"low", &SensorParams::low, -1e7, 1e7},
    {"high", &SensorParams::high, -1e7, 1e7},
}};

template <class Fields, class Group>
void read_group(const toml::table* table, const Fields& fields, const std::string& what,
                Problems& problems, Group& group) {
  if (table == nullptr) return;
  TomlTable reader(*table, what, problems);
  read_fields(reader, fields, group);
  reader.finish();
}

void read_sensors(const toml::table* table, Problems& problems, ProbeSensorParams& sensors) {
  if (table == nullptr) return;
  TomlTable reader(*table, "sensors", problems);
  read_group(reader.table("pressure"), kSensorFields, "sensors.pressure", problems,
             sensors.pressure);
  read_group(reader.table("position"), kSensorFields, "sensors.position", problems,
             sensors.position);
  read_group(reader.table("force"), kSensorFields, "sensors.force", problems, sensors.force);
  reader.finish();
}

/// What only several values together can get wrong.
void check_together(const PneumaticParams& p, TomlTable& reader) {
  if (p.cylinder.travel >= p.cylinder.stroke / 2) {
    reader.problem("travel_m must be less than half of stroke_m, or a chamber would vanish");
  }
  if (p.valve.exhaust >= p.valve.supply) reader.problem("exhaust_pa must be below supply_pa");
  for (const SensorParams* s : {&p.sensors.pressure, &p.sensors.position, &p.sensors.force}) {
    if (!(s->low < s->high)) reader.problem("a sensor's low must be below its high");
  }
}

}  // namespace

Result<PneumaticParams> parse_pneumatic_params(std::string_view text, const std::string& name) {
  const auto table = parse_toml(text, name);
  ARTUS_TRY(table);
  Problems problems;
  TomlTable reader(*table, "probe mock", problems);
  PneumaticParams params;
  static_cast<void>(reader.required_number("format", 1, 1));
  static_cast<void>(reader.text("name"));
  read_group(reader.table("cylinder"), kCylinderFields, "cylinder", problems, params.cylinder);
  read_group(reader.table("valve"), kValveFields, "valve", problems, params.valve);
  read_sensors(reader.table("sensors"), problems, params.sensors);
  reader.finish();
  check_together(params, reader);
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
  return params;
}

Result<PneumaticParams> read_pneumatic_params(const std::filesystem::path& file) {
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  return parse_pneumatic_params(*text, file.string());
}

Result<PneumaticParams> read_bundled_pneumatic_params() {
  return parse_pneumatic_params(kBundledPneumaticProbe, "devices/pneumatic_probe.toml");
}

}  // namespace artus
