// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "artus/detail/viewer/input/gui_context.h"
#include "artus/detail/viewer/input/window_events.h"
#include "artus/detail/viewer/pages/page.h"

namespace artus {

/// What pages and reviews have in common: the events of a person or a script, the letters' size,
/// and how a look becomes a picture on the screen.
class PageGui {
 public:
  PageGui(Screen& screen, const PageOptions& options);

  /// Takes the script's steps for a page; without a name, those that the last one left. `waits`: a
  /// page that is over by itself leaves them all to the next. Errors: as PageScript::take.
  [[nodiscard]] Result<void> begin(const std::string& page, bool waits = false);
  /// Shows looks until `step` says that it is over. `look` draws one; `act` is called with what was
  /// done, before the look that shows it. True: the window was closed, or the script is at its end.
  /// Errors: unreadable (a script's picture), failed (a script that ends nothing).
  [[nodiscard]] Result<bool> run(const std::function<void(const UserEvent&)>& act,
                                 const std::function<void()>& look,
                                 const std::function<bool()>& over);

  [[nodiscard]] float scale() const noexcept { return scale_; }
  [[nodiscard]] const PageOptions& options() const noexcept { return options_; }
  [[nodiscard]] Screen& screen() const noexcept { return screen_; }

 private:
  void fit();
  void feed(const UserEvent& event, const std::function<void(const UserEvent&)>& act);
  void pass(double elapsed, const std::function<void()>& look);
  void run_script(double elapsed, const std::function<void(const UserEvent&)>& act,
                  const std::function<void()>& look, const std::function<bool()>& over);
  [[nodiscard]] Result<void> show();
  [[nodiscard]] bool script_waits(double elapsed);

  Screen& screen_;
  const PageOptions& options_;
  const GuiContext gui_;
  WindowEvents events_;
  float scale_ = 0;
  std::vector<ScriptStep> steps_;
  std::size_t next_step_ = 0;
  double waited_ = 0;   // s
  bool waits_ = false;  // this page takes no steps
  std::vector<std::filesystem::path> wanted_;
};

}  // namespace artus
