// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/anatomy/body/layered_body.h"
#include "artus/detail/haptics/plunger/syringe_choice.h"
#include "artus/detail/training/judgement.h"

namespace artus {

/// A block of layers, made when the scenario is played, in place of a joint. Its top is z = 0, the
/// body lies along +z; regions are named like their tissue, a second one "<tissue>_2".
struct GelBlock {
  std::vector<FlatLayer> layers;  ///< top first
  std::vector<Ball> balls;        ///< each wholly in one layer, none in another
  double width = 0.12;            ///< m, along x and y
};

/// What is sought and how the simulated hands aim.
struct ScenarioTarget {
  std::string structure;      ///< empty: the point
  Vec3 point = Vec3::Zero();  ///< m, frame J: where hands aim, and the target without structure
};

/// Where the tip must not come.
struct ScenarioAvoid {
  std::string structure;
  double margin = 0;  ///< m
  bool fatal = false;
};

/// Where the needle may go in.
struct ScenarioEntry {
  Vec3 centre = Vec3::Zero();  ///< m, on the skin
  double radius = 10e-3;       ///< m
  std::string plane = "in";    ///< in, out or free
  double min_angle = 0;        ///< rad, of the shaft to the probe's face
  double max_angle = 1.5708;   ///< rad
};

/// What is to be injected once the tip is in place; without volume nothing is.
struct ScenarioSyringe {
  double volume = 0;              ///< m^3
  double rate = 0.1e-6;           ///< m^3/s that is asked for
  double barrel = 0;              ///< m^3; 0: the smallest that holds it
  std::string liquid = "saline";  ///< of meshes/liquids.toml
};

/// What may be shown to help, 0 off to 1 full.
struct Aid {
  std::string name;
  double value = 0;
};

/// A task: everything that a session needs beside the joint itself.
struct Scenario {
  std::string name;
  std::string title;
  std::string title_fr;               ///< the same in French; empty: there is none
  std::string joint;                  ///< a joint folder or compiled file; empty: `gel`
  std::vector<std::string> variants;  ///< of the joint: what this patient has
  std::string patient;                ///< whose joint it is (resolve_patient); empty: as modelled
  std::optional<GelBlock> gel;
  std::string procedure;
  int level = 0;  ///< rung of the ladder, 0 to 8
  std::uint64_t seed = 1;
  std::string transducer = "linear-6-18";
  double depth = 40e-3;          ///< m, of the picture
  Pose X_JP = Pose::Identity();  ///< the view that shows target and path
  int gauge = 22;
  double needle_length = 50e-3;  ///< m
  ScenarioSyringe syringe;
  /// Structures to be shown one after another: a task for the probe alone, without needle. Empty:
  /// a task for the needle.
  std::vector<std::string> find;
  ScenarioTarget target;
  std::vector<ScenarioAvoid> avoid;
  ScenarioEntry entry;
  double time_limit = 180;  ///< s
  std::vector<Aid> aids;
  std::string fade = "none";  ///< success, trials or none
  std::vector<Mark> pass;
  std::vector<ScoreWeight> score;
  std::vector<std::string> steps;
  std::string text;  ///< the file as read
  [[nodiscard]] bool aided() const noexcept;
  /// The joint with its variants and patient, as load_joint takes it.
  [[nodiscard]] std::filesystem::path body() const;
};

/// The syringe as it lies ready: what is to be given, and nothing more.
[[nodiscard]] SyringeChoice syringe_of(const Scenario& scenario);

/// The layer that a ball lies wholly in; their number when there is none.
[[nodiscard]] std::size_t layer_of(const GelBlock& gel, const Ball& ball);

/// The names of aids that a scenario may use.
[[nodiscard]] std::vector<std::string> aid_names();

/// Reads a scenario (docs/scenarios.md). Errors: not_found, malformed (TOML), invalid: every
/// unknown key, value out of range and unknown metric of a mark, all in one message with their
/// lines.
[[nodiscard]] Result<Scenario> read_scenario(const std::filesystem::path& file);
[[nodiscard]] Result<Scenario> parse_scenario(std::string_view text, const std::string& name);

/// The scenarios that come with artus, by level and name.
[[nodiscard]] std::vector<std::string_view> bundled_scenario_texts();
/// A file, or the bundled one of that name. Errors: as read_scenario; not_found lists the names.
[[nodiscard]] Result<Scenario> find_scenario(const std::string& name_or_file);

/// What is left of an aid after so many successes: times 0.7 each, off below 0.1.
[[nodiscard]] double faded(double value, int successes) noexcept;

}  // namespace artus
