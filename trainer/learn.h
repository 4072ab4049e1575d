// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "artus/detail/trainer/led_hands.h"
#include "artus/detail/training/scenario.h"
#include "artus/detail/viewer/pages/page.h"
#include "artus/raycast/scene.h"

namespace artus {

/// What is taught of a task before anybody is judged by it.
struct LearnContent {
  std::vector<PageLine> looks;  ///< what lies in the picture from the skin down, and how it looks
  std::vector<PageLine> never;  ///< what must not be entered, and why
  std::vector<PageLine> stand;  ///< patient, hands, and where the needle goes in
  /// The picture as it is, then with the outlines of what lies in it brighter and brighter: those
  /// of the target and of what must not be entered drawn whole, all others as dots.
  std::vector<std::shared_ptr<const PagePicture>> fading;
};

/// Cost: a picture, about a second. Requires: a task for the needle, its scene.
[[nodiscard]] LearnContent make_learn_content(const Scenario& scenario,
                                              const std::shared_ptr<const Scene>& scene,
                                              Language language);

/// What can be chosen on the page, in its order.
enum class LearnChoice { looks, never, stand, expert, probe_alone, needle_alone, both };
/// The lesson of a task: what is marked is told beside it, with the picture whose truth fades in
/// and out; `at`: what is marked. `content` outlives the page.
[[nodiscard]] Page make_learn_page(const Scenario& scenario, const LearnContent& content,
                                   LearnChoice at, Language language);

/// Which hand is led in what was chosen; empty: nothing is done by hand there.
[[nodiscard]] std::optional<LedHand> led_in(LearnChoice choice) noexcept;

/// The task as it is practised with one hand: the tip is marked, so that nobody passes by it.
[[nodiscard]] Scenario for_one_hand(Scenario scenario);

}  // namespace artus
