// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/line_synthesis.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "artus/detail/echo/acquire/point_echo.h"
#include "artus/detail/echo/medium/simd.h"

namespace artus {
namespace {

constexpr std::size_t kNodeStride = 4;    // samples between exact values of gain and texture
constexpr double kGlitter = 0.5;          // assumed: rms variation of a fully diffuse interface
constexpr double kTailShare = 0.35;       // assumed: scattering just behind a rough interface
constexpr float kTailDecay = 0.8F;        // per sample
constexpr std::size_t kTailGap = 3;       // samples behind the surface
constexpr std::size_t kTailSamples = 16;  // samples
constexpr double kHaze = 0.1;  // assumed: -20 dB at the face, +6 for both orders of the path,
                               // -6 because its second leg is out of focus
// bone's line on screens. assumed: from pictures of bone under muscle
constexpr double kCortex = 1.01e-3;      // m thick with the pulse, at the display's speed
constexpr double kCortexStep = 0.8;      // of the pulse's length
constexpr double kCortexEven = 0.3;      // of its thickness that is as bright as its surface
constexpr double kCortexFall = 2.7;      // Np over the rest
constexpr double kCortexGlitter = 0.2;   // rms unevenness
constexpr double kCortexSlope = 0.65;    // power of the cosine by which it is deeper
constexpr double kCortexBeam = 0.85;     // of the beam's width, which a slope has seen already
constexpr double kSteepestCortex = 0.3;  // cosine
constexpr std::size_t kCortexEchoes = 32;
constexpr double kCortexMostRise = 2.5e-3;  // m from plane to plane; beyond it is another bone
constexpr float kSheet = 1.6F;              // texture above which a sheet reflects coherently
constexpr double kSheetEcho = 1.5;  // assumed: coherent amplitude over scattered, per unit above

/// m, half amplitude.
double pulse_length(const Transducer& transducer) noexcept {
  return transducer.pulse_cycles * transducer.wavelength() / 2;
}

/// gain = weight * the straight lines between nodes kNodeStride samples apart. Reads and writes up
/// to the end of the last stride.
ARTUS_SIMD
void interpolate_gain(const float* nodes, const float* weight, float* gain,
                      std::size_t n_strides) noexcept {
  for (std::size_t k = 0; k < n_strides; ++k) {
    const float from = nodes[k];
    const float step = (nodes[k + 1] - from) * (1.0F / kNodeStride);
    for (std::size_t j = 0; j < kNodeStride; ++j) {
      gain[k * kNodeStride + j] =
          weight[k * kNodeStride + j] * (from + static_cast<float>(j) * step);
    }
  }
}

constexpr std::size_t kFadeLanes = 8;

/// Multiplies nodes by an amplitude that starts at `value` and changes by `ratio` from node to
/// node, and sets what their sheets reflect coherently. Goes on to a full multiple of kFadeLanes.
ARTUS_SIMD
void fade_nodes(float value, float ratio, float facing, float* nodes, float* sheets,
                std::size_t n) noexcept {
  std::array<float, kFadeLanes> amplitude{};
  float step = 1;
  for (float& a : amplitude) {
    a = value * step;
    step *= ratio;
  }
  for (std::size_t k = 0; k < n; k += kFadeLanes) {
    for (std::size_t j = 0; j < kFadeLanes; ++j) {
      const float node = nodes[k + j];
      const float above = 0.5F * (node - kSheet + std::abs(node - kSheet));
      sheets[k + j] = amplitude[j] * facing * above;
      nodes[k + j] = node * amplitude[j];
      amplitude[j] *= step;
    }
  }
}

ARTUS_SIMD
void accumulate(const float* in, float* out, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) out[i] += in[i];
}

ARTUS_SIMD
void scale_add(float factor, const float* in, float* out, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) out[i] += factor * in[i];
}

