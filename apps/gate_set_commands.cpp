// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/evidence/validation/injection/injection_gates.h"
#include "artus/detail/evidence/validation/soft/soft_gates.h"

namespace artus {
namespace {

struct GateSetOptions {
  std::vector<std::string> only;
  std::filesystem::path joint;
  std::filesystem::path out;
  bool json = false;
};

ExitCode run_gate_set(const GateSet& set, const GateSetOptions& options) {
  std::vector<std::string> names = options.only;
  if (names.empty()) {
    for (const std::string_view name : item_names(set.gates)) names.emplace_back(name);
    if (!options.joint.empty())
      for (const std::string_view name : item_names(set.joint_gates)) names.emplace_back(name);
  }
  const Progress progress = make_progress_printer(options.json);
  std::shared_ptr<const CompiledJoint> joint;
  if (!options.joint.empty()) {
    JointOptions joint_options;
    joint_options.joint = options.joint;
    auto loaded = load(joint_options, progress);
    if (!loaded) return report_error(loaded.error(), options.json);
    joint = std::move(*loaded);
  }
  std::vector<Gate> gates;
  for (const std::string& name : names) {
    if (progress)
      progress(name, static_cast<double>(gates.size()) / static_cast<double>(names.size()));
    auto gate = run_gate(set, name, joint);
    if (!gate) {
      Error error = gate.error();
      error.where = "--only";
      return report_error(error, options.json);
    }
    gates.push_back(std::move(*gate));
  }
  const EvidenceReport report = report_of(set, gates);
  if (const auto written = write_report(report, options.out); !written)
    return report_error(written.error(), options.json);
  if (options.json) {
    std::cout << verdict(report).dump(2) << '\n';
  } else {
    for (const Claim& claim : report.claims) std::printf("%s\n", to_line(claim).c_str());
    std::printf("report.md, verdict.json in %s\n%s\n", options.out.c_str(),
                count_claims(report.claims).c_str());
  }
  return all_hold(report.claims) ? ExitCode::ok : ExitCode::failed;
}

/// `artus <set's name>`; `two` are gates for the second example.
void add_gate_set_command(Command& app, ExitCode& code, const GateSet& set,
                          const std::string& description, const std::string& two) {
  auto options = std::make_shared<GateSetOptions>();
  const std::string name(set.name);
  const std::string of_joint =
      set.joint_gates.empty() ? "" : "\n  artus " + name + " -j meshes/shoulder --out out/gates";
  Command* command = add_command(app, name, description,
                                 "Gates: " + listed(gate_names(set)) +
                                     "\nExit code 1 when a value is out of its bound.\n"
                                     "Examples:\n"
                                     "  artus " +
                                     name + " --out out/gates\n  artus " + name + " " + two +
                                     " --out out/gates --json" + of_joint);
  command->add_option("--only", options->only, "a gate, may be given several times (default: all)");
  if (!set.joint_gates.empty())
    command->add_option("--joint,-j", options->joint,
                        "joint folder or compiled .artus file: measures " +
                            listed(item_names(set.joint_gates)) + ", too (default: no joint)");
  command->add_option("-o,--out", options->out, "folder for the report")->required();
  command->add_flag("--json", options->json, "print the verdicts as JSON");
  on_run(command, code, [options, &set] { return run_gate_set(set, *options); });
}

}  // namespace

void add_soft_gates_command(Command& app, ExitCode& code) {
  add_gate_set_command(
      app, code, soft_gates(),
      "Measure the mechanics of the tissue that gives way, with a verdict on each value",
      "--only layers --only punch");
}

void add_injection_gates_command(Command& app, ExitCode& code) {
  add_gate_set_command(
      app, code, injection_gates(),
      "Measure syringe, needle and the places that liquid goes to, with a verdict on each value",
      "--only hand --only loss");
}

}  // namespace artus
