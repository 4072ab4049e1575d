// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/picture_source.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"

namespace artus::kit {
namespace {

using Clock = std::chrono::system_clock;

double now() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

/// Waits until files' pictures are due, and stamps them with the time at which they come.
class Pace {
 public:
  explicit Pace(bool paced) : paced_(paced) {}
  [[nodiscard]] double stamp(double time) {
    if (!paced_) return time;
    if (!start_) start_ = now() - time;
    const double due = *start_ + time;
    if (due > now()) std::this_thread::sleep_for(std::chrono::duration<double>(due - now()));
    return due;
  }

 private:
  bool paced_;
  std::optional<double> start_;
};

Result<cv::Mat> to_grey(const cv::Mat& picture, cv::Size& size, const std::string& where) {
  if (picture.empty() || picture.depth() != CV_8U)
    return fail(ErrorCode::unreadable, "this is no picture of 8 bit", where);
  if (size.empty()) size = picture.size();
  if (picture.size() != size)
    return fail(ErrorCode::unreadable,
                printed("a picture of %d x %d among those of %d x %d", picture.cols, picture.rows,
                        size.width, size.height),
                where);
  if (picture.channels() == 1) return picture.clone();
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

class Folder final : public PictureSource {
 public:
  Folder(std::vector<std::filesystem::path> files, const Options& options)
      : files_(std::move(files)),
        period_(1 / (options.fps > 0 ? options.fps : 30)),
        pace_(options.paced) {}
  Result<std::optional<Picture8>> next() override {
    if (at_ == files_.size()) return std::nullopt;
    const auto& file = files_[at_];
    auto grey = to_grey(cv::imread(file.string(), cv::IMREAD_UNCHANGED), size_, file.string());
    ARTUS_TRY(grey);
    const double time = time_of_name(file).value_or(static_cast<double>(at_) * period_);
    if (at_ > 0 && !(time > last_))
      return fail(ErrorCode::unreadable, "this picture's name tells no later time than the last",
                  file.string());
    last_ = time;
    ++at_;
    return Picture8{std::move(*grey), pace_.stamp(time)};
  }
  bool is_live() const override { return false; }

 private:
  std::vector<std::filesystem::path> files_;
  std::size_t at_ = 0;
  double period_;
  double last_ = 0;
  cv::Size size_;
  Pace pace_;
};

class Video final : public PictureSource {
 public:
  Video(cv::VideoCapture capture, std::string name, const Options& options)
      : capture_(std::move(capture)), name_(std::move(name)), pace_(options.paced) {
    const double own = capture_.get(cv::CAP_PROP_FPS);
    period_ = 1 / (options.fps > 0 ? options.fps : own > 1 && own < 1000 ? own : 30);
  }
  Result<std::optional<Picture8>> next() override {
    cv::Mat picture;
    if (!capture_.read(picture)) return std::nullopt;
    auto grey = to_grey(picture, size_, name_);
    ARTUS_TRY(grey);
    return Picture8{std::move(*grey), pace_.stamp(static_cast<double>(at_++) * period_)};
  }
  bool is_live() const override { return false; }

 private:
  cv::VideoCapture capture_;
  std::string name_;
  double period_ = 0;
  std::int64_t at_ = 0;
  cv::Size size_;
  Pace pace_;
};

class Webcam final : public PictureSource {
 public:
  Webcam(cv::VideoCapture capture, std::string name)
      : capture_(std::move(capture)), name_(std::move(name)) {}
  Result<std::optional<Picture8>> next() override {
    cv::Mat picture;
    if (!capture_.grab() || !capture_.retrieve(picture))
      return fail(ErrorCode::unreadable, "the camera gives no picture any more: is it plugged in?",
                  name_);
    const double came = now();
    auto grey = to_grey(picture, size_, name_);
    ARTUS_TRY(grey);
    if (last_ > 0) period_ += 0.1 * (std::clamp(came - last_, 0.005, 0.2) - period_);
    last_ = came;
    return Picture8{std::move(*grey), came - period_ / 2};
  }
  bool is_live() const override { return true; }

 private:
  cv::VideoCapture capture_;
  std::string name_;
  double period_ = 1.0 / 30;  // s between pictures
  double last_ = 0;
  cv::Size size_;
};

Result<std::unique_ptr<PictureSource>> open_webcam(const std::string& source,
                                                   const PictureSource::Options& options) {
  const std::size_t colon = source.find(':');
  const auto number =
      colon == std::string::npos ? 0 : parse_integer(std::string_view(source).substr(colon + 1));
  if (!number || *number < 0 || *number > 63)
    return fail(ErrorCode::malformed, "a webcam is named webcam or webcam:NUMBER", source);
  cv::VideoCapture capture(static_cast<int>(*number));
  if (!capture.isOpened())
    return fail(ErrorCode::not_found,
                "no camera answers: is it plugged in, and does no other program use it?", source);
  capture.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'));
  capture.set(cv::CAP_PROP_FRAME_WIDTH, options.width);
  capture.set(cv::CAP_PROP_FRAME_HEIGHT, options.height);
  capture.set(cv::CAP_PROP_BUFFERSIZE, 1);
  capture.set(cv::CAP_PROP_AUTOFOCUS, 0);
  return std::make_unique<Webcam>(std::move(capture), source);
}

}  // namespace

std::optional<double> time_of_name(const std::filesystem::path& file) {
  std::string name = file.stem().string();
  if (name.size() < 3) return std::nullopt;
  const std::string unit = name.substr(name.size() - 2);
  if (unit != "ms" && unit != "us") return std::nullopt;
  name.resize(name.size() - 2);
  const std::size_t last = name.find_last_not_of("0123456789");
  const auto number =
      parse_number(std::string_view(name).substr(last == std::string::npos ? 0 : last + 1));
  if (!number) return std::nullopt;
  return *number * (unit == "ms" ? 1e-3 : 1e-6);
}

Result<std::unique_ptr<PictureSource>> open_pictures(const std::string& source,
                                                     const PictureSource::Options& options) {
  if (source == "webcam" || source.rfind("webcam:", 0) == 0) return open_webcam(source, options);
  std::error_code error;
  if (std::filesystem::is_directory(source, error)) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(source, error)) {
      const auto ending = entry.path().extension();
      if (ending == ".png" || ending == ".jpg" || ending == ".jpeg" || ending == ".bmp")
        files.push_back(entry.path());
    }
    if (files.empty())
      return fail(ErrorCode::not_found, "the folder has no .png, .jpg or .bmp", source);
    std::sort(files.begin(), files.end());
    return std::make_unique<Folder>(std::move(files), options);
  }
  if (!std::filesystem::exists(source, error))
    return fail(ErrorCode::not_found, "there is no such file, folder or webcam", source);
  cv::VideoCapture capture(source);
  if (!capture.isOpened()) return fail(ErrorCode::unreadable, "this video cannot be read", source);
  return std::make_unique<Video>(std::move(capture), source, options);
}

}  // namespace artus::kit
