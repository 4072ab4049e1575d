// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/haptics/needle/needle_params.h"

namespace artus {

// The named members of NeedleParams and of all that is in it, for visit_fields (core/fields.h).

ARTUS_FIELDS(MotionParams, band, moving_band, time);

ARTUS_FIELDS(LineParams, withdrawal, deviation, angle, advance, drag, near_skin, play);

ARTUS_FIELDS(ContactParams, needle_length, line, behind_skin, lookahead, approach, membrane_margin,
             membrane_edge, layer_edge, bevel, motion, velocity_window);

ARTUS_FIELDS(TrackingWallParams, settling_time, moving_time, fall_time);

ARTUS_FIELDS(VoigtParams, damping);

ARTUS_FIELDS(SimoneOkamuraParams, a1, a2);

ARTUS_FIELDS(BarbeParams, mu, lambda, n);

ARTUS_FIELDS(MembraneParams, dimple);

ARTUS_FIELDS(TearParams, time);

ARTUS_FIELDS(GodObjectParams, stiffness);

ARTUS_FIELDS(PrepunctureParams, membrane, tear, simone_okamura, barbe, god_object);

ARTUS_FIELDS(LugreParams, sigma0, sigma1, sigma2, mu_c, mu_s, alpha, length, stiffness_limit,
             damping_limit, relaxation_time);

ARTUS_FIELDS(DecayingSinusoidParams, amplitude, duration, frequency);

ARTUS_FIELDS(ImpulseParams, restitution, mass, duration);

ARTUS_FIELDS(HardContactParams, law, sinusoid, impulse, rearm_distance);

ARTUS_FIELDS(OrientationParams, stiffness, damping, reference_clamping);

ARTUS_FIELDS(PlasticityParams, stiffness, damping, yield_force);

ARTUS_FIELDS(HemisphereParams, centre, radius, push);

ARTUS_FIELDS(NeedleParams, contact, wall, voigt, prepuncture, friction, hard, orientation, clamping,
             plasticity, use_workspace, workspace);

}  // namespace artus
