// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/window_loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>

#include <GLFW/glfw3.h>

#include "artus/detail/core/text_file.h"
#include "artus/detail/viewer/input/gui_context.h"
#include "artus/detail/viewer/input/screen.h"
#include "artus/detail/viewer/panels/caption.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

constexpr double kLifted = 1e-3;  // m between face and skin that count as lifted

// Pixels a millimetre, as the system says; 96 an inch when it does not.
double screen_density() {
  int width_mm = 0;
  int height_mm = 0;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor != nullptr) glfwGetMonitorPhysicalSize(monitor, &width_mm, &height_mm);
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  return mode != nullptr && width_mm > 50 ? static_cast<double>(mode->width) / width_mm : 96 / 25.4;
}

}  // namespace

WindowLoop::WindowLoop(GLFWwindow* window, std::unique_ptr<JointView> joint, Session& session,
                       HandDevice* hand, const HandTarget& start, const WindowOptions& options)
    : window_(window),
      events_(window),
      session_(session),
      hand_(hand),
      options_(options),
      control_(start, needle_length_of(session.params())),
      joint_(std::move(joint)),
      saver_(options.pictures),
      cine_(session.scene().shared_joint()),
      shown_body_(state_of(session.scene())) {
  state_.language = options.language;
  state_.expert = options.expert;
  state_.welcome = options.welcome;
  state_.offers_training = options.training;
  state_.left_handed = options.left_handed;
  state_.patient = options.patient;
  state_.controls = sent_controls_ = controls_of(session.params());
  if (auto curves = read_bundled_grey_curves()) state_.grey_curves = std::move(*curves);
  state_.pixels_per_mm = options.pixels_per_mm > 0 ? options.pixels_per_mm : screen_density();
  if (options.lesson) begin_lesson();
  input_.session = &session;
  input_.has_hand = hand != nullptr;
  if (auto spaces = make_joint_spaces(session.scene().joint())) spaces_ = std::move(*spaces);
}

Result<void> WindowLoop::prepare() {
  state_.keys = KeyMap(find_keyboard());
  if (!options_.keys.empty()) {
    const auto text = read_bytes(options_.keys);
    ARTUS_TRY(text);
    auto keys = KeyMap::parse(*text, options_.keys, find_keyboard());
    ARTUS_TRY(keys);
    state_.keys = std::move(*keys);
  }
  if (!options_.layout.empty()) state_.layout.read(options_.layout);
  mark_ = make_body_mark(session_.scene().joint());
  mark_texture_.set_grey(mark_.size, mark_.size, mark_.grey);
  input_.mark = &mark_;
  input_.mark_texture = mark_texture_.id();
  if (options_.task < options_.tasks.size()) start_task(options_.task);
  state_.message.clear();
  return {};
}

Result<void> WindowLoop::run(WindowReport& report) {
  const double period = 1 / options_.rate;
  double due = glfwGetTime();
  double before = due;
  while (glfwWindowShouldClose(window_) == GLFW_FALSE && !state_.quit) {
    if (options_.asked_to_close && options_.asked_to_close()) break;
    const double now = glfwGetTime();
    const double elapsed = std::max(1e-4, now - before);
    before = now;
    interval_ += 0.1 * (elapsed - interval_);
    input_.window_rate = 1 / interval_;
    feel();
    take_image();
    fit_window();
    events_.set_left_handed(state_.left_handed);
    for (const std::vector<TimedEvent>& group : events_.take(elapsed)) {
      if (!options_.quit_after_script) handle_group(group);  // a script is alone at the window
    }
    run_script(elapsed);
    if (hand_ != nullptr) hand_->set_target(control_.target());
    events_.hold_cursor(control_.grab() != Grab::nothing);
    draw(elapsed);
    request_final_picture();
    ARTUS_TRY(save_window());
    wanted_pictures_.clear();
    glfwSwapBuffers(window_);
    note_shown(elapsed, report);
    save_pictures(elapsed);
    if (options_.watch) options_.watch(status());
    // Without graphics hardware a picture costs much; a third of the time is left to the others.
    const double drawn = glfwGetTime();
    due = std::max(due + period, drawn + 0.5 * std::min(drawn - now, period));
    events_.wait(due - drawn);
  }
  if (input_.image != nullptr) report.calipers = state_.calipers[input_.image->input.number];
  report.image_place = state_.image_place;
  report.expert = state_.expert;
  report.finished = state_.finished;
  report.training = state_.training;
  report.joint_level = joint_->level();
  if (!options_.layout.empty()) ARTUS_TRY(state_.layout.write(options_.layout));
  return {};
}

void WindowLoop::say(std::string message) {
  state_.message = std::move(message);
  said_at_ = glfwGetTime();
}

/// Why the hand did not do what was asked for.
void WindowLoop::say_refusal() {
  if (control_.refusal() == nullptr) return;
  say(fill(translate(state_, control_.refusal()),
           {state_.keys.said_key(Action::explore, state_.language)}));
}

