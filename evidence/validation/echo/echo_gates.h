// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include <nlohmann/json_fwd.hpp>

#include "artus/core/result.h"
#include "artus/detail/core/plot.h"
#include "artus/detail/core/progress.h"
#include "artus/detail/evidence/gates.h"

namespace artus {

/// A picture that goes with a gate.
struct GatePicture {
  std::string name;
  cv::Mat image;
};

/// A gate of the image's physics, measured on rendered frames, with what shows it.
struct EchoGate : Gate {
  std::string assumed;  ///< what it rests on that has no published source; empty: nothing
  Plot plot;            ///< no panels: none
  std::vector<GatePicture> pictures;
};

/// The names of all gates, in the order of the report. All use the default transducer.
[[nodiscard]] std::span<const std::string_view> echo_gates() noexcept;

/// Measures one gate; deterministic. Errors: not_found. Cost: 0.1 to a few s.
[[nodiscard]] Result<EchoGate> run_echo_gate(std::string_view name);

/// Writes report.md, gates.json and, in pictures/, the plots and pictures of `gates` into `folder`.
/// Errors: unreadable.
[[nodiscard]] Result<void> write_gate_report(std::span<const EchoGate> gates,
                                             const std::filesystem::path& folder);

/// {"pass": all, "counts": by kind, "gates": {name: {title, pass, counts, claims}}}
[[nodiscard]] nlohmann::json to_json(std::span<const EchoGate> gates);

}  // namespace artus
