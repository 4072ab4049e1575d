// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "artus/session/session.h"

namespace artus {

/// Counts what a session's ticks met, for who reads it once the session is over.
class TickTally final : public SessionObserver {
 public:
  /// `next` looks on, too; may be null, else outlives this.
  explicit TickTally(SessionObserver* next) noexcept : next_(next) {}

  void on_tick(const HapticSnapshot& tick) noexcept override {
    ++ticks_;
    if ((tick.status & TickStatus::kFaults & ~TickStatus::kLate) != 0) ++faults_;
    if ((tick.status & TickStatus::kLate) != 0) ++rested_;
    if ((tick.status & SessionStatus::kTissueLate) != 0) ++late_tissue_;
    if (tick.inserted != 0) ++inserted_;
    if (tick.feedback.contact == static_cast<std::uint32_t>(ContactState::bone)) ++on_bone_;
    const double* f = tick.force_J;
    max_force_ = std::max(max_force_, Vec3(f[0], f[1], f[2]).norm());
    if (next_ != nullptr) next_->on_tick(tick);
  }
  void on_frame(const FrameInput& input, const Frame& frame) override {
    if (next_ != nullptr) next_->on_frame(input, frame);
  }

  /// Ticks of each kind, and the largest force that was sent.
  [[nodiscard]] nlohmann::json to_json() const {
    return {{"faults", faults_},     {"rested", rested_},   {"late_tissue", late_tissue_},
            {"inserted", inserted_}, {"on_bone", on_bone_}, {"max_force_n", max_force_}};
  }
  /// The same as a line for people.
  void print() const {
    const double all = static_cast<double>(std::max<std::uint64_t>(1, ticks_)) / 100;
    std::printf(
        "needle in the body %.0f %%, on bone %.0f %% of the ticks; %llu refused, %llu at rest "
        "since late, %.1f %% in tissue older than 0.1 s; up to %.2f N\n",
        static_cast<double>(inserted_) / all, static_cast<double>(on_bone_) / all,
        static_cast<unsigned long long>(faults_), static_cast<unsigned long long>(rested_),
        static_cast<double>(late_tissue_) / all, max_force_);
  }

 private:
  SessionObserver* next_;
  std::uint64_t ticks_ = 0;
  std::uint64_t faults_ = 0;
  std::uint64_t rested_ = 0;       // zero force since too many ticks came late
  std::uint64_t late_tissue_ = 0;  // the tissue that was felt was older than 0.1 s
  std::uint64_t inserted_ = 0;
  std::uint64_t on_bone_ = 0;
  double max_force_ = 0;  // N
};

}  // namespace artus
