// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/lesson.h"

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/panels/panels.h"
#include "artus/detail/viewer/panels/shade.h"

namespace artus {
namespace {

constexpr Shade kDone{0.55F, 0.95F, 0.55F};
constexpr Shade kOpen{0.85F, 0.85F, 0.85F};
constexpr Shade kDim{0.6F, 0.6F, 0.6F};
constexpr Shade kAlarm{1, 0.55F, 0.4F};
constexpr Shade kRemark{1, 0.88F, 0.4F};

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

void draw_lesson_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::session, msgid("Task"), state);
  if (!scope) return;
  const Lesson& lesson = *state.lesson;
  wrapped_text(lesson.title, kOpen);
  wrapped_text(lesson.clock, lesson.late ? kAlarm : kOpen);
  if (!lesson.remark.empty()) wrapped_text(lesson.remark, kRemark);
  for (const LessonStep& step : lesson.steps) {
    const std::string mark = step.known && step.done ? "+ " : "-  ";
    const std::string later =
        step.known ? "" : " (" + std::string(translate(state, "judged afterwards")) + ")";
    wrapped_text(mark + step.text + later, !step.known ? kDim : step.done ? kDone : kOpen);
  }
  draw_syringe(in, state);
  if (in.peer != PeerState::alive) wrapped_text(describe_status(state.language, in.status), kAlarm);
  action_button(state, msgid("I am done"), Action::finish);
  ImGui::SameLine();
  if (ImGui::SmallButton("?")) state.help = !state.help;
  ImGui::Checkbox(translate(state, "left-handed"), &state.left_handed);
}

void draw_patient_panel(const PanelInput& in, ViewState& state) {
  const PanelScope scope(Panel::tissues, msgid("Patient"), state);
  if (!scope) return;
  wrapped_text(state.lesson->patient, state.lesson->patient_hurts ? kAlarm : kOpen);
  draw_patient_words(in, state);
}

}  // namespace artus
