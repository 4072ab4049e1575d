// SPDX-License-Identifier: AGPL-3.0-or-later
#include "viewer/window.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <sys/resource.h>

#include <GLFW/glfw3.h>

#include "viewer/panels.h"

namespace artus {
namespace {

/// What GLFW's callbacks collect; the window's user pointer.
struct EventQueue {
  std::vector<UserEvent> events;
  std::vector<unsigned> characters;
  bool shift = false;
};

EventQueue& queue_of(GLFWwindow* window) {
  return *static_cast<EventQueue*>(glfwGetWindowUserPointer(window));
}

std::string name_of(int key) {
  if ((key >= GLFW_KEY_A && key <= GLFW_KEY_Z) || (key >= GLFW_KEY_0 && key <= GLFW_KEY_9))
    return {static_cast<char>(key)};
  switch (key) {
    case GLFW_KEY_ESCAPE:
      return "ESCAPE";
    case GLFW_KEY_SPACE:
      return "SPACE";
    case GLFW_KEY_HOME:
      return "HOME";
    case GLFW_KEY_F1:
      return "F1";
    default:
      return {};
  }
}

void on_key(GLFWwindow* window, int key, int /*scancode*/, int action, int mods) {
  EventQueue& queue = queue_of(window);
  queue.shift = (mods & GLFW_MOD_SHIFT) != 0;
  if (action == GLFW_RELEASE) return;
  std::string name = name_of(key);
  if (!name.empty()) queue.events.emplace_back(KeyEvent{std::move(name)});
}

void on_move(GLFWwindow* window, double x, double y) {
  queue_of(window).events.emplace_back(MoveEvent{x, y});
}

void on_button(GLFWwindow* window, int button, int action, int /*mods*/) {
  queue_of(window).events.emplace_back(ButtonEvent{button, action == GLFW_PRESS});
}

void on_scroll(GLFWwindow* window, double /*x*/, double y) {
  EventQueue& queue = queue_of(window);
  queue.events.emplace_back(ScrollEvent{y, queue.shift});
}

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

class WindowLoop {
 public:
  WindowLoop(GLFWwindow* window, Session& session, HandDevice* hand, const HandTarget& start,
             const WindowOptions& options, std::unique_ptr<JointView> joint, float scale)
      : window_(window),
        session_(session),
        hand_(hand),
        options_(options),
        control_(start),
        joint_(std::move(joint)) {
    state_.expert = options.expert;
    state_.controls = controls_of(session.params());
    input_.session = &session;
    input_.scale = scale;
    input_.has_hand = hand != nullptr;
    int width_mm = 0;
    int height_mm = 0;
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (monitor != nullptr) glfwGetMonitorPhysicalSize(monitor, &width_mm, &height_mm);
    const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (mode != nullptr && width_mm > 50)
      state_.pixels_per_mm = static_cast<double>(mode->width) / width_mm;
  }

  Result<void> run(EventQueue& queue) {
    const auto period = std::chrono::duration<double>(1 / options_.rate);
    auto due = std::chrono::steady_clock::now();
    auto before = due;
    while (glfwWindowShouldClose(window_) == GLFW_FALSE && !state_.quit) {
      glfwPollEvents();
      for (const UserEvent& event : queue.events) handle(event);
      queue.events.clear();
      const auto now = std::chrono::steady_clock::now();
      const double elapsed = std::max(1e-4, std::chrono::duration<double>(now - before).count());
      before = now;
      interval_ += 0.1 * (elapsed - interval_);
      input_.window_rate = 1 / interval_;
      run_script(elapsed);
      draw(elapsed);
      if (const auto saved = save_window(); !saved) return saved;
      wanted_pictures_.clear();
      glfwSwapBuffers(window_);
      save_pictures();
      // Without graphics hardware a picture costs much; half of the time is left to the others.
      const auto drawn = std::chrono::steady_clock::now();
      due = std::max(due + std::chrono::duration_cast<std::chrono::nanoseconds>(period),
                     drawn + (drawn - now) / 2);
      std::this_thread::sleep_until(due);
    }
    return {};
  }

 private:
  void handle(const UserEvent& event);
  void handle_key(const std::string& key);
  void orbit(double dx, double dy);
  void run_script(double elapsed);
  bool run_step(const ScriptStep& step, double elapsed);
  void gather();
  void draw(double elapsed);
  void save_pictures();
  Result<void> save_window() const;

