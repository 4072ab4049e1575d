// SPDX-License-Identifier: AGPL-3.0-or-later
#include <clocale>
#include <cstdio>
#include <exception>
#include <string>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/apps/shard_commands.h"
#include "artus/detail/apps/training_commands.h"

namespace {

int run(int argc, char** argv) {
  using artus::ExitCode;
  artus::Command app(
      "artus - anatomy, B-mode echography and needle haptics from one layered model of a joint.\n"
      "Not a medical device.");
  app.set_version_flag("--version", std::string("artus ") + ARTUS_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  artus check humerus.stl                                  what is wrong with a surface\n"
      "  artus compile meshes/simple-shoulder -o simple.artus     surfaces -> compiled joint\n"
      "  artus run three-injections --joint simple.artus --out out/run\n"
      "  artus <command> --help                                   options and examples\n\n"
      "Exit codes: 0 done, 1 something in the world is wrong (file, surface, claim),\n"
      "            2 the command line is wrong, 3 a surface, pose or injection must be mended.");
  ExitCode code = ExitCode::ok;
  artus::add_check_command(app, code);
  artus::add_compile_command(app, code);
  artus::add_needle_command(app, code);
  artus::add_image_command(app, code);
  artus::add_slice_command(app, code);
  artus::add_sweep_command(app, code);
  artus::add_sweep_merge_command(app, code);
  artus::add_sweep_stats_command(app, code);
  artus::add_export_command(app, code);
  artus::add_force_command(app, code);
  artus::add_video_command(app, code);
  artus::add_phantom_command(app, code);
  artus::add_echo_gates_command(app, code);
  artus::add_deform_command(app, code);
  artus::add_elastogram_command(app, code);
  artus::add_soft_gates_command(app, code);
  artus::add_injection_gates_command(app, code);
  artus::add_run_command(app, code);
  artus::add_experiment_command(app, code);
  artus::add_inject_command(app, code);
  artus::add_laws_command(app, code);
  artus::add_loop_command(app, code);
  artus::add_serve_command(app, code);
  artus::add_view_command(app, code);
  artus::add_replay_command(app, code);
  artus::add_assess_command(app, code);
  artus::add_learners_command(app, code);
  artus::add_patient_command(app, code);
  artus::add_play_command(app, code);
  artus::add_rate_command(app, code);
  artus::add_scenario_command(app, code);
  artus::add_train_command(app, code);
  artus::add_register_command(app, code);
  artus::add_shm_monitor_command(app, code);
  int mistake = 0;  // CLI11's own many codes become one
  if (!app.parse(argc, argv, mistake)) return mistake == 0 ? 0 : static_cast<int>(ExitCode::usage);
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
  std::setlocale(LC_ALL, "C");
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "artus: %s\n", e.what());
  } catch (...) {
    std::fprintf(stderr, "artus: an unknown failure stopped the program\n");
  }
  return 1;
}
