// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>

#include <sys/inotify.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace artus::test {

/// Counts how often each file of a folder is opened, by whatever program, since it was made.
class OpenCounter {
 public:
  explicit OpenCounter(const std::filesystem::path& folder)
      : events_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    // Closing is watched, too: two equal events in a row would be told as one.
    EXPECT_GE(inotify_add_watch(events_, folder.c_str(), IN_OPEN | IN_CLOSE), 0)
        << std::strerror(errno);
  }
  OpenCounter(const OpenCounter&) = delete;
  OpenCounter& operator=(const OpenCounter&) = delete;
  OpenCounter(OpenCounter&&) = delete;
  OpenCounter& operator=(OpenCounter&&) = delete;
  ~OpenCounter() { close(events_); }

  /// Files by name, how often each was opened since the last call.
  [[nodiscard]] std::map<std::string, int> take() {
    std::map<std::string, int> opened;
    alignas(inotify_event) std::array<char, 65536> buffer{};
    for (ssize_t n = 0; (n = read(events_, buffer.data(), buffer.size())) > 0;)
      for (std::size_t at = 0; at < static_cast<std::size_t>(n);) {
        inotify_event event{};
        std::memcpy(&event, buffer.data() + at, sizeof event);
        const bool is_file = (event.mask & IN_OPEN) != 0 && (event.mask & IN_ISDIR) == 0;
        if (is_file) ++opened[buffer.data() + at + sizeof event];
        at += sizeof event + event.len;
      }
    return opened;
  }

 private:
  int events_;
};

}  // namespace artus::test
