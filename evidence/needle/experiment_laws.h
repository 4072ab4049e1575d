// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/haptics/needle/needle_model.h"

namespace artus {

/// The force laws that a run of an experiment changes; what is not set is as published.
struct ExperimentLaws {
  LawSelection laws;
  PatientProfile patient;
  std::optional<HardLaw> tap;
  std::optional<ClampingLaw> clamping;
  std::optional<LugreParams> friction;
  std::optional<HemisphereParams> workspace;
  bool passivity_control = false;
};

/// Kinds of laws, bits: what an experiment lets a run change, and what a run has changed.
struct LawKind {
  static constexpr std::uint32_t kCutting = 1U << 0U;
  static constexpr std::uint32_t kPrepuncture = 1U << 1U;
  static constexpr std::uint32_t kTap = 1U << 2U;
  static constexpr std::uint32_t kClamping = 1U << 3U;
  static constexpr std::uint32_t kFriction = 1U << 4U;
  static constexpr std::uint32_t kPatient = 1U << 5U;
  static constexpr std::uint32_t kWorkspace = 1U << 6U;
  static constexpr std::uint32_t kPassivity = 1U << 7U;
  static constexpr std::uint32_t kAll = (1U << 8U) - 1;
};
[[nodiscard]] std::uint32_t changed_laws(const ExperimentLaws& laws) noexcept;

/// Whether an experiment that takes `takes` (LawKind bits) and has layers of these names can run by
/// `laws`. Errors: invalid (a kind it does not take: `why_not` says why), not_found (a layer), with
/// the flag that sets it.
[[nodiscard]] Result<void> check_laws(const ExperimentLaws& laws, std::string_view experiment,
                                      std::uint32_t takes, std::string_view why_not,
                                      std::span<const std::string> layer_names);

/// The layers, whose names are `names`, and the parameters as the run wants them.
void apply_laws(const ExperimentLaws& laws, std::span<const std::string> names,
                std::vector<LayerHaptics>& layers);
void apply_laws(const ExperimentLaws& laws, NeedleParams& needle) noexcept;

}  // namespace artus
