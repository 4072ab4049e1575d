// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "artus/detail/operators/scanning_operator.h"
#include "artus/detail/simulation/imaged_body.h"
#include "artus/detail/soft/solver/soft_body.h"
#include "artus/detail/training/health/body_health.h"
#include "artus/detail/training/metrics/attempt_meter.h"
#include "artus/detail/training/scenario.h"
#include "artus/session/recording.h"

namespace artus {

/// The body of a scenario that brings its own. Errors: not_found (a tissue).
[[nodiscard]] Result<std::shared_ptr<const Scene>> make_gel_scene(const GelBlock& gel);

/// What its aids do to the needle hand: `haptic_guide` 1 is 300 N/m across to the planned line,
/// `haptic_wall` 1 is 1000 N/m within what is to be avoided.
[[nodiscard]] HandAids aids_of(const Scenario& scenario);

/// The session that a scenario is played in. Errors: not_found (transducer).
[[nodiscard]] Result<SessionParams> make_session_params(const Scenario& scenario);

/// What a scenario's attempts are measured against. Errors: not_found (a structure), all in one.
[[nodiscard]] Result<MeterOptions> make_meter_options(const Scenario& scenario,
                                                      const CompiledJoint& joint,
                                                      const SessionParams& params);

/// `asked`: which of the task's questions to the patient were asked before the needle went in, as a
/// share of them; nothing where the task has none.
void add_asked(const Scenario& scenario, const std::set<std::string>& asked,
               std::vector<Metric>& metrics);

/// An attempt as it was played.
struct PlayedAttempt {
  Recording recording;  ///< ticks, and frames when pictures were wanted
  AttemptMeasures measures;
  Judgement judgement;
  double duration = 0;  ///< s
  /// What liquid made of the body in the end, and whether it is whole; empty where nothing was
  /// given, or the tissue does not give way.
  std::optional<HealthQuestion> body;
  std::optional<BodyHealth> health;
};

struct PlayOptions {
  std::uint64_t seed = 1;
  bool record = true;       ///< keep ticks, images and what the tissue answered
  bool rigid = false;       ///< tissue does not give way, though the joint could
  double picture_rate = 0;  ///< Hz, pictures kept in the recording; 0: none
  double tissue_rate = 20;  ///< Hz of the tissue's steps, 10 or more; pictures may ask for more
  PreparedBody prepared;    ///< make_played_body of the scenario: saves its seconds
};

/// What all attempts at a scenario begin with: the body around the probe as it is meant to lie, and
/// its spaces where the scenario gives liquid. Empty: tissue cannot give way there. Cost: of
/// SoftBody::make.
[[nodiscard]] PreparedBody make_played_body(const Scenario& scenario, const Scene& scene);

/// Plays a scenario with simulated hands, without its aids and without a clock: hands, device and
/// forces in a closed loop at 1 kHz, in tissue that gives way where the joint can. The same bytes
/// for the same skill and seed. Errors: those of make_session_params and make_meter_options. Cost:
/// some 10 us a tick; where tissue gives way its steps; pictures some 10 ms each.
[[nodiscard]] Result<PlayedAttempt> play(const Scenario& scenario,
                                         const std::shared_ptr<const Scene>& scene,
                                         const OperatorSkill& skill, const PlayOptions& options);

}  // namespace artus
