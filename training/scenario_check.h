// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "artus/detail/core/progress.h"
#include "artus/detail/training/player.h"

namespace artus {

/// What in a scenario cannot be done in its body, a line each: names that are missing, an entry off
/// the skin, a needle too short, bone on the path, an angle out of its range, a path out of plane,
/// a target in a zone to avoid or outside its structure, a probe off the skin. Empty: none.
[[nodiscard]] std::vector<std::string> find_problems(const Scenario& scenario,
                                                     const std::shared_ptr<const Scene>& scene);

/// How simulated hands fare: the scenario's difficulty.
struct Difficulty {
  int tries = 20;
  int expert_passes = 0;
  int novice_passes = 0;
  double expert_score = 0;  ///< mean
  double novice_score = 0;
  int broken = 0;        ///< attempts of either after which the body is not whole
  std::string breakage;  ///< what the first of them shows
  /// An expert passes 19 of 20 or more, a novice 8 of 20 or fewer, and liquid breaks no body.
  [[nodiscard]] bool sound() const noexcept {
    return 20 * expert_passes >= 19 * tries && 20 * novice_passes <= 8 * tries && broken == 0;
  }
};

/// The same in tissue that gives way, of fewer seeds, beside all seeds in rigid tissue.
struct DifficultyInTissue {
  Difficulty rigid;
  Difficulty soft;  ///< tries 0: the body cannot give way, or nobody asked
  int alike = 0;    ///< of the soft attempts, those whose verdict is that of the rigid one
  /// Few seeds in tissue say of a novice nothing that all seeds do not.
  [[nodiscard]] bool sound() const noexcept {
    const bool experts = 20 * soft.expert_passes >= 19 * soft.tries;
    return rigid.sound() && experts && soft.broken == 0 && (soft.tries < 20 || soft.sound());
  }
};

/// How many seeds each simulated operator plays.
struct Tries {
  int rigid = 20;
  int soft = 1;  ///< in tissue that gives way, which costs some ten times as much
};

/// Plays with seeds from 1 on. The same at any number of threads. Errors: those of play.
[[nodiscard]] Result<DifficultyInTissue> measure_difficulty(
    const Scenario& scenario, const std::shared_ptr<const Scene>& scene, const Tries& tries,
    const Progress& progress);

}  // namespace artus
