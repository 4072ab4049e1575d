// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/laws/classic_cutting.h"
#include "artus/detail/haptics/needle/laws/hard_contact.h"
#include "artus/detail/haptics/needle/laws/hemisphere_workspace.h"
#include "artus/detail/haptics/needle/laws/lugre_friction.h"
#include "artus/detail/haptics/needle/laws/orientation_torque.h"
#include "artus/detail/haptics/needle/laws/plasticity_fixture.h"
#include "artus/detail/haptics/needle/laws/prepuncture.h"
#include "artus/detail/haptics/needle/laws/tracking_wall.h"
#include "artus/detail/haptics/needle/needle_contact.h"

namespace artus {

/// Which law holds the needle on its line.
enum class ClampingLaw { projection, plasticity };

/// The parameters of every force law and of the contact; each default has its source where it is
/// declared.
struct NeedleParams {
  ContactParams contact;
  TrackingWallParams wall;
  VoigtParams voigt;
  PrepunctureParams prepuncture;
  LugreParams friction;
  HardContactParams hard;
  OrientationParams orientation;
  ClampingLaw clamping = ClampingLaw::projection;
  PlasticityParams plasticity;
  bool use_workspace = false;  ///< whether the hemisphere pushes
  HemisphereParams workspace;
};

}  // namespace artus
