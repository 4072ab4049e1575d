// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/apps/options/command.h"

namespace artus {

/// All commands, in groups by who uses them. `code` is what the chosen one returns.
void add_commands(Command& app, ExitCode& code);

// One file each, but for the ratings, which stand with the learners.
void add_assess_command(Command& app, ExitCode& code);
void add_bridge_command(Command& app, ExitCode& code);
void add_hands_command(Command& app, ExitCode& code);
void add_check_command(Command& app, ExitCode& code);
void add_compile_command(Command& app, ExitCode& code);
void add_deform_command(Command& app, ExitCode& code);
void add_elastogram_command(Command& image, ExitCode& code);
void add_export_command(Command& app, ExitCode& code);
void add_force_command(Command& app, ExitCode& code);
void add_image_command(Command& app, ExitCode& code);
void add_import_command(Command& app, ExitCode& code);
void add_inject_command(Command& app, ExitCode& code);
void add_laws_command(Command& app, ExitCode& code);
void add_learners_command(Command& app, ExitCode& code);
void add_needle_command(Command& app, ExitCode& code);
void add_patient_command(Command& app, ExitCode& code);
void add_phantom_command(Command& image, ExitCode& code);
void add_play_command(Command& app, ExitCode& code);
void add_rate_command(Command& learners, ExitCode& code);
void add_register_command(Command& app, ExitCode& code);
void add_replay_command(Command& app, ExitCode& code);
void add_run_command(Command& app, ExitCode& code);
void add_scenario_command(Command& app, ExitCode& code);
void add_serve_command(Command& app, ExitCode& code);
void add_shm_monitor_command(Command& serve, ExitCode& code);
void add_slice_command(Command& image, ExitCode& code);
void add_study_command(Command& learners, ExitCode& code);
void add_sweep_command(Command& app, ExitCode& code);
void add_sweep_merge_command(Command& sweep, ExitCode& code);
void add_sweep_stats_command(Command& sweep, ExitCode& code);
void add_train_command(Command& app, ExitCode& code);
void add_validate_command(Command& app, ExitCode& code);
void add_video_command(Command& image, ExitCode& code);
void add_view_command(Command& app, ExitCode& code);

}  // namespace artus
