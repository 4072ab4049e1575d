// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/attempt_files.h"

#include "artus/detail/core/text_file.h"

namespace artus {

nlohmann::json to_json(const Scenario& scenario, const PlayedAttempt& attempt) {
  auto marks = nlohmann::json::array();
  for (const JudgedMark& m : attempt.judgement.marks)
    marks.push_back({{"metric", m.mark.metric},
                     {"mark", m.mark.text},
                     {"value", m.value ? nlohmann::json(*m.value) : nlohmann::json()},
                     {"held", m.held},
                     {"part", m.part},
                     {"weight", m.weight}});
  return {{"scenario", scenario.name},
          {"joint", attempt.recording.head.joint},
          {"passed", attempt.judgement.passed},
          {"score", attempt.judgement.score},
          {"duration_s", attempt.duration},
          {"marks", marks},
          {"metrics_version", kMetricsVersion},
          {"metrics", to_json(attempt.measures.metrics)},
          {"body", attempt.health ? to_json(*attempt.health) : nlohmann::json()}};
}

Result<void> write_attempt_files(const Scenario& scenario, const PlayedAttempt& attempt,
                                 const std::filesystem::path& folder) {
  ARTUS_TRY(write_text(folder / "scenario.toml", scenario.text));
  return write_text(folder / "attempt.json", to_json(scenario, attempt).dump(2) + "\n");
}

}  // namespace artus
