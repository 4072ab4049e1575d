// SPDX-License-Identifier: AGPL-3.0-or-later
// All that artus claims of itself against theory and published figures, in one table.
#include <array>
#include <filesystem>

#include "artus/detail/evidence/validation/echo/echo_gates.h"
#include "artus/detail/evidence/validation/echo/echo_patch.h"
#include "artus/detail/evidence/validation/echo/realism_gates.h"
#include "artus/detail/evidence/validation/gates.h"
#include "artus/detail/evidence/validation/injection/injection_gates.h"
#include "artus/detail/evidence/validation/needle/experiments.h"
#include "artus/detail/evidence/validation/probe/probe_experiments.h"
#include "artus/detail/evidence/validation/soft/soft_gates.h"

namespace artus {
namespace {

constexpr std::array<GateSet, 6> kSets{{
    {"needle", "Published needle experiments, closed loop with a simulated hand",
     "the figures and equations of [Alamilla2020]; each experiment names its own", true},
    {"echo", "The image's physics on test objects",
     "the wave model and the literature; each gate names its own", false, "gates.json"},
    {"realism", "The picture in the clinical look beside scanners'",
     "bands from published pictures of three scanners; [VanDeBerg2019]"},
    {"soft", "Tissue that gives way, on blocks with known answers: mechanics and picture",
     "closed forms of elasticity; each gate names its own"},
    {"injection", "The syringe and the places that liquid goes to, against known answers",
     "closed forms of flow and pressure, integrals, an independent model; each gate names its own"},
    {"probe", "Published tests of the pneumatic probe mock and its control laws",
     "[Alamilla2020] section 3.3.2", true},
}};

constexpr std::uint32_t kWall =
    FeelKind::kCutting | FeelKind::kPatient | FeelKind::kWorkspace | FeelKind::kPassivity;
constexpr ExperimentLaws kFourLaws{
    FeelKind::kPassivity, "compares four fixed cutting laws in a tissue that only cuts", 1};
constexpr ExperimentLaws kWallAlone{
    FeelKind::kFriction | FeelKind::kPatient | FeelKind::kPassivity,
    "compares the tracking wall alone, with shaft friction and no tissue", 1};
constexpr ExperimentLaws kOnlyCuts{kWall, "has a tissue that only cuts", 1};
constexpr ExperimentLaws kNineHold{kWall | FeelKind::kClamping,
                                   "has tissues that only cut and hold the needle's line", 9};
constexpr ExperimentLaws kSevenHold{kNineHold.takes, kNineHold.why_not, 7};
constexpr ExperimentLaws kSoftOnly{kWall | FeelKind::kClamping | FeelKind::kFriction,
                                   "has neither a membrane nor bone", 1};
constexpr ExperimentLaws kOneLine{FeelKind::kCutting | FeelKind::kPrepuncture | FeelKind::kTap |
                                      FeelKind::kFriction | FeelKind::kPatient,
                                  "moves the needle along one line and lets no controller help", 6};
constexpr ExperimentLaws kEverything{FeelKind::kAll, "", 0};
constexpr ExperimentLaws kNothing{0, "uses no force law", 0};
constexpr ExperimentLaws kTableCuts{kWall, "has tissues that only cut", 0};

template <RunExperiment kRun, const ExperimentLaws& kLaws>
Result<Gate> needle(std::string_view name, const GateOptions& options) {
  return measure_experiment(name, kRun, kLaws, options);
}

template <ProbeExperiment (*kRun)(const ProbeExperimentOptions&)>
Result<Gate> probe(std::string_view name, const GateOptions& options) {
  return measure_probe_experiment(name, kRun, options);
}

template <Gate (*kMeasure)()>
Result<Gate> plain(std::string_view /*name*/, const GateOptions& /*options*/) {
  return kMeasure();
}

template <Gate (*kMeasure)(const std::shared_ptr<const CompiledJoint>&)>
Result<Gate> of_joint(std::string_view /*name*/, const GateOptions& options) {
  return kMeasure(options.joint);
}

Result<Gate> plates(std::string_view /*name*/, const GateOptions& options) {
  return measure_plates(options.reference);
}

Result<Gate> muscle_patch(std::string_view /*name*/, const GateOptions& options) {
  const auto table = std::filesystem::is_directory(options.reference)
                         ? options.reference / "stats.tsv"
                         : options.reference;
  const auto range = read_patch_range(table, options.reference_rows);
  ARTUS_TRY(range);
  return measure_muscle(std::make_shared<const Scene>(options.joint), *range);
}

constexpr auto kEntries = std::to_array<GateEntry>({
    {"needle", "wall-vs-classic",
     "four cutting laws on one tissue: stop, then the hand lets go (fig. 2-4)",
     needle<run_wall_vs_classic, kFourLaws>},
    {"needle", "wall-release", "stop, then let go at once or slowly: what keeps the needle in",
     needle<run_wall_release, kWallAlone>},
    {"needle", "wall-move", "the force rises over 2 mm to 1 N and stays (fig. 2-5)",
     needle<run_wall_move, kOnlyCuts>},
    {"needle", "wall-stop", "the force settles to 0 after a stop and builds again (fig. 2-6)",
     needle<run_wall_stop, kOnlyCuts>},
    {"needle", "wall-both", "cutting on the way in, attracted on the way out (fig. 2-10)",
     needle<run_wall_both, kOnlyCuts>},
    {"needle", "wall-nine", "nine layers in a ball, oblique (fig. 2-13)",
     needle<run_wall_nine, kNineHold>},
    {"needle", "wall-seven", "seven layers, attracted by 0.7 N (fig. 2-15)",
     needle<run_wall_seven, kSevenHold>},
    {"needle", "clamp-redirect", "off the line, withdraw, aim again, insert (figs. 2-16, 2-17)",
     needle<run_clamp_redirect, kSoftOnly>},
    {"needle", "wall-energy", "energy given over each closed cycle of 10,000 random insertions",
     needle<run_wall_energy, kOneLine>},
    {"needle", "rates", "the same insertion at 1, 2 and 10 kHz", needle<run_rates, kEverything>},
    {"needle", "velocity-estimators", "noise and lag of every estimator of velocity",
     needle<run_velocity_estimators, kNothing>},
    {"needle", "layer-changes", "each pair of layers of table 4.2 against what a hand can tell",
     needle<run_layer_changes, kTableCuts>},
    {"echo", "speckle", "statistics of a homogeneous block against fully developed speckle",
     plain<gate_speckle>},
    {"echo", "lateral-width", "width of points beside the axis against the wave model",
     plain<gate_lateral_width>},
    {"echo", "slice-width", "width of points across the plane, by element height and depth",
     plain<gate_slice_width>},
    {"echo", "attenuation", "fall of the speckle with depth against twice the attenuation",
     plain<gate_attenuation>},
    {"echo", "matched-impedance", "two tissues of one impedance: no echo between them",
     plain<gate_matched_impedance>},
    {"echo", "interfaces", "echo levels of tissue pairs against their impedance step",
     plain<gate_interfaces>},
    {"echo", "needle-rings", "spacing of the lines below a 22 G needle", plain<gate_needle_rings>},
    {"echo", "needle-angle", "brightness of a needle by its angle to the face",
     plain<gate_needle_angle>},
    {"echo", "needle-offset", "brightness of a needle beside the plane", plain<gate_needle_offset>},
    {"echo", "tendon", "tendon against muscle by the beam's tilt", plain<gate_tendon>},
    {"echo", "fat-shift", "a layer of fat shifts what lies below it", plain<gate_fat_shift>},
    {"echo", "enhancement", "a layer of fluid brightens what lies below it",
     plain<gate_enhancement>},
    {"echo", "motion", "rigid motion, sideways motion, number of threads", plain<gate_motion>},
    {"echo", "muscle-patch", "grey and grain of a joint's muscle against real images", muscle_patch,
     GateNeeds::joint_and_reference},
    {"realism", "bone", "bone's line by its slope, and its shadow", plain<gate_screen_bone>},
    {"realism", "needle", "contrast of a needle by its angle", plain<gate_screen_needle>},
    {"realism", "lumen", "clutter in a lumen", plain<gate_screen_lumen>},
    {"realism", "muscle", "grey and grain of muscle", plain<gate_screen_muscle>},
    {"realism", "plates", "our pictures beside real ones", plates, GateNeeds::reference},
    {"soft", "patch", "linear field in a graded cage", plain<gate_patch>},
    {"soft", "uniaxial", "compression with free sides", plain<gate_uniaxial>},
    {"soft", "point-force", "Boussinesq's far displacement", plain<gate_point_force>},
    {"soft", "cantilever", "bending, with and without near incompressibility",
     plain<gate_cantilever>},
    {"soft", "punch", "flat round punch on a half-space", plain<gate_punch>},
    {"soft", "vessel", "sphere and tube under pressure", plain<gate_vessel>},
    {"soft", "convergence", "stored energy by cube size", plain<gate_convergence>},
    {"soft", "layers", "layered block under the probe's face, by cube size", plain<gate_layers>},
    {"soft", "volume", "volume under a deep press", plain<gate_volume>},
    {"soft", "balance", "force against reaction, compliance, energy of a path",
     plain<gate_balance>},
    {"soft", "turned", "face turned against the cage", plain<gate_turned>},
    {"soft", "reciprocity", "compliance against its transpose", plain<gate_reciprocity>},
    {"soft", "bytes", "the same bytes again", plain<gate_bytes>},
    {"soft", "wild-hand", "random presses and jumps", plain<gate_wild_hand>},
    {"soft", "limb", "fat and muscle over bone against published ones", plain<gate_limb>},
    {"soft", "strain-image", "motion found in two pictures", plain<gate_strain_image>},
    {"soft", "inclusion", "strain of a stiff ball, from two pictures", plain<gate_inclusion>},
    {"soft", "speckle", "speckle statistics under compression", plain<gate_speckle_pressed>},
    {"soft", "thinning", "layers in the picture against the tissue's", plain<gate_thinning>},
    {"soft", "carried", "speckle where the tissue went", plain<gate_carried>},
    {"soft", "border", "echo of a moved border and its speckle's edge", plain<gate_border>},
    {"soft", "shaft", "a needle's compliance by cube size", plain<gate_shaft>},
    {"soft", "needle-rates", "a coupled needle at several rates of the loop",
     plain<gate_needle_rates>},
    {"soft", "tent", "skin before and after a needle", plain<gate_tent>},
    {"soft", "drag", "a needle's load, in and out", plain<gate_drag>},
    {"soft", "packets", "the probe's force between updates", plain<gate_packets>},
    {"soft", "hands", "hands with a probe on tissue that answers late", plain<gate_probe_hands>},
    {"soft", "still", "the same bytes below a still probe", plain<gate_still>},
    {"soft", "joint-pressed", "a joint pressed by 3 N", of_joint<gate_joint_pressed>,
     GateNeeds::joint},
    {"soft", "joint-still", "the same bytes below a probe held still on a joint",
     of_joint<gate_joint_still>, GateNeeds::joint},
    {"injection", "needle", "pressure drops, inverse, power law", plain<gate_needle>},
    {"injection", "compliance", "constant pressure into a bursa", plain<gate_compliance>},
    {"injection", "air", "stopped plunger with trapped air", plain<gate_air>},
    {"injection", "leak", "over a yield pressure", plain<gate_leak>},
    {"injection", "energy", "the thumb's work", plain<gate_energy>},
    {"injection", "mass", "volumes under wild thumbs", plain<gate_mass>},
    {"injection", "rates", "1, 2, 10 kHz against an integral", plain<gate_rates>},
    {"injection", "places", "bundled places against an integral", plain<gate_places>},
    {"injection", "hand", "thumb's force by target, needle and rate", plain<gate_hand>},
    {"injection", "loss", "loss of resistance, at constant rate and force", plain<gate_loss>},
    {"injection", "aspiration", "time to a flash by gauge", plain<gate_aspiration>},
    {"injection", "capsule", "pressure and volume of shoulders", plain<gate_capsule>},
    {"injection", "bevel", "a tip half in two layers", plain<gate_bevel>},
    {"probe", "probe-isp", "increasing stiffness under 1 kg (figs. 3-16 to 3-19)",
     probe<run_probe_isp>},
    {"probe", "probe-ssp", "stiffness steps under 1 kg (figs. 3-20 to 3-24)", probe<run_probe_ssp>},
    {"probe", "probe-study", "which law renders tissue best, under every disturbance",
     probe<run_probe_study>},
});

}  // namespace

std::span<const GateSet> gate_sets() noexcept {
  return kSets;
}

std::span<const GateEntry> gate_entries() noexcept {
  return kEntries;
}

}  // namespace artus
