// SPDX-License-Identifier: AGPL-3.0-or-later
// Every parameter of every law, of the guards, the probe's contact and the pneumatic probe is
// changed by 5 %, one at a time, in the scenarios whose traces are kept as goldens: each must be
// noticed. ARTUS_MUTATION_TABLE names a file for the whole table as JSON.
#include <map>

#include <gtest/gtest.h>

#include "artus/detail/core/csv.h"
#include "artus/detail/haptics/actuator/control_law_supervisor.h"
#include "artus/detail/haptics/probe/probe_contact_fields.h"
#include "tests/mutations/actuator_fields.h"
#include "tests/mutations/mutations.h"
#include "tests/support/layered_body.h"

namespace artus::test {
namespace {

TEST(Mutations, EveryParameterOfTheNeedlesForcesIsNoticed) {
  const std::string kHard = "a hard layer is neither pierced nor cut, nor does it hold the shaft";
  const std::string kProbe = "the probe's hand: SessionCore.TheProbesForceSaysWhenItIsHeldBack";
  const std::string kBox = "a session's border: tests of device files";
  std::vector<Subject<ForceSetup>> subjects;
  for (const ForceScenario& scenario : make_force_scenarios())
    subjects.push_back({scenario.name, scenario.setup, [scenario](const ForceSetup& setup) {
                          return trace_lines(scenario, setup);
                        }});
  expect_noticed("needle", try_mutations(subjects),
                 {{"device.workspace", "shown to people; no force depends on it"},
                  {"device.probe_force", kProbe},
                  {"device.probe_torque", kProbe},
                  {"device.needle_centre", kBox},
                  {"device.needle_half", kBox},
                  {"device.probe_centre", kBox},
                  {"device.probe_half", kBox},
                  {"needle.contact.behind_skin",
                   "room for rounding: the query begins before the skin, where nothing is felt"},
                  {"bone.attracted_force", kHard},
                  {"bone.friction", kHard},
                  {"bone.puncture_force", kHard},
                  {"bone.cutting_law", kHard},
                  {"bone.prepuncture_law", kHard}});
}

// ---- the probe on the skin

struct ProbeStroke {
  double depth = 0;  // m of the face below the skin
  double side = 0;   // m
  double tilt = 0;   // rad
};

std::vector<std::string> probe_trace(const Scene& scene, const ProbeContactParams& params,
                                     const ProbeStroke& to) {
  constexpr int kSteps = 40;
  ProbeContactModel model(std::shared_ptr<const Scene>(std::shared_ptr<void>(), &scene), params);
  std::vector<std::string> lines{
      "normal,fx,fy,fz,tx,ty,tz,edge_x,edge_z,turning_y,friction_x,slip,stiffness,indentation,"
      "share,elements,coverage,status"};
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    const Vec3 axis(std::sin(share * to.tilt), 0, std::cos(share * to.tilt));
    const Vec3 p(share * to.side, 0.3 * share * to.side, -1e-3 + share * (to.depth + 1e-3));
    const ProbeContact& c = model.step(make_pose(p, axis, Vec3::UnitX()));
    double covered = 0;
    for (std::size_t e = 0; e < model.coverage().size(); ++e)
      covered += (1 + static_cast<double>(e)) * static_cast<double>(model.coverage()[e]);
    std::string line;
    for (const double v :
         {c.normal_force, c.wrench.force.x(), c.wrench.force.y(), c.wrench.force.z(),
          c.wrench.torque.x(), c.wrench.torque.y(), c.wrench.torque.z(), c.edge_force.x(),
          c.edge_force.z(), c.turning.y(), c.friction.x(), c.slip, c.stiffness, c.indentation,
          c.contact_share, static_cast<double>(model.coverage().size()), covered})
      line += to_csv(v) + ',';
    lines.push_back(line + std::to_string(c.status));
  }
  return lines;
}

TEST(Mutations, EveryParameterOfTheProbesContactIsNoticed) {
  auto tissues = make_test_tissues();
  tissues[0].mechanical.youngs_modulus = 0;  // "gel" inside the body: a tissue without a value
  const std::vector<FlatLayer> soft{{"skin", 2e-3}, {"gel", 1e-3}, {"muscle", 40e-3}};
  const std::vector<FlatLayer> thin{{"skin", 2e-3}, {"muscle", 3e-3}, {"bone", 30e-3}};
  const auto scene_of = [&tissues](const std::vector<FlatLayer>& layers, double width) {
    return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(
        artus::make_layered_block(tissues, layers, width, width)));
  };
  const auto wide = scene_of(soft, 0.2);
  const auto bony = scene_of(thin, 0.2);
  const auto askew =
      std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(make_block_with_sphere(
          {"muscle", Vec3(0.16, 0.1, 0.1), Vec3::Zero(), "bone", Vec3(5e-3, 4e-3, 25e-3), 0.015})));
  const auto narrow = scene_of(soft, 0.03);  // skin ends under the face
  const auto subject = [](const std::string& name, const std::shared_ptr<const Scene>& scene,
                          const ProbeStroke& to, ProbeContactParams params = {}) {
    return Subject<ProbeContactParams>{name, params, [scene, to](const ProbeContactParams& p) {
                                         return probe_trace(*scene, p, to);
                                       }};
  };
  ProbeContactParams dry;
  dry.gel = false;
  expect_noticed(
      "probe",
      try_mutations<ProbeContactParams>(
          {subject("press", wide, {6e-3, 0, 0}), subject("slide", wide, {4e-3, 20e-3, 0}),
           subject("askew", askew, {6e-3, 2e-3, 0.1}), subject("tilt", wide, {3e-3, 5e-3, 0.3}),
           subject("bone", bony, {4.5e-3, 0, 0}), subject("edge", narrow, {3e-3, 5e-3, 0}),
           subject("deep", wide, {32e-3, 0, 0}), subject("dry", wide, {4e-3, 20e-3, 0}, dry)}),
      {});
}

