// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>

#include "artus/detail/anatomy/compile/check/misplaced.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr std::size_t kPosedPoints = 4000;      // of each bone
constexpr double kMostDepth = 1 * kMillimetre;  // that a pose may press bones farther together
constexpr double kDeepest = 30 * kMillimetre;   // depths are told no farther

/// How far points of one bone lie under the surface of another.
struct Depth {
  double depth = 0;  // m
  Vec3 at = Vec3::Zero();
};

class PoseCheck {
 public:
  PoseCheck(const JointFile& file, const PreparedSurfaces& surfaces)
      : file_(file), surfaces_(surfaces) {
    for (std::size_t i = 0; i < file.structures.size(); ++i)
      if (surfaces.structures[i] && is_hard(file.structures[i])) bones_.push_back(i);
  }

  std::vector<Finding> run() const {
    std::vector<Finding> found;
    for (const JointPose& pose : file_.poses) {
      std::string pairs;
      std::size_t n = 0;
      for (std::size_t a = 0; a < bones_.size(); ++a)
        for (std::size_t b = a + 1; b < bones_.size(); ++b) {
          const std::string text = look_at(pose, bones_[a], bones_[b]);
          if (text.empty()) continue;
          if (++n <= 3) pairs += (pairs.empty() ? "" : ", ") + text;
        }
      if (n == 0) continue;
      found.push_back({Verdict::refused, "pose", pose.name, 0,
                       pairs + "; turn or shift the bone less, or about an axis through another "
                               "point (the middle of its head)"});
    }
    return found;
  }

 private:
  [[nodiscard]] bool is_hard(const Structure& s) const {
    return std::any_of(file_.tissues.begin(), file_.tissues.end(),
                       [&](const Tissue& t) { return t.name == s.tissue && t.haptic.hard; });
  }

  static Pose motion_of(const JointPose& pose, const std::string& name) {
    for (const BoneMotion& motion : pose.motions)
      if (motion.structure == name) return motion.X_J;
    return Pose::Identity();
  }

  /// "'humerus' is pressed 6.2 mm into 'scapula' around (..) mm"; empty: they are not.
  [[nodiscard]] std::string look_at(const JointPose& pose, std::size_t a, std::size_t b) const {
    const Pose X_a = motion_of(pose, file_.structures[a].name);
    const Pose X_b = motion_of(pose, file_.structures[b].name);
    const Pose X_ba = X_b.inverse() * X_a;
    if (X_ba.isApprox(Pose::Identity(), 1e-12)) return {};
    Depth posed = depth_in(a, b, X_ba);
    posed.at = X_b * posed.at;
    Depth other = depth_in(b, a, X_ba.inverse());
    other.at = X_a * other.at;
    if (other.depth > posed.depth) posed = other;
    if (posed.depth <= kMostDepth) return {};
    const double rest =
        std::max(depth_in(a, b, Pose::Identity()).depth, depth_in(b, a, Pose::Identity()).depth);
    if (posed.depth <= rest + kMostDepth) return {};
    return printed(
        "'%s' is pressed %.1f mm into '%s' around (%.1f, %.1f, %.1f) mm, and %.1f mm at "
        "rest",
        file_.structures[a].name.c_str(), posed.depth / kMillimetre,
        file_.structures[b].name.c_str(), posed.at.x() / kMillimetre, posed.at.y() / kMillimetre,
        posed.at.z() / kMillimetre, rest / kMillimetre);
  }

  /// The deepest of the points of `a`, moved by X, in `b`; its place is in b's frame.
  [[nodiscard]] Depth depth_in(std::size_t a, std::size_t b, const Pose& X) const {
    const SurfaceMesh& mesh = surfaces_.structures[a]->mesh;
    const DistanceTree& tree = surfaces_.structures[b]->tree;
    Depth most;
    const std::size_t step = mesh.vertices.size() / kPosedPoints + 1;
    for (std::size_t i = 0; i < mesh.vertices.size(); i += step) {
      const Vec3 p = X * mesh.vertices[i];
      if ((p.array() < tree.lower().array()).any() || (p.array() > tree.upper().array()).any())
        continue;
      if (tree.winding_number(p) <= 0.5) continue;
      const double depth = tree.distance(p, kDeepest);
      if (depth > most.depth) most = {depth, p};
    }
    return most;
  }

  const JointFile& file_;
  const PreparedSurfaces& surfaces_;
  std::vector<std::size_t> bones_;
};

}  // namespace

std::vector<Finding> find_pressed_bones(const JointFile& file, const PreparedSurfaces& surfaces) {
  return PoseCheck(file, surfaces).run();
}

}  // namespace artus
