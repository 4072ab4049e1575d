// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <utility>

#include <GLFW/glfw3.h>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/probe/setting_ranges.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/window_loop.h"
#include "artus/detail/viewer/words/anatomy_names.h"
#include "artus/detail/viewer/words/system_words.h"

namespace artus {

HandGround WindowLoop::ground() const {
  HandGround ground;
  ground.body = {&session_.scene(), to_pose(input_.now.X_WJ)};
  if (input_.now.inserted != 0) {
    const auto& e = input_.now.entry_J;
    ground.entry_W = ground.body.X_WJ * Vec3(e[0], e[1], e[2]);
  }
  ground.has_entry_choice = input_.entry.has_value();
  ground.phase = input_.now.phase;
  return ground;
}

void WindowLoop::handle_group(const std::vector<TimedEvent>& group) {
  for (const TimedEvent& event : group) handle(event.event);
  pass(group.back().time - last_pass_);
}

void WindowLoop::handle(const UserEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  if (const auto* key = std::get_if<KeyEvent>(&event)) {
    act({state_.keys.find(key->key, key->shift), key->shift});
    return;
  }
  if (const auto* request = std::get_if<ActionEvent>(&event)) {
    act(*request);
    return;
  }
  const bool held = control_.grab() != Grab::nothing;
  const bool taken = hand_ != nullptr && control_.handle(event, ground());
  say_refusal();
  if (const auto* move = std::get_if<MoveEvent>(&event)) {
    const ImVec2 away(-FLT_MAX, -FLT_MAX);
    io.MousePos = held || move->hidden
                      ? away
                      : ImVec2(static_cast<float>(move->x), static_cast<float>(move->y));
    navigating_ = false;
  } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
    if (button->down && button->hidden) return;  // made before the pointer was back
    if (button->button >= 0 && button->button < 3) io.MouseDown[button->button] = button->down;
  } else if (const auto* scroll = std::get_if<ScrollEvent>(&event); scroll != nullptr && !taken) {
    io.MouseWheel += static_cast<float>(scroll->notches);
  }
}

void WindowLoop::act(const ActionEvent& request) {
  constexpr std::array<Action, 12> kOfHands{
      Action::take_probe, Action::take_needle,  Action::push,         Action::pull,
      Action::home,       Action::undo,         Action::turn_left,    Action::turn_right,
      Action::explore,    Action::choose_entry, Action::take_plunger, Action::none};
  const Action action = request.action;
  if (action == Action::none) return;
  if (action == Action::let_go) {
    navigating_ = false;
    state_.cross.reset();
    if (std::exchange(state_.help, false)) return;  // what lies over the rest goes first
  }
  const bool of_hands = std::find(kOfHands.begin(), kOfHands.end(), action) != kOfHands.end();
  if (hand_ == nullptr && of_hands) {
    say(fill(translate(state_, "This key moves a hand, but this session is driven by: {}"),
             {said_by_system(state_.language, std::string(session_.device_name()))}));
    return;
  }
  if (of_hands) state_.welcome = false;
  if (!state_.cross && hand_ != nullptr && control_.handle(action, request.fine, ground())) {
    if (action == Action::undo) say(translate(state_, "The needle is back where it was"));
    say_refusal();
    return;
  }
  if (act_on_window(action) || act_on_picture(action)) return;
  act_on_arrow(action, request.fine);
}

/// In a task that is judged without aids nothing shows the truth, and nothing begins again.
bool WindowLoop::refuse_aid(Action action) {
  const bool aid = action == Action::expert || action == Action::aids || action == Action::labels ||
                   action == Action::reset;
  if (!options_.lesson || !aid) return false;
  if (options_.lesson->aids.any() && action != Action::reset) return false;
  say(translate(state_, "Not in this task: it is judged without aids"));
  return true;
}

