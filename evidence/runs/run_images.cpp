// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/run_images.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <opencv2/imgproc.hpp>

#include <nlohmann/json.hpp>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/dataset/video_file.h"
#include "artus/detail/simulation/fluid_core.h"
#include "artus/echo/image_io.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

constexpr int kCaptionHeight = 28;  // pixels
constexpr int kHeldImages = 45;     // in which what was injected until a moment opens the body

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

}  // namespace

/// Draws the pictures of one run into one folder.
class RunPainter {
 public:
  /// `rate`: images a second.
  RunPainter(std::shared_ptr<const Scene> scene, std::filesystem::path folder,
             const RunImagesOptions& options, double rate)
      : scene_(std::move(scene)),
        folder_(std::move(folder)),
        shape_(options.needle),
        rate_(rate),
        video_rate_(options.frames_per_second),
        renderer_(scene_, options.transducer, options.settings) {}

  /// The next image's rigid body with what was injected until the run's row `row`: what is drawn
  /// from now on.
  void lay(const ThreeInjections& run, std::size_t row) {
    std::shared_ptr<const Scene> filled;
    if (!run.syringe.empty()) {
      if (!fluid_) fluid_.emplace(scene_->shared_joint(), run.liquid, rate_);
      const SyringeRow& syringe = run.syringe[row];
      filled = fluid_->step({syringe.sites.data(), syringe.n_sites}, nullptr);
    }
    show(scene_, filled, run);
  }
  /// The same of a body that gives way, as it lies in the image.
  void lay(const std::shared_ptr<const Scene>& tissue, const FluidState& fluid,
           const ThreeInjections& run) {
    show(tissue, in_tissue_.at(fluid, tissue->tissue()), run);
  }
  void forget_liquid() { fluid_.reset(); }
  void set_coverage(std::span<const float> coverage) { renderer_.set_contact(coverage); }

  Result<MomentImage> draw_moment(const ThreeInjections& run, std::size_t index, const Pose& X_JP,
                                  const Pose& X_JN) {
    const NamedMoment& moment = run.moments[index];
    const std::string stem = file_stem(index, moment);
    const NeedleView needle{X_JN, shape_};
    const Transducer& transducer = renderer_.transducer();
    MomentImage image{moment.label,
                      moment.time,
                      moment.pass,
                      folder_ / (stem + ".png"),
                      folder_ / (stem + "-labels.png"),
                      locate_needle(needle, X_JP, transducer, renderer_.settings())};
    const Frame& frame = renderer_.render(X_JP, needle);
    ARTUS_TRY(write_image(annotated_image(frame, transducer), image.bmode));
    const auto labels = render_shown_labels(renderer_, X_JP, needle);
    ARTUS_TRY(write_image(colour_labels(labels, scene_->joint()), image.labels));
    return image;
  }

  /// The run's row as the video's next frame.
  Result<void> draw_frame(const ThreeInjections& run, std::size_t tick, const Pose& X_JP) {
    const NeedleRow& row = run.rows[tick];
    const Frame& frame = renderer_.render(X_JP, NeedleView{row.X_JN, shape_});
    const cv::Mat picture = with_caption(annotated_image(frame, renderer_.transducer()), row,
                                         run.probe[tick], run.region_names[row.region]);
    if (!video_) {
      auto opened =
          VideoFile::open(folder_ / "three-injections.mp4", picture.size(), false, video_rate_);
      ARTUS_TRY(opened);
      video_ = std::move(*opened);
    }
    video_->write(picture);
    ++frames_;
    return {};
  }

  /// The video's file and frames into `images`.
  Result<void> finish(RunImages& images) {
    if (!video_) return {};
    const auto file = video_->finish();
    ARTUS_TRY(file);
    images.video = *file;
    images.video_frames = frames_;
    return {};
  }
  [[nodiscard]] int frames() const noexcept { return frames_; }

 private:
  void show(const std::shared_ptr<const Scene>& body, const std::shared_ptr<const Scene>& filled,
            const ThreeInjections& run) {
    if (filled || filled_)
      renderer_.set_filled_scene(filled ? filled : body);
    else if (body->tissue() != nullptr)
      renderer_.set_scene(body);
    filled_ = filled != nullptr;
    body_ = filled_ ? filled : body;
    shape_.length = run.needle_length;
  }

  std::shared_ptr<const Scene> scene_;
  std::filesystem::path folder_;
  NeedleShape shape_;
  double rate_;
  double video_rate_;
  std::optional<FluidCore> fluid_;  // of a rigid body; empty: nothing was drawn of it yet
  FluidScene in_tissue_;
  bool filled_ = false;
  std::shared_ptr<const Scene> body_;
  Renderer renderer_;
  std::optional<VideoFile> video_;
  int frames_ = 0;
};

