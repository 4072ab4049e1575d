// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/medical/run_images.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <optional>

#include <opencv2/imgproc.hpp>

#include <nlohmann/json.hpp>

#include "artus/core/units.h"
#include "artus/dataset/video_file.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

constexpr int kCaptionHeight = 28;  // pixels

std::string file_stem(std::size_t index, const NamedMoment& moment) {
  char prefix[48];
  std::snprintf(prefix, sizeof prefix, "%02zu-injection-%d-", index + 1, moment.pass);
  std::string stem = prefix;
  for (const char c : moment.label)
    stem += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  return stem;
}

cv::Mat with_caption(const cv::Mat& image, const NeedleRow& row, const ProbeHandRow& probe,
                     const std::string& layer) {
  cv::Mat framed;
  cv::copyMakeBorder(image, framed, 0, kCaptionHeight, 0, 0, cv::BORDER_CONSTANT, cv::Scalar(0));
  char text[128];
  std::snprintf(text, sizeof text, "%5.2f s  %5.1f mm  %4.1f N  probe %4.1f N  %s", row.time,
                std::max(0.0, row.depth) / kMillimetre, row.command.force.norm(),
                probe.normal_force, layer.c_str());
  cv::putText(framed, text, {6, framed.rows - 9}, cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar(220),
              1, cv::LINE_AA);
  return framed;
}

/// Images of an earlier run in the same folder would stand among the new ones.
void remove_old_images(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".png" && name.find("-injection-") == 2) old.push_back(entry);
  }
  for (const auto& file : old) std::filesystem::remove(file, ignored);
}

Result<MomentImage> draw_moment(Renderer& renderer, const Scene& scene, const NamedMoment& moment,
                                const NeedleShape& shape, const std::filesystem::path& folder,
                                const std::string& stem) {
  const NeedleView needle{moment.X_JN, shape};
  MomentImage image{moment.label,
                    moment.time,
                    moment.pass,
                    folder / (stem + ".png"),
                    folder / (stem + "-labels.png"),
                    locate_needle(needle, moment.X_JP, renderer.transducer(), renderer.settings())};
  renderer.set_contact(moment.coverage);
  const Frame& frame = renderer.render(moment.X_JP, needle);
  if (const auto ok = write_image(annotated_image(frame, renderer.transducer()), image.bmode); !ok)
    return tl::unexpected(ok.error());
  const auto labels =
      render_labels(scene, moment.X_JP, renderer.transducer(), renderer.settings(), needle);
  if (const auto ok = write_image(colour_labels(labels, scene.joint()), image.labels); !ok)
    return tl::unexpected(ok.error());
  return image;
}

Result<void> draw_video(Renderer& renderer, const std::shared_ptr<const Scene>& scene,
                        const ThreeInjections& run, const NeedleShape& shape,
                        const std::filesystem::path& folder, double rate, RunImages& images,
                        const Progress& progress) {
  std::optional<VideoFile> video;
  ProbeContactModel contact(scene, run.options.probe.contact);
  const double end = run.rows.back().time;
  const int n_frames = static_cast<int>(std::floor(end * rate)) + 1;
  std::size_t next = 0;
  for (int i = 0; i < n_frames; ++i) {
    const double time = i / rate;
    while (next + 1 < run.rows.size() && run.rows[next].time < time) ++next;
    const NeedleRow& row = run.rows[next];
    const ProbeHandRow& probe = run.probe[next];
    static_cast<void>(contact.step(probe.X_JP));
    renderer.set_contact(contact.coverage());
    const Frame& frame = renderer.render(probe.image_pose(), NeedleView{row.X_JN, shape});
    const cv::Mat picture = with_caption(annotated_image(frame, renderer.transducer()), row, probe,
                                         run.region_names[row.region]);
    if (!video) {
      auto opened = VideoFile::open(folder / "three-injections.mp4", picture.size(), false, rate);
      if (!opened) return tl::unexpected(opened.error());
      video = std::move(*opened);
    }
    video->write(picture);
    ++images.video_frames;
    if (progress) progress("video", static_cast<double>(i + 1) / n_frames);
  }
  const auto file = video->finish();
  if (!file) return tl::unexpected(file.error());
  images.video = *file;
  return {};
}

}  // namespace

Result<RunImages> write_run_images(const std::shared_ptr<const Scene>& scene,
                                   const ThreeInjections& run, const std::filesystem::path& folder,
                                   const RunImagesOptions& options, const Progress& progress) {
  RunImages images;
  if (run.probe.empty() || run.moments.empty()) return images;
  remove_old_images(folder);
  NeedleShape shape = options.needle;
  shape.length = run.needle_length;
  Renderer renderer(scene, options.transducer, options.settings);
  for (std::size_t i = 0; i < run.moments.size(); ++i) {
    auto image =
        draw_moment(renderer, *scene, run.moments[i], shape, folder, file_stem(i, run.moments[i]));
    if (!image) return tl::unexpected(image.error());
    images.moments.push_back(std::move(*image));
    if (progress)
      progress("images", static_cast<double>(i + 1) / static_cast<double>(run.moments.size()));
  }
  if (options.video)
    if (const auto ok = draw_video(renderer, scene, run, shape, folder, options.frames_per_second,
                                   images, progress);
        !ok)
      return tl::unexpected(ok.error());
  return images;
}

nlohmann::json summarize(const RunImages& images) {
  auto moments = nlohmann::json::array();
  for (const auto& m : images.moments)
    moments.push_back({{"label", m.label},
                       {"time_s", m.time},
                       {"injection", m.pass},
                       {"bmode", m.bmode.filename().string()},
                       {"labels", m.labels.filename().string()},
                       {"tip_px", {m.needle.tip.x, m.needle.tip.y}},
                       {"tip_offset_mm", m.needle.tip_offset / kMillimetre},
                       {"plane_angle_deg", m.needle.plane_angle / kDegree},
                       {"needle_in_plane", m.needle.in_plane}});
  nlohmann::json json{{"images", moments}};
  if (!images.video.empty())
    json["video"] = {{"file", images.video.filename().string()}, {"frames", images.video_frames}};
  return json;
}

}  // namespace artus
