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
/// a target in a zone to avoid or outside its structure, a path through such a zone, a probe off
/// the skin or one that does not show the target. Empty: none. Cost: some queries, no play.
[[nodiscard]] std::vector<std::string> find_problems(const Scenario& scenario,
                                                     const std::shared_ptr<const Scene>& scene);

/// How one simulated operator fares.
struct Fared {
  int played = 0;  ///< seeds, from 1 on
  int passes = 0;
  double score = 0;                 ///< mean
  std::vector<std::string> missed;  ///< marks that were missed, a line each with its figure
  int broken = 0;                   ///< attempts after which the body is not whole
  std::string breakage;             ///< what the first of them shows
};

/// How simulated hands fare: the scenario's difficulty.
struct Difficulty {
  int tries = 20;  ///< seeds meant; fewer are played where the answer is known before
  Fared expert;
  Fared novice;
  /// Of 20, an expert passes all but one, and a novice 8 or fewer. Whether liquid broke the body is
  /// told, not judged.
  [[nodiscard]] bool is_for_experts() const noexcept {
    return 20 * (expert.played - expert.passes) <= tries;
  }
  [[nodiscard]] int broken() const noexcept { return expert.broken + novice.broken; }
  [[nodiscard]] const std::string& breakage() const noexcept {
    return expert.broken > 0 ? expert.breakage : novice.breakage;
  }
  [[nodiscard]] bool sound() const noexcept {
    return is_for_experts() && 20 * novice.passes <= 8 * tries;
  }
};

/// The same in tissue that gives way, of fewer seeds, beside all seeds in rigid tissue.
struct DifficultyInTissue {
  Difficulty rigid;
  Difficulty soft;   ///< tries 0: the body cannot give way, or nobody asked
  int compared = 0;  ///< soft attempts whose seed was played in rigid tissue, too
  int alike = 0;     ///< of these, with the same verdict
  /// Few seeds in tissue say of a novice nothing that all seeds do not.
  [[nodiscard]] bool sound() const noexcept {
    return rigid.sound() && soft.is_for_experts() && (soft.tries < 20 || soft.sound());
  }
};

/// How many seeds each simulated operator plays.
struct Tries {
  int rigid = 20;
  int soft = 1;  ///< in tissue that gives way, which costs some ten times as much; no more than it
                 ///< takes to know that a novice does not pass too often
  bool soft_novices = true;  ///< false: experts alone play in tissue that gives way
};

/// Novices that fail, of `tries`, from which on the others cannot pass too often: none more is
/// played in tissue.
[[nodiscard]] constexpr int deciding_failures(int tries) noexcept {
  return tries - 8 * tries / 20;
}

/// Plays with seeds from 1 on. The same at any number of threads. Errors: those of play.
[[nodiscard]] Result<DifficultyInTissue> measure_difficulty(
    const Scenario& scenario, const std::shared_ptr<const Scene>& scene, const Tries& tries,
    const Progress& progress);

}  // namespace artus
