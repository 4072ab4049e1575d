// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/echo_pipeline.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "artus/detail/echo/probe/range_check.h"

namespace artus {
namespace {

/// Adds the time since it was made to a stage's.
class StageClock {
 public:
  explicit StageClock(double& seconds) noexcept : seconds_(&seconds) {}
  ~StageClock() {
    *seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;
  StageClock(StageClock&&) = delete;
  StageClock& operator=(StageClock&&) = delete;

 private:
  double* seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void fill(std::vector<float>& values, float value) noexcept {
  std::fill(values.begin(), values.end(), value);
}

}  // namespace

EchoPipeline::EchoPipeline(const Transducer& transducer, const ImageSettings& settings)
    : transducer_(require_valid(transducer)),
      settings_(require_valid(settings)),
      workers_(settings.n_threads),
      shape_(transducer, settings),
      acquisition_(transducer, settings, shape_),
      shaping_(transducer, settings, shape_),
      compound_(transducer, settings),
      display_(transducer, settings) {
  const auto lines = static_cast<std::size_t>(transducer.n_lines);
  const std::size_t size = lines * static_cast<std::size_t>(settings.n_samples);
  frame_.n_lines = transducer.n_lines;
  frame_.n_samples = settings.n_samples;
  frame_.sample_depth = shape_.sample_depth();
  for (auto* stage : {&frame_.in_phase, &frame_.quadrature, &frame_.envelope, &frame_.decibel})
    stage->resize(size);
  frame_.needle_light.resize(size, 1.0F);
  if (settings.doppler) frame_.velocity.resize(size);
  if (settings.doppler) frame_.motion_db.resize(size);
  frame_.width = display_.converter().width();
  frame_.height = display_.converter().height();
  frame_.pixel = settings.pixel;
  frame_.image.resize(static_cast<std::size_t>(frame_.width) *
                      static_cast<std::size_t>(frame_.height));
  frame_.contact.resize(lines);
  frame_.shadow_from.resize(lines);
}

void EchoPipeline::set_live(const LiveSettings& live) {
  ImageSettings wanted = settings_;
  static_cast<LiveSettings&>(wanted) = live;
  settings_ = require_valid(wanted);
  shaping_.set_time_gain(live);
  display_.set(live);
}

void EchoPipeline::hear(const EchoBody& body, const EchoView& view) {
  {
    const StageClock clock(times_.lines);
    acquisition_.run(body, view, workers_, frame_);
  }
  const StageClock clock(times_.beam);
  shaping_.run(acquisition_, body, workers_, frame_);
}

void EchoPipeline::render(const EchoBody& body, const Pose& X_JP,
                          const std::optional<NeedleView>& needle) {
  times_ = {};
  frame_.status = FrameStatus::kOk;
  acquisition_.begin_frame(body);
  if (compound_.views().empty()) {
    hear(body, {transducer_, X_JP, needle});
  } else {
    compound_.clear();
    for (const CompoundView& view : compound_.views()) {
      hear(body, {view.transducer(), X_JP, needle});
      const StageClock clock(times_.beam);
      compound_.add(view, frame_.envelope, workers_);
    }
    compound_.write(frame_.envelope);
  }
  frame_.tip_shown.reset();
  if (const auto tip = acquisition_.find_shown_tip()) {
    const PixelPoint place = display_.converter().pixel_of(*tip);
    if (display_.converter().inside(place)) frame_.tip_shown = place;
  }
  if (settings_.doppler) {
    const StageClock clock(times_.beam);
    std::optional<Vec3> v_P;
    if (needle) v_P = X_JP.linear().transpose() * needle->v_JN;
    shaping_.find_motion(acquisition_, v_P, workers_, frame_);
    acquisition_.colour_drifting(frame_);
    acquisition_.colour_flow(shaping_.time_gain(), workers_, frame_);
  }
  const StageClock clock(times_.display);
  display_.show(workers_, X_JP, frame_);
}

void EchoPipeline::render_nothing(std::uint32_t status) noexcept {
  times_ = {};
  frame_.status = status;
  for (auto* stage : {&frame_.in_phase, &frame_.quadrature, &frame_.envelope, &frame_.contact,
                      &frame_.shadow_from})
    fill(*stage, 0.0F);
  fill(frame_.needle_light, 1.0F);
  fill(frame_.velocity, std::numeric_limits<float>::quiet_NaN());
  frame_.tip_shown.reset();
  display_.show_nothing(frame_);
}

}  // namespace artus
