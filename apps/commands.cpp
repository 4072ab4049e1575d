// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/commands.h"

namespace artus {

void add_commands(Command& app, ExitCode& code) {
  app.group("For anatomists");
  add_import_command(app, code);
  add_check_command(app, code);
  add_compile_command(app, code);
  add_needle_command(app, code);
  add_image_command(app, code);
  Command& image = app.subcommand("image");
  add_slice_command(image, code);
  add_elastogram_command(image, code);
  add_video_command(image, code);
  add_phantom_command(image, code);
  add_deform_command(app, code);

  app.group("For trainees and teachers");
  add_train_command(app, code);
  add_view_command(app, code);
  add_scenario_command(app, code);
  add_play_command(app, code);
  add_patient_command(app, code);
  add_assess_command(app, code);
  add_learners_command(app, code);
  add_rate_command(app.subcommand("learners"), code);
  add_study_command(app.subcommand("learners"), code);

  app.group("For researchers");
  add_sweep_command(app, code);
  add_sweep_merge_command(app.subcommand("sweep"), code);
  add_sweep_stats_command(app.subcommand("sweep"), code);
  add_force_command(app, code);
  add_run_command(app, code);
  add_inject_command(app, code);
  add_replay_command(app, code);
  add_export_command(app, code);

  app.group("For haptics labs");
  add_serve_command(app, code);
  add_shm_monitor_command(app.subcommand("serve"), code);
  add_bridge_command(app, code);
  add_hands_command(app, code);
  add_register_command(app, code);
  add_laws_command(app, code);

  app.group("For developers");
  add_validate_command(app, code);
}

}  // namespace artus
