// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/core/geometry.h"
#include "artus/raycast/scene.h"

namespace artus {

/// The body as hands in frame W meet it. Without a scene there is nothing to meet.
struct BodyContact {
  const Scene* scene = nullptr;
  Pose X_WJ = Pose::Identity();

  /// m from `p_W` along the unit `direction_W` to the skin from outside; empty when there is none
  /// within `reach`.
  [[nodiscard]] std::optional<double> find_skin(const Vec3& p_W, const Vec3& direction_W,
                                                double reach) const;
  /// The same to the first hard tissue.
  [[nodiscard]] std::optional<double> find_bone(const Vec3& p_W, const Vec3& direction_W,
                                                double reach) const;
  /// The skin's outward normal around the point under a face at X_WP, averaged over some
  /// millimetres; empty where there is no skin.
  [[nodiscard]] std::optional<Vec3> find_normal(const Pose& X_WP) const;
  /// m between the face's centre and the skin below it, negative when pressed in; empty when no
  /// skin is within 40 mm.
  [[nodiscard]] std::optional<double> find_gap(const Pose& X_WP) const;
};

}  // namespace artus
