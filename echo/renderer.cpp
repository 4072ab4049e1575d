// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "artus/core/check.h"
#include "artus/core/noise.h"
#include "artus/echo/aperture_coupling.h"
#include "artus/echo/beam_shape.h"
#include "artus/echo/beam_spread.h"
#include "artus/echo/compound.h"
#include "artus/echo/display.h"
#include "artus/echo/doppler.h"
#include "artus/echo/line_synthesis.h"
#include "artus/echo/needle_echo.h"
#include "artus/echo/penumbra.h"
#include "artus/echo/point_echo.h"
#include "artus/echo/propagation.h"
#include "artus/echo/region_acoustics.h"
#include "artus/echo/scatter_field.h"
#include "artus/echo/simd.h"
#include "artus/echo/texture.h"

namespace artus {
namespace {

constexpr int kBlock = 8;               // lines or rows that one task takes
constexpr double kTrackWidth = 0.3e-3;  // m, of a withdrawn needle's track. assumed

ARTUS_SIMD
void detect(const float* re, const float* im, const float* gain, float* envelope,
            std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    envelope[i] = gain[i] * std::sqrt(re[i] * re[i] + im[i] * im[i]);
  }
}

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

template <class T>
const T& require_valid(const T& value) {
  const Result<void> result = validate(value);
  ARTUS_REQUIRE(result.has_value(), result.error().to_string());
  return value;
}

std::span<float> row(std::vector<float>& data, int i, int n) {
  return {data.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(n),
          static_cast<std::size_t>(n)};
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

struct Renderer::Impl {
  Impl(std::shared_ptr<const Scene> scene_in, const Transducer& t, const ImageSettings& s)
      : scene(std::move(scene_in)),
        transducer(require_valid(t)),
        settings(require_valid(s)),
        regions(make_region_acoustics(scene->joint(), transducer)),
        shape(transducer, settings),
        scatter(settings.seed, shape.scatterer_size()),
        texture(settings.seed, settings.texture),
        synthesis(shape, scatter, texture, transducer, settings),
        converter(transducer, settings),
        time_gain(make_time_gain(transducer, settings)),
        noise_gain(static_cast<std::size_t>(settings.n_samples),
                   static_cast<float>(std::pow(10.0, settings.noise_db / 20))),
        arena(settings.n_threads == 0 ? tbb::task_arena::automatic : settings.n_threads),
        coupling(transducer),
        spread(transducer, settings.depth, settings.n_samples) {
    arena.execute([&] { add_courses(scene->joint(), regions); });
    const int blocks = (transducer.n_lines + kBlock - 1) / kBlock;
    scratch.resize(static_cast<std::size_t>(blocks));
    const auto size =
        static_cast<std::size_t>(transducer.n_lines) * static_cast<std::size_t>(settings.n_samples);
    raw_re.resize(size);
    raw_im.resize(size);
    work.resize(size);
    frame.n_lines = transducer.n_lines;
    frame.n_samples = settings.n_samples;
    frame.sample_depth = shape.sample_depth();
    frame.in_phase.resize(size);
    frame.quadrature.resize(size);
    frame.envelope.resize(size);
    frame.needle_light.resize(size, 1.0F);
    frame.decibel.resize(size);
    if (settings.doppler) {
      moving_re.resize(size);
      moving_im.resize(size);
      frame.velocity.resize(size);
    }
    add_views(size);
    frame.width = converter.width();
    frame.height = converter.height();
    frame.pixel = settings.pixel;
    frame.image.resize(static_cast<std::size_t>(frame.width) *
                       static_cast<std::size_t>(frame.height));
    frame.contact.resize(static_cast<std::size_t>(transducer.n_lines));
    tips.resize(static_cast<std::size_t>(transducer.n_lines));
    frame.shadow_from.resize(static_cast<std::size_t>(transducer.n_lines));
  }

  /// Runs body(first, last) over [0, n) in fixed blocks, in this renderer's own arena.
  template <class Body>
  void for_blocks(int n, const Body& body) {
    const int blocks = (n + kBlock - 1) / kBlock;
    arena.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<int>(0, blocks, 1),
          [&](const tbb::blocked_range<int>& range) {
            for (int b = range.begin(); b < range.end(); ++b) {
              body(b, b * kBlock, std::min(n, (b + 1) * kBlock));
            }
          },
          tbb::simple_partitioner{});
    });
  }

  /// The steered frames of a compound image; the unsteered one comes last.
  void add_views(std::size_t size) {
    const int n = settings.compound_angles;
    if (n == 1) return;
    for (int k = 0; k < n; ++k) {
      const double offset = settings.compound_spread * (static_cast<double>(k) / (n - 1) - 0.5);
      if (2 * k + 1 != n) views.emplace_back(transducer, settings, offset);
    }
    views.emplace_back(transducer, settings, 0);
    sum.resize(size);
    weight.resize(size);
  }

  void synthesise_lines(const Transducer& probe, const Pose& X_JP,
                        const std::optional<NeedleView>& needle) {
    const BeamTracer tracer(*scene, regions, probe, settings);
    const int n = settings.n_samples;
    std::fill(tips.begin(), tips.end(), NeedleEcho::Tip{});
    std::optional<NeedleEcho> needle_echo;
    if (needle) needle_echo.emplace(*needle, X_JP, probe, shape);
    for_blocks(probe.n_lines, [&](int block, int first, int last) {
      LineScratch& mine = scratch[static_cast<std::size_t>(block)];
      for (int l = first; l < last; ++l) {
        const Scanline line = scanline(probe, l);
        const auto re = row(raw_re, l, n);
        const auto im = row(raw_im, l, n);
        synthesis.synthesise(tracer, regions, line, X_JP, mine, re, im);
        spread.note(l, mine.bent);
        add_tracks(probe, line, X_JP, mine, re, im);
        if (needle_echo) {
          add_needle(*needle_echo, line, l, X_JP, mine);
          tips[static_cast<std::size_t>(l)] =
              needle_echo->find_tip(line, X_JP, mine.central, mine.bent);
        }
        coupling.apply(l, shape.sample_depth(), re, im);
        add_lens_ringing(mine.central.contact ? 1 - coupling.at_line(l) : 1, shape.sample_depth(),
                         re);
        frame.contact[static_cast<std::size_t>(l)] =
            static_cast<float>(mine.central.contact ? coupling.at_line(l) : 0);
        frame.shadow_from[static_cast<std::size_t>(l)] =
            static_cast<float>(std::clamp(mine.central.shadow_from, 0.0, static_cast<double>(n)));
      }
    });
    for_blocks(probe.n_lines, [&](int, int first, int last) {
      for (int l = first; l < last; ++l) {
        const auto re = row(raw_re, l, n);
        const auto im = row(raw_im, l, n);
        spread.apply(l, re, im);
        add_penumbra(probe, shape.sample_depth(), frame.shadow_from, l, re, im);
      }
    });
  }

  /// Where the lines that see the needle's tip show it.
  [[nodiscard]] std::optional<PixelPoint> find_shown_tip() const {
    double shares = 0;
    Vec3 place = Vec3::Zero();
    for (int l = 0; l < transducer.n_lines; ++l) {
      const NeedleEcho::Tip& tip = tips[static_cast<std::size_t>(l)];
      if (tip.share <= 0 || tip.sample >= settings.n_samples) continue;
      const Scanline line = scanline(transducer, l);
      shares += tip.share;
      place += tip.share * (line.origin + tip.sample * shape.sample_depth() * line.direction);
    }
    if (shares <= 0) return std::nullopt;
    return converter.pixel_of(place / shares);
  }

  void add_tracks(const Transducer& probe, const Scanline& line, const Pose& X_JP,
                  const LineScratch& mine, std::span<float> re, std::span<float> im) const {
    for (const NeedleTrack& track : tracks) {
      NeedleView thread;
      const Vec3 way = track.p_JTip - track.p_JEntry;
      thread.shape.outer_diameter = kTrackWidth;
      thread.shape.length = way.norm();
      if (thread.shape.length < kTrackWidth) continue;
      thread.X_JN = make_pose(track.p_JTip, way, way.unitOrthogonal());
      NeedleEcho(thread, X_JP, probe, shape)
          .add_track(track.amplitude, line, X_JP, mine.central, mine.bent, re, im);
    }
  }

  void add_needle(const NeedleEcho& echo, const Scanline& line, int l, const Pose& X_JP,
                  const LineScratch& mine) {
    const int n = settings.n_samples;
    const auto re = row(raw_re, l, n);
    const auto im = row(raw_im, l, n);
    const auto light = row(frame.needle_light, l, n);
    std::fill(light.begin(), light.end(), 1.0F);
    if (mine.central.contact) echo.shade(line, light);
    multiply(light.data(), re.data(), im.data(), light.size());
    if (!settings.doppler) {
      echo.add(line, X_JP, mine.central, mine.bent, re, im);
      return;
    }
    const auto own_re = row(moving_re, l, n);
    const auto own_im = row(moving_im, l, n);
    std::fill(own_re.begin(), own_re.end(), 0.0F);
    std::fill(own_im.begin(), own_im.end(), 0.0F);
    echo.add(line, X_JP, mine.central, mine.bent, own_re, own_im);
    accumulate(own_re.data(), re.data(), re.size());
    accumulate(own_im.data(), im.data(), im.size());
  }

  /// Adds the point reflectors to a line that is already spread sideways.
  void add_reflectors(const Transducer& probe, const Pose& X_JP, int l, std::span<float> re) const {
    const Scanline line = scanline(probe, l);
    const Vec3 across(line.direction.z(), 0, -line.direction.x());
    for (const PointReflector& reflector : reflectors) {
      const Vec3 p = X_JP.inverse() * reflector.p_J - line.origin;
      const double depth = p.dot(line.direction);
      if (depth <= 0) continue;
      const double lateral = shape.lateral_amplitude(p.dot(across), depth);
      const double elevation = shape.profile().elevation_amplitude(p.y(), depth);
      const double sample = depth / shape.sample_depth();
      if (lateral * elevation < 1e-6) continue;
      add_point_echo(sample, reflector.amplitude * lateral * elevation * coupling.gain(l, depth),
                     re);
    }
  }

  /// Beam, pulse, noise, envelope and, as a rule, compression.
  void shape_lines(const Transducer& probe, const Pose& X_JP) {
    const int n = settings.n_samples;
    for_blocks(probe.n_lines, [&](int, int first, int last) {
      for (int l = first; l < last; ++l) {
        const auto wide = row(work, l, n);
        const auto re = row(frame.in_phase, l, n);
        const auto im = row(frame.quadrature, l, n);
        shape.across(raw_re, probe.n_lines, l, wide);
        add_reflectors(probe, X_JP, l, wide);
        shape.along(wide, re);
        shape.across(raw_im, probe.n_lines, l, wide);
        shape.along(wide, im);
        add_white_noise(mix_bits(settings.seed), l, noise_gain, re, im);
        const auto envelope = row(frame.envelope, l, n);
        detect(re.data(), im.data(), time_gain.data(), envelope.data(), envelope.size());
        // while the envelope is still at hand
        if (compresses_at_once()) compress(envelope, decibel_gain(), row(frame.decibel, l, n));
      }
    });
  }

  [[nodiscard]] float decibel_gain() const { return static_cast<float>(settings.gain_db); }
  /// Whether a line is done when its envelope is: no mean over views, and no motion to be found in
  /// between, which works in the decibel image.
  [[nodiscard]] bool compresses_at_once() const { return views.empty() && !settings.doppler; }

  /// Where the needle moves. Uses the decibel image as a work space, so it comes before
  /// compression.
  void find_motion(const Pose& X_JP, const std::optional<NeedleView>& needle) {
    if (!settings.doppler) return;
    if (!needle) {
      std::fill(frame.velocity.begin(), frame.velocity.end(),
                std::numeric_limits<float>::quiet_NaN());
      return;
    }
    const int n = settings.n_samples;
    const Vec3 v_P = X_JP.linear().transpose() * needle->v_JN;
    for_blocks(transducer.n_lines, [&](int, int first, int last) {
      for (int l = first; l < last; ++l) {
        const auto wide = row(work, l, n);
        const auto re = row(frame.velocity, l, n);
        const auto im = row(frame.decibel, l, n);
        shape.across(moving_re, transducer.n_lines, l, wide);
        shape.along(wide, re);
        shape.across(moving_im, transducer.n_lines, l, wide);
        shape.along(wide, im);
        detect_motion(re, im, time_gain, -v_P.dot(scanline(transducer, l).direction),
                      settings.doppler_limit, re);
      }
    });
  }

  /// One frame of echoes and its envelope, or the mean envelope of several steered ones.
  void acquire(const Pose& X_JP, const std::optional<NeedleView>& needle) {
    const auto start = std::chrono::steady_clock::now();
    times = {};
    if (!needle) std::fill(frame.needle_light.begin(), frame.needle_light.end(), 1.0F);
    if (views.empty()) {
      synthesise_lines(transducer, X_JP, needle);
      times.lines = seconds_since(start);
      shape_lines(transducer, X_JP);
      times.beam = seconds_since(start) - times.lines;
      return;
    }
    const int n = settings.n_samples;
    std::fill(sum.begin(), sum.end(), 0.0F);
    std::fill(weight.begin(), weight.end(), 0.0F);
    for (const CompoundView& view : views) {
      const auto begin = std::chrono::steady_clock::now();
      synthesise_lines(view.transducer(), X_JP, needle);
      times.lines += seconds_since(begin);
      shape_lines(view.transducer(), X_JP);
      for_blocks(transducer.n_lines, [&](int, int first, int last) {
        for (int l = first; l < last; ++l) {
          view.add(frame.envelope, l, row(sum, l, n), row(weight, l, n));
        }
      });
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      frame.envelope[i] = weight[i] > 0 ? sum[i] / weight[i] : 0.0F;
    }
    times.beam = seconds_since(start) - times.lines;
  }

  void compress_lines() {
    const int n = settings.n_samples;
    if (!compresses_at_once()) {
      for_blocks(transducer.n_lines, [&](int, int first, int last) {
        for (int l = first; l < last; ++l)
          compress(row(frame.envelope, l, n), decibel_gain(), row(frame.decibel, l, n));
      });
    }
    if (settings.smoothing <= 0) return;
    for_blocks(transducer.n_lines, [&](int, int first, int last) {
      for (int l = first; l < last; ++l) {
        smooth_line(frame.decibel, transducer.n_lines, l, static_cast<float>(settings.smoothing),
                    row(work, l, n));
      }
    });
    std::swap(work, frame.decibel);
  }

  void display() {
    const bool persists = settings.persistence > 0 && has_previous;
    if (persists) previous = frame.image;
    for_blocks(frame.height, [&](int, int first, int last) {
      converter.convert(frame.decibel, first, last, frame.image);
    });
    if (persists) {
      const auto keep = static_cast<float>(settings.persistence);
      for (std::size_t i = 0; i < previous.size(); ++i) {
        const auto now = static_cast<float>(frame.image[i]);
        const auto before = static_cast<float>(previous[i]);
        frame.image[i] = static_cast<std::uint8_t>(std::lround(now + keep * (before - now)));
      }
    }
    has_previous = true;
  }

  std::shared_ptr<const Scene> scene;
  Transducer transducer;
  ImageSettings settings;
  std::vector<RegionAcoustics> regions;
  BeamShape shape;
  ScatterField scatter;
  TissueTexture texture;
  LineSynthesis synthesis;
  ScanConverter converter;
  std::vector<float> time_gain;
  std::vector<float> noise_gain;
  tbb::task_arena arena;
  std::vector<PointReflector> reflectors;
  ApertureCoupling coupling;
  BeamSpread spread;
  std::vector<NeedleEcho::Tip> tips;  // (n_lines)
  std::vector<NeedleTrack> tracks;
  std::vector<CompoundView> views;  // none: no compounding
  std::vector<LineScratch> scratch;
  std::vector<float> raw_re;  // (n_lines, n_samples) before the beam's shape
  std::vector<float> raw_im;
  std::vector<float> work;
  std::vector<float> moving_re;  // the needle's own share of raw_re, for Doppler
  std::vector<float> moving_im;
  std::vector<float> sum;  // of the compound views' envelopes
  std::vector<float> weight;
  std::vector<std::uint8_t> previous;
  bool has_previous = false;
  Frame frame;
  StageTimes times;
};

