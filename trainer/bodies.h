// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <string>

#include "artus/detail/training/scenario.h"
#include "artus/detail/viewer/pages/page.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Reads the body that a scenario is played in: `joint` in place of its own when one is named.
/// Called by a thread of its own.
using SceneLoader = std::function<Result<std::shared_ptr<const Scene>>(
    const Scenario& scenario, const std::filesystem::path& joint)>;

/// The bodies and pictures of scenarios, made on a thread of their own one after the other while
/// pages are shown. Pictures are kept, and the last few bodies.
class TrainBodies {
 public:
  /// `joint`: in place of the scenarios' own; empty: theirs.
  TrainBodies(std::filesystem::path joint, SceneLoader load)
      : joint_(std::move(joint)), load_(std::move(load)) {}

  /// Begins to make a scenario's picture when nothing else is being made; for every look.
  void want(const Scenario& scenario);
  /// The same for its body.
  void prepare(const Scenario& scenario);
  /// Whether a scenario's body was made, or cannot be.
  [[nodiscard]] bool ready(const Scenario& scenario);
  /// Null: not yet, or there is none.
  [[nodiscard]] std::shared_ptr<const PagePicture> picture(const Scenario& scenario);
  /// Requires: ready. Errors: those of the loader.
  [[nodiscard]] Result<std::shared_ptr<const Scene>> scene(const Scenario& scenario);

 private:
  using Body = Result<std::shared_ptr<const Scene>>;
  struct Made {
    std::string body;  // its key
    Body scene;
    std::string scenario;
    std::shared_ptr<const PagePicture> picture;
  };
  [[nodiscard]] std::string key_of(const Scenario& scenario) const;
  void begin(const Scenario& scenario);
  void collect();

  std::filesystem::path joint_;
  SceneLoader load_;
  std::map<std::string, Body> bodies_;                                  // by what makes them
  std::deque<std::string> kept_;                                        // their keys, oldest first
  std::map<std::string, std::shared_ptr<const PagePicture>> pictures_;  // by scenario
  std::future<Made> making_;
};

/// The needle as a scenario plans it: at the target on the straight way from the entry.
[[nodiscard]] Pose planned_needle(const Scenario& scenario);

}  // namespace artus
