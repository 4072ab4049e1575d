// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>

#include "artus/session/hand_device.h"
#include "artus/viewer/user_event.h"

namespace artus {

/// What the mouse holds.
enum class Grab { nothing, needle, probe };

/// Turns mouse, keyboard and gamepad into where needle and probe shall be. Pure: no window, no
/// clock. With the needle grabbed, the wheel pushes it along its axis and the mouse turns it about
/// the entry point, or moves it sideways while it is outside; with the probe grabbed, the mouse
/// slides it on the body and the wheel turns it about its own axis. A gamepad moves both at once:
/// left stick the probe, right stick the needle's direction, triggers along its axis.
class HandControl {
 public:
  static constexpr double kPush = 0.5e-3;                      ///< m a notch
  static constexpr double kSlide = 0.1e-3;                     ///< m a pixel
  static constexpr double kTurn = 0.1 * 0.017453292519943295;  ///< rad a pixel
  static constexpr double kPadPush = 20e-3;                    ///< m/s, trigger held
  static constexpr double kPadSlide = 30e-3;                   ///< m/s, stick held
  static constexpr double kPadTurn = 0.35;                     ///< rad/s, stick held

  explicit HandControl(const HandTarget& start) : start_(start), target_(start) {}

  /// True when the event was taken. `entry_W`: where the needle went into the body; empty while it
  /// is outside.
  bool handle(const UserEvent& event, const std::optional<Vec3>& entry_W);
  /// Lets go of the buttons; to be called when a tick has read them, so that no press is lost.
  void release() noexcept { target_.buttons = 0; }
  /// The joint was moved from X_WJ_before to X_WJ (calibration): the probe stays where it is on the
  /// body, the needle goes to the device's insertion point.
  void follow_joint(const Pose& X_WJ_before, const Pose& X_WJ);

  [[nodiscard]] Grab grab() const noexcept { return grab_; }
  [[nodiscard]] const HandTarget& target() const noexcept { return target_; }
  void set_target(const HandTarget& target) noexcept { target_ = target; }

 private:
  bool handle_key(const std::string& key);
  bool act_on(const std::string& key);
  bool handle_move(const MoveEvent& move, const std::optional<Vec3>& entry_W);
  bool handle_scroll(const ScrollEvent& scroll);
  bool handle_pad(const PadEvent& pad, const std::optional<Vec3>& entry_W);
  void push(double length);
  void slide_probe(double x, double y);
  void steer_needle(double x, double y, double slide, double turn,
                    const std::optional<Vec3>& entry_W);

  HandTarget start_;
  HandTarget target_;
  Grab grab_ = Grab::nothing;
  bool have_cursor_ = false;
  double x_ = 0;
  double y_ = 0;
};

}  // namespace artus
