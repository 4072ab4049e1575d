// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <concepts>

#include "artus/detail/haptics/guard.h"
#include "artus/detail/haptics/needle/needle_model.h"
#include "artus/detail/haptics/passivity.h"

namespace artus {

/// Who can say what a line meets: Scene, or a body whose surfaces are formulas.
template <class B>
concept IntervalSource = requires(const B& body, const Segment& segment,
                                  std::span<TissueInterval> out) {
  { body.find_intervals(segment, out) }
  noexcept->std::same_as<QueryCount>;
};

/// What a needle's tick is made of besides the body.
struct NeedleRendererParams {
  NeedleParams needle;
  GuardParams guard;
  PassivityParams passivity;
  DeviceLimits device;    ///< whose limits the command is kept in
  double rate_hz = 1000;  ///< ticks a second, 100 to 20000
};

/// One tick's result: what to send, and why.
struct RenderedNeedle {
  Wrench command;             ///< within the device's limits, safe to send
  NeedleForces forces;        ///< the components before limits; zero on a fault
  std::uint32_t status = 0;   ///< TickStatus bits
  double energy_to_hand = 0;  ///< J given since the start, by the passivity observer
};

/// The complete haptic tick of the needle: input guard, query along the shaft, force laws,
/// passivity, output guard. The one form of it: live, in replays and in experiments on analytic
/// bodies. The period is fixed, so the same poses give the same bytes. A query that did not get all
/// the layers of its line (kTruncated) is not believed: the laws rest, the last force fades over
/// the guard's ramp_time, and comes back as fast. One needle; not for several threads at once.
class NeedleTickStep {
 public:
  /// Requires: rate in [100, 20000] Hz.
  NeedleTickStep(LayerTable table, const NeedleRendererParams& params);
  NeedleTickStep(const NeedleTickStep&) = delete;
  NeedleTickStep& operator=(const NeedleTickStep&) = delete;
  ~NeedleTickStep() = default;

  /// Errors: none; any input gives a wrench within limits and says in the status what was wrong.
  template <IntervalSource Body>
  ARTUS_REALTIME const RenderedNeedle& step(const TimedPose& pose, const Body& body) noexcept {
    feel(pose, body);
    return command();
  }

  /// The first half of a tick, for who adds forces that hang on it: contact and laws. True: nothing
  /// is wrong with the pose.
  template <IntervalSource Body>
  ARTUS_REALTIME bool feel(const TimedPose& pose, const Body& body) noexcept {
    faults_ = input_guard_.check(pose);
    count_ = {};
    if (faults_ == 0) count_ = body.find_intervals(model_.query_segment(pose.X_JN), intervals_);
    run_laws(pose.X_JN);
    return faults_ == 0;
  }
  /// The second: what the laws ask for and `more` (N, frame J; a syringe's, an aid's) through
  /// passivity and output guard, which nothing passes by.
  ARTUS_REALTIME const RenderedNeedle& command(const Vec3& more = Vec3::Zero()) noexcept;

  /// NeedleModel::take.
  ARTUS_REALTIME void take(const NeedlePacket& packet) noexcept { model_.take(packet); }

  [[nodiscard]] const NeedleModel& model() const noexcept { return model_; }
  [[nodiscard]] const LayerTable& table() const noexcept { return table_; }
  [[nodiscard]] double energy_to_hand() const noexcept {
    return passivity_.energy_to_hand();
  }                                                             ///< J
  [[nodiscard]] double period() const noexcept { return dt_; }  ///< s

 private:
  static constexpr std::size_t kMaxIntervals = 64;

  void run_laws(const Pose& X_JN) noexcept;

  LayerTable table_;
  double dt_;
  NeedleModel model_;
  InputGuard input_guard_;
  OutputGuard output_guard_;
  PassivityObserver passivity_;
  std::array<TissueInterval, kMaxIntervals> intervals_{};
  std::uint32_t faults_ = 0;  // of this tick's pose
  QueryCount count_;          // of this tick's line
  Vec3 tip_ = Vec3::Zero();   // m, frame J
  RenderedNeedle rendered_;
};

}  // namespace artus