Renderer::Renderer(std::shared_ptr<const Scene> scene, const Transducer& transducer,
                   const ImageSettings& settings) {
  ARTUS_REQUIRE(scene != nullptr, "no scene");
  impl_ = std::make_unique<Impl>(std::move(scene), transducer, settings);
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const Frame& Renderer::render(const Pose& X_JP, const std::optional<NeedleView>& needle) {
  ARTUS_REQUIRE(X_JP.matrix().allFinite(), "the probe's pose is not finite");
  ARTUS_REQUIRE(!needle || needle->X_JN.matrix().allFinite(), "the needle's pose is not finite");
  ARTUS_REQUIRE(!needle || needle->v_JN.allFinite(), "the needle's velocity is not finite");
  impl_->acquire(X_JP, needle);
  impl_->frame.tip_shown = impl_->find_shown_tip();
  const auto start = std::chrono::steady_clock::now();
  impl_->find_motion(X_JP, needle);
  impl_->compress_lines();
  impl_->times.beam += seconds_since(start);
  const auto display = std::chrono::steady_clock::now();
  impl_->display();
  impl_->times.display = seconds_since(display);
  return impl_->frame;
}

void Renderer::set_contact(std::span<const float> coverage) {
  impl_->coupling.set(coverage);
}

void Renderer::set_point_reflectors(std::vector<PointReflector> reflectors) {
  impl_->reflectors = std::move(reflectors);
}

void Renderer::set_needle_tracks(std::vector<NeedleTrack> tracks) {
  for (const NeedleTrack& track : tracks) {
    ARTUS_REQUIRE(
        track.p_JEntry.allFinite() && track.p_JTip.allFinite() && std::isfinite(track.amplitude),
        "a needle track is not finite");
  }
  impl_->tracks = std::move(tracks);
}

void Renderer::set_scene(std::shared_ptr<const Scene> scene) {
  ARTUS_REQUIRE(scene != nullptr, "no scene");
  const CompiledJoint& before = impl_->scene->joint();
  const CompiledJoint& after = scene->joint();
  const bool same_body =
      before.source_digest == after.source_digest && before.regions.size() == after.regions.size();
  std::vector<RegionAcoustics> regions = make_region_acoustics(after, impl_->transducer);
  for (std::size_t i = 0; same_body && i < regions.size(); ++i) {
    const RegionAcoustics& known = impl_->regions[i];
    regions[i].course = known.course;
    regions[i].continues_as = known.continues_as;
    regions[i].junction = known.junction;
  }
  if (!same_body) impl_->arena.execute([&] { add_courses(after, regions); });
  impl_->regions = std::move(regions);
  impl_->scene = std::move(scene);
}

const Transducer& Renderer::transducer() const noexcept {
  return impl_->transducer;
}
const ImageSettings& Renderer::settings() const noexcept {
  return impl_->settings;
}
const Renderer::StageTimes& Renderer::stage_times() const noexcept {
  return impl_->times;
}

Frame render_bmode(const std::shared_ptr<const Scene>& scene, const Pose& X_JP,
                   const std::optional<NeedleView>& needle, const Transducer& transducer,
                   const ImageSettings& settings) {
  Renderer renderer(scene, transducer, settings);
  return renderer.render(X_JP, needle);
}

Pose probe_in_joint(const Pose& X_WJ, const Pose& X_WP) {
  constexpr double kUnit = 1e9;  // steps per metre, and per unit of a rotation's entries
  Pose X_JP = X_WJ.inverse() * X_WP;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) X_JP(i, j) = std::round(X_JP(i, j) * kUnit) / kUnit;
  }
  return X_JP;
}

}  // namespace artus
