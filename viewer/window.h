// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <functional>
#include <vector>

#include "artus/core/result.h"
#include "artus/session/session.h"
#include "artus/viewer/panels.h"
#include "artus/viewer/script.h"

namespace artus {

struct WindowOptions {
  int width = 1280;  ///< pixels
  int height = 720;  ///< pixels
  bool expert = false;
  double rate = 30;          ///< Hz, at most
  double pixels_per_mm = 0;  ///< of the screen; 0: as the system says
  std::vector<ScriptStep> script;
  std::filesystem::path screenshot;  ///< at the end of the script; empty: none
  bool quit_after_script = false;
  std::filesystem::path layout;          ///< where the panels' places are kept; empty: nowhere
  std::filesystem::path pictures = ".";  ///< folder of saved images and clips
  std::function<bool()> asked_to_close;  ///< asked between two pictures; empty: nobody else closes
  /// Called between two pictures: other programs' hands on the knobs. Empty: there are none.
  std::function<void(ImageControls&)> turn_knobs;
};

/// What a window leaves behind when it is closed.
struct WindowReport {
  std::vector<ImagePoint> calipers;  ///< pairs, as they stood
  ImagePlace image_place;            ///< of the last picture
  bool expert = false;
  std::uint64_t pictures = 0;       ///< shown
  LatencyHistogram pose_to_screen;  ///< from the device's time stamp to the shown picture
};

/// Shows a running session until its window is closed or the script ends. Reads the session's
/// snapshots only; what people do goes to `hand` when there is one (null for other devices). One
/// window at a time, from the main thread. Errors: failed (no display, no OpenGL 3.3), unreadable
/// (a picture cannot be written).
[[nodiscard]] Result<void> run_window(Session& session, HandDevice* hand, const HandTarget& start,
                                      const WindowOptions& options, WindowReport& report);

}  // namespace artus
