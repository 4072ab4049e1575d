// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/evidence/validation/echo/echo_gates.h"
#include "artus/detail/evidence/validation/echo/echo_patch.h"

namespace artus {
namespace {

struct EchoGatesOptions {
  std::vector<std::string> only;
  std::filesystem::path out;
  std::filesystem::path joint;
  std::filesystem::path reference;
  std::vector<std::string> reference_rows;
  bool json = false;
};

void print(const EchoGate& gate) {
  std::printf("%s\n", gate.name.c_str());
  for (const Claim& claim : gate.claims) std::printf("  %s\n", to_line(claim).c_str());
  if (!gate.assumed.empty()) std::printf("  assumed: %s\n", gate.assumed.c_str());
}

Result<std::vector<EchoGate>> measure(const EchoGatesOptions& options, const Progress& progress) {
  std::vector<std::string> names = options.only;
  if (names.empty()) names.assign(echo_gates().begin(), echo_gates().end());
  std::vector<EchoGate> gates;
  for (const std::string& name : names) {
    if (progress)
      progress(name, static_cast<double>(gates.size()) / static_cast<double>(names.size()));
    auto gate = run_echo_gate(name);
    if (!gate) {
      Error error = gate.error();
      error.where = "--only";
      return tl::unexpected(error);
    }
    gates.push_back(std::move(*gate));
  }
  if (options.reference.empty()) return gates;
  const auto range = read_patch_range(options.reference, options.reference_rows);
  ARTUS_TRY(range);
  JointOptions joint_options;
  joint_options.joint = options.joint;
  const auto joint = load(joint_options, progress);
  ARTUS_TRY(joint);
  const auto scene = std::make_shared<const Scene>(*joint);
  if (progress) progress("muscle-patch", 0);
  gates.push_back(measure_muscle(scene, *range));
  return gates;
}

ExitCode run_gates(const EchoGatesOptions& options) {
  const auto gates = measure(options, make_progress_printer(options.json));
  if (!gates) return report_error(gates.error(), options.json);
  if (const auto written = write_gate_report(*gates, options.out); !written)
    return report_error(written.error(), options.json);
  const auto report = to_json(*gates);
  if (options.json) {
    std::cout << report.dump(2) << '\n';
  } else {
    std::vector<Claim> claims;
    for (const EchoGate& gate : *gates) {
      print(gate);
      claims.insert(claims.end(), gate.claims.begin(), gate.claims.end());
    }
    std::printf("report.md, gates.json, pictures/ in %s\n%s\n", options.out.c_str(),
                count_claims(claims).c_str());
  }
  return report.at("pass").get<bool>() ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

void add_echo_gates_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<EchoGatesOptions>();
  Command* command = add_command(
      app, "echo-gates",
      "Measure the image's physics on test objects, with a verdict on each value",
      "Gates: " + listed(echo_gates()) +
          "\nExit code 1 when a value is out of its bound.\n"
          "Examples:\n"
          "  artus echo-gates --out out/gates\n"
          "  artus echo-gates --only needle-angle --only tendon --out out/gates --json\n"
          "  artus echo-gates --joint shoulder.artus --reference stats.tsv --out out/gates");
  command->add_option("--only", options->only, "a gate, may be given several times (default: all)");
  Option* joint =
      command->add_option("--joint,-j", options->joint, "joint whose muscle is compared");
  Option* reference = command->add_option(
      "--reference", options->reference,
      "table of real muscle images (stats.tsv) to compare it with: all claims are fitted");
  command
      ->add_option("--reference-rows", options->reference_rows,
                   "how the names of its muscle images begin, several (default: all rows)")
      ->needs(reference);
  joint->needs(reference);
  reference->needs(joint);
  command->add_option("-o,--out", options->out, "folder for the report")->required();
  command->add_flag("--json", options->json, "print the verdicts as JSON");
  on_run(command, code, [options] { return run_gates(*options); });
}

}  // namespace artus
