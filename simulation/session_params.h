// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/haptics/guard.h"
#include "artus/detail/haptics/passivity.h"
#include "artus/detail/haptics/plunger/syringe_choice.h"
#include "artus/detail/simulation/two_phase_gesture.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"
#include "artus/haptics/device.h"
#include "artus/haptics/needle_feel.h"

namespace artus {

struct CompiledJoint;

/// Whether tissue of this joint can give way: it has tetrahedra.
[[nodiscard]] bool gives_way(const CompiledJoint& joint) noexcept;

/// Help for the needle hand in training (HandAid); none unless something asks for it.
struct HandAids {
  Vec3 entry = Vec3::Zero();   ///< m, frame J: the planned line goes through it
  Vec3 target = Vec3::Zero();  ///< m, frame J
  double guide = 0;            ///< N/m across to that line
  double wall = 0;             ///< N/m along the needle within `keep_out`
  std::string keep_out;        ///< names of structures, one on each line
};

/// All that a session's results depend on besides its inputs and the joint. `feel` is the user's
/// choice and goes before `needle` and `passivity`, which are as published.
struct SessionParams {
  double haptic_rate = 1000;  ///< Hz, 1000 to 10000
  double image_rate = 40;     ///< Hz, 10 to 120
  DeviceLimits device;        ///< whose limits the force is kept in
  NeedleParams needle;
  PassivityParams passivity;
  GuardParams guard;
  NeedleFeel feel;
  GestureParams gesture;
  Pose X_WJ = Pose::Identity();  ///< the joint's place before any calibration
  Transducer transducer;
  ImageSettings image;
  NeedleShape needle_shape;  ///< of its length: see needle_length_of
  SyringeChoice syringe;
  HandAids aids;
  bool deform = false;         ///< tissue gives way to probe and needle, in picture and hands
  bool wait_for_cage = false;  ///< where the probe comes beyond its reach the tissue's next cage is
                               ///< made and used in that image, and a factor of its tangent in the
                               ///< image that needs one: for a loop without a clock
  std::optional<Pose> X_JC;    ///< of the probe around which the tissue's first cage is made; none:
                               ///< where the first image has it, when that is waited for, or the
                               ///< joint's default
};

/// m, hub to tip: the one length that the contact and the picture take.
[[nodiscard]] double needle_length_of(const SessionParams& params) noexcept;

/// Errors: invalid, naming the value.
[[nodiscard]] Result<void> validate(const SessionParams& params);

}  // namespace artus
