// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/image_core.h"

#include <cmath>
#include <optional>
#include <utility>

namespace artus {
namespace {

/// s that new tables may take; see bench_echo for how long they do.
constexpr double kTableTime = 0.3;

}  // namespace

ImageCore::ImageCore(std::shared_ptr<const Scene> scene, const SessionParams& params)
    : probe_(params.transducer),
      image_(params.image),
      needle_shape_(params.needle_shape),
      controls_(controls_of(params)),
      renderer_(std::move(scene), params.transducer, params.image),
      images_to_change_(static_cast<std::uint64_t>(std::ceil(kTableTime * params.image_rate))) {
  needle_shape_.length = needle_length_of(params);
}

void ImageCore::follow(const ImageControls& controls) {
  controls_ = controls;
  Transducer probe = probe_;
  ImageSettings image = image_;
  image.depth = controls.depth;
  image.gain_db = controls.gain_db;
  image.tgc_db_cm_mhz = controls.tgc_db_cm_mhz;
  image.dynamic_range_db = controls.dynamic_range_db;
  probe.frequency = controls.frequency;
  probe.elevation_focus = controls.elevation_focus;
  if (!validate(probe) || !validate(image)) return;
  probe_ = probe;
  image_ = image;
  renderer_.set_live(image_);
}

void ImageCore::take_tables() {
  renderer_.set_pipeline(next_.get());
  renderer_.set_live(image_);
}

void ImageCore::start_tables() {
  due_ = images_ + images_to_change_;
  next_ = std::async(std::launch::async, [probe = probe_, image = image_] {
    return std::make_unique<EchoPipeline>(probe, image);
  });
}

const Frame& ImageCore::render(const FrameInput& input) {
  ++images_;
  if (!(input.controls == controls_)) follow(input.controls);
  if (next_.valid() && images_ == due_) take_tables();
  const TableSettings& tables = image_;
  const bool shown = tables == renderer_.settings() && probe_ == transducer();
  if (!shown && !next_.valid()) start_tables();
  std::optional<NeedleView> needle;
  if (input.has_needle != 0) needle = NeedleView{to_pose(input.X_JN), needle_shape_};
  return renderer_.render(to_pose(input.X_JP), needle);
}

}  // namespace artus