bool WindowLoop::act_on_window(Action action) {
  if (refuse_aid(action)) return true;
  switch (action) {
    case Action::finish:
      if (options_.lesson) state_.quit = state_.finished = true;
      return true;
    case Action::pause:
      session_.set_paused(!session_.paused());
      return true;
    case Action::reset:
      session_.reset();
      joint_->clear_trail();
      state_.insertion.clear();
      guide_.begin_again();
      return true;
    case Action::expert:
      state_.expert = !state_.expert;
      return true;
    case Action::aids:
      state_.aids = !state_.aids;
      return true;
    case Action::labels:
      state_.labels = !state_.labels;
      return true;
    case Action::help:
      state_.help = !state_.help;
      return true;
    case Action::layout:
      state_.layout.put_back();
      say(translate(state_, "The panels are back in their places"));
      return true;
    case Action::next_panel: {
      if (state_.layout.narrow() && !state_.welcome) state_.layout.choose_next();
      const std::string panel = state_.welcome ? "###welcome"
                                : state_.layout.narrow()
                                    ? "###" + std::string(name_of(state_.layout.chosen()))
                                : navigating_ && !state_.expert ? "###session"
                                                                : "###scanner";
      navigating_ = true;
      ImGui::SetWindowFocus(panel.c_str());
      return true;
    }
    default:
      return false;
  }
}

void WindowLoop::set_frozen(bool frozen) {
  session_.set_frozen(frozen);
  if (frozen) return;
  state_.cine.reset();  // measures belong to the picture that they were made on
  std::erase_if(state_.calipers, [this](const auto& measured) {
    return input_.kept == nullptr || measured.first != kept_.input.number;
  });
  state_.cross.reset();
}

void WindowLoop::step_cine(int step) {
  if (!session_.frozen() || cine_.size() == 0) return;
  const auto last = static_cast<int>(cine_.size()) - 1;
  const auto now = static_cast<int>(state_.cine.value_or(cine_.size() - 1));
  state_.cine = static_cast<std::size_t>(std::clamp(now + step, 0, last));
}

void WindowLoop::begin_measuring() {
  if (!session_.frozen()) set_frozen(true);
  if (input_.image != nullptr)
    state_.cross = ImagePoint{500 * input_.image->width * input_.image->pixel,
                              500 * input_.image->height * input_.image->pixel};
  say(fill(translate(state_, "Caliper: arrows move the cross, {} sets a point"),
           {state_.keys.said_key(Action::accept, state_.language)}));
}

bool WindowLoop::act_on_picture(Action action) {
  ImageControls& c = state_.controls;
  const auto turn = [](double& knob, double step, const Range& range) {
    knob = std::clamp(knob + step, range.low, range.high);
  };
  switch (action) {
    case Action::freeze:
      set_frozen(!session_.frozen());
      return true;
    case Action::save:
      state_.wants_screenshot = true;
      return true;
    case Action::clip:
      state_.wants_clip = !state_.wants_clip;
      return true;
    case Action::true_scale:
      state_.true_scale = !state_.true_scale;
      return true;
    case Action::clear_calipers:
      state_.calipers.clear();
      return true;
    case Action::measure:
      begin_measuring();
      return true;
    case Action::depth_more:
    case Action::depth_less:
      turn(c.depth, action == Action::depth_more ? 5e-3 : -5e-3, KnobRanges::depth);
      return true;
    case Action::gain_more:
    case Action::gain_less:
      turn(c.gain_db, action == Action::gain_more ? 2 : -2, KnobRanges::gain_db);
      return true;
    case Action::zoom_in:
    case Action::zoom_out:
      state_.view.zoom_by(action == Action::zoom_in ? 1.25 : 0.8);
      return true;
    case Action::flip:
      state_.look.flipped = !state_.look.flipped;
      return true;
    case Action::dual:
      state_.dual = !state_.dual;
      return true;
    case Action::doppler:
      state_.look.colour = !state_.look.colour;
      if (state_.look.colour)
        say(translate(state_,
                      "Colour Doppler: drag the box, or move it with the arrows. Tilt the probe "
                      "toward a vessel: what runs across the beam shows no colour"));
      return true;
    case Action::cine_back:
    case Action::cine_forward:
      step_cine(action == Action::cine_back ? -1 : 1);
      return true;
    default:
      return false;
  }
}