/// The straight pieces of a run of `n` samples from `first` on whose tissue has moved: from knot to
/// knot, the last two reach to the end.
void place_pieces(const BeamRun& run, std::span<const BeamKnot> knots, std::size_t first,
                  std::size_t n, std::vector<ScatterPiece>& pieces) noexcept {
  const double samples_per_m = (run.end - run.begin) / (run.path_end - run.path_begin);
  const auto at = [&](const BeamKnot& knot) {  // in samples from `first`
    return run.begin + (knot.path - run.path_begin) * samples_per_m - static_cast<double>(first);
  };
  std::size_t begin = 0;
  double from = at(knots.front());
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const double to = at(knots[k + 1]);
    const std::size_t end =
        k + 2 == knots.size()
            ? n
            : static_cast<std::size_t>(std::clamp(std::ceil(to), 0.0, static_cast<double>(n)));
    if (end > begin && to > from) {
      const Vec3 step = (knots[k + 1].rest_J - knots[k].rest_J) / (to - from);
      const Vec3 rest = knots[k].rest_J + (static_cast<double>(begin) - from) * step;
      pieces.push_back({first + begin, first + end, rest, step});
      begin = end;
    }
    from = to;
  }
}

}  // namespace

LineSynthesis::LineSynthesis(const BeamShape& shape, const ScatterField& scatter,
                             const TissueTexture& texture, const Transducer& transducer,
                             const ImageSettings& settings) noexcept
    : shape_(&shape),
      scatter_(&scatter),
      texture_(&texture),
      speckle_(std::pow(10.0, settings.speckle_db / 20)),
      has_texture_(settings.texture),
      reverberates_(settings.reverberation && settings.look == Look::raw),
      on_screen_(settings.look != Look::raw),
      n_planes_(settings.n_planes),
      pitch_(transducer.pitch()),
      cortex_step_(static_cast<std::size_t>(std::max(
          1L, std::lround(kCortexStep * pulse_length(transducer) / shape.sample_depth())))),
      cortex_((kCortex - pulse_length(transducer)) / shape.sample_depth()) {}

/// The nodes of a run whose tissue lay in `pieces`; those behind the last sample go on straight.
void LineSynthesis::sample_moved_texture(const BeamRun& run, const RegionAcoustics& region,
                                         std::span<const ScatterPiece> pieces,
                                         std::span<float> nodes) const noexcept {
  const std::size_t first = pieces.front().begin;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const ScatterPiece& piece = pieces[k];
    const std::size_t end =
        k + 1 == pieces.size() ? nodes.size() : (piece.end - first + kNodeStride - 1) / kNodeStride;
    if (begin >= end) continue;
    const auto into =
        static_cast<double>(first + begin * kNodeStride) - static_cast<double>(piece.begin);
    const Vec3 rest = piece.p_J + into * piece.step_J;
    texture_->sample(region.kind,
                     run.middle.place + run.middle.gradient * (rest - run.rest_middle_J),
                     run.middle.gradient * (static_cast<double>(kNodeStride) * piece.step_J),
                     nodes.subspan(begin, end - begin));
    begin = end;
  }
}

