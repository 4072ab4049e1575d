// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/viewer/window.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include <GLFW/glfw3.h>

#include "artus/viewer/panels.h"
#include "artus/viewer/picture_saver.h"
#include "artus/viewer/window_events.h"

namespace artus {
namespace {

struct WindowCloser {
  void operator()(GLFWwindow* window) const noexcept { glfwDestroyWindow(window); }
};

/// GLFW for as long as it lives.
struct Library {
  bool ready = glfwInit() == GLFW_TRUE;
  Library() = default;
  ~Library() {
    if (ready) glfwTerminate();
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

/// Dear ImGui for as long as it lives. Fed by hand, so that a script's events and a person's are
/// the same.
struct Gui {
  std::string layout;
  explicit Gui(const std::filesystem::path& layout_file, float scale) : layout(layout_file) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = layout.empty() ? nullptr : layout.c_str();
    const char* font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    if (std::filesystem::exists(font)) io.Fonts->AddFontFromFileTTF(font, std::round(13 * scale));
    ImGui::StyleColorsDark();
    ImGui::GetStyle().ScaleAllSizes(scale);
    ImGui_ImplOpenGL3_Init("#version 330");
  }
  ~Gui() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
  }
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;
};

/// The picture comes after haptics and imaging; so do the threads that the graphics driver starts.
/// Where imaging could not be made more urgent than usual, the window is made less.
void yield_to_imaging() {
  const auto self = static_cast<id_t>(gettid());
  const bool may_be_urgent = setpriority(PRIO_PROCESS, self, -1) == 0;
  setpriority(PRIO_PROCESS, self, may_be_urgent ? 0 : 10);
}

/// Letters as large as the screen asks for, or as they are on a window of 720 lines.
float text_scale(GLFWwindow* window, int height) {
  float x = 1;
  float y = 1;
  glfwGetWindowContentScale(window, &x, &y);
  return std::clamp(std::max(y, static_cast<float>(height) / 720.F), 1.F, 4.F);
}

/// An open window and what is drawn in it.
struct Canvas {
  GLFWwindow* window;
  float scale;  ///< of letters
  std::unique_ptr<JointView> joint;
};

class WindowLoop {
 public:
  WindowLoop(Canvas canvas, Session& session, HandDevice* hand, const HandTarget& start,
             const WindowOptions& options, WindowReport& report)
      : window_(canvas.window),
        events_(canvas.window),
        session_(session),
        hand_(hand),
        options_(options),
        report_(report),
        control_(start),
        joint_(std::move(canvas.joint)),
        saver_(options.pictures) {
    state_.expert = options.expert;
    state_.controls = controls_of(session.params());
    state_.pixels_per_mm = options.pixels_per_mm > 0 ? options.pixels_per_mm : screen_density();
    input_.session = &session;
    input_.scale = canvas.scale;
    input_.has_hand = hand != nullptr;
  }

  Result<void> run() {
    const auto period = std::chrono::duration<double>(1 / options_.rate);
    auto due = std::chrono::steady_clock::now();
    auto before = due;
    while (glfwWindowShouldClose(window_) == GLFW_FALSE && !state_.quit) {
      if (options_.asked_to_close && options_.asked_to_close()) break;
      const auto now = std::chrono::steady_clock::now();
      const double elapsed = std::max(1e-4, std::chrono::duration<double>(now - before).count());
      before = now;
      interval_ += 0.1 * (elapsed - interval_);
      input_.window_rate = 1 / interval_;
      feel();
      const std::vector<UserEvent> events = events_.take(elapsed);
      if (!options_.quit_after_script) {  // a script is alone at the window
        for (const UserEvent& event : events) handle(event);
      }
      run_script(elapsed);
      if (hand_ != nullptr) hand_->set_target(control_.target());
      events_.hold_cursor(control_.grab() != Grab::nothing);
      draw(elapsed);
      ARTUS_TRY(save_window());
      wanted_pictures_.clear();
      glfwSwapBuffers(window_);
      note_shown();
      save_pictures(elapsed);
      // Without graphics hardware a picture costs much; a third of the time is left to the others.
      const auto drawn = std::chrono::steady_clock::now();
      due = std::max(due + std::chrono::duration_cast<std::chrono::nanoseconds>(period),
                     drawn + (drawn - now) / 2);
      std::this_thread::sleep_until(due);
    }
    report_.calipers = state_.calipers;
    report_.image_place = state_.image_place;
    report_.expert = state_.expert;
    return {};
  }

