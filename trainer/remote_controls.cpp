// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/remote_controls.h"

namespace artus {

void RemoteTurns::add(double ImageControls::*knob, double value) {
  const std::lock_guard<std::mutex> lock(mutex_);
  turns_.emplace_back(knob, value);
}

void RemoteTurns::take(ImageControls& controls) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& [knob, value] : turns_) controls.*knob = value;
  turns_.clear();
}

RemoteAnswer RemoteScenario::ask(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!why_not_.empty()) return {false, why_not_};
  std::string names;
  for (const std::string_view text : bundled_scenario_texts()) {
    auto scenario = parse_scenario(text, "bundled");
    if (!scenario) continue;
    if (scenario->name == name) {
      scenario_ = std::move(*scenario);
      return {true, "the scenario " + name + " begins"};
    }
    names += (names.empty() ? "" : ", ") + scenario->name;
  }
  return {false, "there is no scenario '" + name + "' but " + names};
}

void RemoteScenario::refuse(const std::string& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  why_not_ = why;
}

bool RemoteScenario::asked() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return scenario_.has_value();
}

std::optional<Scenario> RemoteScenario::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(scenario_, std::nullopt);
}

}  // namespace artus
