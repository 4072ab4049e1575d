// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/mesh/isolated.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace artus {
namespace {

using Clock = std::chrono::steady_clock;

bool write_all(int fd, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = write(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

// The child: never returns, leaves no core file, and says nothing on the parent's terminal.
[[noreturn]] void run_child(int fd, const std::function<std::string()>& work) {
  for (const int fatal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) signal(fatal, SIG_DFL);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  int status = 1;
  try {
    if (write_all(fd, work())) status = 0;
  } catch (...) {
    status = 2;
  }
  _exit(status);
}

// A child at work, and what came from it so far.
struct Child {
  std::size_t work = 0;
  pid_t id = -1;
  int fd = -1;
  Clock::time_point deadline;
  std::string bytes;
};

std::optional<Child> start_child(const std::function<std::string()>& work, double seconds) {
  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  Child child;
  child.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(seconds));
  child.fd = pipe_ends[0];
  child.id = fork();
  if (child.id == 0) {
    close(pipe_ends[0]);
    run_child(pipe_ends[1], work);
  }
  close(pipe_ends[1]);
  if (child.id < 0) {
    close(pipe_ends[0]);
    return std::nullopt;
  }
  return child;
}

// Takes what is in the pipe; true when the child has closed it.
bool read_some(Child& child) {
  std::array<char, 1 << 16> buffer{};
  const ssize_t n = read(child.fd, buffer.data(), buffer.size());
  if (n > 0) child.bytes.append(buffer.data(), static_cast<std::size_t>(n));
  return n == 0 || (n < 0 && errno != EINTR);
}

// The bytes of a child that ended well; one that did not close its pipe is ended.
std::optional<std::string> end_child(Child& child, bool closed) {
  close(child.fd);
  if (!closed) kill(child.id, SIGKILL);
  int status = 0;
  while (waitpid(child.id, &status, 0) < 0 && errno == EINTR) {
  }
  if (!closed || !WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return std::move(child.bytes);
}

// Waits until a pipe has something to read, or a second.
std::vector<pollfd> wait_for(const std::vector<Child>& children) {
  constexpr int kMilliseconds = 1000;
  std::vector<pollfd> pollers;
  for (const Child& child : children) pollers.push_back({child.fd, POLLIN, 0});
  if (poll(pollers.data(), pollers.size(), kMilliseconds) <= 0)
    for (pollfd& poller : pollers) poller.revents = 0;
  return pollers;
}

}  // namespace

std::vector<std::optional<std::string>> run_isolated(
    const std::vector<std::function<std::string()>>& works, double seconds, std::size_t at_once) {
  std::vector<std::optional<std::string>> results(works.size());
  std::vector<Child> children;
  for (std::size_t next = 0; next < works.size() || !children.empty();) {
    for (; next < works.size() && children.size() < std::max<std::size_t>(at_once, 1); ++next)
      if (auto child = start_child(works[next], seconds)) {
        child->work = next;
        children.push_back(std::move(*child));
      }
    const std::vector<pollfd> pollers = wait_for(children);
    std::vector<Child> left;
    for (std::size_t i = 0; i < children.size(); ++i) {
      Child& child = children[i];
      const bool closed = pollers[i].revents != 0 && read_some(child);
      if (closed || Clock::now() >= child.deadline) {
        results[child.work] = end_child(child, closed);
      } else {
        left.push_back(std::move(child));
      }
    }
    children = std::move(left);
  }
  return results;
}

std::optional<std::string> run_isolated(const std::function<std::string()>& work, double seconds) {
  return run_isolated(std::vector<std::function<std::string()>>{work}, seconds, 1).front();
}

double peak_memory() noexcept {
  constexpr double kKibibyte = 1024;
  double peak = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    if (getrusage(who, &usage) == 0)
      peak = std::max(peak, kKibibyte * static_cast<double>(usage.ru_maxrss));
  }
  return peak;
}

}  // namespace artus
