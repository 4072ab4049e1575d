// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "artus/echo/image_settings.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// One result, and what it must be at most.
struct HealthMeasure {
  std::string key;              ///< lower_snake with its unit: "wall_jump_mm"
  std::string name;             ///< in plain words
  std::string unit;             ///< "mm", "ml", "%"; empty for a number of things
  std::optional<double> value;  ///< empty: cannot be said of this body
  double limit = 0;             ///< that it may have at most
  std::string where;            ///< place and region of the worst; empty: none

  [[nodiscard]] bool holds() const noexcept { return !value || *value <= limit; }
};

/// Whether a body is still one after liquid and press.
struct BodyHealth {
  std::vector<HealthMeasure> measures;
  double seconds = 0;  ///< that measuring took

  [[nodiscard]] bool sound() const noexcept;
  /// Requires: a key of it.
  [[nodiscard]] const HealthMeasure& at(std::string_view key) const;
};

/// Liquid that was put into a body.
struct GivenLiquid {
  std::vector<std::string> regions;  ///< that hold it: the space's, and "injected"
  std::vector<std::string> parted;   ///< regions that it parts, and so comes to touch
  double volume = 0;                 ///< m^3 that is drawn in them
  Vec3 p_J = Vec3::Zero();           ///< m, where it came in
};

/// A body before and after, and how it is looked at.
struct HealthQuestion {
  std::shared_ptr<const Scene> before;  ///< under the same press, without liquid
  std::shared_ptr<const Scene> after;
  GivenLiquid liquid;
  Pose X_JP = Pose::Identity();  ///< of the probe, in both
  Transducer transducer;
  ImageSettings settings;
  bool pictures = true;  ///< compares B-mode pictures, too
};

/// In this order, each with its bound: coordinates that are not finite, tetrahedra that are
/// inverted (against the body at rest), jumps of a space's walls from beam to beam, the volume that
/// the skin is lifted by, liquid that rays find against what was given, fragments, new neighbours,
/// and vertical strips in the picture. A measure that has nothing to go by (no tetrahedra, no
/// liquid, no pictures) has no value and holds. Requires: both scenes of one joint. Cost: some ten
/// thousand rays and two label pictures in each body, 0.1 to 0.5 s; pictures twice that of a
/// Renderer.
[[nodiscard]] BodyHealth measure_body_health(const HealthQuestion& question);

/// "FAILS  wall's jump from beam to beam: 4.2 mm (at most 0.5): 12.3 mm across", a line each.
[[nodiscard]] std::string to_text(const BodyHealth& health);

/// {"sound", "seconds", "measures": {key: {"name", "value", "unit", "limit", "holds", "where"}}};
/// null for what has no value.
[[nodiscard]] nlohmann::json to_json(const BodyHealth& health);

}  // namespace artus
