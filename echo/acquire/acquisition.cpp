// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/acquisition.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/echo/acquire/penumbra.h"
#include "artus/detail/echo/acquire/point_echo.h"
#include "artus/detail/echo/medium/simd.h"

namespace artus {
namespace {

constexpr int kRow = 16;                // lines that one worker follows one after the other
constexpr double kTrackWidth = 0.3e-3;  // m, of a withdrawn needle's track. assumed

ARTUS_SIMD
void multiply(const float* factor, float* re, float* im, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    re[i] *= factor[i];
    im[i] *= factor[i];
  }
}

ARTUS_SIMD
void accumulate(const float* in, float* out, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) out[i] += in[i];
}

}  // namespace

/// What all lines of one run share.
struct Acquisition::Pass {
  const EchoView& view;
  BeamTracer tracer;
  std::span<const RegionAcoustics> regions;
  std::optional<NeedleEcho> needle;
  Frame& frame;
};

Acquisition::Acquisition(const Transducer& transducer, const ImageSettings& settings,
                         const BeamShape& shape)
    : n_lines_(transducer.n_lines),
      n_samples_(static_cast<std::size_t>(settings.n_samples)),
      shape_(&shape),
      settings_(settings),
      scatter_(settings.seed, shape.scatterer_size()),
      texture_(settings.seed, settings.texture),
      synthesis_(shape, scatter_, texture_, transducer, settings),
      coupling_(transducer),
      spread_(transducer, settings.depth, settings.n_samples),
      light_(transducer, settings.depth, settings.n_samples),
      drifting_(transducer, shape),
      flow_(transducer, settings, shape),
      n_more_(settings.look == Look::compound ? ScatterField::kMoreSets : 0) {
  const auto lines = static_cast<std::size_t>(n_lines_);
  lines_.resize(lines);
  tips_.resize(lines);
  re_.resize(lines * n_samples_);
  im_.resize(lines * n_samples_);
  for (std::size_t k = 0; k < n_more_; ++k) {
    more_re_[k].resize(lines * n_samples_);
    more_im_[k].resize(lines * n_samples_);
  }
  if (settings.doppler) {
    moving_re_.resize(lines * n_samples_);
    moving_im_.resize(lines * n_samples_);
  }
}

EchoSpan Acquisition::line_of(std::vector<float>& re, std::vector<float>& im, int l) const {
  const std::size_t first = static_cast<std::size_t>(l) * n_samples_;
  return {std::span(re).subspan(first, n_samples_), std::span(im).subspan(first, n_samples_)};
}

/// change(echoes) for line l of each further set of scatterers.
template <class Change>
void Acquisition::for_more(int l, const Change& change) {
  for (std::size_t k = 0; k < n_more_; ++k) change(line_of(more_re_[k], more_im_[k], l));
}

void Acquisition::place_tracks(const EchoBody& body, const EchoView& view) {
  tracks_.clear();
  for (const NeedleTrack& track : body.tracks) {
    NeedleView thread;
    const Vec3 displacement = track.p_JTip - track.p_JEntry;
    thread.shape.outer_diameter = kTrackWidth;
    thread.shape.length = displacement.norm();
    if (thread.shape.length < kTrackWidth) continue;
    thread.X_JN = make_pose(track.p_JTip, displacement, displacement.unitOrthogonal());
    tracks_.push_back(
        {NeedleEcho(thread, view.X_JP, view.probe, *shape_, settings_.look), track.amplitude});
  }
}

void Acquisition::run(const EchoBody& body, const EchoView& view, BlockWorkers& workers,
                      Frame& frame) {
  X_PJ_ = view.X_JP.inverse();
  const auto workers_needed = static_cast<std::size_t>(workers.workers());
  if (scratch_.size() < workers_needed) scratch_.resize(workers_needed);
  place_tracks(body, view);
  drifting_.place(body.drifting, view.X_JP, view.probe);
  const SmoothGradient* const tissue = body.tissue ? &*body.tissue : nullptr;
  Pass pass{view, BeamTracer(*body.scene, tissue, body.regions, view.probe, settings_),
            body.regions, std::nullopt, frame};
  pass.tracer.lay_on_skin(view.probe, view.X_JP);
  if (view.needle) {
    pass.needle.emplace(*view.needle, view.X_JP, view.probe, *shape_, settings_.look);
  } else {
    std::fill(frame.needle_light.begin(), frame.needle_light.end(), 1.0F);
    std::fill(tips_.begin(), tips_.end(), NeedleEcho::Tip{});
  }
  workers.for_blocks(
      n_lines_,
      [&](int worker, int first, int last) {
        LineScratch& scratch = scratch_[static_cast<std::size_t>(worker)];
        scratch.beams.begin_row(settings_.n_planes);
        for (int l = first; l < last; ++l)
          lines_[static_cast<std::size_t>(l)] = place_line(pass.view.probe, l, pass.view.X_JP);
        const auto row = std::span(lines_).subspan(static_cast<std::size_t>(first),
                                                   static_cast<std::size_t>(last - first));
        for (std::size_t l = 0; l < row.size(); ++l) listen(pass, row, l, scratch);
      },
      kRow);
  workers.for_blocks(n_lines_, [&](int, int first, int last) {
    for (int l = first; l < last; ++l) {
      const EchoSpan echoes = line_of(re_, im_, l);
      const bool on_screen = settings_.look != Look::raw;
      const auto dim = [&](EchoSpan line) {
        if (on_screen)
          light_.apply(l, line);
        else
          spread_.apply(l, line);
        add_penumbra(view.probe, shape_->sample_depth(), frame.shadow_from, l, line, on_screen);
      };
      dim(echoes);
      for_more(l, dim);
    }
  });
}