void LineSynthesis::add_run(const BeamRun& run, const Ground& ground, std::span<const float> weight,
                            EchoSpan echoes) const {
  const std::span<float> gain = ground.gain;
  std::vector<ScatterPiece>& pieces = ground.pieces;
  const RegionAcoustics& region = ground.regions[run.region];
  if (region.backscatter <= 0) return;
  const auto first = static_cast<std::size_t>(std::ceil(std::max(0.0, run.begin)));
  const auto last = std::min(echoes.size(), static_cast<std::size_t>(std::ceil(run.end)));
  if (first >= last) return;
  const std::size_t n = last - first;
  const double into = static_cast<double>(first) - run.begin;
  const Vec3 p_J = run.p_J + into * run.step_J;
  const double slope = (run.log_gain_end - run.log_gain_begin) / (run.end - run.begin);
  const double value = speckle_ *
                       local_backscatter(ground.regions, region, run.middle.place.z(), run.along) *
                       std::exp(run.log_gain_begin + into * slope);
  const std::size_t n_nodes = (n - 1) / kNodeStride + 2;
  const std::size_t behind = echoes.size() + kNodeStride;  // the last stride may reach over the end
  const auto nodes = gain.subspan(behind, n_nodes);
  const std::size_t room = (n_nodes + kFadeLanes - 1) / kFadeLanes * kFadeLanes;
  const auto sheets = gain.subspan(behind + room, n_nodes);
  const std::size_t first_piece = pieces.size();
  if (run.n_knots > 0)
    place_pieces(run, ground.knots.subspan(run.first_knot, run.n_knots), first, n, pieces);
  if (pieces.size() == first_piece) pieces.push_back({first, last, p_J, run.step_J});
  const double across =
      region.kind == TissueKind::fat ? run.across * run.across : 1 - run.along * run.along;
  const auto facing = static_cast<float>(kSheetEcho * across);
  const bool textured = has_texture_ && texture_->has(region.kind);
  const bool reflects = textured && facing > 0.05F;
  if (!textured) {
    std::fill(nodes.begin(), nodes.end(), 1.0F);
  } else if (run.n_knots > 0) {
    sample_moved_texture(run, region, std::span(pieces).subspan(first_piece), nodes);
  } else {
    texture_->sample(region.kind, run.material + into * run.material_step,
                     run.material_step * kNodeStride, nodes);
  }
  fade_nodes(static_cast<float>(value), static_cast<float>(std::exp(slope * kNodeStride)),
             reflects ? facing : 0.0F, nodes.data(), sheets.data(), n_nodes);
  if (std::isfinite(region.clear_above)) {
    for (std::size_t k = 0; k < n_nodes; ++k)
      nodes[k] *= settled_share(
          region, region.up_J.dot(p_J + static_cast<double>(k * kNodeStride) * run.step_J));
  }
  const std::size_t n_strides = n_nodes - 1;
  if (reflects) {
    interpolate_gain(sheets.data(), weight.data() + first, gain.data() + first, n_strides);
    accumulate(gain.data() + first, echoes.re.data() + first, n);
  }
  interpolate_gain(nodes.data(), weight.data() + first, gain.data() + first, n_strides);
}

void LineSynthesis::add_plane(const PlaneView& view, const BeamTrace& trace, Ground& ground,
                              EchoSpan echoes) const {
  ground.knots = trace.knots;
  ground.pieces.clear();
  const std::span<const float> speckle = shape_->speckle_weight(view.plane);
  for (std::size_t i = 0; i < trace.n_runs; ++i) {
    add_run(trace.runs[i], ground, speckle, echoes);
  }
  const auto gain = ground.gain.first(echoes.size());
  if (ground.more == nullptr)
    ScatterField::add(ground.view, ground.pieces, gain, ground.room, echoes.re, echoes.im);
  else
    ScatterField::add(ground.view, ground.pieces, gain, ground.room, echoes, *ground.more);
  for (std::size_t i = 0; i < trace.n_echoes; ++i) {
    add_echo(trace.echoes[i], view, echoes);
  }
}

/// The interfaces of a plane that lies between two others: between those of both, or, where both
/// met others, some of each.
void LineSynthesis::add_between(const PlaneView& view, const Between& planes, BeamTrace& blended,
                                EchoSpan echoes) const {
  const double rise = view.cortex_rise > 0 ? planes.b.end_sample - planes.a.end_sample : 0;
  const auto add = [&](const BeamTrace& trace, double part, double deeper) {
    for (std::size_t i = 0; i < trace.n_echoes; ++i) {
      BeamEcho echo = trace.echoes[i];
      echo.amplitude *= part;
      if (echo.is_cortex) echo.sample += deeper;
      add_echo(echo, view, echoes);
    }
  };
  if (BeamTracer::blend_echoes(planes.a, planes.b, planes.share, blended))
    return add(blended, 1, 0);
  add(planes.a, 1 - planes.share, planes.share * rise);
  add(planes.b, planes.share, (planes.share - 1) * rise);
}

/// How much deeper (samples) bone lies in the next plane, from where it ends the beams of two.
double LineSynthesis::cortex_rise(const BeamTrace& a, const BeamTrace& b,
                                  int planes_apart) const noexcept {
  if (!on_screen_ || a.end_amplitude <= 0 || b.end_amplitude <= 0) return 0;
  const double rise = std::abs(b.end_sample - a.end_sample) / planes_apart;
  return rise < kCortexMostRise / shape_->sample_depth() ? rise : 0;
}

