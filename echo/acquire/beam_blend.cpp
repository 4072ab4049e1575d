// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "artus/detail/echo/acquire/propagation.h"

namespace artus {
namespace {

constexpr double kOffSurface = 40e-6;  // m that a blended echo may lie off its interface
constexpr double kOffSide = 100e-6;    // the same in planes beside the middle one, of which several
                                       // add up
constexpr double kChordShare = 0.25;   // of how far one end of a chord lies off the other's plane:
                                       // the arc's height over it
constexpr double kSteepestBlend = 0.35;  // cosine; steeper interfaces are followed
constexpr double kJump = 3e-3;           // m of a region's own coordinates: they jump there
constexpr double kShortest = 1e-9;       // samples

template <class T>
[[nodiscard]] T between(const T& a, const T& b, double share) noexcept {
  return a + share * (b - a);
}

/// Whether the interface between two echoes is as flat as a line between them.
bool is_flat(const BeamEcho& a, const BeamEcho& b, double off_surface) noexcept {
  if (a.is_cortex != b.is_cortex || std::min(a.cosine, b.cosine) < kSteepestBlend) return false;
  const Vec3 chord = b.p_J - a.p_J;
  const double off = std::max(std::abs(chord.dot(a.normal_J)), std::abs(chord.dot(b.normal_J)));
  return kChordShare * off < off_surface * std::min(a.cosine, b.cosine);
}

bool is_alike(const BeamRun& a, const BeamRun& b) noexcept {
  return a.region == b.region && (a.n_knots > 0) == (b.n_knots > 0) &&
         a.end - a.begin > kShortest && b.end - b.begin > kShortest &&
         (!a.has_middle || (a.middle.place - b.middle.place).cwiseAbs().maxCoeff() < kJump);
}

/// The path at rest of a run by its place in it, 0..1; asked for places that ascend.
class RestCourse {
 public:
  RestCourse(const BeamTrace& trace, const BeamRun& run) noexcept
      : knots_(trace.knots.data() + run.first_knot),
        n_(run.n_knots),
        begin_(run.path_begin),
        length_(run.path_end - run.path_begin) {}

  [[nodiscard]] double place(std::size_t k) const noexcept {
    return (knots_[k].path - begin_) / length_;
  }
  [[nodiscard]] Vec3 at(double place) noexcept {
    const double path = begin_ + place * length_;
    while (k_ + 2 < n_ && knots_[k_ + 1].path <= path) ++k_;
    const BeamKnot& from = knots_[k_];
    const BeamKnot& to = knots_[k_ + 1];
    const double step = to.path - from.path;
    return step > 0 ? between(from.rest_J, to.rest_J, (path - from.path) / step) : from.rest_J;
  }

