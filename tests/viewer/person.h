// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "artus/detail/viewer/window.h"
#include "tests/support/x_actor.h"

namespace artus::test {

/// A person before a window: acts in a thread of its own by real events and looks at what the
/// window says that it shows.
class Person {
 public:
  explicit Person(XActor& x) : x_(x) {}

  [[nodiscard]] XActor& x() { return x_; }
  [[nodiscard]] WindowStatus seen() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return seen_;
  }
  /// Until what the window shows is so; a failure of the test after `seconds`.
  bool wait_until(const char* what, const std::function<bool(const WindowStatus&)>& is_so,
                  double seconds = 60) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
      if (is_so(seen())) return true;
      rest(0.01);
    }
    const WindowStatus now = seen();
    ADD_FAILURE() << "never: " << what << "; goal '" << now.goal << "', next '" << now.next
                  << "', message '" << now.message << "', depth " << now.needle.depth;
    return false;
  }
  /// Lets the window show so many pictures more.
  void wait_pictures(std::uint64_t n) {
    const std::uint64_t from = seen().pictures;
    wait_until("pictures", [from, n](const WindowStatus& s) { return s.pictures >= from + n; });
  }
  /// Pushes the needle by the wheel, looking at two pictures after each push, slower near the
  /// target, until what is shown is so. A person who does not look overshoots where the window
  /// shows few pictures.
  bool push_until(const char* what, const std::function<bool(const WindowStatus&)>& is_so) {
    constexpr double kNear = 10e-3;  // m
    constexpr int kMax = 100;
    for (int i = 0; i < kMax && !is_so(seen()); ++i) {
      x_.wheel(seen().needle.to_target > kNear ? 4 : 1);
      rest(0.15);  // the hand is slower than the wheel
      wait_pictures(1);
    }
    return wait_until(what, is_so);
  }
  static void rest(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  }

  /// Shows the window until `does` is done.
  std::unique_ptr<WindowReport> sit_before(Session& session, HandDevice* hand,
                                           const HandTarget& start, WindowOptions options,
                                           const std::function<void(Person&)>& does) {
    std::atomic<bool> done{false};
    options.asked_to_close = [&done] {
      return done.load();
    };
    options.watch = [this](const WindowStatus& status) {
      const std::lock_guard<std::mutex> lock(mutex_);
      seen_ = status;
    };
    std::thread thread([&] {
      if (wait_until(
              "an image", [](const WindowStatus& s) { return s.has_image && s.pictures > 4; }, 180))
        does(*this);
      done = true;
    });
    auto report = std::make_unique<WindowReport>();
    const auto shown = run_window(session, hand, start, options, *report);
    done = true;
    thread.join();
    EXPECT_TRUE(shown) << shown.error().to_string();
    return report;
  }

 private:
  XActor& x_;
  std::mutex mutex_;
  WindowStatus seen_;
};

}  // namespace artus::test
