// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/told_file.h"

#include <cmath>
#include <utility>

#include "artus/detail/core/units.h"

namespace artus {

Result<ToldFile> ToldFile::open(const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::trunc);
  if (!out) return fail(ErrorCode::unreadable, "cannot be written", file.string());
  return ToldFile(std::move(out));
}

void ToldFile::write(const nlohmann::json& said) {
  std::string line = said.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (line == last_) return;
  out_ << line << '\n' << std::flush;
  last_ = std::move(line);
}

void ToldFile::tell(const Page& page) {
  nlohmann::json said{{"page", page.name}, {"title", page.title}, {"at", page.at}};
  said["lines"] = nlohmann::json::array();
  for (const PageLine& line : page.lines) said["lines"].push_back(line.text);
  said["choices"] = nlohmann::json::array();
  for (const PageChoice& choice : page.choices)
    said["choices"].push_back({{"name", choice.name}, {"beside", choice.beside}});
  said["about"] = nlohmann::json::array();
  if (page.at < page.choices.size())
    for (const PageLine& line : page.choices[page.at].about) said["about"].push_back(line.text);
  write(said);
}

void ToldFile::tell(const WindowStatus& window) {
  constexpr double kSteps = 10;  // of a millimetre
  constexpr double kHundreds = 100;
  write({{"task", window.task},
         {"goal", window.goal},
         {"next", window.next},
         {"message", window.message},
         {"steps", window.steps},
         {"remark", window.remark},
         {"picture", window.has_image},
         {"inside", window.needle.inside},
         {"flow_ml_s", std::round(kHundreds * window.syringe.flow / kCubicCentimetre) / kHundreds},
         {"in_hand", window.grab != Grab::nothing},
         {"depth_mm", std::round(kSteps * window.needle.depth / kMillimetre) / kSteps}});
}

}  // namespace artus
