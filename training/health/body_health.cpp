// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/body_health.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <nlohmann/json.hpp>

#include "artus/detail/core/check.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/training/health/beam_walls.h"
#include "artus/detail/training/health/body_shape.h"
#include "artus/detail/training/health/label_pieces.h"
#include "artus/detail/training/health/picture_strips.h"
#include "artus/echo/renderer.h"

namespace artus {
namespace {

constexpr double kWallJump = 0.5;        // mm
constexpr double kLiftShare = 1.5;       // of the liquid, what the skin may be lifted by; assumed:
                                         // where a stiff tendon turns, skin sinks beside it
constexpr double kRayVolume = 0.01e-6;   // m^3 that rays so far from each other may miss
constexpr double kLiftRest = 0.1e-6;     // m^3 beside that: steps of rays, the press
constexpr double kVolume = 2;            // %
constexpr double kStrips = 2;            // %
constexpr std::size_t kRays = 20000;     // through the liquid
constexpr double kMinPiece = 1e-6;       // m^2
constexpr double kLabelPixel = 0.05e-3;  // m
constexpr double kMargin = 10e-3;        // m of label picture around what is shown
constexpr double kAbove = 25e-3;         // m of it above the face
constexpr double kAside = 3e-3;          // m that liquid moves tissue across the picture's plane
constexpr double kMinLiquid = 0.05e-6;   // m^3, of less no share is told

std::string place(const Vec3& p_J) {
  return printed("%.1f, %.1f, %.1f mm", p_J.x() / kMillimetre, p_J.y() / kMillimetre,
                 p_J.z() / kMillimetre);
}

/// Everything that the measures share.
class Examination {
 public:
  explicit Examination(const HealthQuestion& question)
      : q_(question),
        was_(body_in(*q_.before)),
        now_(body_in(*q_.after)),
        liquid_before_(regions_named(q_.before->joint(), q_.liquid.regions)),
        liquid_after_(regions_named(now_, q_.liquid.regions)) {}

  [[nodiscard]] HealthMeasure finite() const {
    HealthMeasure m{"not_finite", "coordinates that are not finite", "", {}, 0, ""};
    m.value = static_cast<double>(count_not_finite(now_.mesh.vertices));
    return m;
  }

  [[nodiscard]] HealthMeasure inverted() const {
    HealthMeasure m{"inverted", "inverted tetrahedra", "", {}, 0, ""};
    const LeastRatio least = find_least_ratio(q_.before->joint().mesh, now_.mesh, liquid_before_);
    if (least.compared == 0) return m;
    const auto counts = [this](std::size_t i) {
      return !q_.after->tissue() || is_tissue_inverted(*q_.after->tissue(), i);
    };
    m.value =
        static_cast<double>(std::count_if(least.inverted.begin(), least.inverted.end(), counts));
    m.where = printed("least volume %.3f of that at rest in ", least.ratio) +
              now_.regions[least.region].name + " at " + place(least.p_J);
    return m;
  }

  [[nodiscard]] HealthMeasure walls() const {
    HealthMeasure m{
        "wall_jump_mm", "a space's wall jumps from beam to beam by", "mm", {}, kWallJump, ""};
    if (!has_liquid()) return m;
    const double depth = q_.settings.depth + kMargin;
    // What parts tissue is many streaks with blunt ends: only spaces have walls.
    const auto in = [&](const Scene& scene, std::vector<bool> regions) {
      for (std::size_t r = 0; r < regions.size(); ++r)
        if (scene.joint().regions[r].name == "injected") regions[r] = false;
      return find_walls(scene, q_.X_JP, q_.transducer, depth, regions);
    };
    const SliceWall wall(was_.mesh, now_.mesh, liquid_after_, q_.X_JP, q_.transducer);
    const WallJump jump =
        find_wall_jump(in(*q_.before, liquid_before_), in(*q_.after, liquid_after_), &wall);
    m.value = jump.jump / kMillimetre;
    m.where = printed("%.1f mm from the picture's left edge",
                      static_cast<double>(jump.beam) * kBeamSpacing / kMillimetre);
    return m;
  }

  [[nodiscard]] HealthMeasure skin() const {
    HealthMeasure m{"skin_lift_ml", "the skin is lifted by", "ml", {}, 0, ""};
    m.limit = (kLiftShare * q_.liquid.volume + kLiftRest) / kCubicCentimetre;
    if (!has_liquid()) return m;
    const SkinLift lift = find_skin_lift(was_.mesh, now_.mesh, q_.liquid.p_J);
    m.value = lift.lifted / kCubicCentimetre;
    m.where = printed("at most by %.1f mm at ", lift.highest / kMillimetre) + place(lift.p_J);
    return m;
  }

  [[nodiscard]] HealthMeasure volume() const {
    HealthMeasure m{"volume_error_percent",
                    "liquid that rays find differs from what was given by",
                    "%",
                    {},
                    kVolume,
                    ""};
    if (!has_liquid() || q_.liquid.volume < kMinLiquid) return m;
    std::vector<Vec3> points = points_of(now_, liquid_after_);
    if (points.empty()) return m;
    const std::vector<Vec3> rest = points_of(was_, liquid_before_);
    points.insert(points.end(), rest.begin(), rest.end());
    const RayGrid grid = grid_around(points, q_.X_JP.linear(), kRays);
    const double found = volume_along(*q_.after, grid, liquid_after_) -
                         volume_along(*q_.before, grid, liquid_before_);
    const double off = std::max(0.0, std::abs(found - q_.liquid.volume) - kRayVolume);
    m.value = 100 * off / q_.liquid.volume;
    m.where =
        printed("%.3f of %.3f ml", found / kCubicCentimetre, q_.liquid.volume / kCubicCentimetre);
    return m;
  }

