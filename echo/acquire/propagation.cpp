// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/propagation.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/echo/acquire/beam_walk.h"

namespace artus {
namespace {

constexpr double kThinnest = 2e-6;    // m, an interval shorter than this is rounding
constexpr double kStraight = 2e-3;    // sine of a bend that is not worth another query
constexpr double kSidewards = 25e-6;  // m that a bend may lead aside within a thin layer
constexpr double kPiece = 4e-3;       // m, longest run: the downshift curves the loss slowly
constexpr double kAlongSurface =
    0.17;                           // cosine of 80 degrees: along a faceted surface, go straight
constexpr double kLongPiece = 1.4;  // of that, where it is to be cut like a neighbour's
constexpr double kSilence = -20;    // ln: 174 dB down, below any receiver
constexpr double kMargin = 1.25;    // tissue as fast as tendon reaches deeper in the same time
constexpr double kTiny = 1e-12;
constexpr double kStill = 1e-9;  // m; tissue that moved less is where it was
// Bone on screens: its line is seen at any slope, so it is rougher than its facets are. assumed,
// from pictures in which it is as bright at 50 degrees as at 20
constexpr double kCortexFacing = 25 * kDegree;  // rad, of the part that faces the beam
constexpr double kCortexRough = 0.34;           // amplitude of the part that any slope returns
// What a steep interface does to the one ray of a line the rest of an aperture does not meet there:
// on screens it reflects and bends as one of this incidence at most, and bends less from the first
// of these on, not at all from the second. assumed: twice the acceptance of an F/2 aperture off a
// tendon's critical angle in fat
constexpr double kSteepestMet = 0.64;  // cosine of 50 degrees
constexpr double kBendsWhole = 0.91;   // of 25
constexpr double kBendsNoMore = 0.64;  // of 50
constexpr double kRepeatFrom = 0.02;   // echoes above -34 dB repeat
// A skin that lies flat under the face where tissue does not give way. assumed, all four
constexpr double kMostFlattened = 3e-3;  // m of gap
constexpr double kStretch = 1.2;         // of the tissue behind
constexpr double kTouches = 0.3e-3;      // m from face to skin, of a probe in contact
constexpr double kHovers = 0.6e-3;       // m from which on it is not
constexpr int kEveryLine = 8;            // lines between those that feel for the skin
constexpr double kOnward = 4e-3;         // m that a knot is good for where the middle plane ends

/// The share of a ray's bend that the whole aperture takes part in.
double bend_share(double cosine) noexcept {
  const double s = std::clamp((cosine - kBendsNoMore) / (kBendsWhole - kBendsNoMore), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// The share of bone's echo at perpendicular incidence that screens show at another.
double cortex_share(double cosine) noexcept {
  const double off = std::acos(std::clamp(cosine, 0.0, 1.0)) / kCortexFacing;
  return kCortexRough + (1 - kCortexRough) * std::exp(-off * off);
}

}  // namespace

BeamTracer::BeamTracer(const Scene& scene, const SmoothGradient* tissue,
                       std::span<const RegionAcoustics> regions, const Transducer& transducer,
                       const ImageSettings& settings) noexcept
    : scene_(&scene),
      tissue_(tissue),
      regions_(regions),
      sample_depth_(settings.depth / settings.n_samples),
      n_samples_(settings.n_samples),
      spectrum_sigma_(settings.frequency_downshift ? transducer.spectrum_sigma() : 0),
      gel_limit_(settings.gel_limit),
      max_path_(settings.depth * kMargin),
      refraction_(settings.refraction),
      reverberation_(settings.reverberation && settings.look == Look::raw),
      on_screen_(settings.look != Look::raw) {}

/// Where the interface at which the interval begins faces, against the wave.
Vec3 BeamTracer::find_normal(Walk& walk, const TissueInterval& interval) const noexcept {
  const Vec3& facet = interval.entry_normal;
  if (tissue_ == nullptr || interval.entry_interface == kNoInterface ||
      !place_knots(walk, walk.path) ||
      !(walk.trace.knots[walk.knot_before(walk.path)].moved > kStill))
    return facet;
  const Vec3 at_rest = scene_->normal_at_rest(interval.entry_interface);
  const Vec3 normal = carried_normal(walk.gradient_at(walk.path), at_rest).normalized();
  return normal.dot(facet) < 0 ? Vec3(-normal) : normal;
}

/// Crosses into the interval's region at `point`. False when no sound goes on.
bool BeamTracer::enter(Walk& walk, const TissueInterval& interval,
                       const Vec3& point) const noexcept {
  BeamTrace& trace = walk.trace;
  const RegionAcoustics& from = regions_[walk.region];
  const RegionAcoustics& to = regions_[interval.region];
  const bool junction = is_junction(from, walk.region, to, interval.region, interval.entry_normal);
  walk.region = interval.region;
  if (junction) return true;
  if (interval.region == kBeyond) return false;
  const bool air = walk.touched && interval.region == kOutside;
  const Vec3 normal = find_normal(walk, interval);
  const double cosine = -walk.wave.dot(normal);
  if (cosine < kAlongSurface) return !to.opaque && !air;
  const double met = on_screen_ ? std::max(cosine, kSteepestMet) : cosine;
  InterfaceResponse response = compute_interface(from, to, met);
  if (air) response = {1, 1, 0, 0};
  const double sheath = sheath_reflection(from, to);
  const double roughness = std::max(from.roughness, to.roughness);
  if (trace.n_echoes < BeamTrace::kMax) {
    const ReturnedShare share = returned_share(roughness, cosine);
    const auto with_sheath = [&](double r) {
      return std::sqrt(r * r + sheath * sheath);
    };
    const double specular = with_sheath(response.reflection) * share.specular;
    const double diffuse = with_sheath(response.facing) * share.diffuse;
    BeamEcho& echo = trace.echoes[trace.n_echoes++];
    echo.sample = walk.sample;
    const double strength =
        on_screen_ && to.opaque ? cortex_share(cosine) * response.facing : specular + diffuse;
    echo.amplitude = strength * std::exp(walk.log_gain(spectrum_sigma_));
    echo.diffuse_share = diffuse > 0 ? diffuse / (specular + diffuse) : 0;
    echo.cosine = cosine;
    echo.is_cortex = on_screen_ && to.opaque;
    echo.p_J = point;
    echo.normal_J = normal;
    echo.rest_J = point;
    echo.step_J = walk.wave * (sample_depth_ * to.speed / kDisplaySpeedOfSound);
    if (tissue_ != nullptr && place_knots(walk, walk.path)) {
      if (trace.knots[walk.knot_before(walk.path)].moved > kStill) {
        echo.rest_J = walk.rest_at(walk.path);
        echo.step_J = echo.step_J.norm() * walk.onward_at(walk.path);
      }
    }
  }
  if (to.opaque || air) {
    trace.end_sample = walk.sample;
    trace.end_amplitude = trace.echoes[trace.n_echoes - 1].amplitude;
    return false;
  }
  const double transmission = beam_transmission(from, to, met, response);
  if (transmission < 1e-4) return false;
  walk.log_transmission += std::log(transmission);
  if (walk.bends && response.transmission > 0) {
    const double ratio = to.speed / from.speed;
    const Vec3 bent = ratio * walk.wave + (ratio * met - response.cosine_out) * normal;
    const double share = on_screen_ ? bend_share(cosine) : 1;
    walk.turn((walk.wave + share * (bent - walk.wave)).normalized());
  }
  return true;
}

void BeamTracer::lay_on_skin(const Transducer& transducer, const Pose& X_JP) noexcept {
  flattens_ = 0;
  if (!on_screen_ || tissue_ != nullptr) return;
  std::array<TissueInterval, 8> intervals;
  double nearest = kHovers;
  for (int l = kEveryLine / 2; l < transducer.n_lines; l += kEveryLine) {
    const PlacedLine line = place_line(transducer, l, X_JP);
    const Vec3 end = line.origin_J + 2 * kHovers * line.direction_J;
    const QueryCount count = scene_->find_intervals({line.origin_J, end}, intervals);
    if (count.size > 0)
      nearest = std::min(nearest, intervals[0].region == kOutside ? intervals[0].exit : 0.0);
  }
  flattens_ = std::clamp((kHovers - nearest) / (kHovers - kTouches), 0.0, 1.0);
}

/// The first region of a beam. False when no sound enters the body.
bool BeamTracer::start(Walk& walk, RegionId region, double length) const noexcept {
  walk.started = true;
  walk.region = region;
  walk.trace.contact = region != kOutside || length <= gel_limit_;
  if (region == kOutside) {
    walk.gap = flattens_ * std::min(length, kMostFlattened);
    walk.flat_to = length + walk.gap / (kStretch - 1);
  }
  return walk.trace.contact && !regions_[region].opaque && region != kBeyond;
}

/// A region's own coordinates at the run's middle; for a side plane on the tangent of the middle
/// plane's, a millimetre or two away.
MaterialPoint BeamTracer::find_material(Walk& walk, const RegionAcoustics& region,
                                        const BeamRun& run) noexcept {
  if (walk.central != nullptr && region.course) {
    if (const BeamRun* const beside = walk.run_beside(run)) {
      MaterialPoint point = beside->middle;
      point.place += point.gradient * (run.rest_middle_J - beside->rest_middle_J);
      return point;
    }
  }
  return locate_in_material(region, run.rest_middle_J);
}

/// Adds a line's first knot, here.
void BeamTracer::begin_knots(Walk& walk) const noexcept {
  walk.has_knots = true;
  walk.line_knot = walk.trace.n_knots;
  walk.n_left_out = 0;
  if (walk.trace.guide != nullptr) {
    walk.add_knot_beside(*walk.knot_beside(walk.path), walk.path);
    return;
  }
  walk.rest_path.emplace(tissue_->body(), walk.line_start, walk.line_direction);
  KnotFrame frame;
  frame.rest = walk.rest_path->at(walk.along(walk.path), walk.displacement);
  frame.gradient_J = tissue_->at(frame.rest.rest_C, frame.rest.cell);
  walk.put_knot(walk.trace.n_knots++, frame);
}

/// Adds the one behind the last; where the guide has no more, at `path` or beyond.
void BeamTracer::add_knot(Walk& walk, double path) const noexcept {
  const std::size_t last = walk.trace.n_knots - 1;
  if (walk.trace.guide != nullptr) {
    const BeamKnot& before = walk.trace.knots[last];
    const BeamKnot* const beside = walk.knot_after(before.path);
    if (beside != nullptr) {
      walk.add_knot_beside(*beside, beside->path);
    } else {
      walk.add_knot_behind(before, std::max(path, before.path + kOnward));
    }
    return;
  }
  KnotFrame frame;
  frame.rest = walk.rest_path->next(walk.trace.frames[last].rest);
  frame.gradient_J = tissue_->at(frame.rest.rest_C, frame.rest.cell);
  walk.add_knot(frame);
}

/// Sees to knots from here, or from where they begin on this line, to `path` or beyond. False
/// where there is no room for them.
bool BeamTracer::place_knots(Walk& walk, double path) const noexcept {
  BeamTrace& trace = walk.trace;
  if (!walk.has_knots) {
    if (trace.n_knots + 2 > BeamTrace::kMaxKnots) return false;
    begin_knots(walk);
  }
  while (trace.knots[trace.n_knots - 1].path < path || trace.n_knots < walk.line_knot + 2) {
    if (trace.n_knots == BeamTrace::kMaxKnots) break;
    add_knot(walk, path);
  }
  return true;
}

/// Notes where the tissue along the run was at rest.
void BeamTracer::find_rest(Walk& walk, BeamRun& run) const noexcept {
  if (!place_knots(walk, run.path_end)) return;
  const BeamTrace& trace = walk.trace;
  run.first_knot = walk.knot_before(run.path_begin);
  double moved = 0;
  for (std::size_t k = run.first_knot; k < trace.n_knots; ++k)
    moved = std::max(moved, trace.knots[k].moved);
  if (!(moved > kStill)) return;
  run.n_knots = trace.n_knots - run.first_knot;
  const double middle = 0.5 * (run.path_begin + run.path_end);
  run.rest_middle_J = walk.rest_at(middle);
  walk.gradient = walk.gradient_at(middle);
}

/// Notes how the run lies to the fibres at its middle, `half_displacement` (m) from its begin.
/// Returns the factor on its attenuation.
double BeamTracer::follow_fibres(Walk& walk, const RegionAcoustics& region, BeamRun& run,
                                 const Vec3& half_displacement) const noexcept {
  run.along = 0;
  run.across = 1;
  run.n_knots = 0;
  run.has_middle = false;
  if (tissue_ != nullptr && walk.region >= kFirstRegion && region.backscatter > 0)
    find_rest(walk, run);
  const bool moved = run.n_knots > 0;
  switch (region.kind) {
    case TissueKind::fat:
    case TissueKind::muscle:
    case TissueKind::tendon:
    case TissueKind::nerve:
      break;
    default:
      return 1;
  }
  if (!moved) run.rest_middle_J = run.p_J + half_displacement;
  run.has_middle = true;
  run.middle = find_material(walk, region, run);
  const MaterialPoint& middle = run.middle;
  run.material = middle.place - middle.gradient * half_displacement;
  run.material_step = middle.gradient * run.step_J;
  const Vec3 sheet_at_rest = middle.gradient.row(0);
  const Vec3 sheet = moved ? carried_normal(walk.gradient, sheet_at_rest) : sheet_at_rest;
  run.across = std::abs(run.direction_J.dot(sheet)) / (sheet.norm() + kTiny);
  if (region.kind == TissueKind::fat || (!region.course && region.fibre.squaredNorm() < 0.5))
    return 1;
  const Vec3 fibre_at_rest = sheet_at_rest.cross(middle.gradient.row(1).transpose());
  const Vec3 fibre = moved ? Vec3(walk.gradient * fibre_at_rest) : fibre_at_rest;
  run.along = std::min(1.0, std::abs(run.direction_J.dot(fibre)) / (fibre.norm() + kTiny));
  return fibre_attenuation(region.kind, run.along);
}

/// Into how many runs a way of `length` (m) through the current region is cut: as many as a
/// neighbour's there, where that is nearly right.
int BeamTracer::cut(const Walk& walk, double length) noexcept {
  const int pieces = std::max(1, static_cast<int>(std::ceil(length / kPiece)));
  const std::size_t at = walk.trace.n_runs;
  if (walk.like == nullptr || at >= walk.like->n_runs) return pieces;
  const BeamRun& beside = walk.like->runs[at];
  const int wanted = beside.n_pieces;
  const bool fits = beside.region == walk.region && std::abs(wanted - pieces) <= 1 &&
                    length < kLongPiece * kPiece * wanted;
  return fits ? wanted : pieces;
}

/// Goes `length` (m of beam) through the current region from `point`. False when the sound ended.
bool BeamTracer::cross(Walk& walk, const Vec3& point, const Vec3& direction, double length,
                       double time_scale) const noexcept {
  walk.touched = walk.touched || walk.region >= kFirstRegion;
  const RegionAcoustics& region = regions_[walk.region];
  const double samples_per_m = kDisplaySpeedOfSound / region.speed / sample_depth_;
  const int pieces = cut(walk, length);
  const double piece = length / pieces;
  for (int j = 0; j < pieces; ++j) {
    if (walk.trace.n_runs == BeamTrace::kMax) return false;
    BeamRun& run = walk.trace.runs[walk.trace.n_runs++];
    run.begin = walk.sample;
    run.p_J = point + j * piece / time_scale * direction;
    run.step_J = direction / (time_scale * samples_per_m);
    run.direction_J = walk.wave;
    run.region = walk.region;
    run.n_pieces = static_cast<std::uint16_t>(pieces);
    run.log_gain_begin = walk.log_gain(spectrum_sigma_);
    run.path_begin = walk.path;
    run.lifted = walk.reached - walk.path;
    run.path_end = walk.path + piece;
    run.end = walk.sample + piece * samples_per_m;
    const double loss = follow_fibres(walk, region, run, 0.5 * piece / time_scale * direction);
    walk.path += piece;
    walk.reached += piece / time_scale;
    walk.sample = run.end;
    walk.attenuation += piece * region.attenuation * loss;
    walk.slope += piece * region.attenuation_slope * loss;
    run.log_gain_end = walk.log_gain(spectrum_sigma_);
    if (walk.sample >= n_samples_ || run.log_gain_end < kSilence) return false;
  }
  return true;
}

/// Goes through an interval, of which a flat skin takes the gel, or stretches the tissue.
bool BeamTracer::go(Walk& walk, const Vec3& point, const Vec3& direction, double thickness,
                    double time_scale) const noexcept {
  if (walk.gap == 0) return cross(walk, point, direction, thickness * time_scale, time_scale);
  if (walk.path == 0 && walk.region == kOutside) {
    const double gel = thickness * time_scale - walk.gap;
    walk.reached += walk.gap / time_scale;
    return gel < kThinnest || cross(walk, point, direction, gel, time_scale);
  }
  double stretched = 0;
  if (walk.path < walk.flat_to - kThinnest) {
    const double scale = kStretch * time_scale;
    stretched = std::min(thickness, (walk.flat_to - walk.path) / scale);
    if (!cross(walk, point, direction, stretched * scale, scale)) return false;
  }
  const double rest = thickness - stretched;
  return rest < kThinnest ||
         cross(walk, point + stretched * direction, direction, rest * time_scale, time_scale);
}

/// Follows one straight piece; `time_scale` is beam length per geometric length. Returns false when
/// the sound ended; a bend ends the piece early with walk.wave off `direction`.
bool BeamTracer::pass(Walk& walk, const Vec3& from, const Vec3& direction, double length,
                      double time_scale) const noexcept {
  auto& intervals = walk.trace.intervals;
  walk.begin_line(from, direction, time_scale);
  const QueryCount count =
      scene_->find_intervals({from, from + length * direction}, intervals, &walk.trace.planes);
  for (std::size_t k = 0; k < count.size; ++k) {
    const TissueInterval& interval = intervals[k];
    const double thickness = interval.exit - interval.entry;
    if (thickness < kThinnest) continue;
    const Vec3 point = from + interval.entry * direction;
    if (!walk.started) {
      if (!start(walk, interval.region, thickness * time_scale)) return false;
    } else if (interval.region != walk.region) {
      if (!enter(walk, interval, point)) return false;
      const double bend = walk.bends ? walk.wave.cross(direction).norm() : 0;
      if (bend > kStraight && bend * thickness > kSidewards) return true;
    }
    if (!go(walk, point, direction, thickness, time_scale)) return false;
  }
  return count.size > 0;
}

void BeamTracer::trace_bent(const Vec3& origin_J, const Vec3& direction_J, BeamTrace& trace,
                            BeamPath& path, const BeamTrace* guide,
                            const BeamTrace* like) const noexcept {
  trace.clear();
  if (tissue_ != nullptr) trace.frames.resize(BeamTrace::kMaxKnots);
  if (guide != nullptr && guide->n_knots > 0) trace.guide = guide;
  path.size = 0;
  Walk walk{trace, direction_J, direction_J, refraction_};
  walk.like = like;
  Vec3 point = origin_J;
  bool alive = true;
  while (alive && walk.path < max_path_ && path.size + 2 < BeamPath::kMax) {
    path.p_J[path.size] = point;
    path.length[path.size++] = walk.reached;
    const Vec3 direction = walk.wave;
    const double before = walk.reached;
    alive = pass(walk, point, direction, max_path_ - walk.path, 1);
    point += (walk.reached - before) * direction;
    if (walk.reached == before) break;
  }
  if (walk.reached < max_path_) point += (max_path_ - walk.reached) * walk.wave;
  path.p_J[path.size] = point;
  path.length[path.size++] = max_path_;
  trace.shadow_from = std::max(walk.sample, 0.0);
  add_repeats(trace);
}

void BeamTracer::trace_along(const BeamPath& path, const Vec3& elevation_axis_J,
                             const BeamTrace& central, BeamTrace& trace,
                             const BeamTrace* like) const noexcept {
  trace.clear();
  const auto without_elevation = [&](const Vec3& direction) {
    return Vec3((direction - elevation_axis_J * elevation_axis_J.dot(direction)).normalized());
  };
  const Vec3 straight = without_elevation(path.p_J[1] - path.p_J[0]);
  Walk walk{trace, straight, straight};
  walk.central = &central;
  trace.is_beside = true;
  walk.like = like;
  const BeamTrace& guide = central.guide != nullptr ? *central.guide : central;
  if (guide.n_knots > 0) trace.guide = &guide;
  if (tissue_ != nullptr && trace.guide == nullptr) trace.frames.resize(BeamTrace::kMaxKnots);
  bool alive = true;
  for (std::size_t i = 0; alive && i + 1 < path.size; ++i) {
    const Vec3 step = path.p_J[i + 1] - path.p_J[i];
    const double geometric = step.norm();
    const double beam = path.length[i + 1] - path.length[i];
    if (geometric <= 0 || beam <= 0) continue;
    walk.turn(without_elevation(step));
    alive = pass(walk, path.p_J[i], step / geometric, geometric, beam / geometric);
  }
  trace.shadow_from = walk.sample;
  add_repeats(trace);
}

/// First repeats: sound that went from the face to a strong interface and back twice.
void BeamTracer::add_repeats(BeamTrace& trace) const noexcept {
  trace.n_first = trace.n_echoes;
  if (!trace.contact || !reverberation_) return;
  const std::size_t n = trace.n_echoes;
  for (std::size_t i = 0; i < n && trace.n_echoes < BeamTrace::kMax; ++i) {
    BeamEcho repeat = trace.echoes[i];
    if (repeat.amplitude < kRepeatFrom || 2 * repeat.sample >= n_samples_) continue;
    repeat.sample *= 2;
    repeat.amplitude *= repeat.amplitude * kFaceReflection;
    trace.echoes[trace.n_echoes++] = repeat;
  }
}

}  // namespace artus
