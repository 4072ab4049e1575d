// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include "artus/detail/core/units.h"
#include "artus/detail/session/hand_device.h"
#include "artus/detail/simulation/two_phase_gesture.h"
#include "artus/detail/viewer/input/body_contact.h"
#include "artus/detail/viewer/input/user_event.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// What the mouse holds.
enum class Grab { nothing, needle, probe, plunger };

/// What the hands meet.
struct HandGround {
  std::optional<Vec3> entry_W;  ///< where the needle went into the body; empty while it is outside
  BodyContact body;
  bool has_entry_choice = true;  ///< there is skin where an entry would be chosen
  GesturePhase phase = GesturePhase::exploring;
};

/// Turns wishes of mouse, keyboard and gamepad into where needle and probe shall be. Pure: no
/// window, no clock. With the needle grabbed, the wheel pushes it along its axis and the mouse
/// turns it about the entry point, or moves it sideways while it is outside; it goes no deeper than
/// its hub, and a few millimetres of the hand's way beyond bone, which press. With the probe
/// grabbed, the mouse slides it on the skin, whose slope it follows, and the wheel turns it; with
/// ctrl the mouse rocks and fans it, and the wheel presses it on. With the thumb on the plunger,
/// the wheel presses it and draws it back. A gamepad moves both at once, or its triggers press.
class HandControl {
 public:
  static constexpr double kPush = 0.5e-3;                      ///< m a notch
  static constexpr double kPress = 0.25e-3;                    ///< m a notch, of the probe
  static constexpr double kThumb = 0.5;                        ///< N a notch, of the thumb
  static constexpr double kMaxThumb = 30;                      ///< N. assumed: a strong push
  static constexpr double kMaxDraw = 12;                       ///< N of drawing back. assumed
  static constexpr double kSlide = 0.1e-3;                     ///< m a pixel
  static constexpr double kTurn = 0.1 * 0.017453292519943295;  ///< rad a pixel
  static constexpr double kArrow = 10;                         ///< pixels a press of an arrow
  static constexpr double kPadPush = 20e-3;                    ///< m/s, trigger held
  static constexpr double kPadSlide = 30e-3;                   ///< m/s, stick held
  static constexpr double kPadTurn = 0.35;                     ///< rad/s, stick held
  static constexpr double kBeyondBone = 5e-3;                  ///< m of the hand's way that press
  /// rad from how it went in that tissue lets a shaft be turned; assumed. A hand that is flicked
  /// bends no needle across the body, nor out of it: the tip of a flat one stays under the skin.
  static constexpr double kMostTurn = 35 * 0.017453292519943295;
  static constexpr double kMostAtOnce = 10 * kDegree;  ///< rad of one event; assumed
  static constexpr int kLooks = 16;               ///< for the turn that keeps the tip in the body
  static constexpr double kDeepestPress = 15e-3;  ///< m, of the probe

  explicit HandControl(const HandTarget& start, double needle_length = 1)
      : start_(start), target_(start), needle_length_(needle_length) {}

  /// True when the event was taken.
  bool handle(const UserEvent& event, const HandGround& ground);
  bool handle(Action action, bool fine, const HandGround& ground);
  /// Lets go of the buttons; to be called when a tick has read them, so that no press is lost.
  void release() noexcept { target_.buttons = 0; }
  /// The joint was moved from X_WJ_before to X_WJ (calibration): the probe stays where it is on the
  /// body, the needle goes to the device's insertion point.
  void follow_joint(const Pose& X_WJ_before, const Pose& X_WJ);
  /// Another start of the needle: it goes there at once.
  void place_needle(const PlainPose& X_WN);

  [[nodiscard]] Grab grab() const noexcept { return grab_; }
  [[nodiscard]] const HandTarget& target() const noexcept { return target_; }
  void set_target(const HandTarget& target) noexcept { target_ = target; }
  /// Why the last event did less than it asked for, in English, {} for the key that goes back to
  /// exploring; null when it did all.
  [[nodiscard]] const char* refusal() const noexcept { return refusal_; }

 private:
  bool take(Grab what);
  void press_thumb(double force);
  bool choose_entry(const HandGround& ground);
  bool explore(const HandGround& ground);
  bool move_with_arrow(Action action, bool fine, const HandGround& ground);
  bool handle_move(const MoveEvent& move, const HandGround& ground);
  bool handle_scroll(const ScrollEvent& scroll, const HandGround& ground);
  bool handle_pad(const PadEvent& pad, const HandGround& ground);
  void move_in_hand(double dx, double dy, bool tilt, const HandGround& ground);
  void keep_turn(Pose& X_WN, const Vec3& entry_W) const;
  void go_home();
  bool undo(const HandGround& ground);
  void push(double length, const HandGround& ground);
  void slide_probe(double x, double y, const HandGround& ground);
  void tilt_probe(double rock, double fan);
  void turn_probe(double angle);
  void press_probe(double length, const HandGround& ground);
  void steer_needle(double x, double y, double slide, double turn, const HandGround& ground);
  /// Remembers how the shaft went in, while it is in.
  void follow_entry(const HandGround& ground);

  HandTarget start_;
  HandTarget target_;
  double needle_length_;  // m
  Grab grab_ = Grab::nothing;
  const char* refusal_ = nullptr;
  std::optional<PlainPose> before_pull_;  // needle before the pulls that are not yet pushed again
  bool pulling_ = false;
  bool have_cursor_ = false;
  double x_ = 0;
  double y_ = 0;
  std::optional<Vec3> entered_axis_W_;  // of the shaft when it went in; empty: it is outside
};

}  // namespace artus
