// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/program.h"

#include <clocale>
#include <cstdio>
#include <exception>

#include "artus/detail/core/plain_reason.h"

namespace artus {

int run_program(const std::function<ExitCode()>& work) noexcept {
  std::setlocale(LC_ALL, "C");
  try {
    return static_cast<int>(work());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "artus: %s\n", plain_reason(e.what()).c_str());
  } catch (...) {
    std::fprintf(stderr, "artus: an unknown failure stopped the program\n");
  }
  return static_cast<int>(ExitCode::failed);
}

ExitCode run_commands(Command& app, int argc, const char* const* argv, const ExitCode& code) {
  int mistake = 0;  // CLI11's own many codes become one
  if (!app.parse(argc, argv, mistake)) return mistake == 0 ? ExitCode::ok : ExitCode::usage;
  return code;
}

}  // namespace artus
