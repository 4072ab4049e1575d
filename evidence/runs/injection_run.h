// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/detail/haptics/plunger/syringe_choice.h"
#include "artus/detail/operators/simulated_hand.h"
#include "artus/detail/simulation/syringe_core.h"
#include "artus/detail/training/health/body_health.h"
#include "artus/echo/transducer.h"
#include "artus/haptics/needle_feel.h"
#include "artus/raycast/scene.h"

namespace artus {

struct Recording;

inline constexpr double kStartOutside = 0.010;  ///< m before the skin, where a way begins
inline constexpr double kSearch = 0.15;         ///< m along a line; none is longer

/// How the hand finds the place.
enum class Technique : std::uint8_t {
  direct,           ///< to the target, by the picture
  through_and_back  ///< beyond it, then back under gentle pressure until it flows
};

/// One injection by a simulated hand; every value has a default.
struct InjectionSpec {
  std::string name = "injection";
  Vec3 entry = Vec3::Zero();   ///< m, frame J, on the skin
  Vec3 target = Vec3::Zero();  ///< m, frame J
  std::optional<RegionId>
      into;  ///< the structure on that line to inject; none: a bursa on it, or the target's
  double volume = 5e-6;  ///< m^3
  double rate = 1e-7;    ///< m^3/s
  double aspirate = 3;   ///< s of pulling before; 0: none
  Technique technique = Technique::direct;
  SyringeChoice syringe;         ///< that holds at least the volume
  double needle_length = 50e-3;  ///< m, hub to tip; longer where the target is deep
  Transducer transducer;         ///< of the probe, which presses on the skin
  bool rigid = false;            ///< tissue does not give way, though the joint could
  double press = 3;              ///< N of the probe on tissue that gives way
  double rate_hz = 1000;
  std::string device = "virtuose_6d_desktop";  ///< a name of device_table()
  NeedleFeel feel;
  HandParams hand;
};

/// One tick as it is recorded. SI.
struct InjectionRow {
  double time = 0;
  double depth = 0;  ///< m of the tip along the line in the material, 0 at the skin
  RegionId region = kOutside;
  double axial = 0;  ///< N of the device on the hand along the needle, positive against insertion,
                     ///< as TrajectoryForce has it; the thumb's push is in it
  PlungerState plunger;
  double thumb = 0;             ///< N
  std::string_view phase;       ///< what the operator is doing
  std::vector<double> volumes;  ///< m^3, by InjectionRun::places
};

/// A moment and what the patient said.
struct PatientLine {
  double time = 0;  ///< s
  std::string text;
};

struct InjectionRun {
  InjectionSpec spec;
  PlungerParams plunger;         ///< syringe, needle and liquid as they were
  bool gave_way = false;         ///< the tissue did
  Pose X_JP = Pose::Identity();  ///< where the probe's face lies on the skin at rest
  std::vector<InjectionRow> rows;
  std::vector<std::string> places;   ///< names of the spaces that got anything, the target first
  std::vector<double> volumes;       ///< m^3 in them at the end
  std::vector<InjectedSite> sites;   ///< where liquid first came to those that are drawn
  std::vector<std::string> regions;  ///< names of the joint's regions, by number
  std::string target;                ///< name of the space that was meant
  std::string target_like;           ///< its profile
  Pose X_JN = Pose::Identity();      ///< where the needle was while it flowed most, in the material
  double depth = 0;                  ///< m of its tip along the line then, as in the rows
  double given = 0;                  ///< m^3 that left the needle
  double drawn = 0;                  ///< m^3 of the patient's own
  double holds = std::numeric_limits<double>::infinity();  ///< m^3 in the target before it leaks
  double highest_pressure = 0;                             ///< Pa at the tip while it flowed
  double highest_force = 0;                                ///< N on the plunger
  double tip_walk = 0;    ///< m, range of the tip's depth while it flowed
  double unbalanced = 0;  ///< m^3, given less what is somewhere
  std::vector<PatientLine> patient;
  bool reached = false;      ///< the tip came where it was meant to
  bool complete = false;     ///< all that was meant was given
  std::uint32_t status = 0;  ///< PlungerStatus bits of all ticks
  /// The body in the end, still pressed, beside the same without liquid; empty where it is rigid.
  std::optional<HealthQuestion> pressed;
};

/// Runs it closed loop over a Simulation: hands, needle, thumb and plunger. Where the joint has
/// tetrahedra tissue gives way, and the other hand presses the probe on the skin as in
/// run_three_injections, where find_view_of sees the tip; the needle's hand goes by the picture,
/// which tells how deep the tip is in the material. `recording`: takes what went in and came out,
/// as a session's does; null: nobody wants it. Deterministic for a scene and spec. Errors:
/// not_found (device, gauge, liquid), invalid (the line does not meet the structure; the target
/// lies outside of the meshed body; volume or rate not above 0; what `validate` refuses; tissue
/// that cannot give way).
[[nodiscard]] Result<InjectionRun> run_injection(const Scene& scene, const InjectionSpec& spec,
                                                 Recording* recording = nullptr);

/// The first row at `time` or later, else the last. Requires: a run with rows.
[[nodiscard]] const InjectionRow& row_of(const InjectionRun& run, double time);

/// A stretch of a line in one structure, m from its entry.
struct LineLayer {
  double from = 0;
  double to = 0;
};
/// The stretch of the line from `entry` along `direction` in `region` in which `wanted` (m) is, or
/// the first with room for a tip, or the widest; none when it does not meet it.
[[nodiscard]] std::optional<LineLayer> find_layer(const Scene& scene, const Vec3& entry,
                                                  const Vec3& direction, RegionId region,
                                                  std::optional<double> wanted = {});

/// A line from the skin into `region`, short and without bone, nerve or vessel on its way, its
/// target where the region is thick; of those that are nearly as good the one that a probe sees
/// best (find_view_of). Deterministic. Cost: about a second. Errors: not_found.
[[nodiscard]] Result<std::pair<Vec3, Vec3>> find_line_into(const Scene& scene, RegionId region);

}  // namespace artus
