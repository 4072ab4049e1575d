// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/pose_draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/detail/echo/probe/placed_line.h"
#include "artus/echo/labels.h"

namespace artus {
namespace {

/// Numbers for one frame; each has its place, so that a new one changes none of the others.
class Dice {
 public:
  Dice(std::uint64_t seed, std::size_t frame) : seed_(mix_bits(mix_bits(seed) ^ frame)) {}
  /// The same frame's, thrown again; the first time as they were.
  [[nodiscard]] Dice again(std::uint64_t attempt) const {
    Dice other = *this;
    if (attempt > 0) other.seed_ = mix_bits(seed_ ^ mix_bits(attempt));
    return other;
  }
  [[nodiscard]] double uniform(std::uint64_t place) const { return uniform_noise(seed_, place); }
  [[nodiscard]] double in(const DrawRange& range, std::uint64_t place) const {
    return range.low + (range.high - range.low) * uniform(place);
  }
  /// One of `n`, each as likely.
  [[nodiscard]] std::size_t of(std::size_t n, std::uint64_t place) const {
    return static_cast<std::size_t>(uniform(place) * static_cast<double>(n));
  }

 private:
  std::uint64_t seed_;
};

enum Place : std::uint64_t {
  kLateral,
  kElevation,
  kTurn,
  kTilt,
  kRock,
  kHasNeedle,
  kWhich,
  kAlong,
  kAsideX,
  kAsideY,
  kSlantX,
  kSlantY,
  kInPlane,
  kPatient,
  kTransducer,
  kGauge,
  kLength,
  kEchogenic,
  kPresses,
  kPress,
  kTip,
  kNotIn,
  kOffset
};

/// Moves a probe along its beam until the middle of its face lies on the skin; where it looks past
/// the body it stays.
void set_on_skin(const Scene& scene, Pose& X_JP) {
  constexpr double kReach = 60e-3;  // m in front of and behind the drawn place
  const Vec3 beam = X_JP.linear().col(2);
  const Vec3 p = X_JP.translation();
  std::array<Crossing, 64> crossings;
  const QueryCount found = scene.find_crossings({p - kReach * beam, p + kReach * beam}, crossings);
  for (std::size_t i = 0; i < found.size; ++i)
    if (crossings[i].from == kOutside) {
      X_JP.translation() = p + (crossings[i].depth - kReach) * beam;
      return;
    }
}

Pose draw_probe(const Scene& scene, const DrawRanges& ranges, const Dice& dice) {
  Pose X_JP = scene.joint().X_JP_default;
  X_JP.translate(Vec3(dice.in(ranges.lateral, kLateral), dice.in(ranges.elevation, kElevation), 0));
  X_JP.rotate(Eigen::AngleAxisd(dice.in(ranges.turn, kTurn), Vec3::UnitZ()));
  X_JP.rotate(Eigen::AngleAxisd(dice.in(ranges.tilt, kTilt), Vec3::UnitX()));
  X_JP.rotate(Eigen::AngleAxisd(dice.in(ranges.rock, kRock), Vec3::UnitY()));
  set_on_skin(scene, X_JP);
  return X_JP;
}

Pose draw_needle(const CompiledJoint& joint, const DrawRanges& ranges, const Dice& dice) {
  Pose X_JN = joint.X_JN_default;
  if (const auto& plans = joint.injections; !plans.empty()) {
    const PlannedInjection& plan = plans[dice.of(plans.size(), kWhich)];
    X_JN = make_pose(plan.target, plan.target - plan.entry, joint.X_JP_default.linear().col(1));
  }
  X_JN.translate(Vec3(dice.in(ranges.aside, kAsideX), dice.in(ranges.aside, kAsideY),
                      dice.in(ranges.along, kAlong)));
  X_JN.rotate(Eigen::AngleAxisd(dice.in(ranges.slant, kSlantX), Vec3::UnitX()));
  X_JN.rotate(Eigen::AngleAxisd(dice.in(ranges.slant, kSlantY), Vec3::UnitY()));
  return X_JN;
}

/// The needle laid into the probe's plane y = 0, tip and direction; where it stands across the
/// plane it stays.
Pose laid_in_plane(const Pose& X_JN, const Pose& X_JP) {
  constexpr double kAcross = 0.05;  // of a needle's direction that must lie in the plane
  Pose X_PN = X_JP.inverse() * X_JN;
  Vec3 axis = X_PN.linear().col(2);
  axis.y() = 0;
  if (axis.norm() < kAcross) return X_JN;
  Vec3 tip = X_PN.translation();
  tip.y() = 0;
  return X_JP * make_pose(tip, axis, Vec3::UnitY());
}

NeedleShape draw_shape(const NeedleShape& own, const DrawRanges& ranges, const Dice& dice) {
  NeedleShape shape = own;
  if (!ranges.gauges.empty())
    shape = *needle_of_gauge(ranges.gauges[dice.of(ranges.gauges.size(), kGauge)]);
  shape.length = ranges.length ? dice.in(*ranges.length, kLength) : own.length;
  shape.echogenic =
      ranges.echogenic_share ? dice.uniform(kEchogenic) < *ranges.echogenic_share : own.echogenic;
  return shape;
}

/// A probe's picture: what can be in it.
class PictureFrame {
 public:
  PictureFrame(const Transducer& transducer, const ImageSettings& settings)
      : transducer_(transducer), labels_(transducer, settings), gel_limit_(settings.gel_limit) {}

