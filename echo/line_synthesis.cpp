// SPDX-License-Identifier: AGPL-3.0-or-later
#include "echo/line_synthesis.h"

#include <algorithm>
#include <cmath>

#include "echo/simd.h"

namespace artus {
namespace {

constexpr std::size_t kStride = 4;  // samples between exact values of gain and texture

/// gain = weight * a line from `from` to `to` over kStride samples.
ARTUS_SIMD
void interpolate_gain(const float* nodes, const float* weight, float* gain,
                      std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = i / kStride;
    const float t = static_cast<float>(i % kStride) * (1.0F / kStride);
    gain[i] = weight[i] * (nodes[k] + t * (nodes[k + 1] - nodes[k]));
  }
}

}  // namespace

LineSynthesis::LineSynthesis(const BeamShape& shape, const ScatterField& scatter,
                             const TissueTexture& texture, const ImageSettings& settings) noexcept
    : shape_(&shape),
      scatter_(&scatter),
      texture_(&texture),
      speckle_(std::pow(10.0, settings.speckle_db / 20)),
      has_texture_(settings.texture),
      n_planes_(settings.n_planes) {}

void LineSynthesis::add_run(const BeamRun& run, const RegionAcoustics& region,
                            std::span<const float> weight, std::span<float> gain,
                            std::span<float> re, std::span<float> im) const {
  if (region.backscatter <= 0) return;
  const auto first = static_cast<std::size_t>(std::ceil(std::max(0.0, run.begin)));
  const auto last = std::min(re.size(), static_cast<std::size_t>(std::ceil(run.end)));
  if (first >= last) return;
  const std::size_t n = last - first;
  const double into = static_cast<double>(first) - run.begin;
  const Vec3 p_J = run.p_J + into * run.step_J;
  const double slope = (run.log_gain_end - run.log_gain_begin) / (run.end - run.begin);
  const double cosine = std::abs(run.direction_J.dot(region.fibre));
  double value = speckle_ * region.backscatter * fibre_backscatter(region.kind, cosine) *
                 std::exp(run.log_gain_begin + into * slope);
  const double ratio = std::exp(slope * kStride);
  const std::size_t n_nodes = (n - 1) / kStride + 2;
  const auto nodes = gain.subspan(re.size(), n_nodes);
  const bool textured = has_texture_ && texture_->has(region.kind);
  const LatticeWalk walk =
      textured ? texture_->make_walk(region, p_J, run.step_J * kStride) : LatticeWalk{};
  for (std::size_t k = 0; k < n_nodes; ++k, value *= ratio) {
    const float factor =
        textured ? texture_->at(region.kind, walk, static_cast<std::uint32_t>(k)) : 1.0F;
    nodes[k] = static_cast<float>(value) * factor;
  }
  interpolate_gain(nodes.data(), weight.data() + first, gain.data(), n);
  scatter_->add(scatter_->make_walk(p_J, run.step_J), gain.first(n), re.subspan(first, n),
                im.subspan(first, n));
}

void LineSynthesis::add_plane(int plane, const BeamTrace& trace,
                              std::span<const RegionAcoustics> regions, std::vector<float>& gain,
                              std::span<float> re, std::span<float> im) const {
  const std::span<const float> speckle = shape_->speckle_weight(plane);
  const std::span<const float> share = shape_->echo_weight(plane);
  for (std::size_t i = 0; i < trace.n_runs; ++i) {
    add_run(trace.runs[i], regions[trace.runs[i].region], speckle, gain, re, im);
  }
  for (std::size_t i = 0; i < trace.n_echoes; ++i) {
    const BeamEcho& echo = trace.echoes[i];
    if (!(echo.sample >= 0) || echo.sample >= static_cast<double>(re.size()) - 1) continue;
    const auto at = static_cast<std::size_t>(echo.sample);
    const auto t = static_cast<float>(echo.sample - static_cast<double>(at));
    // Roughness glitters: part of the diffuse share varies with the place on the interface.
    float one = 1;
    float n_re = 0;
    float n_im = 0;
    scatter_->add(scatter_->make_walk(echo.p_J, Vec3::Zero()), {&one, 1}, {&n_re, 1}, {&n_im, 1});
    const auto glitter = static_cast<float>(0.5 * echo.diffuse_share);
    const float a = static_cast<float>(echo.amplitude) * share[at];
    const float a_re = a * (1 + glitter * n_re);
    const float a_im = a * glitter * n_im;
    re[at] += (1 - t) * a_re;
    re[at + 1] += t * a_re;
    im[at] += (1 - t) * a_im;
    im[at + 1] += t * a_im;
  }
}

void LineSynthesis::synthesise(const BeamTracer& tracer, std::span<const RegionAcoustics> regions,
                               const Scanline& line, const Pose& X_JP, LineScratch& scratch,
                               std::span<float> re, std::span<float> im) const {
  scratch.gain.resize(2 * re.size() + 8);
  std::fill(re.begin(), re.end(), 0.0F);
  std::fill(im.begin(), im.end(), 0.0F);
  tracer.trace_bent(X_JP * line.origin, X_JP.linear() * line.direction, scratch.central,
                    scratch.bent);
  const Vec3 elevation = X_JP.linear().col(1);
  for (int p = 0; p < n_planes_; ++p) {
    if (shape_->plane_offset(p) == 0) {
      add_plane(p, scratch.central, regions, scratch.gain, re, im);
      continue;
    }
    scratch.plane.size = 0;
    for (const double z : shape_->plane_nodes()) {
      scratch.plane.p_J[scratch.plane.size] =
          scratch.bent.at(z) + shape_->plane_elevation(p, z) * elevation;
      scratch.plane.length[scratch.plane.size++] = z;
    }
    tracer.trace_along(scratch.plane, elevation, scratch.side);
    add_plane(p, scratch.side, regions, scratch.gain, re, im);
  }
}

}  // namespace artus
