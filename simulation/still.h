// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>

#include "artus/core/result.h"
#include "artus/detail/soft/solver/press.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// In which direction a needle was last moved.
enum class NeedleDirection { in, out };

/// What a needle feels and does where it was led to.
struct StillNeedle {
  double force = 0;            ///< N of the hand along the needle, positive into the body
  double tip_force = 0;        ///< N of the tip on the tissue before it
  double tissue_moved = 0;     ///< m along the needle, of the tissue at its tip
  RegionId region = kOutside;  ///< that the tip is in
  RegionId tented = kOutside;  ///< the layer whose membrane holds before the tip, if one does
};

/// The body with both hands held still, and what they feel.
struct Still {
  std::shared_ptr<const Scene> scene;  ///< carries the body of that instant (Scene::tissue)
  double probe_force = 0;              ///< N on the probe's hand along its face's axis
  double share = 0;                    ///< of the face that presses
  StillNeedle needle;
};

/// A still in a body that gives way is the last image of a session whose hands were led there: the
/// probe comes down to `press`, then the needle comes along its own line at 10 mm/s, to its tip's
/// place or (out) 5 mm beyond and back. Numbers are those of the tick in which it arrives, or where
/// a membrane still holds of a hand that has stopped there; the body is at rest under what hands
/// and needle then load it with. So a still and a session that was led by the same poses say the
/// same. Requires: a press of this joint that has settled. Errors: unsupported (a curved face),
/// those of validate; failed (tissue cannot give way here). Cost: the tissue's steps of some
/// seconds.
[[nodiscard]] Result<Still> lead_to(const std::shared_ptr<const CompiledJoint>& joint,
                                    const Press& press, const Transducer& transducer,
                                    const NeedleView& needle, NeedleDirection direction);

}  // namespace artus
