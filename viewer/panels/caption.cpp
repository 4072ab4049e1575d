// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/caption.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/joint3d/colours.h"

namespace artus {
namespace {

constexpr int kBottom = 24;    // pixels below the image
constexpr int kMinWide = 420;  // pixels, so that the lines of text fit
constexpr double kLetters = 0.4;

cv::Scalar bgr(const Rgb& c) {
  return {static_cast<double>(c[2]), static_cast<double>(c[1]), static_cast<double>(c[0])};
}

/// OpenCV's strokes know no accents.
std::string without_accents(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, const char*>, 15> kLetter{{{"é", "e"},
                                                                              {"è", "e"},
                                                                              {"ê", "e"},
                                                                              {"à", "a"},
                                                                              {"â", "a"},
                                                                              {"î", "i"},
                                                                              {"ï", "i"},
                                                                              {"ô", "o"},
                                                                              {"ù", "u"},
                                                                              {"û", "u"},
                                                                              {"ç", "c"},
                                                                              {"É", "E"},
                                                                              {"À", "A"},
                                                                              {"µ", "u"},
                                                                              {"±", "+-"}}};
  std::string out;
  while (!text.empty()) {
    const auto* const found = std::find_if(kLetter.begin(), kLetter.end(), [&](const auto& l) {
      return text.substr(0, l.first.size()) == l.first;
    });
    const bool known = found != kLetter.end();
    const bool ascii = static_cast<unsigned char>(text[0]) < 0x80;
    if (known)
      out += found->second;
    else if (ascii)
      out += text[0];
    else if ((static_cast<unsigned char>(text[0]) & 0xc0U) == 0xc0U)
      out += '?';
    text.remove_prefix(known ? found->first.size() : 1);
  }
  return out;
}

void write(cv::Mat& picture, const std::string& text, const cv::Point& at, const Rgb& colour) {
  const std::string plain = without_accents(text);
  cv::putText(picture, plain, at, cv::FONT_HERSHEY_SIMPLEX, kLetters, bgr(kOutline), 3,
              cv::LINE_AA);
  cv::putText(picture, plain, at, cv::FONT_HERSHEY_SIMPLEX, kLetters, bgr(colour), 1, cv::LINE_AA);
}

void outlined_line(cv::Mat& picture, const cv::Point& a, const cv::Point& b) {
  cv::line(picture, a, b, bgr(kOutline), 3, cv::LINE_AA);
  cv::line(picture, a, b, bgr(kOverlay), 1, cv::LINE_AA);
}

void draw_calipers(cv::Mat& picture, const ImageSnapshot& image, const Caption& caption) {
  const double scale = kMillimetre / image.pixel;  // pixels a millimetre
  const auto place = [&](const ImagePoint& p) {
    const double x = caption.look.flipped ? image.width - scale * p.x_mm : scale * p.x_mm;
    return cv::Point(kCaptionLeft + static_cast<int>(std::lround(x)),
                     kCaptionTop + static_cast<int>(std::lround(scale * p.y_mm)));
  };
  for (std::size_t i = 0; i < caption.calipers.size(); ++i) {
    const cv::Point p = place(caption.calipers[i]);
    outlined_line(picture, p - cv::Point(4, 0), p + cv::Point(4, 0));
    outlined_line(picture, p - cv::Point(0, 4), p + cv::Point(0, 4));
    if (i % 2 == 0) continue;
    outlined_line(picture, place(caption.calipers[i - 1]), p);
    const double mm = distance_mm(caption.calipers[i - 1], caption.calipers[i]);
    write(picture, number(caption.language, mm, 1) + " mm", p + cv::Point(6, -6), kOverlay);
  }
}

void draw_ruler(cv::Mat& picture, const ImageSnapshot& image) {
  const double scale = kMillimetre / image.pixel;
  const double depth = image.height / scale;
  constexpr Rgb kWhite{235, 235, 235};
  for (int mm = 0; mm <= static_cast<int>(depth); mm += 5) {
    const bool ten = mm % 10 == 0;
    const int y = kCaptionTop + static_cast<int>(std::lround(scale * mm));
    cv::line(picture, {kCaptionLeft - (ten ? 9 : 5), y}, {kCaptionLeft - 2, y}, bgr(kWhite));
    if (ten) write(picture, std::to_string(mm), {6, y + 4}, kWhite);
  }
}

void draw_mark(cv::Mat& picture, const ImageSnapshot& image, const BodyMark& mark) {
  const cv::Point corner(kCaptionLeft + image.width + 8, kCaptionTop + image.height - mark.size);
  const cv::Mat grey = cv::Mat(mark.grey, true).reshape(1, mark.size);
  cv::cvtColor(grey, picture(cv::Rect(corner.x, std::max(corner.y, 0), mark.size, mark.size)),
               cv::COLOR_GRAY2BGR);
  const MarkLine line = probe_on_mark(mark, to_pose(image.input.X_JP), image.probe_width);
  const cv::Point a = corner + cv::Point(cv::Point2f(line.x0, line.y0));
  outlined_line(picture, a, corner + cv::Point(cv::Point2f(line.x1, line.y1)));
  cv::circle(picture, a, 3, bgr(kOverlay), cv::FILLED, cv::LINE_AA);
}

void draw_box(cv::Mat& picture, const ImageSnapshot& image, const Caption& caption) {
  if (!caption.look.colour) return;
  const ColourBox& box = caption.look.box;
  const double middle = caption.look.flipped ? 1 - box.x : box.x;
  const cv::Rect frame(
      kCaptionLeft + static_cast<int>(std::lround((middle - box.width / 2) * image.width)),
      kCaptionTop + static_cast<int>(std::lround((box.y - box.height / 2) * image.height)),
      static_cast<int>(std::lround(box.width * image.width)),
      static_cast<int>(std::lround(box.height * image.height)));
  cv::rectangle(picture, frame, bgr(kOverlay));
  const std::string said = doppler_line(caption.language, caption.doppler_limit);
  write(picture, said, {kCaptionLeft + 16, 32}, kOverlay);  // beside the marked side
}

}  // namespace

std::string date_of_now() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::array<char, 32> shown{};
  const std::size_t n = std::strftime(shown.data(), shown.size(), "%Y-%m-%d %H:%M:%S", &local);
  return {shown.data(), n};
}

