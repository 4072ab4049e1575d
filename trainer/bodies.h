// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "artus/detail/anatomy/outside/outside_body.h"
#include "artus/detail/core/progress.h"
#include "artus/detail/training/scenario.h"
#include "artus/detail/viewer/pages/page.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Reads the body that a scenario is played in: `joint` in place of its own when one is named.
/// Called by a thread of its own.
using SceneLoader = std::function<Result<std::shared_ptr<const Scene>>(
    const Scenario& scenario, const std::filesystem::path& joint, const Progress& progress)>;

/// The bodies and pictures of scenarios, made on a thread of their own one after the other while
/// pages are shown. Pictures are kept, and the last few bodies.
class TrainBodies {
 public:
  /// `joint`: in place of the scenarios' own; empty: theirs.
  TrainBodies(std::filesystem::path joint, SceneLoader load)
      : joint_(std::move(joint)), load_(std::move(load)) {}
  ~TrainBodies() { give_up(); }
  TrainBodies(const TrainBodies&) = delete;
  TrainBodies& operator=(const TrainBodies&) = delete;

  /// Begins to make a scenario's picture when nothing else is being made; for every look.
  void want(const Scenario& scenario);
  /// The same for its body; another that is being made is given up for it.
  void prepare(const Scenario& scenario);
  /// How far what is being made has come: its step in English, and 0 to 1 of it.
  [[nodiscard]] std::pair<std::string, double> progress() const;
  /// Gives up what is being made, at its next step; what failed is tried anew when it is asked for.
  void give_up();
  void forget(const Scenario& scenario);
  /// Whether a scenario's body was made, or cannot be.
  [[nodiscard]] bool ready(const Scenario& scenario);
  /// Null: not yet, or there is none.
  [[nodiscard]] std::shared_ptr<const PagePicture> picture(const Scenario& scenario);
  /// Requires: ready. Errors: those of the loader.
  [[nodiscard]] Result<std::shared_ptr<const Scene>> scene(const Scenario& scenario);
  /// The person around its joint; null: there is none, as around a block of gel. Errors: those of
  /// read_outside.
  [[nodiscard]] Result<std::shared_ptr<const OutsideBody>> outside(const Scenario& scenario) const;

 private:
  using Body = Result<std::shared_ptr<const Scene>>;
  struct Made {
    std::string body;  // its key
    Body scene;
    std::string scenario;
    std::shared_ptr<const PagePicture> picture;
  };
  /// What the thread that makes something tells, and is told. For two threads.
  struct Watch {
    std::mutex mutex;
    std::string step;
    double fraction = 0;
    std::atomic<bool> given_up{false};
  };
  [[nodiscard]] std::string key_of(const Scenario& scenario) const;
  void begin(const Scenario& scenario);
  void collect();

  std::filesystem::path joint_;
  SceneLoader load_;
  std::map<std::string, Body> bodies_;                                  // by what makes them
  std::deque<std::string> kept_;                                        // their keys, oldest first
  std::map<std::string, std::shared_ptr<const PagePicture>> pictures_;  // by scenario
  std::shared_ptr<Watch> watch_;
  std::string making_key_;
  std::future<Made> making_;
};

/// The needle as a scenario plans it: at the target on the straight way from the entry.
[[nodiscard]] Pose planned_needle(const Scenario& scenario);

}  // namespace artus