/// How much deeper (samples) an interface lies in the next elevation plane. On screens an interface
/// that slopes across the slice is one that is smeared over its thickness, not one copy a plane.
double LineSynthesis::rise_to_next_plane(const BeamEcho& echo,
                                         const PlaneView& view) const noexcept {
  if (!on_screen_ || n_planes_ < 2) return 0;
  const double depth = echo.sample * shape_->sample_depth();
  const int before = std::max(0, view.plane - 1);
  const int behind = std::min(n_planes_ - 1, view.plane + 1);
  const double apart =
      (shape_->plane_elevation(behind, depth) - shape_->plane_elevation(before, depth)) /
      (behind - before);
  const double slope =
      std::abs(echo.normal_J.dot(view.elevation_J)) / std::max(kSteepestFacet, echo.cosine);
  return std::abs(apart) * slope / shape_->sample_depth();
}

/// An interface seen by one beam: steep ones reach over several samples within the beam's pitch and
/// from plane to plane, and rough ones glitter and scatter on from just behind their surface.
void LineSynthesis::add_echo(const BeamEcho& echo, const PlaneView& view, EchoSpan echoes) const {
  const auto end = static_cast<double>(echoes.size()) - 1;
  if (!(echo.sample >= 0) || echo.sample >= end) return;
  if (echo.is_cortex) return add_cortex(echo, view, echoes);
  const auto first = static_cast<std::size_t>(echo.sample);
  const double slope = std::sqrt(std::max(0.0, 1 - echo.cosine * echo.cosine)) /
                       std::max(kSteepestFacet, echo.cosine);
  const double reach =
      std::max(pitch_ * slope / shape_->sample_depth(), rise_to_next_plane(echo, view));
  const int n = std::max(1, static_cast<int>(std::lround(reach)));
  const std::array<float, 1> one{1};
  std::array<float, 1> n_re{};
  std::array<float, 1> n_im{};
  ScatterField::add(view.scatter, echo.rest_J, Vec3::Zero(), one, n_re, n_im);
  const auto glitter = static_cast<float>(kGlitter * echo.diffuse_share);
  const float amplitude =
      static_cast<float>(echo.amplitude) * shape_->echo_weight(view.plane)[first];
  const float a_re = amplitude * (1 + glitter * n_re[0]) / static_cast<float>(n);
  const float a_im = amplitude * glitter * n_im[0] / static_cast<float>(n);
  for (int k = 0; k < n; ++k) {
    const double sample = echo.sample + k - 0.5 * (n - 1);
    add_point_echo(sample, a_re, echoes.re);
    add_point_echo(sample, a_im, echoes.im);
  }
  const std::size_t from = first + kTailGap;
  if (echo.diffuse_share < 0.05 || from >= echoes.size()) return;
  std::array<float, kTailSamples> gain{};
  float value = amplitude * static_cast<float>(kTailShare * echo.diffuse_share);
  for (float& g : gain) {
    g = value;
    value *= kTailDecay;
  }
  const EchoSpan tail = echoes.part(from, std::min(gain.size(), echoes.size() - from));
  ScatterField::add(view.scatter, echo.rest_J + static_cast<double>(kTailGap) * echo.step_J,
                    echo.step_J, std::span(gain).first(tail.size()), tail.re, tail.im);
}

/// Bone as screens show it: a line as thick as cortex lets the sound in and out again, even along
/// itself, made of echoes closer to each other than the pulse is long; thicker where it rises from
/// plane to plane.
void LineSynthesis::add_cortex(const BeamEcho& echo, const PlaneView& view, EchoSpan echoes) const {
  std::array<float, kCortexEchoes> one{};
  one.fill(1);
  std::array<float, kCortexEchoes> n_re{};
  std::array<float, kCortexEchoes> n_im{};
  // across itself the line is as thick at a slope as where it is flat; the beam's width adds to it
  const double cosine = std::max(kSteepestCortex, echo.cosine);
  const double width = shape_->profile().lateral_width(echo.sample * shape_->sample_depth());
  const double length =
      std::max(0.5 * static_cast<double>(cortex_step_),  // one echo
               cortex_ / std::pow(cosine, kCortexSlope) -
                   kCortexBeam * std::sqrt(1 - cosine * cosine) * width / shape_->sample_depth());
  const double rise = view.cortex_rise;
  const double step = std::max(static_cast<double>(cortex_step_),
                               (length + rise) / static_cast<double>(kCortexEchoes));
  const auto n = std::min(kCortexEchoes, static_cast<std::size_t>((length + rise) / step) + 1);
  ScatterField::add(view.scatter, echo.rest_J, step * echo.step_J, std::span(one).first(n),
                    std::span(n_re).first(n), std::span(n_im).first(n));
  const double amplitude =
      echo.amplitude * length / (length + rise) *
      static_cast<double>(shape_->echo_weight(view.plane)[static_cast<std::size_t>(echo.sample)]);
  for (std::size_t k = 0; k < n; ++k) {
    const double into = static_cast<double>(k) * step;
    const double sample = echo.sample - 0.5 * rise + into;
    if (sample < 0) continue;
    const double behind = std::max(0.0, into - rise);
    const double value =
        amplitude * std::exp(-kCortexFall * std::max(0.0, behind / length - kCortexEven));
    add_point_echo(sample, value * (1 + kCortexGlitter * static_cast<double>(n_re[k])), echoes.re);
    add_point_echo(sample, value * kCortexGlitter * static_cast<double>(n_im[k]), echoes.im);
  }
}