std::string settings_line(Language language, const ImageSnapshot& image) {
  const ImageControls& c = image.input.controls;
  const auto whole = [language](double value) {
    return number(language, value, 0);
  };
  return whole(image.height * image.pixel / kMillimetre) + " mm  " + whole(c.frequency * 1e-6) +
         " MHz  " + translate(language, "gain") + " " + (c.gain_db > 0 ? "+" : "") +
         whole(c.gain_db) + " dB  " + translate(language, "range") + " " +
         whole(c.dynamic_range_db) + " dB  " + translate(language, "focus") + " " +
         whole(c.elevation_focus / kMillimetre) + " mm";
}

std::string doppler_line(Language language, double limit) {
  return "Doppler \xc2\xb1" + number(language, 100 * limit, 0) + " cm/s";
}

cv::Mat plain_picture(const ImageSnapshot& image, const DisplayLook& look) {
  cv::Mat picture;
  if (look.colour) {
    std::vector<std::uint8_t> rgb = displayed_colour(image, look);
    cv::cvtColor(cv::Mat(image.height, image.width, CV_8UC3, rgb.data()), picture,
                 cv::COLOR_RGB2BGR);
  } else {
    std::vector<std::uint8_t> grey = displayed_grey(image, look);
    picture = cv::Mat(image.height, image.width, CV_8UC1, grey.data()).clone();
  }
  if (look.flipped) cv::flip(picture, picture, 1);
  return picture;
}

cv::Mat captioned_picture(const ImageSnapshot& image, const Caption& caption) {
  const int beside = caption.mark != nullptr ? caption.mark->size + 8 : 0;
  const int width = std::max(kCaptionLeft + image.width + 8 + beside, kMinWide);
  const int below = std::max(image.height, beside);
  cv::Mat picture(kCaptionTop + below + kBottom, width, CV_8UC3, cv::Scalar(0, 0, 0));
  cv::Mat colour = plain_picture(image, caption.look);
  if (colour.channels() == 1) cv::cvtColor(colour, colour, cv::COLOR_GRAY2BGR);
  colour.copyTo(picture(cv::Rect(kCaptionLeft, kCaptionTop, image.width, image.height)));
  if (caption.mark != nullptr) draw_mark(picture, image, *caption.mark);
  draw_box(picture, image, caption);
  constexpr Rgb kWhite{235, 235, 235};
  const std::string who = caption.patient + (caption.patient.empty() ? "" : "   ") + caption.side;
  write(picture, who, {kCaptionLeft, 15}, kWhite);
  write(picture, caption.date, {width - 150, 15}, kWhite);
  write(picture, translate(caption.language, "SIMULATED"), {width - 150, 32}, kOverlay);
  write(picture, settings_line(caption.language, image), {kCaptionLeft, picture.rows - 8}, kWhite);
  const int mark = caption.look.flipped ? kCaptionLeft + image.width - 6 : kCaptionLeft + 6;
  cv::circle(picture, {mark, kCaptionTop - 6}, 4, bgr(kOverlay), cv::FILLED, cv::LINE_AA);
  draw_ruler(picture, image);
  draw_calipers(picture, image, caption);
  return picture;
}

}  // namespace artus
