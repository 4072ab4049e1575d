// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "artus/detail/viewer/joint3d/body_mark.h"
#include "artus/detail/viewer/panels/display_look.h"
#include "artus/detail/viewer/panels/image_place.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// What is written beside a saved picture.
struct Caption {
  Language language = Language::english;
  std::string patient;               ///< a pseudonym; empty: none
  std::string side;                  ///< of the body
  std::string date;                  ///< as it is to be read
  std::vector<ImagePoint> calipers;  ///< pairs
  DisplayLook look;
  const BodyMark* mark = nullptr;  ///< with the probe of the picture; null: none
  double doppler_limit = 0;        ///< m/s
};

/// The date and time of now, as year-month-day hour:minute:second of this place.
[[nodiscard]] std::string date_of_now();

/// The depth, gain and so on that made this image, as one line.
[[nodiscard]] std::string settings_line(Language language, const ImageSnapshot& image);

/// The velocities that colours mean, as text: "Doppler +-5 cm/s".
[[nodiscard]] std::string doppler_line(Language language, double limit);

/// The picture as the display shows it and nothing else: (height, width), 8 bit grey, or blue,
/// green, red where colour Doppler is on.
[[nodiscard]] cv::Mat plain_picture(const ImageSnapshot& image, const DisplayLook& look);

/// The same within a black border with ruler, calipers, settings, name, side, date and the word
/// "simulated"; 8 bit blue, green, red. The image's pixels keep their size.
[[nodiscard]] cv::Mat captioned_picture(const ImageSnapshot& image, const Caption& caption);
/// Where the image's upper left pixel stands in it.
inline constexpr int kCaptionLeft = 44;  // pixels
inline constexpr int kCaptionTop = 40;   // pixels

}  // namespace artus
