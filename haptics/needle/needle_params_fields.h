// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/haptics/needle/needle_params.h"

namespace artus {

// The named members of NeedleParams and of all that is in it, for visit_fields (core/fields.h).

template <Like<MotionParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [band, moving_band, time] = params;
  visit("band", band);
  visit("moving_band", moving_band);
  visit("time", time);
}

template <Like<LineParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [withdrawal, deviation, angle, advance, way, near_skin, play] = params;
  visit("withdrawal", withdrawal);
  visit("deviation", deviation);
  visit("angle", angle);
  visit("advance", advance);
  visit("way", way);
  visit("near_skin", near_skin);
  visit("play", play);
}

template <Like<ContactParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [length, line, behind_skin, lookahead, approach, margin, edge, layer_edge, bevel, motion,
         velocity_window] = params;
  visit("needle_length", length);
  visit("line", line);
  visit("behind_skin", behind_skin);
  visit("lookahead", lookahead);
  visit("approach", approach);
  visit("membrane_margin", margin);
  visit("membrane_edge", edge);
  visit("layer_edge", layer_edge);
  visit("bevel", bevel);
  visit("motion", motion);
  visit("velocity_window", velocity_window);
}

template <Like<TrackingWallParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [settling_time, moving_time, fall_time] = params;
  visit("settling_time", settling_time);
  visit("moving_time", moving_time);
  visit("fall_time", fall_time);
}

template <Like<VoigtParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [damping] = params;
  visit("damping", damping);
}

template <Like<SimoneOkamuraParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [a1, a2] = params;
  visit("a1", a1);
  visit("a2", a2);
}

template <Like<BarbeParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [mu, lambda, n] = params;
  visit("mu", mu);
  visit("lambda", lambda);
  visit("n", n);
}

template <Like<MembraneParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [dimple] = params;
  visit("dimple", dimple);
}

template <Like<TearParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [time] = params;
  visit("time", time);
}

template <Like<GodObjectParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [stiffness] = params;
  visit("stiffness", stiffness);
}

template <Like<PrepunctureParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [membrane, tear, simone_okamura, barbe, god_object] = params;
  visit("membrane", membrane);
  visit("tear", tear);
  visit("simone_okamura", simone_okamura);
  visit("barbe", barbe);
  visit("god_object", god_object);
}

template <Like<LugreParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [sigma0, sigma1, sigma2, mu_c, mu_s, alpha, length, stiffness_limit, damping_limit,
         relaxation_time] = params;
  visit("sigma0", sigma0);
  visit("sigma1", sigma1);
  visit("sigma2", sigma2);
  visit("mu_c", mu_c);
  visit("mu_s", mu_s);
  visit("alpha", alpha);
  visit("length", length);
  visit("stiffness_limit", stiffness_limit);
  visit("damping_limit", damping_limit);
  visit("relaxation_time", relaxation_time);
}

template <Like<DecayingSinusoidParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [amplitude, duration, frequency] = params;
  visit("amplitude", amplitude);
  visit("duration", duration);
  visit("frequency", frequency);
}

template <Like<ImpulseParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [restitution, mass, duration] = params;
  visit("restitution", restitution);
  visit("mass", mass);
  visit("duration", duration);
}

template <Like<HardContactParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [law, sinusoid, impulse, rearm_distance] = params;
  visit("law", law);
  visit("sinusoid", sinusoid);
  visit("impulse", impulse);
  visit("rearm_distance", rearm_distance);
}

template <Like<OrientationParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [stiffness, damping, reference_clamping] = params;
  visit("stiffness", stiffness);
  visit("damping", damping);
  visit("reference_clamping", reference_clamping);
}

template <Like<PlasticityParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [stiffness, damping, yield_force] = params;
  visit("stiffness", stiffness);
  visit("damping", damping);
  visit("yield_force", yield_force);
}

template <Like<HemisphereParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [centre, radius, push] = params;
  visit("centre", centre);
  visit("radius", radius);
  visit("push", push);
}

template <Like<NeedleParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [contact, wall, voigt, prepuncture, friction, hard, orientation, clamping, plasticity,
         use_workspace, workspace] = params;
  visit("contact", contact);
  visit("wall", wall);
  visit("voigt", voigt);
  visit("prepuncture", prepuncture);
  visit("friction", friction);
  visit("hard", hard);
  visit("orientation", orientation);
  visit("clamping", clamping);
  visit("plasticity", plasticity);
  visit("use_workspace", use_workspace);
  visit("workspace", workspace);
}

}  // namespace artus
