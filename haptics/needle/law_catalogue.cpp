// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/law_catalogue.h"

#include "artus/detail/haptics/needle/needle_model.h"
#include "artus/detail/haptics/passivity.h"

namespace artus {
namespace {

constexpr std::string_view kThesis = "[Alamilla2020]";
constexpr std::string_view kAssumed = "assumed";

std::vector<LawDescription> cutting_laws() {
  const TrackingWallParams wall;
  const VoigtParams voigt;
  return {
      {"cutting",
       "tracking_wall",
       "--cutting tracking_wall",
       "a spring K_t whose anchor follows the tip at f_R / K_t; settles after a stop; f_A resists "
       "withdrawal",
       "[Alamilla2020] eqs. 2.14-2.19",
       {{"settling_time", wall.settling_time, "s", kAssumed},
        {"moving_time", wall.moving_time, "s", kAssumed},
        {"fall_time", wall.fall_time, "s", kAssumed}}},
      {"cutting",
       "direct",
       "--cutting direct",
       "f = f_R inside, 0 outside",
       "[Alamilla2020] section 2.1.2",
       {}},
      {"cutting", "spring", "--cutting spring", "f = K_t (w0 - x)", "[Alamilla2020] eq. 2.7", {}},
      {"cutting",
       "voigt",
       "--cutting voigt",
       "f = K_t (w0 - x) - B dx/dt",
       "[Alamilla2020] eq. 2.8",
       {{"damping", voigt.damping, "N s/m", kAssumed}}}};
}

std::vector<LawDescription> prepuncture_laws() {
  const PrepunctureParams p;
  return {{"prepuncture",
           "membrane",
           "--prepuncture membrane",
           "the polynomial of simone_okamura scaled to reach the tissue's puncture force at this "
           "dimple, then a pop",
           "shape of [Alamilla2020] eq. 2.1",
           {{"dimple", p.membrane.dimple, "m", kAssumed}}},
          {"prepuncture",
           "simone_okamura",
           "--prepuncture simone_okamura",
           "f = a1 d + a2 d^2",
           "[Simone2002], [Alamilla2020] eq. 2.1",
           {{"a1", p.simone_okamura.a1, "N/m", "[Simone2002]"},
            {"a2", p.simone_okamura.a2, "N/m^2", "[Simone2002]"}}},
          {"prepuncture",
           "barbe",
           "--prepuncture barbe",
           "f = mu d^n + lambda d v",
           "[Barbe2006], [Alamilla2020] eq. 2.2",
           {{"mu", p.barbe.mu, "N/m^n", "[Barbe2006]"},
            {"lambda", p.barbe.lambda, "N s/m^2", "[Barbe2006]"},
            {"n", p.barbe.n, "-", "[Barbe2006]"}}},
          {"prepuncture",
           "god_object",
           "--prepuncture god_object",
           "a spring from the tip to its place on the skin, along the skin's normal",
           "[Zilles1995]",
           {{"stiffness", p.god_object.stiffness, "N/m", kAssumed}}},
          {"prepuncture",
           "tear",
           "",
           "what a membrane held fades as exp(-t / time) once it gives way",
           kAssumed,
           {{"time", p.tear.time, "s", kAssumed},
            {"membrane_margin", ContactParams{}.membrane_margin, "m", kAssumed}}}};
}

std::vector<LawDescription> friction_laws() {
  constexpr std::array<std::string_view, 4> kNames{"lugre 20 mm 0.025 Hz", "lugre 20 mm 0.05 Hz",
                                                   "lugre 40 mm 0.025 Hz", "lugre 40 mm 0.05 Hz"};
  constexpr std::array<std::string_view, 4> kFlags{"--friction-set 1", "--friction-set 2",
                                                   "--friction-set 3", "--friction-set 4"};
  constexpr std::string_view kSource = "[Asadian2011]";
  std::vector<LawDescription> laws;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const LugreParams& p = lugre_sets()[i];
    laws.push_back({"friction",
                    kNames[i],
                    kFlags[i],
                    "f = F_n (sigma0 z + sigma1 dz/dt + sigma2 v), F_n = sum of f_R * friction * "
                    "shaft length in the layer / length",
                    "[Asadian2011], [Alamilla2020] eqs. 2.4-2.6",
                    {{"sigma0", p.sigma0, "1/m", kSource},
                     {"sigma1", p.sigma1, "s/m", kSource},
                     {"sigma2", p.sigma2, "s/m", kSource},
                     {"mu_c", p.mu_c, "-", kSource},
                     {"mu_s", p.mu_s, "-", kSource},
                     {"alpha", p.alpha, "s/m", kSource},
                     {"length", p.length, "m", kSource},
                     {"stiffness_limit", p.stiffness_limit, "N/m", kAssumed},
                     {"damping_limit", p.damping_limit, "N s/m", kAssumed},
                     {"relaxation_time", p.relaxation_time, "s", kAssumed}}});
  }
  return laws;
}

std::vector<LawDescription> bone_laws() {
  const HardContactParams p;
  return {{"bone tap",
           "decaying_sinusoid",
           "--bone-tap decaying_sinusoid",
           "f = A v_in exp(ln(0.01) t / d) sin(2 pi f t), 0 < t < d, once per contact",
           "[Kuchenbecker2006], [Alamilla2020] eq. 2.3",
           {{"amplitude", p.sinusoid.amplitude, "N s/m", "[Kuchenbecker2006]"},
            {"duration", p.sinusoid.duration, "s", "[Kuchenbecker2006]"},
            {"frequency", p.sinusoid.frequency, "Hz", "[Kuchenbecker2006]"},
            {"rearm_distance", p.rearm_distance, "m", kAssumed}}},
          {"bone tap",
           "impulse",
           "--bone-tap impulse",
           "f = (e + 1) M v_in / T over T, once per contact",
           "[Alamilla2020] eqs. 2.9, 2.10",
           {{"restitution", p.impulse.restitution, "-", kThesis},
            {"mass", p.impulse.mass, "kg", kAssumed},
            {"duration", p.impulse.duration, "s", kThesis},
            {"rearm_distance", p.rearm_distance, "m", kAssumed}}},
          {"bone edge",
           "slide",
           "",
           "a tip that slides off bone leaves it over min(depth pressed in, f_cutting / K, bevel)",
           kAssumed,
           {{"bevel", ContactParams{}.bevel, "m", kAssumed}}}};
}

std::vector<LawDescription> line_laws() {
  const PlasticityParams plasticity;
  const OrientationParams orientation;
  const ContactParams contact;
  return {{"clamping",
           "projection",
           "--clamping projection",
           "f = k |QP| towards the insertion line; k grows with depth and the tissue's clamping",
           "[Alamilla2020] eq. 2.20",
           {}},
          {"clamping",
           "plasticity",
           "--clamping plasticity",
           "holds the tip on the line up to a force and lets it slip beyond",
           "[Kikuuwe2007], [Alamilla2020] eqs. 2.11-2.13",
           {{"stiffness", plasticity.stiffness, "N/m", kAssumed},
            {"damping", plasticity.damping, "N s/m", kAssumed},
            {"yield_force", plasticity.yield_force, "N", kAssumed}}},
          {"orientation",
           "quaternion",
           "",
           "tau = k eps - B omega",
           "[Alamilla2020] eqs. 2.21-2.25",
           {{"stiffness", orientation.stiffness, "N m/rad", kAssumed},
            {"damping", orientation.damping, "N m s/rad", kAssumed},
            {"reference_clamping", orientation.reference_clamping, "N/m", kAssumed}}},
          {"re-direction",
           "cone",
           "",
           "a new line within atan((n_L - d) / (n_L + d)) after a withdrawal",
           "[Alamilla2020] eq. 1.2",
           {{"needle_length", contact.needle_length, "m", "[Alamilla2020] section 1.6.1"},
            {"withdrawal", contact.line.withdrawal, "m", kAssumed},
            {"deviation", contact.line.deviation, "m", kAssumed},
            {"angle", contact.line.angle, "rad", kAssumed},
            {"advance", contact.line.advance, "m", kAssumed},
            {"drag", contact.line.drag, "m", kAssumed},
            {"near_skin", contact.line.near_skin, "m", kAssumed},
            {"play", contact.line.play, "m", kAssumed},
            {"layer_edge", contact.layer_edge, "m", kAssumed}}}};
}

std::vector<LawDescription> other_laws() {
  const MotionParams motion;
  const HemisphereParams sphere;
  const PassivityParams passivity;
  return {{"rest",
           "motion detector",
           "",
           "stillness from 1 to 0 as the range of the last positions over a time goes from one "
           "band to the other",
           "[Alamilla2020] section 2.4, |dx/dt| < eps",
           {{"band", motion.band, "m", kAssumed},
            {"moving_band", motion.moving_band, "m", kAssumed},
            {"time", motion.time, "s", kAssumed}}},
          {"workspace",
           "hemisphere",
           "--workspace-mm X Y Z R",
           "f = K (p - c) / |p - c| inside the sphere",
           "[Alamilla2020] eqs. 2.26, 2.27",
           {{"radius", sphere.radius, "m", kThesis}, {"push", sphere.push, "N", kAssumed}}},
          {"passivity",
           "controller",
           "--passivity-control",
           "damps while the forces have given more energy than they took",
           "[Hannaford2002]",
           {{"max_damping", passivity.max_damping, "N s/m", kAssumed}}}};
}

}  // namespace

std::vector<LawDescription> describe_laws() {
  std::vector<LawDescription> all;
  for (auto* group :
       {cutting_laws, prepuncture_laws, friction_laws, bone_laws, line_laws, other_laws}) {
    std::vector<LawDescription> laws = group();
    all.insert(all.end(), laws.begin(), laws.end());
  }
  return all;
}

}  // namespace artus
