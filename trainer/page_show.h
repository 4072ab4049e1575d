// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <utility>

#include "artus/detail/trainer/pages.h"

namespace artus {

/// Pages one after the other on a screen that a session's window takes in between.
class PageShow {
 public:
  /// The screen outlives it.
  PageShow(Screen& screen, PageOptions options) : screen_(&screen), options_(std::move(options)) {}

  [[nodiscard]] const PageOptions& options() const noexcept { return options_; }
  [[nodiscard]] Screen& screen() noexcept { return *screen_; }

  /// Errors: those of PageWindow::show.
  [[nodiscard]] Result<PageAnswer> show(Page page) {
    if (!pages_) pages_ = std::make_unique<PageWindow>(*screen_, options_);
    return pages_->show(std::move(page));
  }
  /// Another window takes the screen until the next page.
  void leave_screen() { pages_.reset(); }

  /// What a thread of its own makes while a page asks to wait; empty: the window was closed.
  /// Errors: those of `make`, which returns a Result, and of show.
  template <class Make>
  auto meanwhile(const char* what, Make make)
      -> Result<std::optional<typename decltype(make())::value_type>> {
    auto making = std::async(std::launch::async, make);
    const auto ready = [&making] {
      return making.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    };
    const auto waited = show(make_busy_page(what, ready, options_.language));
    ARTUS_TRY(waited);
    auto made = making.get();
    ARTUS_TRY(made);
    if (waited->kind != PageAnswer::Kind::done) return std::nullopt;
    return std::optional(std::move(*made));
  }

 private:
  Screen* screen_;
  PageOptions options_;
  std::unique_ptr<PageWindow> pages_;
};

}  // namespace artus
