// SPDX-License-Identifier: AGPL-3.0-or-later
#include <clocale>
#include <cstdio>
#include <exception>

#include "artus/detail/apps/validate/validation.h"

int main(int argc, char** argv) {
  std::setlocale(LC_ALL, "C");
  try {
    artus::ExitCode code = artus::ExitCode::ok;
    artus::Command app("Measure what artus claims against theory and published figures");
    artus::add_validation(app, code);
    int mistake = 0;  // CLI11's own many codes become one
    if (!app.parse(argc, argv, mistake))
      return mistake == 0 ? 0 : static_cast<int>(artus::ExitCode::usage);
    return static_cast<int>(code);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "artus: %s\n", e.what());
  } catch (...) {
    std::fprintf(stderr, "artus: an unknown failure stopped the program\n");
  }
  return 1;
}