/// What shows inside a shadow: sound that bone threw back, that the face reflected and that went
/// through the tissue above once more. It lies behind the bone by as much as the tissue lies below
/// the face, fainter by the bone's echo and the face.
void LineSynthesis::add_haze(const BeamTrace& trace, EchoSpan echoes) noexcept {
  const auto shift = static_cast<std::size_t>(std::ceil(std::max(1.0, trace.end_sample)));
  if (!trace.contact || trace.end_amplitude <= 0 || shift >= echoes.size()) return;
  const std::size_t n = std::min(shift, echoes.size() - shift);
  const auto share = static_cast<float>(kHaze * trace.end_amplitude);
  scale_add(share, echoes.re.data(), echoes.re.data() + shift, n);
  scale_add(share, echoes.im.data(), echoes.im.data() + shift, n);
}

void LineSynthesis::synthesise(const BeamTracer& tracer, std::span<const PlacedLine> row,
                               std::size_t l, LineScratch& scratch, EchoSpan echoes,
                               const ScatterField::MoreSets* more) const {
  const PlacedLine& placed = row[l];
  scratch.gain.resize(3 * echoes.size() + 8 * kNodeStride);
  scratch.pieces.reserve(BeamTrace::kMax + BeamTrace::kMaxKnots);
  scratch.room.resize(echoes.size());
  std::fill(echoes.re.begin(), echoes.re.end(), 0.0F);
  std::fill(echoes.im.begin(), echoes.im.end(), 0.0F);
  for (std::size_t k = 0; more != nullptr && k < more->size(); ++k) {
    std::fill((*more)[k].re.begin(), (*more)[k].re.end(), 0.0F);
    std::fill((*more)[k].im.begin(), (*more)[k].im.end(), 0.0F);
  }
  LineBeams& beams = scratch.beams;
  beams.go_to(tracer, *shape_, row, l);
  const Vec3& elevation = placed.elevation_J;
  scratch.view = scatter_->make_view(placed.direction_J, elevation);
  Ground ground{
      tracer.regions(), scratch.view, scratch.gain, scratch.pieces, scratch.room, more, {}};
  const BeamTrace* before = nullptr;
  int last = 0;
  bool is_first = true;
  PlaneView view{0, elevation, scratch.view, 0};
  const auto add = [&](int p, const BeamTrace& trace) {
    view.plane = p;
    add_plane(view, trace, ground, echoes);
  };
  for (int p = 0; p < n_planes_; ++p) {
    if (!shape_->hears_speckle(p)) continue;
    const BeamTrace& trace = beams.plane(p);
    if (before != nullptr) {
      view.cortex_rise = cortex_rise(*before, trace, p - last);
      if (is_first) add(last, *before);
      is_first = false;
      add(p, trace);
      for (view.plane = last + 1; view.plane < p; ++view.plane)
        add_between(view, {*before, trace, (view.plane - last) / static_cast<double>(p - last)},
                    scratch.between, echoes);
    }
    before = &trace;
    last = p;
  }
  if (is_first) add(last, *before);
  if (reverberates_) add_haze(beams.central(), echoes);
}

}  // namespace artus