namespace {

std::size_t row_at(const ThreeInjections& run, double time) {
  const auto row = std::lower_bound(run.rows.begin(), run.rows.end() - 1, time,
                                    [](const NeedleRow& r, double t) { return r.time < t; });
  return static_cast<std::size_t>(row - run.rows.begin());
}

/// The whole run of a rigid body in real time.
Result<void> draw_video(const std::shared_ptr<const Scene>& scene, const ThreeInjections& run,
                        double rate, RunPainter& painter, const Progress& progress) {
  ProbeContactModel contact(scene, run.options.probe.contact);
  painter.forget_liquid();
  const int n_frames = static_cast<int>(std::floor(run.rows.back().time * rate)) + 1;
  std::size_t next = 0;
  for (int i = 0; i < n_frames; ++i) {
    const double time = i / rate;
    while (next + 1 < run.rows.size() && run.rows[next].time < time) ++next;
    const ProbeHandRow& probe = run.probe[next];
    painter.lay(run, next);
    static_cast<void>(contact.step(probe.X_JP));
    painter.set_coverage(contact.coverage());
    ARTUS_TRY(painter.draw_frame(run, next, probe.image_pose()));
    if (progress) progress("video", static_cast<double>(i + 1) / n_frames);
  }
  return {};
}

}  // namespace

Result<RunImages> write_run_images(const std::shared_ptr<const Scene>& scene,
                                   const ThreeInjections& run, const std::filesystem::path& folder,
                                   const RunImagesOptions& options, const Progress& progress) {
  RunImages images;
  if (run.probe.empty() || run.moments.empty()) return images;
  remove_old_images(folder);
  RunPainter painter(scene, folder, options, options.frames_per_second);
  for (std::size_t i = 0; i < run.moments.size(); ++i) {
    const NamedMoment& moment = run.moments[i];
    const std::size_t row = row_at(run, moment.time);
    painter.set_coverage(moment.coverage);
    for (int k = 0; k < kHeldImages; ++k) painter.lay(run, row);
    auto image = painter.draw_moment(run, i, moment.X_JP, moment.X_JN);
    ARTUS_TRY(image);
    images.moments.push_back(std::move(*image));
    if (progress)
      progress("images", static_cast<double>(i + 1) / static_cast<double>(run.moments.size()));
  }
  if (options.video)
    ARTUS_TRY(draw_video(scene, run, options.frames_per_second, painter, progress));
  ARTUS_TRY(painter.finish(images));
  return images;
}

LiveRunImages::LiveRunImages(std::shared_ptr<const Scene> scene, std::filesystem::path folder,
                             const RunImagesOptions& options, double image_rate)
    : options_(options) {
  remove_old_images(folder);
  painter_ = std::make_unique<RunPainter>(std::move(scene), std::move(folder), options, image_rate);
}

LiveRunImages::~LiveRunImages() = default;

void LiveRunImages::see(const ThreeInjections& run, const std::shared_ptr<const Scene>& body,
                        const FluidState& fluid) {
  if (failed_) return;
  const auto drawn = draw(run, body, fluid);
  if (!drawn) failed_ = drawn.error();
}

Result<void> LiveRunImages::draw(const ThreeInjections& run,
                                 const std::shared_ptr<const Scene>& body,
                                 const FluidState& fluid) {
  const std::size_t row = run.rows.size() - 1;
  const Pose& X_JP = run.probe[row].X_JP;
  painter_->lay(body, fluid, run);
  while (images_.moments.size() < run.moments.size()) {
    auto image = painter_->draw_moment(run, images_.moments.size(), X_JP, run.rows[row].X_JN);
    ARTUS_TRY(image);
    images_.moments.push_back(std::move(*image));
  }
  if (options_.video && run.rows[row].time * options_.frames_per_second >= painter_->frames())
    ARTUS_TRY(painter_->draw_frame(run, row, X_JP));
  return {};
}

Result<RunImages> LiveRunImages::finish() {
  if (failed_) return tl::unexpected<Error>(*failed_);
  ARTUS_TRY(painter_->finish(images_));
  return std::move(images_);
}

nlohmann::json summarize(const RunImages& images) {
  auto moments = nlohmann::json::array();
  for (const auto& m : images.moments)
    moments.push_back({{"label", m.label},
                       {"time_s", m.time},
                       {"injection", m.pass},
                       {"bmode", m.bmode.filename().string()},
                       {"labels", m.labels.filename().string()},
                       {"tip_true_px", {m.needle.tip.x, m.needle.tip.y}},
                       {"tip_offset_mm", m.needle.tip_offset / kMillimetre},
                       {"plane_angle_deg", m.needle.plane_angle / kDegree},
                       {"needle_in_plane", m.needle.in_plane}});
  nlohmann::json json{{"images", moments}};
  if (!images.video.empty())
    json["video"] = {{"file", images.video.filename().string()}, {"frames", images.video_frames}};
  return json;
}

}  // namespace artus
