// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "artus/detail/viewer/input/hand_control.h"
#include "artus/detail/viewer/input/window_events.h"
#include "artus/detail/viewer/joint3d/body_mark.h"
#include "artus/detail/viewer/joint3d/joint_view.h"
#include "artus/detail/viewer/panels/cine_loop.h"
#include "artus/detail/viewer/panels/guide.h"
#include "artus/detail/viewer/panels/lesson.h"
#include "artus/detail/viewer/panels/picture_saver.h"
#include "artus/detail/viewer/panels/view_state.h"
#include "artus/detail/viewer/window.h"

namespace artus {

/// The window's life between opening and closing: events, then what they change, then a picture,
/// again and again. Needs a current OpenGL context and Dear ImGui's.
class WindowLoop {
 public:
  WindowLoop(GLFWwindow* window, std::unique_ptr<JointView> joint, Session& session,
             HandDevice* hand, const HandTarget& start, const WindowOptions& options);
  /// Errors: unreadable (keys), malformed, invalid.
  [[nodiscard]] Result<void> prepare();
  Result<void> run(WindowReport& report);

 private:
  // window_input.cpp: what people do
  void handle_group(const std::vector<TimedEvent>& group);
  void handle(const UserEvent& event);
  void act(const ActionEvent& request);
  bool act_on_window(Action action);
  void begin_measuring();
  bool act_on_picture(Action action);
  bool refuse_aid(Action action);
  void act_on_arrow(Action action, bool fine);
  void set_frozen(bool frozen);
  void step_cine(int step);
  void start_task(std::size_t task);
  void apply_requests();
  void run_script(double elapsed);
  bool run_step(const ScriptStep& step, double elapsed);
  [[nodiscard]] HandGround ground() const;
  [[nodiscard]] bool holds(const std::string& what) const;

  // window_loop.cpp, window_picture.cpp: what is shown
  void say(std::string message);
  void say_refusal();
  void forget_message();
  void feel();
  void take_image();
  void add_to_loop(const ImageSnapshot& image);
  void upload_image();
  void show(const ImageSnapshot& image, GlTexture& texture) const;
  void follow_gesture(const HapticSnapshot& now);
  void read_state();
  void guide();
  void begin_lesson();
  void lead_lesson();
  void fit_window();
  void draw_joint();
  void pass(double elapsed);
  void draw(double elapsed);
  void note_shown(double elapsed, WindowReport& report);
  void save_pictures(double elapsed);
  void request_final_picture();
  [[nodiscard]] Result<void> save_window() const;
  [[nodiscard]] Caption caption() const;
  [[nodiscard]] WindowStatus status() const;

  GLFWwindow* window_;
  WindowEvents events_;
  Session& session_;
  HandDevice* hand_;
  const WindowOptions& options_;
  HandControl control_;
  std::unique_ptr<JointView> joint_;
  PictureSaver saver_;
  CineLoop cine_;
  std::shared_ptr<const Scene> body_;  // of the newest image
  BodyState shown_body_;               // of the shown one
  std::uint64_t shown_body_image_ = 0;
  Guide guide_;
  ViewState state_;
  Lesson lesson_;
  PanelInput input_;
  JointSpaces spaces_;
  JointArea area_;
  GlTexture image_texture_;
  GlTexture kept_texture_;
  BodyMark mark_;
  GlTexture mark_texture_;
  ImageSnapshot kept_;
  std::optional<Vec3> target_J_;  // of the task
  std::string target_name_;
  RegionId target_region_ = kOutside;
  std::uint64_t shown_image_ = 0;
  DisplayLook shown_look_;
  bool fresh_image_ = false;
  ImageControls sent_controls_;
  std::size_t next_step_ = 0;
  double waited_ = 0;
  double interval_ = 0.1;    // s between pictures, smoothed
  double last_pass_ = 0;     // s, of the window system's clock
  double alive_at_ = 0;      // s, the last state of a living device
  double joint_took_ = 0;    // s
  double said_at_ = 0;       // s, the last message
  bool navigating_ = false;  // arrows go from knob to knob
  bool wants_final_ = true;
  std::uint64_t pictures_ = 0;
  std::vector<std::filesystem::path> wanted_pictures_;
};

}  // namespace artus
