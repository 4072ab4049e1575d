// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/assumed_structures.h"

#include <algorithm>

#include "artus/detail/anatomy/import/nearest_bones.h"
#include "artus/detail/core/known_names.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

// All assumed: what a segmentation lacks has no measure there.
constexpr double kCartilage = 1.5 * kMillimetre;
constexpr double kFacing = 8 * kMillimetre;    // bones that a joint is between
constexpr double kTouching = 2 * kMillimetre;  // cartilage and its bone, between samples
constexpr double kRecess = 1.0 * kMillimetre;
constexpr double kRecessWithin = 8 * kMillimetre;
constexpr double kAttached = 5 * kMillimetre;  // a muscle that a bone holds
constexpr double kTendon = 20 * kMillimetre;
constexpr double kBursa = 1.5 * kMillimetre;
constexpr double kBursaWithin = 4 * kMillimetre;
constexpr double kGapRadius = 40 * kMillimetre;  // around where its walls are nearest

std::string in_mm(double length) {
  return printed("%.3g", length / kMillimetre);
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "\"" : ", \"") + name + "\"";
  return "[" + out + "]";
}

/// The joint and what is being added to it.
class Assumer {
 public:
  explicit Assumer(ImportedJoint& joint) : joint_(joint), samples_(sample_structures(joint)) {}

  Result<void> add_recess(const std::vector<std::string>& between) {
    const auto pair = find_joint_bones(joint_, between, samples_);
    ARTUS_TRY(pair);
    if (!*pair)
      return fail(ErrorCode::not_found,
                  "no two bones are near each other; --between says between which there is one",
                  "--assume recess");
    const auto& [a, b] = **pair;
    // Of the joint's fluid, so that it takes liquid as a joint does and not as a bursa.
    add(unused("joint_recess"), "synovial_fluid",
        gap(a, b, {with_cartilage(a), with_cartilage(b)}, kRecess, kRecessWithin),
        "a recess of " + in_mm(kRecess) + " mm between '" + name(a) + "' and '" + name(b) + "'");
    return {};
  }

