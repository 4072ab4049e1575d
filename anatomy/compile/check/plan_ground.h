// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/compile/labels/compile_surfaces.h"

namespace artus {

/// A stretch of a line in one layer; m from the line's start.
struct LineLayer {
  std::string name;  ///< of the region; "outside" before the skin, "beyond" the region of interest
  std::string tissue;
  bool hard = false;
  double entry = 0;
  double exit = 0;
};

/// A bone as something that can be in a needle's path.
struct HardPart {
  std::string name;
  DistanceTree tree{SurfaceMesh{}};
};

/// A tree that is made when it is first asked for, since a joint without plans needs none and a
/// skin's is large. Copies share it. Not for threads.
class TreeWhenAsked {
 public:
  TreeWhenAsked() : TreeWhenAsked([] { return SurfaceMesh{}; }) {}
  explicit TreeWhenAsked(std::function<SurfaceMesh()> surface)
      : made_(std::make_shared<Made>(Made{std::move(surface), std::nullopt})) {}
  explicit TreeWhenAsked(const DistanceTree& tree)
      : made_(std::make_shared<Made>(Made{nullptr, tree})) {}

  [[nodiscard]] const DistanceTree& get() const {
    if (!made_->tree) made_->tree.emplace(made_->surface());
    return *made_->tree;
  }

 private:
  struct Made {
    std::function<SurfaceMesh()> surface;
    std::optional<DistanceTree> tree;
  };
  std::shared_ptr<Made> made_;
};

/// What poses and injections are checked against: a joint's repaired surfaces before anything is
/// compiled, or the compiled body.
struct PlanGround {
  SurfaceMesh skin;                  ///< where something can stand: skin in the region
  DistanceTree hull{SurfaceMesh{}};  ///< of all that is meshed, closed
  TreeWhenAsked skin_tree;
  TreeWhenAsked cut_tree;  ///< where the body's surface was cut and closed
  std::vector<HardPart> bones;
  std::optional<RegionOfInterest> region;
  bool is_compiled = false;  ///< constructs are among the layers
  std::function<std::vector<LineLayer>(const Segment&)> layers;
  /// The point of `skin` nearest to another; none where there is no skin.
  std::function<std::optional<Vec3>(const Vec3&)> nearest_skin;
  /// The same of all skin, in the region or not; of a compiled body what is meshed of it.
  std::function<std::optional<Vec3>(const Vec3&)> nearest_any_skin;

  /// Signed distance to the skin, m: negative inside. Cost: log n.
  [[nodiscard]] double skin_distance(const Vec3& p) const;
  /// How far from `p` along the unit `direction` skin is met, the nearest to `p` within +-`reach`.
  /// Cost: linear in triangles of skin.
  [[nodiscard]] std::optional<double> skin_along(const Vec3& p, const Vec3& direction,
                                                 double reach) const;
  /// The first bone on the path from `from` to `to`, but for one that holds `to` itself.
  [[nodiscard]] const HardPart* bone_between(const Vec3& from, const Vec3& to) const;
  [[nodiscard]] bool in_region(const Vec3& p) const;
};

/// The ground of surfaces: layers are surfaces in the file's order and the filler; of constructs
/// shells of the body alone are known. Lines are sampled every 0.2 mm. Requires: `surfaces` of
/// `file`, alive as long as the ground.
[[nodiscard]] PlanGround make_ground(const JointFile& file, const PreparedSurfaces& surfaces);

/// The ground of a compiled body, exact. Requires: `joint` alive as long as the ground.
[[nodiscard]] PlanGround make_ground(const CompiledJoint& joint,
                                     const std::optional<RegionOfInterest>& region);

}  // namespace artus