void Acquisition::listen(const Pass& pass, std::span<const PlacedLine> row, std::size_t of_row,
                         LineScratch& scratch) {
  const PlacedLine& placed = row[of_row];
  const int l = placed.index;
  const auto at = static_cast<std::size_t>(l);
  const EchoSpan echoes = line_of(re_, im_, l);
  ScatterField::MoreSets more;
  std::size_t k = 0;
  for_more(l, [&](EchoSpan line) { more[k++] = line; });
  synthesis_.synthesise(pass.tracer, row, of_row, scratch, echoes, n_more_ > 0 ? &more : nullptr);
  spread_.note(l, scratch.beams.path());
  const BeamTrace& central = scratch.beams.central();
  light_.note(l, central);
  flow_.note(l, central, pass.regions, coupling_.at_line(l));
  const SoundedLine sounded{placed, central, scratch.beams.path()};
  for (const Track& track : tracks_) track.echo.add_track(track.amplitude, sounded, echoes);
  drifting_.add(sounded, echoes);
  if (pass.needle) add_needle(pass, sounded);
  coupling_.apply(l, shape_->sample_depth(), echoes);
  for_more(l, [&](EchoSpan line) { coupling_.apply(l, shape_->sample_depth(), line); });
  const bool touches = central.contact;
  coupling_.add_ringing(l, touches, shape_->sample_depth(), echoes.re);
  pass.frame.contact[at] = static_cast<float>(touches ? coupling_.at_line(l) : 0);
  pass.frame.shadow_from[at] =
      static_cast<float>(std::clamp(central.shadow_from, 0.0, static_cast<double>(n_samples_)));
}

void Acquisition::add_needle(const Pass& pass, const SoundedLine& sounded) {
  const int l = sounded.placed.index;
  const NeedleEcho& needle = *pass.needle;
  const EchoSpan echoes = line_of(re_, im_, l);
  const auto light = std::span(pass.frame.needle_light)
                         .subspan(static_cast<std::size_t>(l) * n_samples_, n_samples_);
  std::fill(light.begin(), light.end(), 1.0F);
  if (sounded.trace.contact) needle.shade(sounded.placed, light);
  multiply(light.data(), echoes.re.data(), echoes.im.data(), light.size());
  for_more(l, [&](EchoSpan line) {
    multiply(light.data(), line.re.data(), line.im.data(), light.size());
  });
  NeedleEcho::Tip& tip = tips_[static_cast<std::size_t>(l)];
  tip = needle.find_tip(sounded);
  if (moving_re_.empty()) {
    needle.add(sounded, tip, echoes);
    return;
  }
  const EchoSpan own = line_of(moving_re_, moving_im_, l);
  std::fill(own.re.begin(), own.re.end(), 0.0F);
  std::fill(own.im.begin(), own.im.end(), 0.0F);
  needle.add(sounded, tip, own);
  accumulate(own.re.data(), echoes.re.data(), echoes.size());
  accumulate(own.im.data(), echoes.im.data(), echoes.size());
}

void Acquisition::add_reflectors(const EchoBody& body, int l, std::span<float> re) const noexcept {
  const PlacedLine& placed = lines_[static_cast<std::size_t>(l)];
  for (const PointReflector& reflector : body.reflectors) {
    const Vec3 p = X_PJ_ * reflector.p_J - placed.line.origin;
    const double depth = p.dot(placed.line.direction);
    if (depth <= 0) continue;
    const double lateral = shape_->lateral_amplitude(p.dot(placed.across), depth);
    const double elevation = shape_->profile().elevation_amplitude(p.y(), depth);
    const double sample = depth / shape_->sample_depth();
    if (lateral * elevation < 1e-6) continue;
    add_point_echo(sample, reflector.amplitude * lateral * elevation * coupling_.gain(l, depth),
                   re);
  }
}

void Acquisition::colour_drifting(Frame& frame) const noexcept {
  drifting_.colour(lines_, settings_.doppler_limit, frame);
}

std::optional<Vec3> Acquisition::find_shown_tip() const noexcept {
  double shares = 0;
  Vec3 place = Vec3::Zero();
  for (std::size_t l = 0; l < tips_.size(); ++l) {
    const NeedleEcho::Tip& tip = tips_[l];
    if (tip.share <= 0 || tip.sample >= static_cast<double>(n_samples_)) continue;
    const Scanline& line = lines_[l].line;
    shares += tip.share;
    place += tip.share * (line.origin + tip.sample * shape_->sample_depth() * line.direction);
  }
  if (shares <= 0) return std::nullopt;
  return place / shares;
}

}  // namespace artus
