// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/viewer/input/key_map.h"
#include "artus/detail/viewer/input/screen.h"
#include "artus/detail/viewer/input/script.h"

namespace artus {

/// How a line is meant.
enum class Tone { plain, heading, good, bad, dim };

struct PageLine {
  std::string text;
  Tone tone = Tone::plain;
};

/// (height, width) grey, x fastest.
struct PagePicture {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  std::vector<std::uint8_t> grey;
};

/// Something that can be chosen, and what is told of it while it is marked.
struct PageChoice {
  std::string name;
  std::string beside;  ///< at the right of its line
  Tone tone = Tone::plain;
  std::vector<PageLine> about;
  std::shared_ptr<const PagePicture> picture;  ///< null: none
};

/// A page of a window: lines, and choices of which one is taken by mouse, keyboard or gamepad.
struct Page {
  std::string name;  ///< its name in scripts
  std::string title;
  std::vector<PageLine> lines;
  std::vector<PageChoice> choices;
  std::size_t at = 0;     ///< the choice that is marked
  bool may_back = false;  ///< one can go back from here
  /// How far something has come that is waited for, in words and 0 to 1; empty: there is no bar.
  std::function<std::pair<std::string, double>()> bar;
  std::function<void(Page&)> refresh;  ///< called before each look; empty: it stays as it is
  std::function<bool()> done;          ///< ends the page without a choice; empty: only choices do
};

/// How a page ended.
struct PageAnswer {
  enum class Kind { chosen, back, closed, done };
  Kind kind = Kind::closed;
  std::size_t choice = 0;
};

/// Where the mark goes, and whether the page ends.
struct PageMove {
  std::size_t at = 0;
  bool chosen = false;
  bool back = false;
};
/// What an action does on a page with `n` choices of which `at` is marked: up and down move the
/// mark and stop at the ends, accept and a gamepad's A choose, let_go and its B go back. Pure.
[[nodiscard]] PageMove move_on_page(Action action, std::size_t at, std::size_t n) noexcept;

struct PageOptions {
  Language language = Language::english;
  KeyMap keys;
  double font_scale = 1;
  PageScript* script = nullptr;  ///< whose steps the pages take; null: a person is there
  std::function<bool()> asked_to_close;
  std::function<void(const Page&)> watch = {};  ///< called at each look; may be empty
};

/// Shows pages on a screen, one after the other, until it is destroyed.
class PageWindow {
 public:
  PageWindow(Screen& screen, PageOptions options);
  ~PageWindow();
  PageWindow(const PageWindow&) = delete;
  PageWindow& operator=(const PageWindow&) = delete;

  /// Until something is chosen, the page is done or the window is closed. A script that has no
  /// steps left closes the window. Errors: those of PageScript::take, unreadable (a picture
  /// cannot be written), failed (a script's steps choose nothing).
  [[nodiscard]] Result<PageAnswer> show(Page page);

 private:
  class Shown;
  std::unique_ptr<Shown> shown_;
};

}  // namespace artus
