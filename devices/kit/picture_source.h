// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "artus/core/result.h"

namespace artus::kit {

/// One picture of a source.
struct Picture8 {
  cv::Mat grey;     ///< 8 bit
  double time = 0;  ///< s: of a camera the system's realtime clock, of files from their beginning
};

/// Where pictures come from: a webcam, a video file or a folder of pictures.
class PictureSource {
 public:
  struct Options {
    double fps = 0;      ///< of a folder or video whose times are not told; 0: 30, or the video's
    int width = 1280;    ///< pixels that a webcam is asked for
    int height = 720;    ///< pixels
    bool paced = false;  ///< files come at their own pace, with the time at which they come
  };
  virtual ~PictureSource() = default;
  PictureSource() = default;
  PictureSource(const PictureSource&) = delete;
  PictureSource& operator=(const PictureSource&) = delete;

  /// The next picture; nullopt at the end of a file. Times are mid-exposure as far as the source
  /// tells: a webcam's are when the picture came, less half a picture's period for its exposure and
  /// readout (assumed; drivers do not say). Errors: unreadable (the camera went away; a picture
  /// that is none; another size than those before).
  [[nodiscard]] virtual Result<std::optional<Picture8>> next() = 0;
  /// Does it go on for ever?
  [[nodiscard]] virtual bool is_live() const = 0;
};

/// "webcam", "webcam:2", a folder of .png, .jpg or .bmp (in the order of their names; a name that
/// ends in digits and "ms" or "us" tells its time), or a video file. Errors: not_found, unreadable.
[[nodiscard]] Result<std::unique_ptr<PictureSource>> open_pictures(
    const std::string& source, const PictureSource::Options& options);

/// The number that a picture's name ends in, as s, where "ms" or "us" stands behind it:
/// "hand_0033ms.png". nullopt: it tells no time.
[[nodiscard]] std::optional<double> time_of_name(const std::filesystem::path& file);

}  // namespace artus::kit