  [[nodiscard]] double half_slice(double depth) const { return labels_.half_slice(depth); }
  [[nodiscard]] bool shows(const NeedleView& needle, const Pose& X_JP) const {
    const NeedleTruth truth = labels_.locate(needle, X_JP);
    return truth.in_picture && truth.in_slice;
  }
  /// Whether sound comes straight to a tip that the picture shows.
  [[nodiscard]] bool reaches(const Scene& scene, const std::vector<bool>& opaque, const Pose& X_JP,
                             const Vec3& tip_P) const {
    const ScanConverter& converter = labels_.converter();
    const PixelPoint at = converter.pixel_of(tip_P);
    const int line =
        converter.line_at(static_cast<int>(std::round(at.x)), static_cast<int>(std::round(at.y)))
            .line;
    const Vec3 face = place_line(transducer_, line, X_JP).origin_J;
    std::array<TissueInterval, kMostIntervals> intervals;
    const QueryCount found = scene.find_intervals({face, X_JP * tip_P}, intervals);
    for (std::size_t k = 0; k < found.size; ++k) {
      const TissueInterval& piece = intervals[k];
      if (piece.region < kFirstRegion && (k > 0 || piece.exit - piece.entry > gel_limit_))
        return false;
      if (opaque[piece.region]) return false;
    }
    return true;
  }

  static constexpr std::size_t kMostIntervals = 128;

