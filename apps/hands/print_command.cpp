// SPDX-License-Identifier: AGPL-3.0-or-later
#include <memory>

#include "artus/detail/apps/hands/hands_commands.h"
#include "artus/detail/core/units.h"
#include "artus/detail/devices/kit/sheets.h"

namespace artus {
namespace {

struct PrintOptions {
  std::filesystem::path out;
  std::string hand = "right";
  std::string paper = "a4";
  double barrel_mm = 15.8;
};

ExitCode run_print(const PrintOptions& options) {
  const kit::Hand hand = options.hand == "left" ? kit::Hand::left : kit::Hand::right;
  const kit::Paper paper = options.paper == "letter" ? kit::Paper::letter : kit::Paper::a4;
  auto written = kit::write_parts(options.out, hand, options.barrel_mm * kMillimetre);
  if (written) written = kit::write_sheets(options.out, paper, hand);
  if (!written) return report_error(written.error(), false);
  tell("probe.stl, syringe.stl, plunger.stl, divots.stl: print the parts, in millimetres");
  tell("markers.pdf, sheet.pdf, board.pdf: print at 100 %, then measure the ruler of each");
  tell("written to " + options.out.string());
  return ExitCode::ok;
}

}  // namespace

void add_print_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<PrintOptions>();
  Command* command = add_command(app, "print", "Sheets as PDF and parts as STL",
                                 "Examples:\n"
                                 "  artus hands print -o kit\n"
                                 "  artus hands print -o kit --hand left --paper letter");
  command->add_option("-o,--out", options->out, "folder")->required();
  command->add_option("--hand", options->hand, "that holds the syringe")
      ->one_of({"right", "left"})
      ->capture_default_str();
  command->add_option("--paper", options->paper, "its size")
      ->one_of({"a4", "letter"})
      ->capture_default_str();
  command->add_option("--barrel-mm", options->barrel_mm, "outer diameter of the syringe")
      ->check(number_in(8, 22))
      ->capture_default_str();
  on_run(command, code, [options] { return run_print(*options); });
}

}  // namespace artus
