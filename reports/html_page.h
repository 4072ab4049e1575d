// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// A page that needs nothing but itself: no server, no script, pictures inside.
class HtmlPage {
 public:
  explicit HtmlPage(const std::string& title, Language language = Language::english);

  [[nodiscard]] Language language() const noexcept { return language_; }

  void heading(const std::string& text);
  void paragraph(const std::string& text);
  /// One line a point; `kind` colours it and stands before it in the page's language: refused,
  /// look, mended, note, passed, failed, do.
  void point(const std::string& kind, const std::string& text);
  void picture(const cv::Mat& image, const std::string& caption);
  /// Pictures of one size one after the other, half a second each, again and again; in print, and
  /// for people who want no motion, every other one side by side.
  static constexpr std::size_t kClipLength = 8;
  void clip(const std::array<cv::Mat, kClipLength>& images, const std::string& caption);
  /// A vector drawing, as it is: whoever made it escaped its text.
  void drawing(const std::string& svg, const std::string& caption);
  /// A card that pictures and points stand in, with a heading.
  void open_card(const std::string& text);
  void close_card();
  /// What most need not see: it opens by a click, without script.
  void open_details(const std::string& summary);
  void close_details();
  /// Head cells with what they mean, shown below the table.
  struct Column {
    std::string name;
    std::string meaning;
    bool words = false;  ///< its cells are sentences: on a phone they stand on lines of their own
  };
  void table(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows);

  /// The whole page.
  [[nodiscard]] std::string text() const;

 private:
  std::string body_;
  std::string title_;
  Language language_;
};

/// A sentence in the page's language.
[[nodiscard]] inline const char* translate(const HtmlPage& page, const char* english) noexcept {
  return translate(page.language(), english);
}

}  // namespace artus