  [[nodiscard]] LayoutChange layout() const {
    Transducer wide = q_.transducer;
    ImageSettings settings = q_.settings;
    settings.pixel = kLabelPixel;
    settings.depth += kAbove + kMargin;
    Pose X_JP = q_.X_JP;  // skin that rises past the face is seen
    X_JP.translation() -= kAbove * X_JP.linear().col(2);
    const double margin = wide.radius == 0 ? kMargin : 0;
    wide.width += 2 * margin;
    const LabelRenderer renderer(wide, settings);
    const auto labels_of = [&](const Scene& scene, const std::vector<bool>& liquid, double aside) {
      Pose X_JS = X_JP;
      X_JS.translation() += aside * X_JP.linear().col(1);
      LabelImage labels = renderer.render(scene, X_JS);
      const std::vector<std::string> injected{"injected"};
      join_liquid(labels, liquid, regions_named(scene.joint(), injected));
      return labels;
    };
    const auto shown_in = [&](const LabelImage& labels) {
      const auto pixels = static_cast<int>(margin / kLabelPixel);
      const auto deep = static_cast<int>(kMargin / kLabelPixel);
      return find_layout(labels, {pixels, labels.width - pixels, 0, labels.height - deep},
                         kMinPiece);
    };
    RegionLayout before;
    for (const double aside : {-kAside, 0.0, kAside}) {
      const LabelImage labels = labels_of(*q_.before, liquid_before_, aside);
      before.add(shown_in(labels));
      // Those that touch below or beside the picture may be moved into it.
      before.add_contacts(find_layout(labels, {0, labels.width, 0, labels.height}, kMinPiece));
    }
    const RegionLayout after = shown_in(labels_of(*q_.after, liquid_after_, 0));
    return compare_layouts(before, after, now_, regions_named(now_, q_.liquid.parted));
  }

  [[nodiscard]] HealthMeasure strips() const {
    HealthMeasure m{"strips_percent",
                    "share of the picture in vertical strips, more than before",
                    "%",
                    {},
                    kStrips,
                    ""};
    if (!q_.pictures) return m;
    const auto share = [&](const std::shared_ptr<const Scene>& scene) {
      Renderer renderer(scene, q_.transducer, q_.settings);
      return 100 * share_of_strips(renderer.render(q_.X_JP), q_.transducer.pitch());
    };
    const double was = share(q_.before);
    const double is = share(q_.after);
    m.value = std::max(0.0, is - was);
    m.where = printed("%.2f %% before, %.2f %% after", was, is);
    return m;
  }

 private:
  [[nodiscard]] bool has_liquid() const { return q_.liquid.volume > 0; }

  const HealthQuestion& q_;
  CompiledJoint was_;  // under the same press
  CompiledJoint now_;
  std::vector<bool> liquid_before_;
  std::vector<bool> liquid_after_;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

bool BodyHealth::sound() const noexcept {
  return std::all_of(measures.begin(), measures.end(),
                     [](const HealthMeasure& m) { return m.holds(); });
}

const HealthMeasure& BodyHealth::at(std::string_view key) const {
  const auto found = std::find_if(measures.begin(), measures.end(),
                                  [key](const HealthMeasure& m) { return m.key == key; });
  ARTUS_REQUIRE(found != measures.end(), "a measure of that key");
  return *found;
}

BodyHealth measure_body_health(const HealthQuestion& question) {
  const auto start = std::chrono::steady_clock::now();
  const Examination examination(question);
  BodyHealth health;
  health.measures = {examination.finite(), examination.inverted(), examination.walls(),
                     examination.skin(), examination.volume()};
  const LayoutChange layout = examination.layout();
  health.measures.push_back({"fragments", "pieces of structures more than before", "",
                             static_cast<double>(layout.fragments), 0, layout.which_fragments});
  health.measures.push_back({"new_neighbours", "structures that touch and did not before", "",
                             static_cast<double>(layout.neighbours), 0, layout.which_neighbours});
  health.measures.push_back(examination.strips());
  health.seconds = seconds_since(start);
  return health;
}

std::string to_text(const BodyHealth& health) {
  std::string text;
  for (const HealthMeasure& m : health.measures) {
    text += m.holds() ? (m.value ? "holds  " : "-      ") : "FAILS  ";
    text += m.name;
    if (m.value) text += printed(": %.3g", *m.value) + (m.unit.empty() ? "" : " " + m.unit);
    text += printed(" (at most %.3g)", m.limit);
    if (m.value && !m.where.empty()) text += "; " + m.where;
    text += '\n';
  }
  return text;
}

nlohmann::json to_json(const BodyHealth& health) {
  auto measures = nlohmann::json::object();
  for (const HealthMeasure& m : health.measures)
    measures[m.key] = {
        {"name", m.name},     {"value", m.value ? nlohmann::json(*m.value) : nlohmann::json()},
        {"unit", m.unit},     {"limit", m.limit},
        {"holds", m.holds()}, {"where", m.where}};
  return {{"sound", health.sound()}, {"seconds", health.seconds}, {"measures", measures}};
}

}  // namespace artus
