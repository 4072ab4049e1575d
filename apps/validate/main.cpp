// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/command.h"
#include "artus/detail/apps/validate/validation.h"

int main(int argc, char** argv) {
  return artus::run_program([&] {
    artus::ExitCode code = artus::ExitCode::ok;
    artus::Command app("Measure what artus claims against theory and published figures");
    artus::add_validation(app, code);
    return artus::run_commands(app, argc, argv, code);
  });
}
