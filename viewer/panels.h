// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "artus/session/session.h"
#include "artus/viewer/hand_control.h"
#include "artus/viewer/joint_view.h"

namespace artus {

/// A point of the B-mode image in millimetres from its upper left corner.
struct ImagePoint {
  double x_mm = 0;
  double y_mm = 0;
};

/// Where the B-mode image stands in the window.
struct ImagePlace {
  double x = 0;      ///< pixels from the window's left to the image's first column
  double y = 0;      ///< pixels from its top to the image's first row
  double scale = 1;  ///< pixels a millimetre of tissue, both ways
  [[nodiscard]] ImagePoint point_at(double px, double py) const noexcept {
    return {(px - x) / scale, (py - y) / scale};
  }
};

/// What the window remembers between two of its frames; the panels read and change it.
struct ViewState {
  bool expert = false;  ///< the 3D view is hidden, as in a real room
  bool help = false;
  bool quit = false;
  bool true_scale = false;      ///< one millimetre of tissue is one millimetre of the screen
  double pixels_per_mm = 3.78;  ///< of the screen
  ImageControls controls;
  ImagePlace image_place;
  std::vector<ImagePoint> calipers;  ///< pairs
  std::deque<TracePoint> trace;      ///< the last seconds
  double trace_seconds = 10;
  bool wants_screenshot = false;  ///< of the B-mode image
  bool wants_clip = false;        ///< from then on, until it is false again
  std::string message;            ///< last thing that was saved or refused
};

/// All that the panels show, gathered once a frame.
struct PanelInput {
  Session* session = nullptr;
  HapticSnapshot now;
  const ImageSnapshot* image = nullptr;
  unsigned image_texture = 0;
  unsigned joint_texture = 0;
  Grab grab = Grab::nothing;
  bool has_hand = false;
  const char* gamepad = nullptr;     ///< its name; null: none
  std::optional<EntryChoice> entry;  ///< where the needle would enter, while exploring
  float scale = 1;                   ///< of the fonts, for the screen's resolution
  double window_rate = 0;            ///< Hz
};

/// Where the joint's picture goes; its size for the next frame.
struct JointArea {
  int width = 640;
  int height = 400;
  bool hovered = false;
};

/// Where the next panel stands before a person moves it, as shares of the window.
void place_panel(float x, float y, float width, float height);

void draw_joint_panel(const PanelInput& in, ViewState& state, JointArea& area);
void draw_image_panel(const PanelInput& in, ViewState& state);
void draw_scanner_panel(const PanelInput& in, ViewState& state);
void draw_force_panel(const PanelInput& in, ViewState& state);
void draw_rates_panel(const PanelInput& in, ViewState& state);
void draw_session_panel(const PanelInput& in, ViewState& state);
void draw_tissue_panel(const PanelInput& in, ViewState& state, JointView& view);
void draw_help(const PanelInput& in, ViewState& state);

/// What the bits of a tick's status say, for people; "all well" for none.
[[nodiscard]] std::string describe_status(std::uint32_t status);

}  // namespace artus
