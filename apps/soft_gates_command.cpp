// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/apps/command.h"
#include "artus/core/known_names.h"
#include "artus/evidence/soft/soft_gates.h"

namespace artus {
namespace {

struct SoftGatesOptions {
  std::vector<std::string> only;
  std::filesystem::path out;
  bool json = false;
};

ExitCode run_soft_gates(const SoftGatesOptions& options) {
  std::vector<std::string> names = options.only;
  if (names.empty()) names.assign(soft_gates().begin(), soft_gates().end());
  const Progress progress = make_progress_printer(options.json);
  std::vector<SoftGate> gates;
  for (const std::string& name : names) {
    if (progress)
      progress(name, static_cast<double>(gates.size()) / static_cast<double>(names.size()));
    auto gate = run_soft_gate(name);
    if (!gate) {
      Error error = gate.error();
      error.where = "--only";
      return report_error(error, options.json);
    }
    gates.push_back(std::move(*gate));
  }
  const EvidenceReport report = report_of(gates);
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

}  // namespace

void add_soft_gates_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<SoftGatesOptions>();
  Command* command = add_command(
      app, "soft-gates",
      "Measure the mechanics of the tissue that gives way, with a verdict on each value",
      "Gates: " + listed(soft_gates()) +
          "\nExit code 1 when a value is out of its bound.\n"
          "Examples:\n"
          "  artus soft-gates --out out/soft\n"
          "  artus soft-gates --only layers --only punch --out out/soft --json");
  command->add_option("--only", options->only, "a gate, may be given several times (default: all)");
  command->add_option("-o,--out", options->out, "folder for the report")->required();
  command->add_flag("--json", options->json, "print the verdicts as JSON");
  on_run(command, code, [options] { return run_soft_gates(*options); });
}

}  // namespace artus
