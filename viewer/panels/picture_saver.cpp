// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/picture_saver.h"

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace artus {
/// Writes in a thread of its own: where encoding takes longer than the pictures last, the window
/// goes on and the clip is ready later.
struct PictureSaver::Clip {
  struct Shown {
    cv::Mat picture;
    int times;
  };
  std::filesystem::path file;
  cv::Size size;
  double due = 0;  // s that the clip is behind the session
  int frames = 0;
  std::atomic<bool> written{false};

  ~Clip() {
    close();
    if (thread_.joinable()) thread_.join();
  }
  bool open() {
    writer_.open(file.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kClipRate, size, true);
    if (!writer_.isOpened()) return false;
    thread_ = std::thread([this] { write_all(); });
    return true;
  }
  void add(Shown shown) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      queue_.push_back(std::move(shown));
    }
    more_.notify_one();
  }
  void close() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      closed_ = true;
    }
    more_.notify_one();
  }

 private:
  void write_all() {
    for (;;) {
      Shown next;
      {
        std::unique_lock<std::mutex> lock(mutex_);
        more_.wait(lock, [this] { return closed_ || !queue_.empty(); });
        if (queue_.empty()) break;
        next = std::move(queue_.front());
        queue_.pop_front();
      }
      for (int i = 0; i < next.times; ++i) writer_.write(next.picture);
    }
    writer_.release();
    written = true;
  }

  cv::VideoWriter writer_;
  std::mutex mutex_;
  std::condition_variable more_;
  std::deque<Shown> queue_;
  bool closed_ = false;
  std::thread thread_;  // of the others' lifetime
};

PictureSaver::PictureSaver(std::filesystem::path folder) : folder_(std::move(folder)) {}
PictureSaver::~PictureSaver() = default;

std::filesystem::path PictureSaver::next(const char* stem, const char* extension) const {
  for (int number = 1;; ++number) {
    auto file = folder_ / (stem + std::to_string(number) + extension);
    if (!std::filesystem::exists(file)) return file;
  }
}

std::string PictureSaver::save(const ImageSnapshot& image, const Caption& caption, bool plain) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  const auto file = next("bmode-", ".png");
  const cv::Mat picture =
      plain ? plain_picture(image, caption.look) : captioned_picture(image, caption);
  const bool written = cv::haveImageWriter(file.string()) && cv::imwrite(file.string(), picture);
  const char* const said = written ? msgid("saved {}") : msgid("cannot write {}");
  return fill(translate(caption.language, said), {std::filesystem::absolute(file, error).string()});
}

std::string PictureSaver::begin_clip(const ImageSnapshot& image, Language language) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  closing_.reset();  // waits until the one before is written
  clip_ = std::make_unique<Clip>();
  clip_->file = next("clip-", ".avi");
  clip_->size = cv::Size(image.width, image.height);
  if (clip_->open()) return fill(translate(language, "clip started: {}"), {clip_->file.string()});
  std::string refusal = fill(translate(language, "cannot write {}"), {clip_->file.string()});
  clip_.reset();
  return refusal;
}

void PictureSaver::add_to_clip(const ImageSnapshot& image, const DisplayLook& look,
                               double elapsed) {
  if (!clip_ || cv::Size(image.width, image.height) != clip_->size) return;
  clip_->due += elapsed;
  const int times = static_cast<int>(std::ceil(clip_->due * kClipRate));
  if (times <= 0) return;
  clip_->due -= times / kClipRate;
  clip_->frames += times;
  cv::Mat picture = plain_picture(image, look);
  if (picture.channels() == 1) cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  clip_->add({picture, times});
}

void PictureSaver::end_clip() {
  if (!clip_) return;
  clip_->close();
  closing_ = std::move(clip_);
}

std::string PictureSaver::take_written(Language language) {
  if (!closing_ || !closing_->written) return {};
  std::error_code error;
  std::string said =
      fill(translate_count(language, "saved clip of {} picture: {}",
                           "saved clip of {} pictures: {}", static_cast<long>(closing_->frames)),
           {std::to_string(closing_->frames),
            std::filesystem::absolute(closing_->file, error).string()});
  closing_.reset();
  return said;
}

double PictureSaver::clip_seconds() const noexcept {
  return clip_ ? clip_->frames / kClipRate : 0;
}

bool PictureSaver::in_clip() const noexcept {
  return clip_ != nullptr;
}

}  // namespace artus