void WindowLoop::forget_message() {
  if (glfwGetTime() - said_at_ > options_.message_seconds) state_.message.clear();
}

// When the joint was moved to the device, what the hand holds moves with it.
void WindowLoop::follow_gesture(const HapticSnapshot& now) {
  const Pose before = to_pose(input_.now.X_WJ);
  const Pose after = to_pose(now.X_WJ);
  if (now.phase != input_.now.phase) {
    joint_->clear_trail();
    state_.insertion.clear();
    say(now.phase == GesturePhase::inserting
            ? fill(translate(state_, "The entry point is at the needle; {} takes it"),
                   {state_.keys.said_key(Action::take_needle, state_.language)})
            : translate(state_, "Back to exploring"));
  }
  if (input_.now.input.tick != 0 && !before.isApprox(after, 1e-12))
    control_.follow_joint(before, after);
  input_.entry.reset();
  if (options_.lesson && !options_.lesson->needle) return;
  if (now.phase == GesturePhase::exploring && now.input.device.has_probe != 0 && now.inserted == 0)
    input_.entry = choose_entry(session_.scene(), to_pose(now.X_JP), session_.params().gesture);
}

// Before the events of a picture: a hand that acts after the gesture changed acts where it was
// moved to, however late the picture is. A button stays down until a tick has read it. The last
// state of a device that is gone stays.
void WindowLoop::feel() {
  HapticSnapshot now;
  if (session_.newest(now)) {
    input_.peer = now.input.device.state;
    input_.status = now.status;
    const bool alive = input_.peer == PeerState::alive;
    if (alive) {
      follow_gesture(now);
      input_.now = now;
      alive_at_ = glfwGetTime();
    }
    if (now.input.device.buttons == control_.target().buttons) control_.release();
  }
  input_.lost_for = glfwGetTime() - alive_at_;
  TracePoint point;
  while (session_.next_trace_point(point)) {
    state_.trace.push_back(point);
    if (input_.peer == PeerState::alive) state_.insertion.add(point);
  }
  while (!state_.trace.empty() &&
         state_.trace.back().time - state_.trace.front().time > state_.trace_seconds)
    state_.trace.pop_front();
  read_state();
}

void WindowLoop::read_state() {
  if (input_.now.input.tick == 0) return;
  const Scene& body = body_ ? *body_ : session_.scene();
  input_.needle = read_needle(body, input_.now, needle_length_of(session_.params()), target_J_,
                              state_.language);
  input_.probe = read_probe(input_.now, session_.params());
  if (!spaces_.spaces.empty())
    input_.syringe = read_syringe(session_.scene(), spaces_, input_.now, session_.params());
  const Pose X_JP = to_pose(input_.now.X_JP);
  const auto gap = BodyContact{&session_.scene(), Pose::Identity()}.find_gap(X_JP);
  // Where the skin is hollow a face lies on with its ends: what presses is not lifted.
  const bool touches = input_.probe.share > 0 || (gap && *gap <= kLifted);
  const bool lifted = input_.now.input.device.has_probe != 0 && !touches;
  if (lifted != input_.probe_lifted && control_.grab() == Grab::probe)
    say(translate(state_, lifted ? msgid("The probe lifts off the skin")
                                 : msgid("The probe lies on the skin")));
  input_.probe_lifted = lifted;
}

void WindowLoop::guide() {
  if (options_.lesson) lead_lesson();
  GuideInput in;
  in.language = state_.language;
  in.keys = &state_.keys;
  in.has_hand = hand_ != nullptr;
  in.welcome = state_.welcome;
  in.paused = session_.paused();
  in.frozen = session_.frozen();
  in.peer = input_.peer;
  in.connect = options_.connect;
  in.phase = input_.now.phase;
  in.grab = control_.grab();
  in.probe_lifted = input_.probe_lifted;
  in.target = target_name_;
  in.target_region = target_region_;
  in.target_is_bone = session_.scene().joint().tissue_of(target_region_).haptic.hard;
  in.needle = input_.needle;
  in.needle_length = needle_length_of(session_.params());
  if (options_.lesson && !options_.lesson->aids.any()) in.needle = seen_from_outside(in.needle);
  const bool looks = options_.lesson && !options_.lesson->needle && in.peer == PeerState::alive;
  if (!looks)
    input_.next = guide_.next(in);
  else if (in.grab == Grab::probe)
    input_.next.clear();
  else
    input_.next = state_.keys.said_key(Action::take_probe, state_.language) + ": " +
                  translate(state_, "Explore with the probe");
  const bool able = in.peer == PeerState::alive && !in.paused;
  if (able && options_.lesson && !lesson_.next.empty()) input_.next = lesson_.next;
  input_.goal = options_.lesson ? lesson_.goal : guide_.goal(in);
}

