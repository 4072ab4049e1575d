// SPDX-License-Identifier: AGPL-3.0-or-later
#include "echo/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "core/check.h"
#include "core/noise.h"
#include "echo/aperture_coupling.h"
#include "echo/beam_shape.h"
#include "echo/display.h"
#include "echo/line_synthesis.h"
#include "echo/needle_echo.h"
#include "echo/propagation.h"
#include "echo/region_acoustics.h"
#include "echo/scatter_field.h"
#include "echo/simd.h"
#include "echo/texture.h"

namespace artus {
namespace {

constexpr int kBlock = 8;  // lines or rows that one task takes

ARTUS_SIMD
void detect(const float* re, const float* im, const float* gain, float* envelope,
            std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    envelope[i] = gain[i] * std::sqrt(re[i] * re[i] + im[i] * im[i]);
  }
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
        coupling(transducer) {
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
    frame.decibel.resize(size);
    frame.width = converter.width();
    frame.height = converter.height();
    frame.pixel = settings.pixel;
    frame.image.resize(static_cast<std::size_t>(frame.width) *
                       static_cast<std::size_t>(frame.height));
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

  void synthesise_lines(const Pose& X_JP, const std::optional<NeedleView>& needle) {
    const BeamTracer tracer(*scene, regions, transducer, settings);
    const int n = settings.n_samples;
    std::optional<NeedleEcho> needle_echo;
    if (needle) needle_echo.emplace(*needle, X_JP, transducer, shape);
    for_blocks(transducer.n_lines, [&](int block, int first, int last) {
      LineScratch& mine = scratch[static_cast<std::size_t>(block)];
      for (int l = first; l < last; ++l) {
        const Scanline line = scanline(transducer, l);
        const auto re = row(raw_re, l, n);
        const auto im = row(raw_im, l, n);
        synthesis.synthesise(tracer, regions, line, X_JP, mine, re, im);
        if (needle_echo) needle_echo->add(line, X_JP, mine.central, mine.bent, re, im);
        coupling.apply(l, shape.sample_depth(), re, im);
        add_lens_ringing(mine.central.contact ? 1 - coupling.at_line(l) : 1, shape.sample_depth(),
                         re);
        frame.shadow_from[static_cast<std::size_t>(l)] =
            static_cast<float>(std::clamp(mine.central.shadow_from, 0.0, static_cast<double>(n)));
      }
    });
  }

  /// Adds the point reflectors to a line that is already spread sideways.
  void add_reflectors(const Pose& X_JP, int l, std::span<float> re) const {
    const Scanline line = scanline(transducer, l);
    const Vec3 across(line.direction.z(), 0, -line.direction.x());
    for (const PointReflector& reflector : reflectors) {
      const Vec3 p = X_JP.inverse() * reflector.p_J - line.origin;
      const double depth = p.dot(line.direction);
      if (depth <= 0) continue;
      const double lateral = shape.lateral_amplitude(p.dot(across), depth);
      const double elevation = shape.profile().elevation_amplitude(p.y(), depth);
      const double sample = depth / shape.sample_depth();
      if (lateral * elevation < 1e-6 || sample >= static_cast<double>(re.size()) - 1) continue;
      const auto i = static_cast<std::size_t>(sample);
      const double t = sample - static_cast<double>(i);
      const double a = reflector.amplitude * lateral * elevation * coupling.gain(l, depth);
      re[i] += static_cast<float>((1 - t) * a);
      re[i + 1] += static_cast<float>(t * a);
    }
  }

  void shape_lines(const Pose& X_JP) {
    const int n = settings.n_samples;
    for_blocks(transducer.n_lines, [&](int, int first, int last) {
      for (int l = first; l < last; ++l) {
        const auto spread = row(work, l, n);
        const auto re = row(frame.in_phase, l, n);
        const auto im = row(frame.quadrature, l, n);
        shape.across(raw_re, transducer.n_lines, l, spread);
        add_reflectors(X_JP, l, spread);
        shape.along(spread, re);
        shape.across(raw_im, transducer.n_lines, l, spread);
        shape.along(spread, im);
        add_white_noise(mix_bits(settings.seed), l, noise_gain, re, im);
        const auto envelope = row(frame.envelope, l, n);
        detect(re.data(), im.data(), time_gain.data(), envelope.data(), envelope.size());
        compress(envelope, static_cast<float>(settings.gain_db), row(frame.decibel, l, n));
      }
    });
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
        frame.image[i] = static_cast<std::uint8_t>(now + keep * (before - now) + 0.5F);
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
  std::vector<LineScratch> scratch;
  std::vector<float> raw_re;  // (n_lines, n_samples) before the beam's shape
  std::vector<float> raw_im;
  std::vector<float> work;
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
  const auto start = std::chrono::steady_clock::now();
  impl_->synthesise_lines(X_JP, needle);
  const auto lines = std::chrono::steady_clock::now();
  impl_->shape_lines(X_JP);
  const auto beam = std::chrono::steady_clock::now();
  impl_->display();
  impl_->times = {std::chrono::duration<double>(lines - start).count(),
                  std::chrono::duration<double>(beam - lines).count(), seconds_since(beam)};
  return impl_->frame;
}

void Renderer::set_contact(std::span<const float> coverage) {
  impl_->coupling.set(coverage);
}

void Renderer::set_point_reflectors(std::vector<PointReflector> reflectors) {
  impl_->reflectors = std::move(reflectors);
}

void Renderer::set_scene(std::shared_ptr<const Scene> scene) {
  ARTUS_REQUIRE(scene != nullptr, "no scene");
  impl_->regions = make_region_acoustics(scene->joint(), impl_->transducer);
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