  GLFWwindow* window_;
  Session& session_;
  HandDevice* hand_;
  const WindowOptions& options_;
  HandControl control_;
  std::unique_ptr<JointView> joint_;
  ViewState state_;
  PanelInput input_;
  JointArea area_;
  GlTexture image_texture_;
  std::uint64_t shown_image_ = 0;
  ImageControls sent_controls_;
  std::size_t next_step_ = 0;
  double waited_ = 0;
  double interval_ = 0.1;  // s between pictures, smoothed
  bool wants_final_ = true;
  std::vector<std::filesystem::path> wanted_pictures_;
  bool dragging_ = false;
  double x_ = 0;
  double y_ = 0;
  int saved_ = 0;
  cv::VideoWriter clip_;
};

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
  if (key == "R") {
    session_.reset();
    joint_->clear_trail();
  }
}

void WindowLoop::handle(const UserEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  const bool taken = hand_ != nullptr && control_.handle(event, input_.now.inserted != 0);
  if (hand_ != nullptr) hand_->set_target(control_.target());
  if (const auto* key = std::get_if<KeyEvent>(&event)) {
    if (!taken) handle_key(key->key);
  } else if (const auto* move = std::get_if<MoveEvent>(&event)) {
    if (dragging_ && control_.grab() == Grab::nothing) orbit(move->x - x_, move->y - y_);
    x_ = move->x;
    y_ = move->y;
    io.MousePos = ImVec2(static_cast<float>(x_), static_cast<float>(y_));
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

void WindowLoop::gather() {
  HapticSnapshot now;
  if (session_.newest(now)) input_.now = now;
  TracePoint point;
  while (session_.next_trace_point(point)) state_.trace.push_back(point);
  while (!state_.trace.empty() &&
         state_.trace.back().time - state_.trace.front().time > state_.trace_seconds)
    state_.trace.pop_front();
  input_.image = session_.newest_image();
  if (input_.image != nullptr && input_.image->input.number != shown_image_) {
    shown_image_ = input_.image->input.number;
    image_texture_.set_grey(input_.image->width, input_.image->height, input_.image->grey);
  }
  input_.image_texture = image_texture_.id();
  input_.grab = control_.grab();
  if (!(state_.controls == sent_controls_)) {
    session_.set_controls(state_.controls);
    sent_controls_ = state_.controls;
  }
}

void WindowLoop::draw(double elapsed) {
  gather();
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  io.DeltaTime = static_cast<float>(elapsed);
  if (!state_.expert)
    input_.joint_texture =
        joint_->draw(area_.width, area_.height, input_.now, input_.image, image_texture_);
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

void WindowLoop::save_pictures() {
  if (input_.image == nullptr || input_.image->width == 0) return;
  const ImageSnapshot& image = *input_.image;
  const cv::Mat grey(image.height, image.width, CV_8UC1,
                     const_cast<std::uint8_t*>(image.grey.data()));  // read only
  if (state_.wants_screenshot) {
    state_.wants_screenshot = false;
    const auto file = options_.pictures / ("bmode-" + std::to_string(++saved_) + ".png");
    state_.message = cv::imwrite(file.string(), grey) ? "saved " + file.string()
                                                      : "cannot write " + file.string();
  }
  if (state_.recording_clip && !clip_.isOpened()) {
    const auto file = options_.pictures / ("clip-" + std::to_string(++saved_) + ".avi");
    clip_.open(file.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), options_.rate,
               grey.size(), false);
    state_.message = clip_.isOpened() ? "clip " + file.string() : "cannot write " + file.string();
  }
  if (state_.recording_clip && clip_.isOpened()) clip_.write(grey);
  if (!state_.recording_clip && clip_.isOpened()) clip_.release();
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
                        const WindowOptions& options) {
  // The picture yields to haptics and imaging; threads that the graphics driver starts do, too.
  setpriority(PRIO_PROCESS, 0, 10);
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
  EventQueue queue;
  glfwSetWindowUserPointer(window.get(), &queue);
  glfwSetKeyCallback(window.get(), on_key);
  glfwSetCursorPosCallback(window.get(), on_move);
  glfwSetMouseButtonCallback(window.get(), on_button);
  glfwSetScrollCallback(window.get(), on_scroll);
  const float scale = std::clamp(static_cast<float>(options.height) / 720.F, 1.F, 3.F);
  const Gui gui(options.layout, scale);
  auto joint = JointView::make(session.scene().joint(), session.params().transducer.width,
                               session.params().needle_shape.length);
  if (!joint) return tl::unexpected<Error>(joint.error());
  WindowLoop loop(window.get(), session, hand, start, options, std::move(*joint), scale);
  return loop.run(queue);
}

}  // namespace artus