// ---- the pneumatic probe

std::vector<std::string> actuator_trace(const ActuatorSetup& setup, ControlLawKind kind,
                                        bool two_valves) {
  PneumaticPlant plant(setup.plant, two_valves ? ValveLayout::two : ValveLayout::one);
  ProbeSensors sensors(setup.plant.sensors, 5);
  ControlSupervisor supervisor(setup.control, setup.plant, setup.supervisor, kind);
  std::vector<std::string> lines{"t,y,v,p_P,p_N,u_P,u_N,force,reference,status"};
  std::uint32_t status = 0;
  constexpr double kEnd = 2.6;  // s
  const auto n = static_cast<long>(kEnd / supervisor.period());
  for (long i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) * supervisor.period();
    RodLoad load;
    load.mass = 0.2;
    load.force = t < 0.8 ? 12 * t : (t < 1.4 ? 60 : 3);  // an overload, too
    ProbeTarget target;
    target.y = t > 1.8 || t < 0.6 ? 5e-3 : 0;
    target.stiffness = 900;
    if (t > 2) plant.set_supply(t < 2.3 ? 1.2e5 : setup.plant.valve.supply);
    const bool broken = t > 2.4;
    sensors.set_fault(ProbeSensor::force, broken ? SensorFault::stuck : SensorFault::none);
    sensors.set_fault(ProbeSensor::position, broken ? SensorFault::stuck : SensorFault::none);
    const ControlTick& tick = supervisor.step(sensors.read(plant), target);
    plant.step(tick.command, load, supervisor.period());
    if (i % 100 != 0 && tick.status == status) continue;
    status = tick.status;
    const CylinderState& s = plant.state();
    std::string line;
    for (const double v : {t, s.y * 1e3, s.v * 1e3, s.p_P, s.p_N, tick.command.u_P,
                           tick.command.u_N, plant.contact_force(), tick.reference * 1e3})
      line += to_csv(v) + ',';
    lines.push_back(line + std::to_string(tick.status));
  }
  return lines;
}

TEST(Mutations, EveryParameterOfTheActuatorIsNoticed) {
  std::vector<Subject<ActuatorSetup>> subjects;
  const auto add = [&subjects](const std::string& name, ActuatorSetup setup, ControlLawKind kind) {
    setup.control.rate = 2500;
    subjects.push_back({name, setup, [kind](const ActuatorSetup& s) {
                          return actuator_trace(s, kind,
                                                kind != ControlLawKind::backstepping_one_valve);
                        }});
  };
  for (const ControlLawKind kind :
       {ControlLawKind::admittance_pid, ControlLawKind::admittance_ipc,
        ControlLawKind::backstepping_one_valve, ControlLawKind::backstepping_two_valves})
    add(to_string(kind), {}, kind);
  ActuatorSetup fixed;
  fixed.control.backstepping.from_target = false;
  add("fixed gains", fixed, ControlLawKind::backstepping_two_valves);
  // Limits near enough to be reached.
  ActuatorSetup limits;
  limits.control.pid.integral = 300;
  limits.control.pid.integral_limit = 0.3;
  limits.control.backstepping.z_3i_limit = 0.02;
  limits.supervisor.stop_margin = 8e-3;
  add("limited pid", limits, ControlLawKind::admittance_pid);
  add("limited backstepping", limits, ControlLawKind::backstepping_one_valve);
  ActuatorSetup narrow;
  narrow.plant.sensors.position.low = -2e-3;
  add("narrow position", narrow, ControlLawKind::admittance_pid);
  narrow = {};
  narrow.plant.sensors.pressure.low = 1.8e5;
  narrow.plant.sensors.pressure.high = 3.1e5;
  add("narrow pressure", narrow, ControlLawKind::admittance_pid);
  narrow = {};
  narrow.plant.sensors.position.high = -0.5e-3;  // lost until the load has pushed the rod in
  add("narrow stroke", narrow, ControlLawKind::admittance_pid);
  narrow = {};
  narrow.plant.sensors.force.low = 4;
  add("narrow force", narrow, ControlLawKind::admittance_pid);
  expect_noticed("actuator", try_mutations(subjects), {});
}

}  // namespace
}  // namespace artus::test
