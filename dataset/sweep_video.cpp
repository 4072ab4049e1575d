// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/sweep_video.h"

#include <optional>

#include <opencv2/imgproc.hpp>

#include "artus/detail/dataset/video_file.h"
#include "artus/detail/echo/display/shown_places.h"
#include "artus/echo/image_io.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

/// The image, and beside it the labels of the same height when they are asked for.
cv::Mat picture_of(Renderer& renderer, const LabelRenderer* truth, const CompiledJoint& joint,
                   const Pose& X_JP, const std::optional<NeedleView>& needle) {
  const Frame& frame = renderer.render(X_JP, needle);
  cv::Mat image = annotated_image(frame, renderer.transducer());
  if (truth == nullptr) return image;
  const cv::Mat labels =
      colour_labels(truth->render_shown(renderer.shown_places(X_JP), X_JP, needle), joint);
  cv::Mat both(image.rows, image.cols + labels.cols, CV_8UC3, cv::Scalar(0, 0, 0));
  cv::cvtColor(image, both(cv::Rect(0, 0, image.cols, image.rows)), cv::COLOR_GRAY2BGR);
  labels.copyTo(
      both(cv::Rect(image.cols, (image.rows - labels.rows) / 2, labels.cols, labels.rows)));
  return both;
}

}  // namespace

Result<SweepVideo> write_sweep_video(const std::shared_ptr<const Scene>& scene,
                                     const std::vector<ListedPose>& poses,
                                     const std::filesystem::path& file,
                                     const SweepVideoOptions& options, const Progress& progress) {
  constexpr double kLongest = 3600;  // s
  const auto path = sample_path(poses, options.frames_per_second,
                                static_cast<std::size_t>(kLongest * options.frames_per_second) + 1);
  ARTUS_TRY(path);
  Renderer renderer(scene, options.transducer, options.settings);
  std::optional<LabelRenderer> truth;
  if (options.labels) truth.emplace(options.transducer, options.settings);
  std::optional<VideoFile> video;
  SweepVideo result;
  for (const ListedPose& pose : *path) {
    std::optional<NeedleView> needle;
    if (pose.X_JN) needle = NeedleView{*pose.X_JN, options.needle};
    const cv::Mat picture =
        picture_of(renderer, truth ? &*truth : nullptr, scene->joint(), pose.X_JP, needle);
    if (!video) {
      auto opened =
          VideoFile::open(file, picture.size(), options.labels, options.frames_per_second);
      ARTUS_TRY(opened);
      video = std::move(*opened);
    }
    video->write(picture);
    ++result.frames;
    if (progress)
      progress("video", static_cast<double>(result.frames) / static_cast<double>(path->size()));
  }
  const auto name = video->finish();
  ARTUS_TRY(name);
  result.file = *name;
  return result;
}

}  // namespace artus
