// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/html_page.h"

#include <algorithm>
#include <cstdint>

#include <opencv2/imgcodecs.hpp>

#include "artus/detail/core/markup.h"
#include "artus/detail/core/text_cursor.h"

namespace artus {
namespace {

constexpr const char* kStyle = R"(body{font:15px/1.45 sans-serif;margin:2em auto;max-width:75em;
padding:0 1em;color:#222}h1{font-size:1.6em}h2{font-size:1.25em;margin-top:2em;border-bottom:1px
solid #ccc}table{border-collapse:collapse;font-size:.9em}th,td{padding:.25em .7em;text-align:right;
border-bottom:1px solid #e3e3e3}th:first-child,td:first-child{text-align:left;white-space:nowrap}tr:hover
td{background:#f4f8fc}dl{display:grid;grid-template-columns:max-content auto;gap:.2em 1em;
font-size:.9em}dt{font-weight:bold}dd{margin:0}figure{display:inline-block;margin:.4em}figcaption{
font-size:.8em;color:#555}img{border:1px solid #ddd;max-width:100%}.card{border:1px solid #ddd;
border-radius:6px;padding:.3em 1em .6em;margin:.4em;
display:inline-block;vertical-align:top;max-width:68em}.card h3{margin:.4em 0}p.point{margin:.25em 0}
.tag{display:inline-block;min-width:4.5em;padding:0 .5em;margin-right:.6em;border-radius:3px;
text-align:center;color:#fff;font-size:.85em}.refused,.failed{background:#b3261e}.look{background:#b26a00}
.mended,.passed,.do{background:#3a7d44}.note{background:#777}.drawing{width:100%;max-width:640px;margin:.4em 0}
img{height:auto}.rows{overflow-x:auto}.words{text-align:left;color:#555}.clip div{display:grid}.clip img{grid-area:1/1;opacity:0;
animation:turn 4s step-end infinite}@keyframes turn{0%{opacity:1}12.5%,100%{opacity:0}}
@media(max-width:40em){body{margin:.6em auto;padding:0 .6em}h1{font-size:1.3em}.card{display:block;
padding:.2em .6em .5em;margin:.4em 0}figure{margin:.4em 0}th,td{padding:.2em .4em}dl{display:block}
.told thead{display:none}.told td[data-name]::before{content:attr(data-name) ": ";color:#777}
.told td:first-child{white-space:normal;font-weight:bold;flex-basis:100%}.told tr{display:flex;flex-wrap:wrap;border-bottom:1px solid #e3e3e3}.told
td{border:0}.told .words{flex-basis:100%}}
@media(prefers-reduced-motion:reduce){.clip div{grid-template-columns:1fr 1fr}.clip img{grid-area:auto;
opacity:1;animation:none}.clip img:nth-child(even){display:none}}
@media print{body{font-size:9.5pt;max-width:none;margin:0;padding:0}.rows{overflow:visible}h2,h3{
break-after:avoid}.card,figure,tr{break-inside:avoid}.card{display:block}.tag{color:#000;
background:none;border:1px solid}table{font-size:8pt}th,td{padding:.1em .35em}.drawing{width:48%;
display:inline-block}.clip div{grid-template-columns:1fr 1fr}.clip img{grid-area:auto;opacity:1;
animation:none}.clip img:nth-child(even){display:none}})";

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

/// `alt`: escaped.
std::string img(const cv::Mat& image, const std::string& alt, const std::string& style) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 88});
  return "<img alt=\"" + alt + "\" width=\"" + std::to_string(image.cols) + "\" height=\"" +
         std::to_string(image.rows) + (style.empty() ? "" : "\" style=\"" + style) +
         "\" src=\"data:image/jpeg;base64," + base64(bytes) + "\">";
}

}  // namespace

HtmlPage::HtmlPage(const std::string& title, Language language)
    : title_(escape_markup(title)), language_(language) {}

void HtmlPage::heading(const std::string& text) {
  body_ += "<h2>" + escape_markup(text) + "</h2>\n";
}

void HtmlPage::paragraph(const std::string& text) {
  body_ += "<p>" + escape_markup(text) + "</p>\n";
}

void HtmlPage::point(const std::string& kind, const std::string& text) {
  body_ += "<p class=\"point\"><span class=\"tag " + escape_markup(kind) + "\">" +
           escape_markup(translate(language_, kind.c_str())) + "</span>" + escape_markup(text) +
           "</p>\n";
}

void HtmlPage::picture(const cv::Mat& image, const std::string& caption) {
  const std::string text = escape_markup(caption);
  body_ += "<figure>" + img(image, text, "") + "<figcaption>" + text + "</figcaption></figure>\n";
}

void HtmlPage::clip(const std::array<cv::Mat, kClipLength>& images, const std::string& caption) {
  const std::string text = escape_markup(caption);
  body_ += "<figure class=\"clip\"><div>";
  for (std::size_t i = 0; i < kClipLength; ++i)
    body_ += img(
        images[i], text,  // begun in the past, so that each waits for its turn
        "animation-delay:" + fixed_number(0.5 * (static_cast<double>(i) - kClipLength), 1) + "s");
  body_ += "</div><figcaption>" + text + "</figcaption></figure>\n";
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

void HtmlPage::open_details(const std::string& summary) {
  body_ += "<details><summary>" + escape_markup(summary) + "</summary>\n";
}

void HtmlPage::close_details() {
  body_ += "</details>\n";
}

void HtmlPage::table(const std::vector<Column>& columns,
                     const std::vector<std::vector<std::string>>& rows) {
  const bool told =
      std::any_of(columns.begin(), columns.end(), [](const Column& c) { return c.words; });
  body_ +=
      std::string("<div class=\"rows\"><table") + (told ? " class=\"told\"" : "") + "><thead><tr>";
  for (const Column& c : columns) body_ += "<th>" + escape_markup(c.name) + "</th>";
  body_ += "</tr></thead><tbody>\n";
  for (const auto& row : rows) {
    body_ += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      // Where the head is hidden each cell says what it is, but for the row's own name.
      const bool says = told && i > 0 && !columns[i].name.empty();
      body_ += std::string("<td") + (columns[i].words ? " class=\"words\"" : "") +
               (says ? " data-name=\"" + escape_markup(columns[i].name) + "\"" : "") + ">" +
               escape_markup(row[i]) + "</td>";
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n<dl>\n";
  for (const Column& c : columns)
    if (!c.meaning.empty())
      body_ += "<dt>" + escape_markup(c.name) + "</dt><dd>" + escape_markup(c.meaning) + "</dd>\n";
  body_ += "</dl>\n";
}

std::string HtmlPage::text() const {
  const std::string lang = language_ == Language::french ? "fr" : "en";
  return "<!DOCTYPE html>\n<html lang=\"" + lang +
         "\"><head><meta charset=\"utf-8\">\n<meta "
         "name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>" +
         title_ + "</title>\n<style>" + kStyle + "</style></head>\n<body>\n<h1>" + title_ +
         "</h1>\n" + body_ + "</body></html>\n";
}

}  // namespace artus
