// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/haptics/needle/classic_cutting.h"
#include "artus/haptics/needle/hard_contact.h"
#include "artus/haptics/needle/hemisphere_workspace.h"
#include "artus/haptics/needle/lugre_friction.h"
#include "artus/haptics/needle/needle_contact.h"
#include "artus/haptics/needle/orientation_torque.h"
#include "artus/haptics/needle/plasticity_fixture.h"
#include "artus/haptics/needle/prepuncture.h"
#include "artus/haptics/needle/tracking_wall.h"

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
