// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/live_metrics.h"

#include <cstdio>
#include <fstream>
#include <system_error>

#include "artus/detail/core/text_file.h"
#include "artus/detail/training/assessment.h"
#include "artus/detail/training/session_meter.h"

namespace artus {

void add_live_metrics_option(Command* command, std::filesystem::path& file) {
  command->add_option("--metrics", file,
                      "file for the numbers of the gesture, measured while it is done (.json; the "
                      "first 30 minutes)");
}

Result<std::unique_ptr<LiveAttempt>> make_live_meter(const std::filesystem::path& file,
                                                     const std::shared_ptr<const Scene>& scene,
                                                     const SessionParams& params) {
  if (file.empty()) return nullptr;
  std::error_code error;
  const bool was_there = std::filesystem::exists(file, error);
  if (was_there) {
    if (!std::ofstream(file, std::ios::app))
      return fail(ErrorCode::unreadable, "cannot write the file of --metrics", file.string());
  } else {
    ARTUS_TRY(write_text(file, ""));
    std::filesystem::remove(file, error);
  }
  return std::make_unique<LiveAttempt>(scene, options_for(make_head(scene->joint(), params)),
                                       params.haptic_rate);
}

Result<void> write_live_metrics(const std::filesystem::path& file, LiveAttempt* meter) {
  if (meter == nullptr) return {};
  if (meter->full())
    std::fprintf(stderr, "%s: the numbers are of the session's first %.0f minutes\n",
                 file.string().c_str(), meter->longest() / 60);
  const AttemptMeasures measures = meter->measure();
  std::vector<std::string> notices;
  add_left_out(measures, notices);
  for (const std::string& notice : notices)
    std::fprintf(stderr, "%s: %s\n", file.string().c_str(), notice.c_str());
  return write_text(file, to_json(measures.metrics).dump(2) + "\n");
}

}  // namespace artus
