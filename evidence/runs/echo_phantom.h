// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "artus/core/result.h"
#include "artus/detail/anatomy/body/layered_body.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/raycast/scene.h"

namespace artus {

/// A standard test object: what lies in it, where the probe is held, and what it must show. The
/// probe is at the origin of frame J and looks along +z, its lateral axis is +x.
struct EchoPhantom {
  std::string name;
  std::string title;  ///< one line: what it is for
  std::shared_ptr<const Scene> scene;
  Pose X_JP = Pose::Identity();
  std::vector<PointReflector> reflectors;
  std::optional<NeedleView> needle;
  nlohmann::json truth;  ///< geometry (mm) and the values that a right image shows
};

struct PhantomOptions {
  NeedleShape needle;           ///< of the needle phantom
  double needle_angle = 0;      ///< rad to the face, 0 parallel
  double needle_depth = 20e-3;  ///< m, of the shaft's axis below the middle of the face
};

/// homogeneous, points, cyst, layers, needle.
[[nodiscard]] std::span<const std::string_view> echo_phantoms() noexcept;

/// Errors: not_found (lists the names), invalid (needle angle or depth out of range).
[[nodiscard]] Result<EchoPhantom> make_echo_phantom(std::string_view name,
                                                    const PhantomOptions& options = {});

/// The tissue library with "tissue_mimic" added: 1540 m/s, 0.5 dB/cm/MHz, speckle as muscle.
[[nodiscard]] std::vector<Tissue> make_phantom_tissues();

/// A layered block of library tissues, 160 mm x 60 mm, its top in z = 0; `change` edits the body
/// before it is indexed.
[[nodiscard]] std::shared_ptr<const Scene> make_block_scene(
    std::span<const FlatLayer> layers, const std::function<void(CompiledJoint&)>& change = {});

/// The acoustic values of a tissue of the joint. Requires: there is one of this name.
[[nodiscard]] Acoustic& acoustic_of(CompiledJoint& joint, std::string_view tissue);

/// Makes every tissue silent and free of loss, so that interfaces or a needle stand alone.
void silence(CompiledJoint& joint);

/// A silent block of water-like tissue, 60 mm deep.
[[nodiscard]] std::shared_ptr<const Scene> make_clear_block();

/// A needle in the probe's plane whose tip is at `tip_P`, dipping by `angle` rad toward +x.
[[nodiscard]] NeedleView needle_in_plane(const Pose& X_JP, const Vec3& tip_P, double angle,
                                         const NeedleShape& shape = {});

}  // namespace artus
