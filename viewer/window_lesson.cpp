// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/lesson.h"
#include "artus/detail/viewer/window_loop.h"

namespace artus {

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
  lesson_ = options_.lesson->lead({input_.now, input_.needle, state_.look.colour});
  if (lesson_.over) state_.quit = state_.finished = true;
  if (lesson_.frozen && *lesson_.frozen != session_.frozen()) set_frozen(*lesson_.frozen);
  const LessonAids& aids = lesson_.aids ? *lesson_.aids : options_.lesson->aids;
  if (lesson_.aids) {
    state_.aids = aids.any();
    state_.labels = aids.labels > 0;
    joint_->cut_away = aids.plane > 0;
  }
  input_.needle.in_plane = input_.needle.in_plane && lesson_.beam_on_tip;
  input_.marks.clear();
  if (input_.image == nullptr || input_.image->width == 0) return;
  const ImageSnapshot& image = *input_.image;
  if (lesson_.pointed) {
    const double millimetre = 1e3 * image.pixel;  // mm of a pixel
    input_.marks.push_back({{lesson_.pointed->first * image.width * millimetre,
                             lesson_.pointed->second * image.height * millimetre},
                            std::nullopt,
                            1,
                            true});
  }
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

}  // namespace artus