 private:
  static double screen_density();
  void handle(const UserEvent& event);
  void handle_key(const std::string& key);
  void handle_move(const MoveEvent& move);
  void orbit(double dx, double dy);
  void run_script(double elapsed);
  bool run_step(const ScriptStep& step, double elapsed);
  void feel();
  void take_image();
  void follow_gesture(const HapticSnapshot& now);
  void draw_joint();
  void draw(double elapsed);
  void note_shown();
  void save_pictures(double elapsed);
  Result<void> save_window() const;

  GLFWwindow* window_;
  WindowEvents events_;
  Session& session_;
  HandDevice* hand_;
  const WindowOptions& options_;
  WindowReport& report_;
  HandControl control_;
  std::unique_ptr<JointView> joint_;
  PictureSaver saver_;
  ViewState state_;
  PanelInput input_;
  JointArea area_;
  GlTexture image_texture_;
  std::uint64_t shown_image_ = 0;
  bool fresh_image_ = false;
  ImageControls sent_controls_;
  std::size_t next_step_ = 0;
  double waited_ = 0;
  double interval_ = 0.1;  // s between pictures, smoothed
  bool wants_final_ = true;
  std::vector<std::filesystem::path> wanted_pictures_;
  std::chrono::steady_clock::time_point joint_due_;
  bool dragging_ = false;
  double x_ = 0;
  double y_ = 0;
};

// Pixels a millimetre, as the system says; 96 an inch when it does not.
double WindowLoop::screen_density() {
  int width_mm = 0;
  int height_mm = 0;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor != nullptr) glfwGetMonitorPhysicalSize(monitor, &width_mm, &height_mm);
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  return mode != nullptr && width_mm > 50 ? static_cast<double>(mode->width) / width_mm : 96 / 25.4;
}

void WindowLoop::orbit(double dx, double dy) {
  OrbitCamera& camera = joint_->camera();
  camera.yaw += 0.01 * dx;
  camera.pitch = std::clamp(camera.pitch + 0.01 * dy, -1.5, 1.5);
}

void WindowLoop::handle_key(const std::string& key) {
  if (key == "F") session_.set_frozen(!session_.frozen());
  if (key == "SPACE") session_.set_paused(!session_.paused());
  if (key == "E") state_.expert = !state_.expert;
  if (key == "F1") state_.help = !state_.help;
  if (key == "V") state_.wants_screenshot = true;
  if (key == "K") state_.wants_clip = !state_.wants_clip;
  if (key == "T") state_.true_scale = !state_.true_scale;
  if (key == "M") state_.calipers.clear();
  if (key == "R") {
    session_.reset();
    joint_->clear_trail();
  }
}

void WindowLoop::handle_move(const MoveEvent& move) {
  const bool held = control_.grab() != Grab::nothing;
  if (dragging_ && !held) orbit(move.x - x_, move.y - y_);
  x_ = move.x;
  y_ = move.y;
  if (!held) ImGui::GetIO().MousePos = ImVec2(static_cast<float>(x_), static_cast<float>(y_));
}

void WindowLoop::handle(const UserEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  std::optional<Vec3> entry_W;
  if (input_.now.inserted != 0) {
    const auto& e = input_.now.entry_J;
    entry_W = to_pose(input_.now.X_WJ) * Vec3(e[0], e[1], e[2]);
  }
  const bool taken = hand_ != nullptr && control_.handle(event, entry_W);
  if (const auto* key = std::get_if<KeyEvent>(&event)) {
    if (!taken) handle_key(key->key);
  } else if (const auto* move = std::get_if<MoveEvent>(&event)) {
    handle_move(*move);
  } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
    if (button->button >= 0 && button->button < 3) io.MouseDown[button->button] = button->down;
    dragging_ = button->button == 0 && button->down && area_.hovered;
  } else if (const auto* scroll = std::get_if<ScrollEvent>(&event); scroll != nullptr && !taken) {
    io.MouseWheel += static_cast<float>(scroll->notches);
    if (area_.hovered) joint_->camera().distance *= std::pow(0.9, scroll->notches);
  }
}

