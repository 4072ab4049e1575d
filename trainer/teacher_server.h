// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "artus/core/result.h"
#include "artus/detail/trainer/teacher_board.h"

namespace artus {

/// A small page for a teacher's browser: the picture, the hands' numbers, steps, marks and aids of
/// the attempt that runs, four times a second, and what a teacher can do on it. On this machine
/// alone it is open (only under this machine's own names, so that no other page reaches it);
/// everywhere else each request needs a token. Nothing is encrypted.
class TeacherServer {
 public:
  struct Options {
    std::string address = "127.0.0.1";
    int port = 0;       ///< 0: any that is free
    std::string token;  ///< of requests; empty: one is drawn where others can connect
    Language language = Language::english;
  };
  /// Listens in a thread of its own until it is destroyed. The board outlives it. Errors: invalid
  /// (no such address), unreadable (another program listens there).
  [[nodiscard]] static Result<std::unique_ptr<TeacherServer>> open(TeacherBoard& board,
                                                                   const Options& options);
  ~TeacherServer();
  TeacherServer(const TeacherServer&) = delete;
  TeacherServer& operator=(const TeacherServer&) = delete;

  [[nodiscard]] int port() const noexcept;
  /// What a teacher types into the browser, with the token where one is needed.
  [[nodiscard]] std::string link() const;

 private:
  class Listener;
  explicit TeacherServer(std::unique_ptr<Listener> listener);
  std::unique_ptr<Listener> listener_;
};

/// The page itself; it sends on the token that stands in its own address.
[[nodiscard]] std::string teacher_page(Language language);

}  // namespace artus
