// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/detail/viewer/panels/image_place.h"
#include "artus/detail/viewer/panels/needle_reading.h"
#include "artus/session/session.h"

namespace artus {

/// What whoever leads a lesson looks at between two pictures.
struct LessonView {
  const HapticSnapshot& now;    ///< the last state of a living device
  const NeedleReading& needle;  ///< in `now`
  bool doppler = false;         ///< the picture shows what moves
};

/// A step of a task. `known`: people may know already whether it is done.
struct LessonStep {
  std::string text;
  bool done = false;
  bool known = true;
};

/// What is shown of the truth to help, 0 off to 1 full.
struct LessonAids {
  double needle = 0;  ///< the shaft's line on the picture
  double tip = 0;     ///< a ring at the tip, filled while the beam is on it
  double target = 0;  ///< a ring at the target
  double labels = 0;  ///< structures' names
  double plane = 0;   ///< the body cut open along the picture's plane, in 3D
  std::optional<Vec3> target_J;
  [[nodiscard]] bool any() const noexcept { return needle + tip + target + labels + plane > 0; }
};

/// What a window tells of a task while it is done.
struct Lesson {
  std::string title;
  std::string goal;
  std::vector<LessonStep> steps;
  std::string next;  ///< what to do now; empty: what the guide says
  std::string clock;
  bool late = false;           ///< beyond the time that the task gives
  std::string patient;         ///< what the patient says; empty: nothing
  bool patient_hurts = false;  ///< and how
  bool over = false;           ///< the window ends
  bool beam_on_tip = true;     ///< the picture's beam does not pass beside the tip
  // What somebody who looks on does.
  std::optional<bool> frozen;                        ///< the picture, from now on
  std::optional<std::pair<double, double>> pointed;  ///< at a place of it: 0 to 1 across and down
  std::optional<LessonAids> aids;                    ///< in place of the options'
  std::string remark;                                ///< empty: none
};

/// A reading without what only the truth tells of a needle inside: where the tip is, what it
/// touches, whether the picture has it.
[[nodiscard]] NeedleReading seen_from_outside(NeedleReading reading);

/// Where a point of the joint lies on a picture, whether its slice has it or not.
[[nodiscard]] ImagePoint point_on_picture(const ImageSnapshot& image, const Vec3& p_J);

/// A task in a window: who leads it, and what is shown of the truth. Without aids the body is seen
/// from outside alone, and nothing is told that a real room would not tell.
struct LessonOptions {
  std::function<Lesson(const LessonView&)> lead;  ///< called before each picture
  LessonAids aids;
  bool needle = true;  ///< false: a task for the probe alone
};

}  // namespace artus
