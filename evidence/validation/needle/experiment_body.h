// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <vector>

#include "artus/detail/evidence/runs/needle_trace.h"
#include "artus/detail/evidence/validation/needle/analytic_body.h"
#include "artus/detail/operators/hand_loop.h"
#include "artus/detail/operators/injection_operator.h"
#include "artus/haptics/needle_feel.h"

namespace artus {

/// A needle, a hand and a device on an analytic body, and what the operator does.
struct BodyExperiment {
  AnalyticBody body = AnalyticBody::make_stack(Vec3::Zero(), Vec3::UnitZ(), {0});
  std::vector<LayerHaptics> layers;  ///< outermost first
  std::vector<std::string> names;    ///< of the layers; empty: those of layer_names()
  NeedleFeel feel;                   ///< what the run changes of layers and parameters
  NeedleCompliance tissue;           ///< that gives way to the needle; no points: rigid
  Vec3 entry = Vec3::Zero();         ///< m, on the skin
  Vec3 direction = Vec3::UnitZ();    ///< unit
  double start_outside = 0.005;      ///< m before the skin
  std::vector<OperatorPhase> phases;
  /// When set, what the hand means at a time, s, instead of the phases, which look at the needle
  /// and so at the loop's rate.
  std::function<Intention(double)> path;
  double path_duration = 0;  ///< s
  NeedleParams needle;
  DeviceLimits device;
  HandParams hand;
  double rate_hz = 1000;
};

/// Runs it closed loop; a row a tick.
[[nodiscard]] std::vector<NeedleRow> run_body(const BodyExperiment& experiment);
/// The same, row by row as they come: for what keeps little of many runs.
void run_body(const BodyExperiment& experiment,
              const std::function<void(const NeedleRow&)>& take_row);

/// A layer with f_R, f_A in N and K_t in N/m, and nothing else: no membrane, friction or clamping.
[[nodiscard]] LayerHaptics plain_layer(double cutting, double stiffness, double attracted = 0);

/// A layer the tip cannot enter.
[[nodiscard]] LayerHaptics bone_layer(double cutting, double stiffness);

/// "layer 1", ... : what layers without a tissue's name are called.
[[nodiscard]] std::vector<std::string> numbered_layers(std::size_t layers);
/// `layers` behind "outside" and "beyond": names by region, for a trace.
[[nodiscard]] std::vector<std::string> region_names(std::vector<std::string> layers);
[[nodiscard]] std::vector<std::string> layer_names(std::size_t layers);

}  // namespace artus
