// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/lesson.h"

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/panels/shade.h"
#include "artus/detail/viewer/window_loop.h"

namespace artus {
namespace {

constexpr Shade kDone{0.55F, 0.95F, 0.55F};
constexpr Shade kOpen{0.85F, 0.85F, 0.85F};
constexpr Shade kDim{0.6F, 0.6F, 0.6F};
constexpr Shade kAlarm{1, 0.55F, 0.4F};

}  // namespace

ImagePoint point_on_picture(const ImageSnapshot& image, const Vec3& p_J) {
  const Vec3 p_P = to_pose(image.input.X_JP).inverse() * p_J;
  return {p_P.x() / kMillimetre + 500 * image.width * image.pixel, p_P.z() / kMillimetre};
}

NeedleReading seen_from_outside(NeedleReading reading) {
  reading.layer.clear();
  reading.region = kOutside;
  reading.on_bone = false;
  reading.hand_excess = 0;
  reading.to_target = 0;
  reading.in_plane = true;
  reading.plane_offset = reading.plane_angle = 0;
  return reading;
}

/// Without aids the body is opaque, as in a room; the panel beside a narrow picture is the task's.
void WindowLoop::begin_lesson() {
  const LessonAids& aids = options_.lesson->aids;
  state_.lesson = &lesson_;
  state_.aids = aids.any();
  state_.labels = aids.labels > 0;
  state_.layout.choose(Panel::session);
  if (aids.plane > 0) return;
  joint_->cut_away = false;
  for (TissueLook& look : joint_->looks()) {
    look.visible = true;
    look.alpha = 1;
  }
}

void WindowLoop::lead_lesson() {
  lesson_ = options_.lesson->lead({input_.now, input_.needle});
  if (lesson_.over) state_.quit = state_.finished = true;
  input_.needle.in_plane = input_.needle.in_plane && lesson_.beam_on_tip;
  input_.marks.clear();
  if (input_.image == nullptr || input_.image->width == 0) return;
  const ImageSnapshot& image = *input_.image;
  const LessonAids& aids = options_.lesson->aids;
  if (aids.target > 0 && aids.target_J)
    input_.marks.push_back(
        {point_on_picture(image, *aids.target_J), std::nullopt, aids.target, false});
  if (image.input.has_needle == 0) return;
  const Pose X_JN = to_pose(image.input.X_JN);
  const ImagePoint tip = point_on_picture(image, X_JN.translation());
  const Vec3 hub = X_JN * Vec3(0, 0, -needle_length_of(session_.params()));
  if (aids.needle > 0)
    input_.marks.push_back({tip, point_on_picture(image, hub), aids.needle, false});
  if (aids.tip > 0) input_.marks.push_back({tip, std::nullopt, aids.tip, input_.needle.in_plane});
}

void draw_lesson_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::session, Text::lesson_panel, state);
  if (!scope) return;
  const Lesson& lesson = *state.lesson;
  wrapped_text(lesson.title, kOpen);
  wrapped_text(lesson.clock, lesson.late ? kAlarm : kOpen);
  for (const LessonStep& step : lesson.steps) {
    const std::string mark = step.known && step.done ? "+ " : "-  ";
    const std::string later =
        step.known ? "" : " (" + std::string(tell(state, Text::lesson_later)) + ")";
    wrapped_text(mark + step.text + later, !step.known ? kDim : step.done ? kDone : kOpen);
  }
  draw_syringe(in, state);
  if (in.peer != PeerState::alive) wrapped_text(describe_status(state.language, in.status), kAlarm);
  action_button(state, Text::lesson_finish, Action::finish);
  ImGui::SameLine();
  if (ImGui::SmallButton("?")) state.help = !state.help;
  ImGui::Checkbox(tell(state, Text::left_handed), &state.left_handed);
}

void draw_patient_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::tissues, Text::lesson_patient, state);
  if (!scope) return;
  wrapped_text(state.lesson->patient, state.lesson->patient_hurts ? kAlarm : kOpen);
  draw_patient_words(in, state);
}

}  // namespace artus
