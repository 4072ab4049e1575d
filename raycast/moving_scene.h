// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "artus/raycast/scene.h"

namespace artus {

/// Scenes of a body that gives way, one for each of its states, by fitting a hierarchy that is
/// there to where the surfaces are now. A scene that nobody holds any more is used again, so that
/// in a steady run three go round: one that is read, one that was, one that is being made; who
/// keeps one to itself needs one more. One thread at a time asks; the scenes may be read and let go
/// of on any.
class MovingScene {
 public:
  static constexpr std::size_t kGoingRound = 3;

  explicit MovingScene(SceneOptions options = {});

  /// The scene of one state. A body at rest answers every query with the bytes of Scene(joint).
  /// Requires: a body (std::invalid_argument). Errors: as Scene. Cost: 0.1 us a triangle that
  /// moved; the first ones for a joint and its cage build an index, which shapes of the same
  /// surfaces share (BodyMap::first).
  [[nodiscard]] std::shared_ptr<const Scene> at(std::shared_ptr<const DeformedBody> tissue);

  /// The same for all `count` that go round, so that no state to come waits for an index. Cost: of
  /// the indices.
  std::vector<std::shared_ptr<const Scene>> make_ready(
      const std::shared_ptr<const DeformedBody>& tissue, std::size_t count = kGoingRound);

  /// Makes `count` of the surfaces that are shared, which `at` takes; none where another body's are
  /// by now. From any thread: what `at` answers does not depend on when it is done.
  void make_ahead(const std::shared_ptr<const DeformedBody>& tissue, std::size_t count) const;

  /// Scenes of the same surfaces as `other`, which another MovingScene made, share with it what of
  /// an index does not move: four tenths of its memory.
  void share(const Scene& other);

 private:
  struct Pool;
  SceneOptions options_;
  std::shared_ptr<Pool> pool_;
};

/// One-shot form for a first try.
[[nodiscard]] std::shared_ptr<const Scene> make_scene(std::shared_ptr<const DeformedBody> tissue);

}  // namespace artus