bool WindowLoop::run_step(const ScriptStep& step, double elapsed) {
  if (const auto* event = std::get_if<UserEvent>(&step)) {
    handle(*event);
  } else if (const auto* wait = std::get_if<WaitStep>(&step)) {
    waited_ += elapsed;
    if (waited_ < wait->seconds) return false;
    waited_ = 0;
  } else if (const auto* tissue = std::get_if<TissueStep>(&step)) {
    for (TissueLook& look : joint_->looks()) {
      if (look.name == tissue->tissue) look.alpha = static_cast<float>(tissue->alpha);
    }
  } else if (const auto* shot = std::get_if<ScreenshotStep>(&step)) {
    wanted_pictures_.push_back(shot->file);
  } else if (const auto* connect = std::get_if<ConnectStep>(&step)) {
    if (hand_ != nullptr) hand_->set_connected(connect->connected);
  } else if (const auto* camera = std::get_if<CameraStep>(&step)) {
    joint_->camera().yaw = camera->yaw;
    joint_->camera().pitch = camera->pitch;
    joint_->camera().distance = camera->distance;
  } else if (const auto* measure = std::get_if<MeasureStep>(&step)) {
    state_.calipers.push_back({measure->from_x_mm, measure->from_y_mm});
    state_.calipers.push_back({measure->to_x_mm, measure->to_y_mm});
  }
  return true;
}

void WindowLoop::run_script(double elapsed) {
  while (next_step_ < options_.script.size()) {
    if (!run_step(options_.script[next_step_], elapsed)) return;
    ++next_step_;
    elapsed = 0;
  }
  if (!options_.script.empty() && wants_final_ && !options_.screenshot.empty()) {
    wants_final_ = false;
    wanted_pictures_.push_back(options_.screenshot);
  }
  if (options_.quit_after_script) state_.quit = true;
}

// When the joint was moved to the device, what the hand holds moves with it.
void WindowLoop::follow_gesture(const HapticSnapshot& now) {
  const Pose before = to_pose(input_.now.X_WJ);
  const Pose after = to_pose(now.X_WJ);
  if (now.phase != input_.now.phase) {
    joint_->clear_trail();
    state_.message = now.phase == GesturePhase::inserting
                         ? "the entry point is at the needle; N takes it"
                         : "back to exploring";
  }
  if (input_.now.input.tick != 0 && !before.isApprox(after, 1e-12))
    control_.follow_joint(before, after);
  input_.entry.reset();
  if (now.phase == GesturePhase::exploring && now.input.device.has_probe != 0 && now.inserted == 0)
    input_.entry = choose_entry(session_.scene(), to_pose(now.X_JP), session_.params().gesture);
}

// Before the events of a picture: a hand that acts after the gesture changed acts where it was
// moved to, however late the picture is. A button stays down until a tick has read it.
void WindowLoop::feel() {
  HapticSnapshot now;
  if (session_.newest(now)) {
    follow_gesture(now);
    input_.now = now;
  }
  if (input_.now.input.device.buttons == control_.target().buttons) control_.release();
  TracePoint point;
  while (session_.next_trace_point(point)) state_.trace.push_back(point);
  while (!state_.trace.empty() &&
         state_.trace.back().time - state_.trace.front().time > state_.trace_seconds)
    state_.trace.pop_front();
}

