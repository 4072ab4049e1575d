// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/viewer/input/user_event.h"

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
/// What follows belongs to the page or window of that name: see PageScript.
struct PageStep {
  std::string name;
};
/// Lets time pass until something is so, and no longer than some seconds.
struct AwaitStep {
  std::string what;  ///< picture (there is one), inside or outside (the needle's tip)
  double seconds = 0;
};
using ScriptStep = std::variant<UserEvent, WaitStep, TissueStep, ScreenshotStep, ConnectStep,
                                CameraStep, MeasureStep, PageStep, AwaitStep>;

/// The steps of a script, one a line; `#` begins a comment:
///   wait SECONDS | key [shift+]NAME | move X Y | button N down|up | scroll NOTCHES [fine]
///   pad LEFT_X LEFT_Y RIGHT_X RIGHT_Y PUSH SECONDS | tissue NAME ALPHA | screenshot FILE
///   connect | disconnect | camera YAW_DEG PITCH_DEG DISTANCE_MM | measure X Y X Y
///   page NAME | await picture|inside|outside SECONDS
/// Errors: malformed, with file and line.
[[nodiscard]] Result<std::vector<ScriptStep>> parse_script(std::string_view text,
                                                           const std::string& name);

/// A script over several pages and windows, one after the other: each takes its own steps.
class PageScript {
 public:
  PageScript() = default;
  explicit PageScript(std::vector<ScriptStep> steps) : steps_(std::move(steps)) {}

  [[nodiscard]] bool given() const noexcept { return !steps_.empty(); }
  [[nodiscard]] bool over() const noexcept { return next_ >= steps_.size(); }
  /// The steps between the next "page NAME" and the one after it, when that is `page`'s. Errors:
  /// failed, when another page's steps are next, naming both; never without a script.
  [[nodiscard]] Result<std::vector<ScriptStep>> take(const std::string& page);

 private:
  std::vector<ScriptStep> steps_;
  std::size_t next_ = 0;
};

}  // namespace artus
