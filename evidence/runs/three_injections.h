// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/anatomy/body/liquid.h"
#include "artus/detail/core/progress.h"
#include "artus/detail/evidence/claim.h"
#include "artus/detail/evidence/runs/needle_trace.h"
#include "artus/detail/evidence/runs/plateau.h"
#include "artus/detail/operators/probe_hand.h"
#include "artus/detail/operators/simulated_hand.h"
#include "artus/detail/simulation/syringe_core.h"
#include "artus/echo/transducer.h"
#include "artus/haptics/needle_feel.h"

namespace artus {

struct FluidState;

/// What is given at each target of a run.
struct TargetDose {
  SyringeChoice syringe;  ///< of the whole run; what is drawn up is made enough for it
  double volume = 0;      ///< m^3 at each target; 0: a dry run, as published
  double rate = 1e-7;     ///< m^3/s
};

/// How the published medical test is run; every value has a default.
struct ThreeInjectionsOptions {
  double rate_hz = 1000;
  std::uint64_t seed = 1;
  std::string device = "virtuose_6d_desktop";  ///< a name of device_table()
  double slow_speed = 0.012;                   ///< m/s, injections 1 and 2
  double fast_speed = 0.10;                    ///< m/s, injection 3
  double withdrawal = 0.020;  ///< m back before re-aiming; [Alamilla2020] "a few centimetres"
  std::string target_tissue = "bursa";  ///< where a line has none: the layer of its target, or
                                        ///< the last one before bone when that is bone
  NeedleFeel feel;        ///< without a needle's length: the shortest of 25, 35, 50, 90 mm that
                          ///< reaches the bone
  HandParams hand;        ///< its seed is replaced by `seed`
  ProbeHandParams probe;  ///< the other hand; likewise
  TargetDose dose;
};

/// An instant worth a picture.
struct NamedMoment {
  double time = 0;    ///< s
  std::string label;  ///< "bursa reached", "re-aimed", "bone touched", ...
  int pass = 0;       ///< which injection, from 1
  Pose X_JN = Pose::Identity();
  Pose X_JP_seat = Pose::Identity();  ///< where the probe is meant to lie: on the skin, its plane
                                      ///< through the insertion line
  Pose X_JP = Pose::Identity();       ///< where the picture is taken: see ProbeHandRow in rigid
                                      ///< tissue, else where the probe is
  std::vector<float> coverage;  ///< of each of the probe's elements with skin or gel, 0..1, on
                                ///< a rigid body
};

/// One touch of bone.
struct BoneTouch {
  int pass = 0;
  double time = 0;            ///< s
  double incoming_speed = 0;  ///< m/s
  double peak = 0;            ///< N, of the tap alone
  double duration = 0;        ///< s, from the touch to the tap's last non-zero row
};

/// The syringe in one tick. SI.
struct SyringeRow {
  PlungerFeedback plunger;
  std::uint32_t n_sites = 0;
  std::array<InjectedSite, kMaxSites> sites;
};

/// What one place has at the end of a run, and whether a target is in it.
struct GivenTo {
  std::string place;
  double volume = 0;  ///< m^3
  bool target = false;
};

struct ThreeInjections {
  std::vector<NeedleRow> rows;
  std::vector<ProbeHandRow> probe;  ///< as many, at the same times
  std::vector<SyringeRow> syringe;  ///< likewise; empty: a dry run
  std::vector<GivenTo> given;       ///< by place, those that got something
  Liquid liquid;                    ///< that was drawn up
  bool into_cavity = false;         ///< a target is in a place that opens, as a bursa
  double asked = 0;                 ///< m^3 at all targets together
  double unbalanced = 0;            ///< m^3 out of the needle, less what is somewhere
  std::vector<NamedMoment> moments;
  std::vector<LayerPlateau> plateaus;
  std::vector<BoneTouch> touches;
  std::vector<Claim> claims;
  std::vector<std::string> region_names;
  double needle_length = 0;  ///< m
  ThreeInjectionsOptions options;
};

/// How tissue gives way in a run.
struct RunTissueOptions {
  Transducer transducer;   ///< whose face presses
  double image_rate = 30;  ///< 1/s of its steps, of which each is an image's instant
  /// Called with the run so far and the body as it lies at its last row, which is an image's, and
  /// what was injected into it.
  std::function<void(const ThreeInjections&, const std::shared_ptr<const Scene>&,
                     const FluidState&)>
      on_image;
};

/// The published medical test [Alamilla2020] section 4.6 with a simulated hand and device: the
/// first two injections go slowly to the bursa, withdraw, re-aim inside the cone, reach another
/// part of it and touch bone slowly; the third goes fast and straight to the bone. With a dose the
/// thumb gives it wherever the needle stops at a target, the bevel's whole opening in it where the
/// layer is thick enough, and what the thumb pushes moves the needle. The other hand
/// presses the probe on the skin, its plane in the needle's line. With `tissue` the body gives way
/// to both hands as in a session; null: it is rigid, as published. Deterministic for a scene,
/// options and seed. Works on any joint with a target; a line without bone behind it
/// skips the touch and says so in a claim. Errors: not_found (no such device), invalid (fewer than
/// three injections, an entry inside or a target outside the body; a dose that no syringe holds),
/// those of make_plunger_params and TissueCore::make.
[[nodiscard]] Result<ThreeInjections> run_three_injections(
    const Scene& scene, std::span<const PlannedInjection> injections,
    const ThreeInjectionsOptions& options = {}, const Progress& progress = {},
    const RunTissueOptions* tissue = nullptr);

/// Plateaus, touches, moments, claims and settings, in the units of the names.
[[nodiscard]] nlohmann::json summarize(const ThreeInjections& run);

/// Writes trace.csv and forces.svg into `folder` (made when missing). Errors: unreadable.
[[nodiscard]] Result<void> write_three_injections(const ThreeInjections& run,
                                                  const std::filesystem::path& folder);

}  // namespace artus
