// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "artus/detail/echo/probe/grey_curve_file.h"
#include "artus/detail/viewer/input/hand_control.h"
#include "artus/detail/viewer/input/key_map.h"
#include "artus/detail/viewer/joint3d/body_mark.h"
#include "artus/detail/viewer/panels/display_look.h"
#include "artus/detail/viewer/panels/image_place.h"
#include "artus/detail/viewer/panels/insertion_trace.h"
#include "artus/detail/viewer/panels/lesson.h"
#include "artus/detail/viewer/panels/needle_reading.h"
#include "artus/detail/viewer/panels/panel_layout.h"
#include "artus/detail/viewer/panels/probe_reading.h"
#include "artus/detail/viewer/panels/syringe_reading.h"
#include "artus/detail/viewer/words/translation.h"
#include "artus/session/session.h"

namespace artus {

/// What the window remembers between two of its frames; the panels read and change it.
struct ViewState {
  Language language = Language::english;
  KeyMap keys;
  PanelLayout layout;
  bool welcome = false;  ///< the three choices are shown
  bool expert = false;   ///< the 3D view and the aids are hidden, as in a real room
  bool help = false;
  bool aids = true;     ///< layer, target and plane are told
  bool labels = false;  ///< structures are named
  bool quit = false;
  bool finished = false;           ///< a task was said to be done
  bool offers_training = false;    ///< the welcome has a way to it
  bool training = false;           ///< it was taken
  const Lesson* lesson = nullptr;  ///< the task; null: the window is free
  bool left_handed = false;        ///< the mouse's buttons change places
  bool true_scale = false;         ///< one millimetre of tissue is one millimetre of the screen
  double pixels_per_mm = 3.78;     ///< of the screen
  ImageControls controls;
  std::vector<GreyCurvePreset> grey_curves;  ///< to choose from
  DisplayLook look;
  PictureView view;  ///< what is seen of the picture
  std::string patient;
  ImagePlace image_place;
  std::map<std::uint64_t, std::vector<ImagePoint>> calipers;  ///< pairs, by the image's number
  std::optional<ImagePoint> cross;  ///< a caliper's next point, moved by keys
  std::optional<std::size_t> cine;  ///< which picture of the loop is shown; empty: the live one
  bool drags_box = false;           ///< the mouse holds the colour box, not the picture
  bool dual = false;                ///< a kept picture stands beside the live one
  std::deque<TracePoint> trace;     ///< the last seconds
  InsertionTrace insertion;
  double trace_seconds = 10;
  bool wants_screenshot = false;       ///< of the B-mode image
  bool wants_clip = false;             ///< from then on, until it is false again
  std::string message;                 ///< last thing that was saved or refused
  std::vector<ActionEvent> requests;   ///< of buttons, done after the panels
  std::optional<std::size_t> planned;  ///< an injection that was just chosen
};

/// A ring on the picture, or the end of a line that goes on to `to`.
struct PictureMark {
  ImagePoint at;
  std::optional<ImagePoint> to;
  double alpha = 1;
  bool full = false;  ///< a disc in place of a ring
};

/// All that the panels show, gathered once a frame.
struct PanelInput {
  Session* session = nullptr;
  HapticSnapshot now;                    ///< the last state of a living device
  PeerState peer = PeerState::absent;    ///< as the device is now
  std::uint32_t status = 0;              ///< of the newest tick
  double lost_for = 0;                   ///< s since the last state
  NeedleReading needle;                  ///< in `now`
  SyringeReading syringe;                ///< likewise
  ProbeReading probe;                    ///< likewise
  const ImageSnapshot* image = nullptr;  ///< shown: live or of the cine loop
  const ImageSnapshot* kept = nullptr;   ///< of a dual picture
  unsigned image_texture = 0;
  unsigned kept_texture = 0;
  unsigned joint_texture = 0;
  const BodyMark* mark = nullptr;
  unsigned mark_texture = 0;
  std::size_t cine_size = 0;
  double cine_age = 0;  ///< s of the shown picture before the newest
  Grab grab = Grab::nothing;
  bool has_hand = false;
  bool probe_lifted = false;
  const char* gamepad = nullptr;     ///< its name; null: none
  std::optional<EntryChoice> entry;  ///< where the needle would enter, while exploring
  std::vector<PictureLabel> labels;  ///< on the picture, when they are wanted
  std::vector<PictureMark> marks;    ///< of a task's aids
  std::string goal;
  std::string next;
  float scale = 1;         ///< of the fonts, for the screen's resolution
  double window_rate = 0;  ///< Hz
  double clip_seconds = 0;
};

/// Where the joint's picture goes; its size for the next frame.
struct JointArea {
  int width = 640;
  int height = 400;
};

}  // namespace artus
