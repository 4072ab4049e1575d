// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "artus/detail/apps/options/command.h"
#include "artus/detail/devices/kit/kit_file.h"
#include "artus/detail/devices/kit/picture_source.h"

namespace artus {

/// artus hands print.
void add_print_command(Command& app, ExitCode& code);
/// artus hands calibrate, markers and state: camera and glued markers.
void add_calibration_commands(Command& app, ExitCode& code);
/// artus hands pivot and face.
void add_tip_commands(Command& app, ExitCode& code);
/// artus hands run and track.
void add_tracking_commands(Command& app, ExitCode& code);

/// What all commands with pictures take.
struct PictureOptions {
  std::vector<std::string> sources;
  std::filesystem::path kit;
  double fps = 0;
  double lead_s = 6;    ///< before a live phase begins
  double phase_s = 15;  ///< that it lasts
};
void add_picture_options(Command* command, PictureOptions& options, const std::string& what);

/// One thing that a person does before the camera.
struct Phase {
  std::string what;    ///< said to the person
  double seconds = 0;  ///< of a live one; 0: as the flag says
};
/// Pictures of one phase after the other: of a live source each in its time, of files one source
/// each. `on_picture` is called with the phase's number; where it returns false, the phase ends.
/// Lines for people go to stdout, one each, as they come. Errors: those of the sources; invalid
/// (not as many files as phases).
[[nodiscard]] Result<void> for_phases(
    const PictureOptions& options, const std::vector<Phase>& phases,
    const std::function<bool(std::size_t phase, const kit::Picture8& picture)>& on_picture);

/// A line for a person, or for the page that shows it.
void tell(const std::string& line);

/// The kit in a file; one as printed where the file is not there yet. Errors: those of read_kit.
[[nodiscard]] Result<kit::MeasuredKit> kit_of(const std::filesystem::path& file);
/// Errors: invalid (pictures of another size than those of the calibration).
[[nodiscard]] Result<void> check_size(const kit::Lens& lens, const cv::Mat& grey);

}  // namespace artus