 private:
  const BeamKnot* knots_;
  std::size_t n_;
  double begin_;
  double length_;
  std::size_t k_ = 0;
};

BeamEcho blend_echo(const BeamEcho& a, const BeamEcho& b, double share) noexcept {
  BeamEcho echo = a;
  echo.sample = between(a.sample, b.sample, share);
  echo.amplitude = between(a.amplitude, b.amplitude, share);
  echo.diffuse_share = between(a.diffuse_share, b.diffuse_share, share);
  echo.cosine = between(a.cosine, b.cosine, share);
  echo.p_J = between(a.p_J, b.p_J, share);
  echo.rest_J = between(a.rest_J, b.rest_J, share);
  echo.step_J = between(a.step_J, b.step_J, share);
  return echo;
}

void blend_runs(const BeamRun& a, const BeamRun& b, double share, BeamRun& run) noexcept {
  run.begin = between(a.begin, b.begin, share);
  run.end = between(a.end, b.end, share);
  run.p_J = between(a.p_J, b.p_J, share);
  run.step_J = between(a.step_J, b.step_J, share);
  run.direction_J = between(a.direction_J, b.direction_J, share);
  run.region = a.region;
  run.n_pieces = a.n_pieces;
  run.log_gain_begin = between(a.log_gain_begin, b.log_gain_begin, share);
  run.log_gain_end = between(a.log_gain_end, b.log_gain_end, share);
  run.path_begin = between(a.path_begin, b.path_begin, share);
  run.path_end = between(a.path_end, b.path_end, share);
  run.material = between(a.material, b.material, share);
  run.material_step = between(a.material_step, b.material_step, share);
  run.along = between(a.along, b.along, share);
  run.across = between(a.across, b.across, share);
  run.rest_middle_J = between(a.rest_middle_J, b.rest_middle_J, share);
  run.n_knots = 0;
  run.has_middle = a.has_middle;
  if (!a.has_middle) return;
  run.middle.place = between(a.middle.place, b.middle.place, share);
  run.middle.gradient = between(a.middle.gradient, b.middle.gradient, share);
}

/// Gives the run knots where `a`'s are, at rest between the paths of both.
void blend_knots(const BeamTrace& a, const BeamTrace& b, std::size_t i, double share,
                 BeamTrace& trace) noexcept {
  BeamRun& run = trace.runs[i];
  const RestCourse before(a, a.runs[i]);
  RestCourse behind(b, b.runs[i]);
  run.first_knot = trace.n_knots;
  run.n_knots = a.runs[i].n_knots;
  for (std::size_t k = 0; k < run.n_knots; ++k) {
    const BeamKnot& knot = a.knots[a.runs[i].first_knot + k];
    const double place = before.place(k);
    trace.knots[trace.n_knots++] = {between(run.path_begin, run.path_end, place),
                                    between(knot.rest_J, behind.at(place), share), knot.moved,
                                    knot.frame};
  }
}

}  // namespace

bool BeamTracer::blend_echoes(const BeamTrace& a, const BeamTrace& b, double share,
                              BeamTrace& trace) noexcept {
  if (a.n_echoes != b.n_echoes || a.contact != b.contact) return false;
  for (std::size_t k = 0; k < a.n_echoes; ++k)
    if (!is_flat(a.echoes[k], b.echoes[k], kOffSide)) return false;
  trace.n_echoes = a.n_echoes;
  for (std::size_t k = 0; k < a.n_echoes; ++k)
    trace.echoes[k] = blend_echo(a.echoes[k], b.echoes[k], share);
  return true;
}

bool BeamTracer::blend(const BeamTrace& a, const BeamTrace& b, double share,
                       BeamTrace& trace) const noexcept {
  if (a.contact != b.contact || a.n_runs != b.n_runs || a.n_first != b.n_first ||
      (a.end_amplitude > 0) != (b.end_amplitude > 0))
    return false;
  const double off = a.is_beside ? kOffSide : kOffSurface;
  for (std::size_t k = 0; k < a.n_first; ++k)
    if (!is_flat(a.echoes[k], b.echoes[k], off)) return false;
  std::size_t knots = 0;
  for (std::size_t i = 0; i < a.n_runs; ++i) {
    if (!is_alike(a.runs[i], b.runs[i])) return false;
    knots += a.runs[i].n_knots;
  }
  if (knots > BeamTrace::kMaxKnots) return false;
  trace.clear();
  trace.contact = a.contact;
  trace.is_beside = a.is_beside;
  trace.guide = a.guide != nullptr || a.n_knots == 0 ? a.guide : &a;
  trace.n_runs = a.n_runs;
  for (std::size_t i = 0; i < a.n_runs; ++i) {
    blend_runs(a.runs[i], b.runs[i], share, trace.runs[i]);
    if (a.runs[i].n_knots > 0) blend_knots(a, b, i, share, trace);
  }
  trace.n_echoes = a.n_first;
  for (std::size_t k = 0; k < a.n_first; ++k)
    trace.echoes[k] = blend_echo(a.echoes[k], b.echoes[k], share);
  trace.shadow_from = between(a.shadow_from, b.shadow_from, share);
  trace.end_sample = between(a.end_sample, b.end_sample, share);
  trace.end_amplitude = between(a.end_amplitude, b.end_amplitude, share);
  add_repeats(trace);
  return true;
}

}  // namespace artus
