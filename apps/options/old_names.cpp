// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/old_names.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace artus {
namespace {

/// A flag that the old command had at another default.
struct OldDefault {
  std::string_view flag;
  std::string_view value;  ///< empty: the flag takes none
};

struct OldName {
  std::string_view old;
  std::string_view now;  ///< words with a blank between
  std::array<OldDefault, 4> defaults = {};
};

constexpr auto kOldNames = std::to_array<OldName>({
    {"echo-gates", "validate echo"},
    {"soft-gates", "validate soft"},
    {"injection-gates", "validate injection"},
    {"experiment", "validate needle probe", {{{"--rigid", ""}}}},
    {"loop",
     "serve --no-images",
     {{{"--input", "injection"},
       {"--seconds", "10"},
       {"--device", "virtuose_6d_desktop"},
       {"--speed-mm-s", "15"}}}},
    {"sweep-merge", "sweep merge"},
    {"sweep-stats", "sweep stats"},
    {"slice", "image labels"},
    {"elastogram", "image strain"},
    {"video", "image video"},
    {"phantom", "image phantom"},
    {"rate", "learners rate"},
    {"shm-monitor", "serve monitor"},
});

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    words.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

bool has_flag(const std::vector<std::string>& arguments, std::string_view flag) {
  return std::any_of(arguments.begin(), arguments.end(), [&](const std::string& argument) {
    return argument == flag || argument.rfind(std::string(flag) + "=", 0) == 0;
  });
}

}  // namespace

std::optional<RenamedLine> rename_command(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return std::nullopt;
  const auto* const known =
      std::find_if(kOldNames.begin(), kOldNames.end(),
                   [&](const OldName& name) { return name.old == arguments.front(); });
  if (known == kOldNames.end()) return std::nullopt;
  RenamedLine line;
  line.arguments = words_of(known->now);
  line.arguments.insert(line.arguments.end(), arguments.begin() + 1, arguments.end());
  for (const auto& [flag, value] : known->defaults) {
    if (flag.empty() || has_flag(arguments, flag)) continue;
    line.arguments.emplace_back(flag);
    if (!value.empty()) line.arguments.emplace_back(value);
  }
  line.note = "'artus " + std::string(known->old) + "' is 'artus " + std::string(known->now) +
              "' now; the old name goes with the next version";
  return line;
}

}  // namespace artus
