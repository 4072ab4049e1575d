// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/hands_program.h"

#include <array>
#include <csignal>
#include <cstdio>

#include <sys/wait.h>
#include <unistd.h>

namespace artus {

HandsProgram::HandsProgram(const std::filesystem::path& program,
                           const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  std::vector<std::string> line{program.string()};
  line.insert(line.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& argument : line) argv.push_back(argument.data());
  argv.push_back(nullptr);
  if (pipe(ends.data()) == 0) {
    child_ = fork();
    if (child_ == 0) {
      sigset_t none;
      sigemptyset(&none);
      sigprocmask(SIG_SETMASK, &none, nullptr);
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      close(ends[0]);
      close(ends[1]);
      execv(program.c_str(), argv.data());
      _exit(127);
    }
    close(ends[1]);
    if (child_ < 0) close(ends[0]);
  }
  if (child_ < 0) {
    ended_ = true;
    return;
  }
  reader_ = std::thread([this, from = ends[0]] { read(from); });
}

HandsProgram::~HandsProgram() {
  if (child_ > 0 && !ended()) kill(child_, SIGTERM);
  if (reader_.joinable()) reader_.join();
}

void HandsProgram::read(int from) {
  constexpr std::size_t kMost = 8;
  std::string rest;
  std::array<char, 512> bytes{};
  for (;;) {
    const ssize_t n = ::read(from, bytes.data(), bytes.size());
    if (n <= 0) break;
    rest.append(bytes.data(), static_cast<std::size_t>(n));
    for (std::size_t end = rest.find('\n'); end != std::string::npos; end = rest.find('\n')) {
      const std::lock_guard lock(mutex_);
      lines_.push_back(rest.substr(0, end));
      if (lines_.size() > kMost) lines_.erase(lines_.begin());
      rest.erase(0, end + 1);
    }
  }
  close(from);
  int status = 0;
  waitpid(child_, &status, 0);
  const std::lock_guard lock(mutex_);
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  ended_ = true;
}

std::vector<std::string> HandsProgram::lines() const {
  const std::lock_guard lock(mutex_);
  return lines_;
}

bool HandsProgram::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

int HandsProgram::exit_code() const {
  const std::lock_guard lock(mutex_);
  return exit_code_;
}

Result<HandsState> parse_hands_state(const std::string& line) {
  int camera = 0;
  int markers = 0;
  int tip = 0;
  int face = 0;
  HandsState state;
  if (std::sscanf(line.c_str(), "camera=%d markers=%d tip=%d face=%d error_mm=%lf", &camera,
                  &markers, &tip, &face, &state.error_mm) != 5)
    return fail(ErrorCode::malformed, line.empty() ? "artus-hands says nothing" : line,
                "artus hands state");
  state.camera = camera != 0;
  state.markers = markers != 0;
  state.tip = tip != 0;
  state.face = face != 0;
  return state;
}

}  // namespace artus