  Result<void> add_cartilage() {
    const std::size_t before = joint_.made.size();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (!is(i, "bone") || with_cartilage(i).size() > 1) continue;
      std::vector<std::string> facing;
      for (std::size_t k = 0; k < samples_.size(); ++k)
        if (k != i && is(k, "bone") && distance(i, k) < kFacing) facing.push_back(name(k));
      if (facing.empty()) continue;
      add(unused(name(i) + "_cartilage"), "cartilage",
          "cap = { on = \"" + name(i) + "\", near = " + quoted_list(facing) +
              ", within = " + in_mm(kFacing) + ", thickness = " + in_mm(kCartilage) + " }",
          "cartilage of " + in_mm(kCartilage) + " mm on '" + name(i) + "' where a bone faces it");
    }
    if (joint_.made.size() > before) return {};
    return fail(ErrorCode::not_found,
                "no two bones without cartilage are within " + in_mm(kFacing) + " mm of each other",
                "--assume cartilage");
  }

  Result<void> add_tendons() {
    const std::size_t before = joint_.made.size();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (!is(i, "muscle") || joint_.structures[i].is_swept || has_tendon(i)) continue;
      std::size_t bone = i;
      double least = kAttached;
      for (std::size_t k = 0; k < samples_.size(); ++k)
        if (is(k, "bone") && distance(i, k) < least) {
          least = distance(i, k);
          bone = k;
        }
      if (bone == i) continue;
      add(unused(name(i) + "_tendon"), "tendon",
          "end = { of = \"" + name(i) + "\", toward = \"" + name(bone) +
              "\", within = " + in_mm(kTendon) + " }",
          "a tendon, the last " + in_mm(kTendon) + " mm of '" + name(i) + "' at '" + name(bone) +
              "'");
    }
    if (joint_.made.size() > before) return {};
    return fail(ErrorCode::not_found,
                "no muscle without a tendon is within " + in_mm(kAttached) + " mm of a bone",
                "--assume tendons");
  }

  Result<void> add_bursa(const std::vector<std::string>& walls) {
    const auto names = item_names(joint_.structures);
    std::array<std::vector<std::string>, 2> sides;
    std::array<std::size_t, 2> places{};
    bool has_hard = false;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto at = find_name(names, walls[k], "structure", "--bursa");
      ARTUS_TRY(at);
      sides.at(k) = {name(*at)};
      places.at(k) = *at;
      if (keeps_shape(*at))
        has_hard = true;
      else
        soft_walls_.push_back(name(*at));
    }
    // It lies half in each wall where they touch, and a hard one gives nothing.
    add(unused(walls[0] + "_" + walls[1] + "_bursa"), "bursa",
        gap(places[0], places[1], sides, has_hard ? 2 * kBursa : kBursa, kBursaWithin),
        "a bursa of " + in_mm(kBursa) + " mm between '" + walls[0] + "' and '" + walls[1] + "'");
    return {};
  }

  /// What was added stands behind what keeps its shape and before the soft walls of bursae.
  void place() {
    const auto is_before = [&](const ImportedStructure& s) {
      return std::find(soft_walls_.begin(), soft_walls_.end(), s.name) == soft_walls_.end();
    };
    std::stable_partition(joint_.structures.begin(), joint_.structures.end(), is_before);
    joint_.n_before_made = static_cast<std::size_t>(
        std::count_if(joint_.structures.begin(), joint_.structures.end(), is_before));
  }

 private:
  [[nodiscard]] const std::string& name(std::size_t i) const { return joint_.structures[i].name; }
  [[nodiscard]] bool is(std::size_t i, const char* tissue) const {
    return joint_.structures[i].tissue == tissue;
  }
  [[nodiscard]] bool keeps_shape(std::size_t i) const {
    return is(i, "bone") || is(i, "cartilage") || is(i, "labrum");
  }
  [[nodiscard]] double distance(std::size_t a, std::size_t b) const {
    if (are_apart(samples_[a], samples_[b], kTendon))
      return std::numeric_limits<double>::infinity();
    return nearest_of(samples_[a], samples_[b]).distance;
  }
  /// A bone and the segmented cartilages that lie nearer to it than to any other bone.
  [[nodiscard]] std::vector<std::string> with_cartilage(std::size_t bone) const {
    std::vector<std::string> names{name(bone)};
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (!is(i, "cartilage")) continue;
      const double mine = distance(i, bone);
      bool is_mine = mine < kTouching;
      for (std::size_t k = 0; k < samples_.size() && is_mine; ++k)
        is_mine = k == bone || !is(k, "bone") || mine <= distance(i, k);
      if (is_mine) names.push_back(name(i));
    }
    return names;
  }
  [[nodiscard]] bool has_tendon(std::size_t muscle) const {
    for (std::size_t i = 0; i < samples_.size(); ++i)
      if (is(i, "tendon") && name(i).find(name(muscle)) != std::string::npos) return true;
    return false;
  }
  /// A gap around where two structures are nearest.
  [[nodiscard]] std::string gap(std::size_t a, std::size_t b,
                                const std::array<std::vector<std::string>, 2>& walls,
                                double thickness, double within) const {
    const Vec3 centre = nearest_of(samples_[a], samples_[b]).centre / kMillimetre;
    return "gap = { roof = " + quoted_list(walls[0]) + ", floor = " + quoted_list(walls[1]) +
           ", thickness = " + in_mm(thickness) + ", within = " + in_mm(within) +
           printed(", centre = [%.1f, %.1f, %.1f]", centre.x(), centre.y(), centre.z()) +
           ", radius = " + in_mm(kGapRadius) + " }";
  }
  [[nodiscard]] std::string unused(const std::string& wanted) const {
    const auto is_taken = [&](const std::string& candidate) {
      const auto is_same = [&](const auto& s) {
        return s.name == candidate;
      };
      return std::any_of(joint_.structures.begin(), joint_.structures.end(), is_same) ||
             std::any_of(joint_.made.begin(), joint_.made.end(), is_same);
    };
    std::string free = wanted;
    for (int k = 2; is_taken(free); ++k) free = wanted + "_" + std::to_string(k);
    return free;
  }
  void add(std::string made, std::string tissue, std::string shape, const std::string& what) {
    joint_.assumed.push_back("'" + made + "': " + what);
    joint_.made.push_back({std::move(made), std::move(tissue), std::move(shape)});
  }

  ImportedJoint& joint_;
  std::vector<SurfaceSamples> samples_;
  std::vector<std::string> soft_walls_;
};

}  // namespace

Result<void> add_assumed(ImportedJoint& joint, const ImportOptions& options) {
  for (const std::string& what : options.assume)
    ARTUS_TRY(find_name(kAssumable, what, "structure that can be assumed", "--assume"));
  const auto is_asked = [&](std::string_view what) {
    return std::find(options.assume.begin(), options.assume.end(), what) != options.assume.end();
  };
  if (options.assume.empty() && options.bursa.size() != 2) return {};
  Assumer assumer(joint);
  // A recess comes before the cartilage that is assumed on both sides of it.
  if (is_asked("recess")) ARTUS_TRY(assumer.add_recess(options.between));
  if (is_asked("cartilage")) ARTUS_TRY(assumer.add_cartilage());
  if (options.bursa.size() == 2) ARTUS_TRY(assumer.add_bursa(options.bursa));
  if (is_asked("tendons")) ARTUS_TRY(assumer.add_tendons());
  assumer.place();
  return {};
}

}  // namespace artus