// Nothing is in hand: arrows move a caliper's cross, go from knob to knob, move the colour box or
// what is seen of a zoomed picture, or turn the joint.
void WindowLoop::act_on_arrow(Action action, bool fine) {
  ImGuiIO& io = ImGui::GetIO();
  const int dx = action == Action::right ? 1 : action == Action::left ? -1 : 0;
  const int dy = action == Action::down ? 1 : action == Action::up ? -1 : 0;
  if (state_.cross) {
    const double step = fine ? 0.1 : 0.5;  // mm
    state_.cross->x_mm += step * (state_.look.flipped ? -dx : dx);
    state_.cross->y_mm += step * dy;
    if (action == Action::accept && input_.image != nullptr)
      state_.calipers[input_.image->input.number].push_back(*state_.cross);
  } else if (navigating_ || action == Action::accept) {
    if (action == Action::accept) io.NavInputs[ImGuiNavInput_Activate] = 1;
    if (dx < 0) io.NavInputs[ImGuiNavInput_DpadLeft] = 1;
    if (dx > 0) io.NavInputs[ImGuiNavInput_DpadRight] = 1;
    if (dy < 0) io.NavInputs[ImGuiNavInput_DpadUp] = 1;
    if (dy > 0) io.NavInputs[ImGuiNavInput_DpadDown] = 1;
  } else if (state_.look.colour) {
    const double step = fine ? 0.01 : 0.05;
    state_.look.box.move(step * (state_.look.flipped ? -dx : dx), step * dy);
  } else if (state_.view.zoom > 1) {
    const double step = (fine ? 0.01 : 0.05) / state_.view.zoom;
    state_.view.move(step * (state_.look.flipped ? -dx : dx), step * dy);
  } else {
    OrbitCamera& camera = joint_->camera();
    camera.yaw += (fine ? 0.01 : 0.1) * dx;
    camera.pitch = std::clamp(camera.pitch + (fine ? 0.01 : 0.1) * dy, -1.5, 1.5);
  }
}

void WindowLoop::start_task(std::size_t task) {
  const PlannedInjection& plan = options_.tasks[task].injection;
  target_J_ = plan.target;
  target_region_ = session_.scene().region_at(plan.target);
  target_name_ =
      clinical_name(state_.language, session_.scene().joint().regions[target_region_].name);
  guide_.begin_again();
}

// What buttons of the panels asked for.
void WindowLoop::apply_requests() {
  for (const ActionEvent& request : std::exchange(state_.requests, {})) act(request);
  if (!state_.planned) return;
  const std::size_t task = std::min(*state_.planned, options_.tasks.size());
  state_.planned.reset();
  state_.welcome = false;
  if (task >= options_.tasks.size() || hand_ == nullptr) return;
  start_task(task);
  control_.place_needle(options_.tasks[task].start.X_WN);
  act({Action::take_needle, false});
}

bool WindowLoop::holds(const std::string& what) const {
  if (what == "picture") return input_.image != nullptr && input_.image->width > 0;
  return input_.needle.inside == (what == "inside");
}

bool WindowLoop::run_step(const ScriptStep& step, double elapsed) {
  if (const auto* event = std::get_if<UserEvent>(&step)) {
    handle_group({{*event, glfwGetTime()}});
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
  } else if (const auto* await = std::get_if<AwaitStep>(&step)) {
    waited_ += elapsed;
    if (waited_ < await->seconds && !holds(await->what)) return false;
    waited_ = 0;
  } else if (const auto* measure = std::get_if<MeasureStep>(&step)) {
    if (input_.image == nullptr) return true;
    set_frozen(true);
    auto& points = state_.calipers[input_.image->input.number];
    points.push_back({measure->from_x_mm, measure->from_y_mm});
    points.push_back({measure->to_x_mm, measure->to_y_mm});
  }
  return true;
}

void WindowLoop::run_script(double elapsed) {
  while (next_step_ < options_.script.size()) {
    if (!run_step(options_.script[next_step_], elapsed)) return;
    ++next_step_;
    elapsed = 0;
    if (!wanted_pictures_.empty()) return;  // what follows is not on that picture
  }
  if (!options_.script.empty() && wants_final_ && !options_.screenshot.empty()) {
    wants_final_ = false;
    wanted_pictures_.push_back(options_.screenshot);
  }
  if (options_.quit_after_script) state_.quit = true;
}

}  // namespace artus
