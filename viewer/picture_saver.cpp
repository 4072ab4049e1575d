// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/viewer/picture_saver.h"

#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

namespace artus {
namespace {

/// The image's pixels without a copy; OpenCV has no constant view of them.
cv::Mat view_of(const ImageSnapshot& image) {
  return {image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.grey.data())};
}

}  // namespace

struct PictureSaver::Clip {
  cv::VideoWriter writer;
  std::filesystem::path file;
  cv::Size size;
  double due = 0;  // s that the clip is behind the session
  int frames = 0;
};

PictureSaver::PictureSaver(std::filesystem::path folder) : folder_(std::move(folder)) {}
PictureSaver::~PictureSaver() = default;

std::filesystem::path PictureSaver::next(const char* stem, const char* extension) const {
  for (int number = 1;; ++number) {
    auto file = folder_ / (stem + std::to_string(number) + extension);
    if (!std::filesystem::exists(file)) return file;
  }
}

std::string PictureSaver::save(const ImageSnapshot& image) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  const auto file = next("bmode-", ".png");
  const bool written =
      cv::haveImageWriter(file.string()) && cv::imwrite(file.string(), view_of(image));
  return (written ? "saved " : "cannot write ") + file.string();
}

std::string PictureSaver::begin_clip(const ImageSnapshot& image) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  clip_ = std::make_unique<Clip>();
  clip_->file = next("clip-", ".avi");
  clip_->size = cv::Size(image.width, image.height);
  clip_->writer.open(clip_->file.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kClipRate,
                     clip_->size, false);
  if (clip_->writer.isOpened()) return "clip " + clip_->file.string();
  std::string refusal = "cannot write " + clip_->file.string();
  clip_.reset();
  return refusal;
}

void PictureSaver::add_to_clip(const ImageSnapshot& image, double elapsed) {
  if (!clip_ || cv::Size(image.width, image.height) != clip_->size) return;
  clip_->due += elapsed;
  while (clip_->due > 0) {
    clip_->due -= 1 / kClipRate;
    clip_->writer.write(view_of(image));
    ++clip_->frames;
  }
}

std::string PictureSaver::end_clip() {
  if (!clip_) return {};
  clip_->writer.release();
  std::string text =
      "clip of " + std::to_string(clip_->frames) + " pictures: " + clip_->file.string();
  clip_.reset();
  return text;
}

bool PictureSaver::in_clip() const noexcept {
  return clip_ != nullptr;
}

}  // namespace artus
