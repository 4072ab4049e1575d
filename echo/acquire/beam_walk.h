// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "artus/detail/core/units.h"
#include "artus/detail/echo/acquire/propagation.h"

namespace artus {

inline constexpr double kNoLength = 1e-12;  // m
// Knots between which the path at rest is straight to so much, m, and the gradient to so much, are
// one piece: each costs every plane.
inline constexpr double kOnePiece = 8e-6;
inline constexpr double kOneGradient = 0.02;
inline constexpr std::size_t kMaxLeftOut = 12;
// rad, bend at which a beam has lost a neper. assumed: half the acceptance of an F/2 aperture; the
// rest of the aperture took another path and no longer adds up
inline constexpr double kBendLobe = 12 * kDegree;

/// Where a beam is and what it has lost.
struct BeamTracer::Walk {
  /// A knot that the last two knots do without.
  struct LeftOut {
    double path;
    Vec3 rest_J;
    Eigen::Matrix3d gradient_J;
  };

  BeamTrace& trace;
  Vec3 wave;           // unit, direction of the wave
  Vec3 straight;       // unit, direction in which it left the face
  bool bends = false;  // whether `wave` follows Snell's law
  RegionId region = kOutside;
  bool started = false;  // whether `region` is known
  bool touched = false;  // whether the beam has been inside the body
  double sample = 0;
  double path = 0;         // m, as shown
  double reached = 0;      // m of the body and the gel
  double gap = 0;          // m of gel that the flat skin takes, see lay_on_skin
  double flat_to = 0;      // m of path, where the stretched tissue ends
  double attenuation = 0;  // Np, two-way
  double slope = 0;        // Np/Hz, two-way
  double log_transmission = 0;
  double bend_loss = 0;                    // Np, see kBendLobe
  const BeamTrace* central = nullptr;      // of the middle plane, for the others
  std::size_t central_run = 0;             // the one beside this beam's place
  const BeamTrace* like = nullptr;         // runs are cut as in this one, where it is near
  std::size_t guide_knot = 0;              // the first behind the last one made
  Vec3 line_start = {};                    // of the straight piece, as the next four
  Vec3 line_direction = {};                // unit
  double line_path = 0;                    // m, at its start
  double time_scale = 1;                   // length of beam over length of line
  std::optional<RestPath> rest_path = {};  // for knots of its own, once they are needed
  bool has_knots = false;                  // whether this line has any
  std::size_t line_knot = 0;               // its first
  std::array<LeftOut, kMaxLeftOut> left_out = {};
  std::size_t n_left_out = 0;
  Vec3 displacement = Vec3::Zero();                        // m, of the tissue last met
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();  // of deformation, in the run's middle

