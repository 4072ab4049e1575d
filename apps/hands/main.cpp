// SPDX-License-Identifier: AGPL-3.0-or-later
#include <opencv2/core.hpp>

#include "artus/detail/apps/hands/hands_commands.h"
#include "artus/detail/apps/options/command.h"

int main(int argc, char** argv) {
  return artus::run_program([&] {
    cv::setNumThreads(1);  // the session beside it needs the processor, too
    artus::ExitCode code = artus::ExitCode::ok;
    artus::Command app(
        "Hands by a webcam and paper: printed markers on a probe mock, a syringe and a sheet");
    app.require_subcommand(1);
    app.footer(
        "Examples:\n"
        "  artus hands print -o kit                       sheets (PDF) and parts (STL)\n"
        "  artus hands calibrate webcam -k hands.toml     the camera, by the board\n"
        "  artus hands pivot webcam -k hands.toml         the needle's tip\n"
        "  artus hands face webcam -k hands.toml          the probe's face\n"
        "  artus hands run webcam -k hands.toml           OpenIGTLink on port 18944\n"
        "  artus train --hands webcam                     all of it, page by page");
    artus::add_print_command(app, code);
    artus::add_calibration_commands(app, code);
    artus::add_tip_commands(app, code);
    artus::add_tracking_commands(app, code);
    return artus::run_commands(app, argc, argv, code);
  });
}
