// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "artus/core/result.h"
#include "artus/viewer/user_event.h"

namespace artus {

/// Lets time pass.
struct WaitStep {
  double seconds = 0;
};
/// Shows or hides a tissue, or makes it transparent.
struct TissueStep {
  std::string tissue;
  double alpha = 1;
};
/// Writes what the window shows.
struct ScreenshotStep {
  std::filesystem::path file;
};
/// Pulls the hand's cable, or puts it back.
struct ConnectStep {
  bool connected = true;
};
/// Turns the view of the joint.
struct CameraStep {
  double yaw = 0;         ///< rad
  double pitch = 0;       ///< rad
  double distance = 0.2;  ///< m
};
/// Puts a calliper between two points of the image.
struct MeasureStep {
  double from_x_mm = 0;
  double from_y_mm = 0;
  double to_x_mm = 0;
  double to_y_mm = 0;
};
using ScriptStep = std::variant<UserEvent, WaitStep, TissueStep, ScreenshotStep, ConnectStep,
                                CameraStep, MeasureStep>;

/// The steps of a script, one a line; `#` begins a comment:
///   wait SECONDS | key [shift+]NAME | move X Y | button N down|up | scroll NOTCHES [fine]
///   pad LEFT_X LEFT_Y RIGHT_X RIGHT_Y PUSH SECONDS | tissue NAME ALPHA | screenshot FILE
///   connect | disconnect | camera YAW_DEG PITCH_DEG DISTANCE_MM | measure X Y X Y
/// Errors: malformed, with file and line.
[[nodiscard]] Result<std::vector<ScriptStep>> parse_script(std::string_view text,
                                                           const std::string& name);

}  // namespace artus
