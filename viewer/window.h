// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/outside/outside_body.h"
#include "artus/detail/viewer/input/key_map.h"
#include "artus/detail/viewer/input/script.h"
#include "artus/detail/viewer/joint3d/orbit_camera.h"
#include "artus/detail/viewer/panels/lesson.h"
#include "artus/detail/viewer/panels/view_state.h"
#include "artus/session/session.h"

namespace artus {

class Screen;

/// An injection that the window can offer, and where both hands stand before it.
struct PlannedTask {
  PlannedInjection injection;
  HandTarget start;
};

/// What a window shows at a moment, for who watches it.
struct WindowStatus {
  std::uint64_t pictures = 0;  ///< shown so far
  std::string goal;
  std::string next;
  std::string message;
  std::string task;                ///< a lesson's title; empty: there is none
  std::vector<std::string> steps;  ///< of a lesson, those that are not done
  std::string remark;              ///< of who looks on, as it stands there
  NeedleReading needle;
  SyringeReading syringe;
  Grab grab = Grab::nothing;
  GesturePhase phase = GesturePhase::exploring;
  ImagePlace image_place;
  std::size_t caliper_points = 0;
  bool has_image = false;
  std::uint64_t image = 0;  ///< number of the shown picture
  /// Of the image whose body the 3D view shows, and points that were sent again for it.
  std::uint64_t joint_image = 0;
  std::size_t joint_points_sent = 0;
  bool frozen = false;
  bool recording = false;
  double clip_seconds = 0;  ///< of the running clip
  bool reached = false;
  OrbitCamera camera;
  ImageControls controls;
  DisplayLook look;
  PictureView view;          ///< what is seen of a zoomed picture
  bool dual = false;         ///< a kept picture stands beside
  bool help = false;         ///< the keys are shown
  KeyMap keys;               ///< as they act now
  PanelPlace picture_panel;  ///< as the layout has it
};

struct WindowOptions {
  int width = 1280;  ///< pixels
  int height = 720;  ///< pixels
  bool expert = false;
  bool welcome = false;      ///< offers the three choices at first
  bool training = false;     ///< and a fourth: the way to training, which ends the window
  double rate = 30;          ///< Hz, at most
  double pixels_per_mm = 0;  ///< of the screen; 0: as the system says
  double font_scale = 1;     ///< of the letters, besides what screen and window ask for
  Language language = Language::english;
  std::string keys;  ///< a file of keys as TOML; empty: the default keys
  bool left_handed = false;
  bool plain = false;                          ///< saved pictures without captions
  std::string patient;                         ///< a pseudonym
  std::string connect;                         ///< how a device that was never there is connected
  std::shared_ptr<const OutsideBody> outside;  ///< the person around the joint; null: none
  std::vector<PlannedTask> tasks;
  std::size_t task = 0;  ///< of tasks, the goal at first
  std::vector<ScriptStep> script;
  std::filesystem::path screenshot;  ///< at the end of the script, or of the first whole picture
  bool quit_after_script = false;
  std::filesystem::path layout;          ///< where the panels' places are kept; empty: nowhere
  std::filesystem::path pictures = ".";  ///< folder of saved images and clips
  double message_seconds = 12;           ///< s that a message stands; assumed
  std::function<bool()> asked_to_close;  ///< asked between two pictures; empty: nobody else closes
  /// Called between two pictures: other programs' hands on the knobs. Empty: there are none.
  std::function<void(ImageControls&)> turn_knobs;
  std::function<void(const WindowStatus&)> watch;  ///< called after each picture; may be empty
  std::optional<LessonOptions> lesson;             ///< a task; empty: the window is free
};

/// What a window leaves behind when it is closed.
struct WindowReport {
  std::vector<ImagePoint> calipers;  ///< pairs, as they stood on the last picture
  ImagePlace image_place;            ///< of the last picture
  bool expert = false;
  bool finished = false;            ///< a lesson's: its end was asked for, or it was over
  bool training = false;            ///< the way to training was taken
  std::uint64_t pictures = 0;       ///< shown
  LatencyHistogram interval;        ///< from picture to picture
  LatencyHistogram joint;           ///< that a drawn 3D view took
  std::size_t joint_level = 0;      ///< of detail at the end, see DetailChooser
  LatencyHistogram pose_to_screen;  ///< from the device's time stamp to the shown picture
};

/// Shows a running session until its window is closed or the script ends. Reads the session's
/// snapshots only; what people do goes to `hand` when there is one (null for other devices). One
/// window at a time, from the main thread. Errors: failed (no display, no OpenGL 3.3), unreadable
/// (a picture cannot be written), those of the file of keys.
[[nodiscard]] Result<void> run_window(Session& session, HandDevice* hand, const HandTarget& start,
                                      const WindowOptions& options, WindowReport& report);
/// The same on a screen that stays.
[[nodiscard]] Result<void> run_window(Screen& screen, Session& session, HandDevice* hand,
                                      const HandTarget& start, const WindowOptions& options,
                                      WindowReport& report);

}  // namespace artus
