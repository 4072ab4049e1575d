// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "artus/detail/viewer/panels/caption.h"

namespace artus {

/// Writes B-mode images and clips into a folder, numbered so that nothing is overwritten.
class PictureSaver {
 public:
  static constexpr double kClipRate = 25;  ///< pictures a second of a clip

  explicit PictureSaver(std::filesystem::path folder);
  ~PictureSaver();
  PictureSaver(const PictureSaver&) = delete;
  PictureSaver& operator=(const PictureSaver&) = delete;

  /// Writes a PNG, with its caption unless `plain`; returns what to tell the person.
  [[nodiscard]] std::string save(const ImageSnapshot& image, const Caption& caption, bool plain);

  /// Begins a clip (Motion JPEG, AVI) of images of this size.
  [[nodiscard]] std::string begin_clip(const ImageSnapshot& image, Language language);
  /// The clip shows `image` for `elapsed` s: it runs as fast as the session did. Images of another
  /// size (the depth was changed) are left out.
  void add_to_clip(const ImageSnapshot& image, const DisplayLook& look, double elapsed);
  /// The clip is written to its end in the background.
  void end_clip();
  /// What to tell the person when a clip that was ended is written; empty until then, and later.
  [[nodiscard]] std::string take_written(Language language);
  [[nodiscard]] bool in_clip() const noexcept;
  /// s that the clip will play so far.
  [[nodiscard]] double clip_seconds() const noexcept;

 private:
  struct Clip;
  [[nodiscard]] std::filesystem::path next(const char* stem, const char* extension) const;

  std::filesystem::path folder_;
  std::unique_ptr<Clip> clip_;
  std::unique_ptr<Clip> closing_;
};

}  // namespace artus
