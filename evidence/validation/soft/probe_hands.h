// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "artus/detail/operators/pushed_probe.h"

namespace artus {

/// What a hand does with a probe over skin whose plane is z = 0 of frame J, z into the body.
enum class ProbeGesture { press, tap, slide, lift, twist };
[[nodiscard]] const char* to_string(ProbeGesture gesture) noexcept;

/// A hand, what it does, and how late the tissue answers.
struct ProbeHandCase {
  PushedProbeParams hand;
  ProbeGesture gesture = ProbeGesture::press;
  double tick_rate = 1000;  ///< Hz
  double image_rate = 30;   ///< Hz of the tissue's answers
  double delay = 0.03;      ///< s from a pose to the tick that takes its answer
  bool lost = false;        ///< no answers for 0.5 s
  double prior = 1;         ///< what is told of the tissue before a touch, over what is so
  double hardness = 1;      ///< of the tissue, over a shoulder's
};

/// What came of it.
struct ProbeHandResult {
  double given = 0;        ///< J to the hand, the most at any time
  double off_skin = 0;     ///< N felt where the face is more than 0.2 mm off the skin
  double swing = 0;        ///< m, of the place in the last 0.3 s of a press, where it does not fade
  double settled = 0;      ///< share by which the last force misses what is so; press and twist
  double first_touch = 0;  ///< s from meeting the skin at 0.1 m/s or more to a force of 1 mN
  double first_depth = 0;  ///< m of the face then
  double step = 0;         ///< N, largest change from tick to tick beyond motion's
  double highest = 0;      ///< m off the skin after the first touch; of a press
};

/// The hand's course: where it wants the probe at time t, s.
[[nodiscard]] Pose wanted_pose(ProbeGesture gesture, double t);

/// Plays a case on tissue of closed form, F(d) = k/b (e^(b d) - 1), k 154 N/m, b 200 1/m (a
/// shoulder's). Cost: some us a tick.
[[nodiscard]] ProbeHandResult play_probe_hand(const ProbeHandCase& c);

/// Masses 0.05 to 1 kg, springs 0 to 2000 N/m, damping from 3 N s/m on (from 0 at 10 kHz), answers
/// at 5 to 60 Hz, late, lost, all gestures, told 0.7 to 1.3 of what is so. `every`: one of so many.
[[nodiscard]] std::vector<ProbeHandCase> probe_hand_cases(std::size_t every);

}  // namespace artus