  /// The knot of this line after which a place on the beam comes. Requires: knots to there.
  [[nodiscard]] std::size_t knot_before(double at_path) const noexcept {
    std::size_t k = trace.n_knots - 2;
    while (k > line_knot && trace.knots[k].path > at_path) --k;
    return k;
  }
  /// A place on the beam between a knot and the next, 0..1.
  [[nodiscard]] double share_behind(std::size_t knot, double at_path) const noexcept {
    const double from = trace.knots[knot].path;
    return std::clamp((at_path - from) / (trace.knots[knot + 1].path - from + kNoLength), 0.0, 1.0);
  }
  /// Where the tissue there was at rest.
  [[nodiscard]] Vec3 rest_at(double at_path) const noexcept {
    const std::size_t k = knot_before(at_path);
    const Vec3& from = trace.knots[k].rest_J;
    return from + share_behind(k, at_path) * (trace.knots[k + 1].rest_J - from);
  }
  /// How the path at rest goes on there, m per metre of beam.
  [[nodiscard]] Vec3 onward_at(double at_path) const noexcept {
    const BeamKnot* const knot = &trace.knots[knot_before(at_path)];
    return (knot[1].rest_J - knot[0].rest_J) / (knot[1].path - knot[0].path + kNoLength);
  }
  /// How it is turned and stretched.
  [[nodiscard]] Eigen::Matrix3d gradient_at(double at_path) const noexcept {
    const std::size_t k = knot_before(at_path);
    const auto& frames = (trace.guide != nullptr ? *trace.guide : trace).frames;
    const Eigen::Matrix3d& before = frames[trace.knots[k].frame].gradient_J;
    const Eigen::Matrix3d& behind = frames[trace.knots[k + 1].frame].gradient_J;
    return before + share_behind(k, at_path) * (behind - before);
  }
  [[nodiscard]] double log_gain(double sigma) const noexcept {
    const double shift = slope * sigma;
    return log_transmission - bend_loss - attenuation + 0.5 * shift * shift;
  }
  /// The middle plane's run beside a run, of the same region; null: none. Only ever asked for runs
  /// farther on.
  [[nodiscard]] const BeamRun* run_beside(const BeamRun& run) noexcept {
    std::size_t& i = central_run;
    while (i + 1 < central->n_runs && central->runs[i].path_end <= run.path_begin) ++i;
    for (std::size_t k = i; k < std::min(i + 2, central->n_runs); ++k)
      if (central->runs[k].region == run.region) return &central->runs[k];
    return nullptr;
  }
  /// m of this line from its start to a place on the beam.
  [[nodiscard]] double along(double at_path) const noexcept {
    return (at_path - line_path) / time_scale;
  }
  /// The first knot of the guide behind a place on the beam, of the line that is there; null:
  /// none. Only ever asked for places farther on.
  [[nodiscard]] const BeamKnot* knot_after(double at_path) noexcept {
    const BeamTrace& guide = *trace.guide;
    const auto in_force = [&](std::size_t k) {  // not past its line's end
      return k + 1 == guide.n_knots || guide.knots[k + 1].path > guide.knots[k].path;
    };
    while (guide_knot < guide.n_knots &&
           (guide.knots[guide_knot].path <= at_path || !in_force(guide_knot)))
      ++guide_knot;
    return guide_knot < guide.n_knots ? &guide.knots[guide_knot] : nullptr;
  }
  /// The last one before or at it.
  [[nodiscard]] const BeamKnot* knot_beside(double at_path) noexcept {
    const BeamKnot* after = knot_after(at_path);
    if (after != nullptr && guide_knot == 0) return after;
    const BeamKnot& before = trace.guide->knots[guide_knot - 1];
    return after == nullptr || before.path <= at_path ? &before : after;
  }
  /// Adds a knot of its own; instead of the last one, where the path is straight without that.
  void add_knot(const KnotFrame& frame) noexcept {
    const std::size_t last = trace.n_knots - 1;
    if (last > line_knot && n_left_out < kMaxLeftOut) {
      left_out[n_left_out] = {trace.knots[last].path, trace.knots[last].rest_J,
                              trace.frames[last].gradient_J};
      if (is_straight(last - 1, frame, std::span(left_out).first(n_left_out + 1))) {
        ++n_left_out;
        put_knot(last, frame);
        return;
      }
    }
    n_left_out = 0;
    put_knot(trace.n_knots++, frame);
  }
  /// Adds a knot where one of the guide says that the tissue was.
  void add_knot_beside(const BeamKnot& knot, double at_path) noexcept {
    const Vec3 p_J = line_start + along(at_path) * line_direction;
    const Vec3 rest_J = trace.guide->frames[knot.frame].rest.beside(p_J);
    trace.knots[trace.n_knots++] = {at_path, rest_J, (p_J - rest_J).norm(), knot.frame};
  }
  /// Adds one where the tissue moved as at the last, behind which the guide has none.
  void add_knot_behind(const BeamKnot& last, double at_path) noexcept {
    trace.outran = true;
    const Vec3 onward = (along(at_path) - along(last.path)) * line_direction;
    trace.knots[trace.n_knots++] = {at_path, last.rest_J + onward, last.moved, last.frame};
  }
  void put_knot(std::size_t at, const KnotFrame& frame) noexcept {
    trace.frames[at] = frame;
    trace.knots[at] = {line_path + frame.rest.along * time_scale, frame.rest.rest_J,
                       frame.rest.moved, at};
  }
  [[nodiscard]] bool is_straight(std::size_t first, const KnotFrame& to,
                                 std::span<const LeftOut> between) const noexcept {
    const BeamKnot& from = trace.knots[first];
    const Eigen::Matrix3d& gradient_J = trace.frames[first].gradient_J;
    const double length = line_path + to.rest.along * time_scale - from.path + kNoLength;
    return std::all_of(between.begin(), between.end(), [&](const LeftOut& knot) {
      const double share = (knot.path - from.path) / length;
      const Vec3 rest = from.rest_J + share * (to.rest.rest_J - from.rest_J);
      if (!((knot.rest_J - rest).squaredNorm() < kOnePiece * kOnePiece)) return false;
      const Eigen::Matrix3d between_J = gradient_J + share * (to.gradient_J - gradient_J);
      return (knot.gradient_J - between_J).cwiseAbs().maxCoeff() < kOneGradient;
    });
  }
  /// Goes on straight from `from`.
  void begin_line(const Vec3& from, const Vec3& direction, double scale) noexcept {
    if (has_knots && trace.guide == nullptr) displacement = from - rest_at(path);
    has_knots = false;
    line_start = from;
    line_direction = direction;
    line_path = path;
    time_scale = scale;
  }
  /// Goes on along `direction`.
  void turn(const Vec3& direction) noexcept {
    wave = direction;
    bend_loss = 2 * std::max(0.0, 1 - wave.dot(straight)) / (kBendLobe * kBendLobe);
  }
};

}  // namespace artus
