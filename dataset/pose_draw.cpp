// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/dataset/pose_draw.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <utility>

#include "artus/core/noise.h"
#include "artus/core/text_file.h"
#include "artus/core/toml_table.h"
#include "artus/core/units.h"

namespace artus {
namespace {

/// Numbers for one frame; each has its place, so that a new one changes none of the others.
class Dice {
 public:
  Dice(std::uint64_t seed, std::size_t frame) : seed_(mix_bits(mix_bits(seed) ^ frame)) {}
  [[nodiscard]] double uniform(std::uint64_t place) const { return uniform_noise(seed_, place); }
  [[nodiscard]] double in(const DrawRange& range, std::uint64_t place) const {
    return range.low + (range.high - range.low) * uniform(place);
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
  kInPlane
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
    const auto n = static_cast<double>(plans.size());
    const PlannedInjection& plan = plans[static_cast<std::size_t>(dice.uniform(kWhich) * n)];
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

void read_range(TomlTable& table, std::string_view key, double unit, DrawRange& range) {
  if (!table.has(key)) return;
  const toml::array* pair = table.raw()[key].as_array();
  const auto at = [&](std::size_t i) {
    return pair != nullptr && pair->size() == 2 ? (*pair)[i].value<double>() : std::nullopt;
  };
  const auto low = at(0);
  const auto high = at(1);
  if (!low || !high || !std::isfinite(*low) || !std::isfinite(*high) || *low > *high)
    table.problem_at(key, "'" + std::string(key) + "' must be two numbers, [low, high]");
  else
    range = {*low * unit, *high * unit};
}

struct ShareKey {
  const char* key;
  double DrawRanges::*member;
};

struct RangeKey {
  const char* key;
  double unit;
  DrawRange DrawRanges::*member;
};

template <class Key>
bool is_known(std::string_view key, const std::vector<Key>& keys) {
  return std::any_of(keys.begin(), keys.end(), [key](const Key& k) { return key == k.key; });
}

/// Reads a table, whose keys are those of `keys` and `shares`.
void read_ranges(const toml::table& root, const char* name, const std::vector<RangeKey>& keys,
                 const std::vector<ShareKey>& shares, std::pair<DrawRanges&, Problems&> into) {
  const toml::table* found = root[name].as_table();
  if (found == nullptr) return;
  TomlTable table(*found, name, into.second);
  for (const auto& [key, node] : *found)
    if (!is_known(key.str(), keys) && !is_known(key.str(), shares))
      table.problem("unknown key '" + std::string(key.str()) + "'");
  for (const RangeKey& key : keys) read_range(table, key.key, key.unit, into.first.*key.member);
  for (const ShareKey& share : shares)
    if (const auto number = table.number(share.key, 0, 1)) into.first.*share.member = *number;
}

std::uint64_t mix(std::uint64_t hash, double value) {
  return mix_bits(hash ^ std::bit_cast<std::uint64_t>(value));
}

std::string digest_of(const DrawRanges& r, std::uint64_t seed, std::size_t count) {
  std::uint64_t hash = mix_bits(mix_bits(seed) ^ count);
  for (const DrawRange& range :
       {r.lateral, r.elevation, r.turn, r.tilt, r.rock, r.along, r.aside, r.slant})
    hash = mix(mix(hash, range.low), range.high);
  hash = mix(mix(hash, r.needle_share), r.in_plane_share);
  char text[24];
  std::snprintf(text, sizeof text, "drawn-%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace

Result<DrawRanges> parse_draw_ranges(std::string_view text, const std::string& name) {
  const auto parsed = parse_toml(text, name);
  ARTUS_TRY(parsed);
  DrawRanges ranges;
  Problems problems;
  for (const auto& [key, node] : *parsed)
    if ((key.str() != "probe" && key.str() != "needle") || !node.is_table())
      problems.add(node, "unknown key '" + std::string(key.str()) + "'; tables are probe, needle");
  read_ranges(*parsed, "probe",
              {{"lateral_mm", kMillimetre, &DrawRanges::lateral},
               {"elevation_mm", kMillimetre, &DrawRanges::elevation},
               {"turn_deg", kDegree, &DrawRanges::turn},
               {"tilt_deg", kDegree, &DrawRanges::tilt},
               {"rock_deg", kDegree, &DrawRanges::rock}},
              {}, {ranges, problems});
  read_ranges(*parsed, "needle",
              {{"along_mm", kMillimetre, &DrawRanges::along},
               {"aside_mm", kMillimetre, &DrawRanges::aside},
               {"slant_deg", kDegree, &DrawRanges::slant}},
              {{"share", &DrawRanges::needle_share}, {"in_plane", &DrawRanges::in_plane_share}},
              {ranges, problems});
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
  return ranges;
}

Result<DrawRanges> read_draw_ranges(const std::filesystem::path& file) {
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  return parse_draw_ranges(*text, file.string());
}

PoseSource drawn_poses(std::shared_ptr<const Scene> scene, const DrawRanges& ranges,
                       std::uint64_t seed, std::size_t count) {
  PoseSource source;
  source.count = count;
  source.digest = digest_of(ranges, seed, count);
  source.pose = [scene = std::move(scene), ranges, seed](std::size_t i) {
    const Dice dice(seed, i);
    ListedPose pose;
    pose.X_JP = draw_probe(*scene, ranges, dice);
    if (dice.uniform(kHasNeedle) < ranges.needle_share)
      pose.X_JN = draw_needle(scene->joint(), ranges, dice);
    if (pose.X_JN && dice.uniform(kInPlane) < ranges.in_plane_share)
      pose.X_JN = laid_in_plane(*pose.X_JN, pose.X_JP);
    return pose;
  };
  return source;
}

}  // namespace artus
