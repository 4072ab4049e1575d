// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "artus/detail/exchange/remote_command.h"
#include "artus/detail/training/scenario.h"
#include "artus/echo/renderer.h"
#include "artus/session/session.h"

namespace artus {

/// Knobs that other programs turned, until a window takes them over. For two threads.
class RemoteTurns {
 public:
  void add(double ImageControls::*knob, double value);
  /// Turns them all on `controls`.
  void take(ImageControls& controls);

 private:
  std::mutex mutex_;
  std::vector<std::pair<double ImageControls::*, double>> turns_;
};

/// The scenario that another program asks for by a command, until someone is free for it. For two
/// threads.
class RemoteScenario {
 public:
  /// Answers a command with the scenario that comes with artus by this name: who connects reads no
  /// files.
  [[nodiscard]] RemoteAnswer ask(const std::string& name);
  /// From now on nothing is taken, for this reason; empty: all is. What was asked before stays.
  void refuse(const std::string& why);
  [[nodiscard]] bool asked() const;
  /// What was asked last, once.
  [[nodiscard]] std::optional<Scenario> take();

 private:
  mutable std::mutex mutex_;
  std::string why_not_;
  std::optional<Scenario> scenario_;
};

}  // namespace artus
