// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/medical/run_images.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include <nlohmann/json.hpp>

#include "artus/core/printed.h"
#include "artus/core/units.h"
#include "artus/dataset/video_file.h"
#include "artus/echo/image_io.h"
#include "artus/echo/pressing_face.h"
#include "artus/echo/renderer.h"
#include "artus/session/fluid_core.h"
#include "artus/session/tissue_core.h"

namespace artus {
namespace {

constexpr int kCaptionHeight = 28;  // pixels
constexpr int kHeldImages = 45;     // of tissue that comes to rest under the probe of a moment

std::string file_stem(std::size_t index, const NamedMoment& moment) {
  const std::string prefix = printed("%02zu-injection-%d-", index + 1, moment.pass);
  std::string stem = prefix;
  for (const char c : moment.label)
    stem += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  return stem;
}

cv::Mat with_caption(const cv::Mat& image, const NeedleRow& row, const ProbeHandRow& probe,
                     const std::string& layer) {
  cv::Mat framed;
  cv::copyMakeBorder(image, framed, 0, kCaptionHeight, 0, 0, cv::BORDER_CONSTANT, cv::Scalar(0));
  const std::string text = printed("%5.2f s  %5.1f mm  %4.1f N  probe %4.1f N  %s", row.time,
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

/// Draws one run into one folder.
class RunPainter {
 public:
  RunPainter(std::shared_ptr<const Scene> scene, const ThreeInjections& run,
             std::filesystem::path folder, const RunImagesOptions& options,
             std::optional<TissueCore> tissue)
      : scene_(std::move(scene)),
        tissue_(std::move(tissue)),
        run_(&run),
        folder_(std::move(folder)),
        shape_(options.needle),
        rate_(options.frames_per_second),
        renderer_(scene_, options.transducer, options.settings) {
    shape_.length = run.needle_length;
  }

  Result<MomentImage> draw_moment(std::size_t index) {
    const NamedMoment& moment = run_->moments[index];
    const std::string stem = file_stem(index, moment);
    const NeedleView needle{moment.X_JN, shape_};
    const Transducer& transducer = renderer_.transducer();
    MomentImage image{moment.label,
                      moment.time,
                      moment.pass,
                      folder_ / (stem + ".png"),
                      folder_ / (stem + "-labels.png"),
                      locate_needle(needle, moment.X_JP, transducer, renderer_.settings())};
    Pose X_JP = moment.X_JP;
    const std::size_t row = row_at(moment.time);
    if (tissue_) {
      X_JP = run_->probe[row].X_JP;
      image.needle = locate_needle(needle, X_JP, transducer, renderer_.settings());
    } else {
      renderer_.set_contact(moment.coverage);
    }
    for (int k = 0; k < kHeldImages; ++k) draw_body(X_JP, row);
    const Frame& frame = renderer_.render(X_JP, needle);
    ARTUS_TRY(write_image(annotated_image(frame, transducer), image.bmode));
    const auto labels = render_labels(*body_, X_JP, transducer, renderer_.settings(), needle);
    ARTUS_TRY(write_image(colour_labels(labels, scene_->joint()), image.labels));
    return image;
  }

  /// The whole run in real time. The video's file and frames go into `images`.
  Result<void> draw_video(double rate, RunImages& images, const Progress& progress) {
    std::optional<VideoFile> video;
    ProbeContactModel contact(scene_, run_->options.probe.contact);
    fluid_.reset();
    const int n_frames = static_cast<int>(std::floor(run_->rows.back().time * rate)) + 1;
    std::size_t next = 0;
    for (int i = 0; i < n_frames; ++i) {
      const double time = i / rate;
      while (next + 1 < run_->rows.size() && run_->rows[next].time < time) ++next;
      const cv::Mat picture = draw_tick(next, contact);
      if (!video) {
        auto opened =
            VideoFile::open(folder_ / "three-injections.mp4", picture.size(), false, rate);
        ARTUS_TRY(opened);
        video = std::move(*opened);
      }
      video->write(picture);
      ++images.video_frames;
      if (progress) progress("video", static_cast<double>(i + 1) / n_frames);
    }
    const auto file = video->finish();
    ARTUS_TRY(file);
    images.video = *file;
    return {};
  }

 private:
  [[nodiscard]] std::size_t row_at(double time) const {
    const auto row = std::lower_bound(run_->rows.begin(), run_->rows.end() - 1, time,
                                      [](const NeedleRow& r, double t) { return r.time < t; });
    return static_cast<std::size_t>(row - run_->rows.begin());
  }

  /// The body one image later under the probe, with what was injected until then: what the picture
  /// is drawn of.
  void draw_body(const Pose& X_JP, std::size_t row) {
    if (tissue_) tissue_->step(X_JP);
    body_ = tissue_ ? tissue_->scene() : scene_;
    std::shared_ptr<const Scene> filled;
    if (!run_->syringe.empty()) {
      if (!fluid_) fluid_.emplace(scene_->shared_joint(), run_->liquid, rate_);
      const SyringeRow& syringe = run_->syringe[row];
      filled = fluid_->step({syringe.sites.data(), syringe.n_sites}, body_->tissue());
    }
    if (filled || filled_)
      renderer_.set_filled_scene(filled ? filled : body_);
    else if (tissue_)
      renderer_.set_scene(body_);
    filled_ = filled != nullptr;
    if (filled_) body_ = filled;
  }

  cv::Mat draw_tick(std::size_t tick, ProbeContactModel& contact) {
    const NeedleRow& row = run_->rows[tick];
    const ProbeHandRow& probe = run_->probe[tick];
    draw_body(probe.X_JP, tick);
    if (!tissue_) {
      static_cast<void>(contact.step(probe.X_JP));
      renderer_.set_contact(contact.coverage());
    }
    const Pose X_JP = tissue_ ? probe.X_JP : probe.image_pose();
    const Frame& frame = renderer_.render(X_JP, NeedleView{row.X_JN, shape_});
    return with_caption(annotated_image(frame, renderer_.transducer()), row, probe,
                        run_->region_names[row.region]);
  }

  std::shared_ptr<const Scene> scene_;
  std::optional<TissueCore> tissue_;  // empty: rigid
  const ThreeInjections* run_;
  std::filesystem::path folder_;
  NeedleShape shape_;
  double rate_;                     // images a second
  std::optional<FluidCore> fluid_;  // empty: nothing was drawn of it yet
  bool filled_ = false;
  std::shared_ptr<const Scene> body_;
  Renderer renderer_;
};

}  // namespace

Result<RunImages> write_run_images(const std::shared_ptr<const Scene>& scene,
                                   const ThreeInjections& run, const std::filesystem::path& folder,
                                   const RunImagesOptions& options, const Progress& progress) {
  RunImages images;
  if (run.probe.empty() || run.moments.empty()) return images;
  remove_old_images(folder);
  std::optional<TissueCore> tissue;
  if (options.deform) {
    const auto face = pressing_face(options.transducer);
    ARTUS_TRY(face);
    auto made = TissueCore::make(scene->shared_joint(), run.moments.front().X_JP_seat,
                                 options.frames_per_second, *face);
    ARTUS_TRY(made);
    tissue.emplace(std::move(*made));
  }
  RunPainter painter(scene, run, folder, options, std::move(tissue));
  for (std::size_t i = 0; i < run.moments.size(); ++i) {
    auto image = painter.draw_moment(i);
    ARTUS_TRY(image);
    images.moments.push_back(std::move(*image));
    if (progress)
      progress("images", static_cast<double>(i + 1) / static_cast<double>(run.moments.size()));
  }
  if (options.video) ARTUS_TRY(painter.draw_video(options.frames_per_second, images, progress));
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
