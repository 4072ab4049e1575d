// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/trouble.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <thread>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "artus/detail/viewer/words/system_words.h"

namespace artus {
namespace {

bool says(const Error& error, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* word) {
    return error.message.find(word) != std::string::npos;
  });
}

}  // namespace

const char* remedy_of(const Error& error) noexcept {
  if (says(error, {"another program is using it", "is locked"}))
    return msgid("Close the other program that uses the records, then try again.");
  if (says(error, {"space left", "No space", "is full"}))
    return msgid("Make room on the disk, then try again.");
  if (says(error, {"may be written", "readonly", "Permission denied", "Read-only", "cannot write",
                   "cannot make"}))
    return msgid("Allow that file and its folder to be written, then try again.");
  if (error.code == ErrorCode::not_found)
    return msgid("Put what is missing where it says, or start artus where it is, then try again.");
  return msgid("Try again. If it stays so, show this page to whoever looks after the machine.");
}

Page make_trouble_page(const Error& error, const char* safe, bool may_go_on, Language language) {
  Page page;
  page.name = "trouble";
  page.title = translate(language, "Something went wrong");
  page.lines = {{translate(language, "What happened"), Tone::heading},
                {said_by_system(language, error.message), Tone::bad}};
  if (!error.where.empty())
    page.lines.push_back({fill(translate(language, "Where: {}"), {error.where}), Tone::dim});
  page.lines.push_back({translate(language, "What is safe"), Tone::heading});
  page.lines.push_back({translate(language, safe), Tone::good});
  page.lines.push_back({translate(language, "What to do"), Tone::heading});
  page.lines.push_back({translate(language, remedy_of(error))});
  page.choices.push_back({translate(language, "Try it again"), "", Tone::good, {}, nullptr});
  if (may_go_on)
    page.choices.push_back({translate(language, "Another task"), "", Tone::plain, {}, nullptr});
  page.choices.push_back({translate(language, "Leave"), "", Tone::plain, {}, nullptr});
  return page;
}

Result<void> open_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    return fail(ErrorCode::not_found, "there is no such file", file.string());
  std::string opener = "xdg-open";
  std::string name = file.string();
  std::array<char*, 3> arguments{opener.data(), name.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, opener.c_str(), nullptr, nullptr, arguments.data(), environ) != 0)
    return fail(ErrorCode::failed, "no program opens it here (xdg-open is not installed)",
                file.string());
  std::thread([child] { waitpid(child, nullptr, 0); }).detach();
  return {};
}

Result<TrainDesk> open_desk(Screen& screen, const PageOptions& pages,
                            const std::filesystem::path& records,
                            const std::filesystem::path& attempts) {
  for (;;) {
    auto desk = TrainDesk::open(records, attempts);
    if (desk) return desk;
    PageWindow window(screen, pages);
    const auto answer = window.show(make_trouble_page(
        desk.error(), msgid("Nothing was begun yet; what was stored before is as it was."), false,
        pages.language));
    const bool again = answer && answer->kind == PageAnswer::Kind::chosen && answer->choice == 0;
    if (!again) return desk;
  }
}

}  // namespace artus
