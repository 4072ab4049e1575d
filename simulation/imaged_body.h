// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "artus/detail/simulation/fluid_shapes.h"
#include "artus/detail/simulation/tissue_packet.h"
#include "artus/raycast/scene.h"

namespace artus {

/// The body at an image's instant, before its picture.
struct ImagedBody {
  std::uint64_t number = 0;            ///< of the image; 0: of none
  std::shared_ptr<const Scene> scene;  ///< without what was injected
  std::optional<TissuePacket> packet;  ///< what it answers the hands with; empty: it is rigid
  FluidState fluid;                    ///< what was injected
};

/// What sessions of one joint can share, so that each need not make it again.
struct PreparedBody {
  std::shared_ptr<const SoftBody> tissue;      ///< used where the probe begins at its cage's pose
  std::shared_ptr<const OpenedSpaces> spaces;  ///< of the scene's joint
};

}  // namespace artus