 private:
  Transducer transducer_;
  LabelRenderer labels_;
  double gel_limit_;
};

/// By region, whether `names` has its structure or its tissue.
std::vector<bool> named_regions(const CompiledJoint& joint, std::span<const std::string> names) {
  std::vector<bool> named(joint.regions.size());
  for (std::size_t r = 0; r < named.size(); ++r)
    for (const std::string& name : names)
      named[r] = named[r] || joint.regions[r].name == name ||
                 joint.tissue_of(static_cast<RegionId>(r)).name == name;
  return named;
}

std::vector<bool> opaque_regions(const CompiledJoint& joint) {
  std::vector<bool> opaque;
  for (const RegionAcoustics& region : make_region_acoustics(joint, Transducer{}))
    opaque.push_back(region.opaque);
  return opaque;
}

bool passes(const Scene& scene, const Pose& X_JN, double length, const std::vector<bool>& barred) {
  std::array<TissueInterval, PictureFrame::kMostIntervals> intervals;
  const Vec3 tip = X_JN.translation();
  const QueryCount found =
      scene.find_intervals({tip - length * X_JN.linear().col(2), tip}, intervals);
  for (std::size_t k = 0; k < found.size; ++k)
    if (barred[intervals[k].region]) return true;
  return barred[scene.region_at(tip)];
}

/// Everything that a draw needs, made once.
struct DrawTables {
  DrawBase base;
  DrawRanges ranges;
  std::uint64_t seed = 0;
  std::vector<PictureFrame> pictures;     // by transducer
  std::vector<std::vector<bool>> barred;  // by patient and region
  std::vector<std::vector<bool>> opaque;  // likewise
};

/// One throw of probe and needle; false: the needle may not be there.
bool throw_needle(const DrawTables& tables, const Dice& first, const Dice& dice,
                  FrameOrder& frame) {
  const DrawRanges& ranges = tables.ranges;
  const Scene& scene = *tables.base.patients[frame.patient];
  const PictureFrame& picture = tables.pictures[std::max<std::size_t>(frame.transducer, 1) - 1];
  frame.X_JP = draw_probe(scene, ranges, dice);
  Pose X_JN = draw_needle(scene.joint(), ranges, dice);
  const bool shown = ranges.tip != TipPlace::anywhere && first.uniform(kTip) < ranges.tip_share;
  if (first.uniform(kInPlane) < ranges.in_plane_share) {
    X_JN = laid_in_plane(X_JN, frame.X_JP);
  } else if (shown) {
    Vec3 tip = frame.X_JP.inverse() * X_JN.translation();
    tip.y() = (2 * dice.uniform(kOffset) - 1) * picture.half_slice(tip.z());
    X_JN.translation() = frame.X_JP * tip;
  }
  frame.X_JN = X_JN;
  frame.needle = draw_shape(tables.base.needle, ranges, first);
  const Vec3 tip = frame.X_JP.inverse() * X_JN.translation();
  if (shown && !picture.shows({X_JN, *frame.needle}, frame.X_JP)) return false;
  if (shown && ranges.tip == TipPlace::visible &&
      !picture.reaches(scene, tables.opaque[frame.patient], frame.X_JP, tip))
    return false;
  return !(first.uniform(kNotIn) < ranges.not_in_share &&
           passes(scene, X_JN, frame.needle->length, tables.barred[frame.patient]));
}

FrameOrder draw_frame(const DrawTables& tables, std::size_t i) {
  constexpr std::uint64_t kAttempts = 200;
  const DrawRanges& ranges = tables.ranges;
  const Dice dice(tables.seed, i);
  FrameOrder frame;
  frame.patient = dice.of(tables.base.patients.size(), kPatient);
  if (!ranges.transducers.empty())
    frame.transducer = 1 + dice.of(ranges.transducers.size(), kTransducer);
  if (dice.uniform(kPresses) < ranges.press_share)
    frame.press = dice.in(ranges.press_depth, kPress);
  if (dice.uniform(kHasNeedle) < ranges.needle_share)
    for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt)
      if (throw_needle(tables, dice, dice.again(attempt), frame)) return frame;
  frame.X_JN.reset();
  frame.needle.reset();
  frame.X_JP = draw_probe(*tables.base.patients[frame.patient], ranges, dice);
  return frame;
}

}  // namespace

std::vector<std::string> unknown_places(const DrawBase& base, const DrawRanges& ranges) {
  std::vector<std::string> unknown;
  for (const std::string& name : ranges.not_in) {
    const auto has = [&](const std::shared_ptr<const Scene>& patient) {
      const auto named = named_regions(patient->joint(), std::span(&name, 1));
      return std::find(named.begin(), named.end(), true) != named.end();
    };
    if (std::none_of(base.patients.begin(), base.patients.end(), has)) unknown.push_back(name);
  }
  return unknown;
}

FrameSource drawn_frames(const DrawBase& base, const DrawRanges& ranges, std::uint64_t seed,
                         std::size_t count) {
  FrameSource source;
  source.count = count;
  source.digest =
      "drawn-" + in_hexadecimal(mix_bits(mix_bits(mix_bits(seed) ^ count) ^ hash_of(ranges)));
  const auto tables = std::make_shared<DrawTables>(DrawTables{base, ranges, seed, {}, {}, {}});
  for (const Transducer& transducer : base.transducers)
    tables->pictures.emplace_back(transducer, base.settings);
  for (const auto& patient : base.patients) {
    tables->barred.push_back(named_regions(patient->joint(), ranges.not_in));
    tables->opaque.push_back(opaque_regions(patient->joint()));
  }
  source.frame = [tables = std::shared_ptr<const DrawTables>(tables)](std::size_t i) {
    return draw_frame(*tables, i);
  };
  return source;
}

}  // namespace artus