void WindowLoop::take_image() {
  input_.image = session_.newest_image();
  fresh_image_ = input_.image != nullptr && input_.image->input.number != shown_image_;
  if (fresh_image_) {
    shown_image_ = input_.image->input.number;
    image_texture_.set_grey(input_.image->width, input_.image->height, input_.image->grey);
  }
  input_.image_texture = image_texture_.id();
  input_.grab = control_.grab();
  input_.gamepad = WindowEvents::gamepad_name();
  if (options_.turn_knobs) options_.turn_knobs(state_.controls);
  if (!(state_.controls == sent_controls_)) {
    session_.set_controls(state_.controls);
    sent_controls_ = state_.controls;
  }
}

// Drawn in software the joint takes longer than all else; the image and the plots go on meanwhile
// with the joint's last picture for as long as it took, twice over.
void WindowLoop::draw_joint() {
  const auto now = std::chrono::steady_clock::now();
  if (now < joint_due_) return;
  input_.joint_texture = joint_->draw(area_.width, area_.height,
                                      {input_.now, input_.image, image_texture_, input_.entry});
  glFinish();
  const auto drawn = std::chrono::steady_clock::now();
  joint_due_ = drawn + 2 * (drawn - now);
}

void WindowLoop::draw(double elapsed) {
  take_image();
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  io.DeltaTime = static_cast<float>(elapsed);
  if (!state_.expert) draw_joint();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  if (!state_.expert) draw_joint_panel(input_, state_, area_);
  draw_image_panel(input_, state_);
  draw_scanner_panel(input_, state_);
  draw_session_panel(input_, state_);
  draw_tissue_panel(input_, state_, *joint_);
  draw_force_panel(input_, state_);
  draw_rates_panel(input_, state_);
  draw_help(input_, state_);
  ImGui::Render();
  glViewport(0, 0, width, height);
  glClearColor(0.05F, 0.05F, 0.06F, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void WindowLoop::note_shown() {
  ++report_.pictures;
  if (fresh_image_ && input_.now.input.device.state == PeerState::alive)
    report_.pose_to_screen.add(monotonic_ns() - input_.image->input.sample_time_ns);
}

void WindowLoop::save_pictures(double elapsed) {
  if (input_.image == nullptr || input_.image->width == 0) return;
  const ImageSnapshot& image = *input_.image;
  if (std::exchange(state_.wants_screenshot, false)) state_.message = saver_.save(image);
  if (saver_.in_clip()) saver_.add_to_clip(image, elapsed);
  if (state_.wants_clip == saver_.in_clip()) return;
  state_.message = state_.wants_clip ? saver_.begin_clip(image) : saver_.end_clip();
  state_.wants_clip = saver_.in_clip();  // it may have been refused
}

// What was just drawn, before it is shown and the buffer's content is lost.
Result<void> WindowLoop::save_window() const {
  if (wanted_pictures_.empty()) return {};
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  cv::Mat picture(height, width, CV_8UC3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, width, height, GL_BGR, GL_UNSIGNED_BYTE, picture.data);
  cv::flip(picture, picture, 0);
  for (const std::filesystem::path& file : wanted_pictures_) {
    if (!cv::imwrite(file.string(), picture))
      return fail(ErrorCode::unreadable, "cannot write the picture", file);
  }
  return {};
}

}  // namespace

Result<void> run_window(Session& session, HandDevice* hand, const HandTarget& start,
                        const WindowOptions& options, WindowReport& report) {
  yield_to_imaging();
  const Library library;
  if (!library.ready)
    return fail(ErrorCode::failed, "there is no display; run under Xvfb (xvfb-run) without one");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  const std::unique_ptr<GLFWwindow, WindowCloser> window(
      glfwCreateWindow(options.width, options.height, "artus", nullptr, nullptr));
  if (!window) return fail(ErrorCode::failed, "the display has no OpenGL 3.3");
  glfwMakeContextCurrent(window.get());
  glfwSwapInterval(0);
  const float scale = text_scale(window.get(), options.height);
  const Gui gui(options.layout, scale);
  auto joint = JointView::make(session.scene().joint(), session.params().transducer.width,
                               needle_length_of(session.params()));
  ARTUS_TRY(joint);
  WindowLoop loop({window.get(), scale, std::move(*joint)}, session, hand, start, options, report);
  return loop.run();
}

}  // namespace artus