// One look of the panels at what was done; nothing is shown yet.
void WindowLoop::pass(double elapsed) {
  ImGuiIO& io = ImGui::GetIO();
  io.DeltaTime = static_cast<float>(std::clamp(elapsed, 1e-4, 1.0));
  last_pass_ = glfwGetTime();
  input_.grab = control_.grab();
  ImGui::NewFrame();
  draw_guide_panel(input_, state_);
  draw_joint_panel(input_, state_, *joint_, area_);
  draw_image_panel(input_, state_);
  draw_scanner_panel(input_, state_);
  if (state_.lesson != nullptr) {
    draw_lesson_panel(input_, state_);
    draw_patient_panel(input_, state_);
  } else {
    draw_session_panel(input_, state_);
    draw_tissue_panel(input_, state_, *joint_);
  }
  draw_force_panel(input_, state_);
  draw_rates_panel(input_, state_);
  draw_welcome(input_, state_);
  draw_help(input_, state_);
  ImGui::EndFrame();
  for (float& held : io.NavInputs) held = 0;
  io.MouseWheel = 0;
  apply_requests();
}

// Letters and panels follow the window's size and the screen's resolution.
void WindowLoop::fit_window() {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  const float scale = find_gui_scale(window_, options_.font_scale);
  if (std::abs(scale - input_.scale) > 0.01F || !ImGui::GetIO().Fonts->IsBuilt()) {
    set_gui_scale(scale);
    input_.scale = scale;
  }
  ImGui::GetIO().DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  state_.layout.set_shape({width, height, scale, state_.expert});
  ImGui_ImplOpenGL3_NewFrame();
}

void WindowLoop::draw(double elapsed) {
  input_.clip_seconds = saver_.clip_seconds();
  forget_message();
  guide();
  const bool shown = !state_.expert && state_.layout.place(Panel::joint).width > 0;
  if (shown) draw_joint();
  pass(elapsed);
  ImGui::Render();
  if (!(state_.controls == sent_controls_)) {
    session_.set_controls(state_.controls);
    sent_controls_ = state_.controls;
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  glViewport(0, 0, static_cast<int>(size.x), static_cast<int>(size.y));
  glClearColor(0.05F, 0.05F, 0.06F, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void WindowLoop::note_shown(double elapsed, WindowReport& report) {
  report.pictures = ++pictures_;
  report.interval.add(static_cast<std::int64_t>(1e9 * elapsed));
  if (joint_took_ > 0) report.joint.add(static_cast<std::int64_t>(1e9 * joint_took_));
  if (fresh_image_ && input_.peer == PeerState::alive)
    report.pose_to_screen.add(monotonic_ns() - input_.image->input.sample_time_ns);
}

// Without a script: one picture of the window as soon as everything is in it.
void WindowLoop::request_final_picture() {
  if (!options_.script.empty() || options_.screenshot.empty() || !wants_final_) return;
  constexpr std::uint64_t kSettled = 5;  // pictures, until all panels have their sizes
  const bool image = input_.image != nullptr && input_.image->width > 0;
  const bool joint = state_.expert || input_.joint_texture != 0;
  if (!image || !joint || pictures_ < kSettled) return;
  wants_final_ = false;
  wanted_pictures_.push_back(options_.screenshot);
  state_.quit = true;
}

// What was just drawn, before it is shown and the buffer's content is lost.
Result<void> WindowLoop::save_window() const {
  for (const std::filesystem::path& file : wanted_pictures_) ARTUS_TRY(save_screen(window_, file));
  return {};
}

WindowStatus WindowLoop::status() const {
  WindowStatus now;
  now.pictures = pictures_;
  now.goal = input_.goal;
  now.next = input_.next;
  now.message = state_.message;
  now.needle = input_.needle;
  now.syringe = input_.syringe;
  now.grab = control_.grab();
  now.phase = input_.now.phase;
  now.image_place = state_.image_place;
  now.image = input_.image == nullptr ? 0 : input_.image->input.number;
  now.joint_image = joint_->image_shown();
  now.joint_points_sent = joint_->points_sent();
  now.has_image = input_.image != nullptr && input_.image->width > 0;
  for (const auto& [image, points] : state_.calipers) now.caliper_points += points.size();
  if (state_.lesson != nullptr) {
    now.task = state_.lesson->title;
    now.remark = state_.lesson->remark;
    for (const LessonStep& step : state_.lesson->steps)
      if (!step.done) now.steps.push_back(step.text);
  }
  now.frozen = session_.frozen();
  now.recording = state_.wants_clip;
  now.clip_seconds = saver_.clip_seconds();
  now.look = state_.look;
  now.reached = guide_.reached();
  now.camera = joint_->camera();
  now.controls = state_.controls;
  now.view = state_.view;
  now.dual = state_.dual;
  now.help = state_.help;
  now.keys = state_.keys;
  now.picture_panel = state_.layout.place(Panel::picture);
  return now;
}

}  // namespace artus
