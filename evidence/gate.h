// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/evidence/report.h"
#include "artus/haptics/needle_feel.h"

namespace artus {

struct CompiledJoint;

/// What was measured of something, against what, with what shows it.
using Gate = EvidenceReport;

/// What gates may be told; each takes what concerns it.
struct GateOptions {
  std::uint64_t seed = 1;                      ///< of hand and noise
  std::string device = "virtuose_6d_desktop";  ///< of needle experiments, see device_table()
  NeedleFeel feel;                             ///< of needle experiments; unset: as published
  bool tissue = false;  ///< needle experiments also in tissue that gives way, reported beside
  std::filesystem::path mock;  ///< TOML file of the pneumatic probe mock; empty: the bundled one
  std::shared_ptr<const CompiledJoint> joint;  ///< for gates of a joint; may be null
  std::filesystem::path reference;             ///< real pictures: a folder, or their table
  std::vector<std::string> reference_rows;     ///< how the names of its images begin; empty: all
};

/// What a gate cannot be measured without.
enum class GateNeeds : std::uint8_t { nothing, joint, joint_and_reference, reference };

/// An entry of the table of all gates.
struct GateEntry {
  std::string_view set;
  std::string_view name;   ///< one within its set
  std::string_view title;  ///< what is measured, in a line
  /// Deterministic for its options; leaves Gate::name to run_gate.
  Result<Gate> (*run)(std::string_view name, const GateOptions& options);
  GateNeeds needs = GateNeeds::nothing;
};

/// Gates that make one report.
struct GateSet {
  std::string_view name;
  std::string_view title;
  std::string_view source;  ///< what its values stand beside
  /// Each of its gates has a report of its own, with traces and tables: a folder each.
  bool apart = false;
  std::string_view verdict_file = "verdict.json";
};

}  // namespace artus
