// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/video_file.h"

#include <array>
#include <utility>

namespace artus {
namespace {

namespace fs = std::filesystem;

fs::path part_of(const fs::path& file) {
  fs::path part = file;
  part.replace_filename(file.stem().string() + ".part" + file.extension().string());
  return part;
}

}  // namespace

Result<VideoFile> VideoFile::open(const fs::path& file, const cv::Size& size, bool colour,
                                  double rate) {
  if (file.extension() != ".mp4" && file.extension() != ".avi")
    return fail(ErrorCode::unsupported, "videos are written as .mp4 or .avi", file.string());
  if (size.empty())
    return fail(ErrorCode::invalid, "a video needs at least one picture", file.string());
  VideoFile video;
  const std::array<std::pair<const char*, int>, 2> forms{
      {{".mp4", cv::VideoWriter::fourcc('m', 'p', '4', 'v')},
       {".avi", cv::VideoWriter::fourcc('M', 'J', 'P', 'G')}}};
  for (const auto& [extension, code] : forms) {
    if (file.extension() == ".avi" && std::string_view(extension) == ".mp4") continue;
    video.file_ = file;
    video.file_.replace_extension(extension);
    video.part_ = part_of(video.file_);
    if (video.writer_.open(video.part_.string(), code, rate, size, colour)) return video;
  }
  return fail(ErrorCode::unsupported,
              "OpenCV can write neither MP4 nor MJPEG here (or the folder is missing)",
              file.string());
}

void VideoFile::write(const cv::Mat& frame) {
  writer_.write(frame);
}

Result<fs::path> VideoFile::finish() {
  writer_.release();
  std::error_code error;
  fs::rename(part_, file_, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), file_.string());
  return file_;
}

}  // namespace artus
