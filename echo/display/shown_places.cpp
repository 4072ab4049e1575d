// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/shown_places.h"

#include <algorithm>
#include <array>
#include <memory>

#include "artus/detail/core/check.h"
#include "artus/detail/echo/acquire/propagation.h"
#include "artus/detail/echo/probe/placed_line.h"

namespace artus {
namespace {

constexpr std::size_t kMaxBeyond = 128;  // intervals of a line behind its sound
constexpr double kPastSurface = 1e-6;    // m behind the surface that ended the sound

/// What the sound of a line met.
void add_runs(const BeamTrace& trace, std::vector<ShownPlaces::Piece>& pieces) {
  for (std::size_t k = 0; k < trace.n_runs; ++k) {
    const BeamRun& run = trace.runs[k];
    const double samples = run.end - run.begin;
    const double step = samples > 0 ? (run.path_end - run.path_begin) / samples : run.step_J.norm();
    pieces.push_back(
        {run.begin, run.path_begin, run.p_J, run.step_J, run.region, step, run.lifted});
  }
}

/// Where the sound of a line ends, and how it would go on.
ShownPlaces::Piece end_of(const BeamTrace& trace, const PlacedLine& placed, double sample_depth) {
  if (trace.n_runs == 0)
    return {0, 0, placed.origin_J, sample_depth * placed.direction_J, kOutside, sample_depth, 0};
  const BeamRun& run = trace.runs[trace.n_runs - 1];
  return {run.end,
          run.path_end,
          run.p_J + (run.end - run.begin) * run.step_J,
          sample_depth * run.direction_J,
          run.region,
          sample_depth,
          0};
}

/// What lies on the straight line behind it, to the picture's lower edge.
void add_beyond(const Scene& scene, const ShownPlaces::Piece& end, double n_samples,
                double sample_depth, std::vector<ShownPlaces::Piece>& pieces) {
  const double length = (n_samples - end.begin) * sample_depth;
  if (length <= kPastSurface) return;
  const Vec3 direction = end.step_J / sample_depth;
  const Vec3 from = end.p_J + kPastSurface * direction;
  std::array<TissueInterval, kMaxBeyond> intervals;
  const QueryCount count = scene.find_intervals({from, end.p_J + length * direction}, intervals);
  for (std::size_t k = 0; k < count.size; ++k) {
    const double at = k == 0 ? 0 : intervals[k].entry + kPastSurface;
    pieces.push_back({end.begin + at / sample_depth, end.path + at, end.p_J + at * direction,
                      end.step_J, intervals[k].region, end.path_step, 0});
  }
}

}  // namespace

ShownPlaces::ShownPlaces(const Scene& scene, const SmoothGradient* tissue,
                         std::span<const RegionAcoustics> regions, const Transducer& transducer,
                         const ImageSettings& settings, const Pose& X_JP) {
  ARTUS_REQUIRE(X_JP.matrix().allFinite(), "the probe's pose is not finite");
  BeamTracer tracer(scene, tissue, regions, transducer, settings);
  tracer.lay_on_skin(transducer, X_JP);
  const double sample_depth = settings.depth / settings.n_samples;
  const auto trace = std::make_unique<BeamTrace>();
  BeamPath path;
  for (int l = 0; l < transducer.n_lines; ++l) {
    first_.push_back(pieces_.size());
    const PlacedLine placed = place_line(transducer, l, X_JP);
    trace->clear();
    tracer.trace_bent(placed.origin_J, placed.direction_J, *trace, path);
    add_runs(*trace, pieces_);
    const Piece end = end_of(*trace, placed, sample_depth);
    add_beyond(scene, end, settings.n_samples, sample_depth, pieces_);
    if (pieces_.size() == first_.back()) pieces_.push_back(end);
  }
  first_.push_back(pieces_.size());
}

std::span<const ShownPlaces::Piece> ShownPlaces::line(int index) const noexcept {
  const std::size_t first = first_[static_cast<std::size_t>(index)];
  return std::span(pieces_).subspan(first, first_[static_cast<std::size_t>(index) + 1] - first);
}

const ShownPlaces::Piece& ShownPlaces::piece_at(int index, double sample) const noexcept {
  const std::span<const Piece> pieces = line(index);
  const auto behind =
      std::upper_bound(pieces.begin() + 1, pieces.end(), sample,
                       [](double s, const Piece& piece) { return s < piece.begin; });
  return *(behind - 1);
}

Vec3 ShownPlaces::place(int index, double sample) const noexcept {
  const Piece& piece = piece_at(index, sample);
  return piece.p_J + (sample - piece.begin) * piece.step_J;
}

Vec3 ShownPlaces::needle_place(int index, double sample) const noexcept {
  const Piece& piece = piece_at(index, sample);
  const double step = piece.step_J.norm();
  const double lifted = piece.lifted + (sample - piece.begin) * (step - piece.path_step);
  return place(index, sample) - lifted / step * piece.step_J;
}

RegionId ShownPlaces::region(int index, double sample) const noexcept {
  return piece_at(index, sample).region;
}

double ShownPlaces::sample_of(int index, double depth) const noexcept {
  const std::span<const Piece> pieces = line(index);
  const auto behind = std::upper_bound(pieces.begin() + 1, pieces.end(), depth,
                                       [](double d, const Piece& piece) { return d < piece.path; });
  const Piece& piece = *(behind - 1);
  return piece.begin + (depth - piece.path) / piece.path_step;
}

}  // namespace artus
