// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/apps/html_page.h"

#include <algorithm>
#include <cstdint>

#include <opencv2/imgcodecs.hpp>

#include "artus/core/markup.h"

namespace artus {
namespace {

constexpr const char* kStyle = R"(body{font:15px/1.45 sans-serif;margin:2em auto;max-width:75em;
padding:0 1em;color:#222}h1{font-size:1.6em}h2{font-size:1.25em;margin-top:2em;border-bottom:1px
solid #ccc}table{border-collapse:collapse;font-size:.9em}th,td{padding:.25em .7em;text-align:right;
border-bottom:1px solid #e3e3e3}th:first-child,td:first-child{text-align:left}tr:hover
td{background:#f4f8fc}dl{display:grid;grid-template-columns:max-content auto;gap:.2em 1em;
font-size:.9em}dt{font-weight:bold}dd{margin:0}figure{display:inline-block;margin:.4em}figcaption{
font-size:.8em;color:#555}img{border:1px solid #ddd;max-width:100%}.card{border:1px solid #ddd;
border-radius:6px;padding:.3em 1em .6em;margin:.4em;
display:inline-block;vertical-align:top;max-width:68em}.card h3{margin:.4em 0}p.point{margin:.25em 0}
.tag{display:inline-block;min-width:4.5em;padding:0 .5em;margin-right:.6em;border-radius:3px;
text-align:center;color:#fff;font-size:.85em}.refused,.failed{background:#b3261e}.look{background:#b26a00}
.mended,.passed,.do{background:#3a7d44}.note{background:#777}.drawing{width:100%;max-width:640px;margin:.4em 0})";

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(4 * (bytes.size() + 2) / 3);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8U | (k < n ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= n ? kDigits[word >> (18U - 6U * k) & 63U] : '=';
  }
  return out;
}

}  // namespace

HtmlPage::HtmlPage(const std::string& title) : title_(escape_markup(title)) {}

void HtmlPage::heading(const std::string& text) {
  body_ += "<h2>" + escape_markup(text) + "</h2>\n";
}

void HtmlPage::paragraph(const std::string& text) {
  body_ += "<p>" + escape_markup(text) + "</p>\n";
}

void HtmlPage::point(const std::string& kind, const std::string& text) {
  body_ += "<p class=\"point\"><span class=\"tag " + escape_markup(kind) + "\">" +
           escape_markup(kind) + "</span>" + escape_markup(text) + "</p>\n";
}

void HtmlPage::picture(const cv::Mat& image, const std::string& caption) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 88});
  const std::string text = escape_markup(caption);
  body_ += "<figure><img alt=\"" + text + "\" width=\"" + std::to_string(image.cols) +
           "\" height=\"" + std::to_string(image.rows) + "\" src=\"data:image/jpeg;base64," +
           base64(bytes) + "\"><figcaption>" + text + "</figcaption></figure>\n";
}

void HtmlPage::drawing(const std::string& svg, const std::string& caption) {
  body_ += "<figure class=\"drawing\">" + svg + "<figcaption>" + escape_markup(caption) +
           "</figcaption></figure>\n";
}

void HtmlPage::open_card(const std::string& text) {
  body_ += "<div class=\"card\"><h3>" + escape_markup(text) + "</h3>\n";
}

void HtmlPage::close_card() {
  body_ += "</div>\n";
}

void HtmlPage::table(const std::vector<Column>& columns,
                     const std::vector<std::vector<std::string>>& rows) {
  body_ += "<table><thead><tr>";
  for (const Column& c : columns) body_ += "<th>" + escape_markup(c.name) + "</th>";
  body_ += "</tr></thead><tbody>\n";
  for (const auto& row : rows) {
    body_ += "<tr>";
    for (const std::string& cell : row) body_ += "<td>" + escape_markup(cell) + "</td>";
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table>\n<dl>\n";
  for (const Column& c : columns)
    if (!c.meaning.empty())
      body_ += "<dt>" + escape_markup(c.name) + "</dt><dd>" + escape_markup(c.meaning) + "</dd>\n";
  body_ += "</dl>\n";
}

std::string HtmlPage::text() const {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta "
         "name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>" +
         title_ + "</title>\n<style>" + kStyle + "</style></head>\n<body>\n<h1>" + title_ +
         "</h1>\n" + body_ + "</body></html>\n";
}

}  // namespace artus
