// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/needle_tick_step.h"

#include <algorithm>
#include <utility>

namespace artus {
namespace {

/// What every source of intervals promises: they follow one another without gaps.
[[maybe_unused]] bool is_contiguous(std::span<const TissueInterval> intervals) noexcept {
  return std::adjacent_find(intervals.begin(), intervals.end(), [](const auto& a, const auto& b) {
           return a.exit != b.entry || a.exit < a.entry;
         }) == intervals.end();
}

}  // namespace

NeedleTickStep::NeedleTickStep(LayerTable table, const NeedleRendererParams& params)
    : table_(std::move(table)),
      dt_(1 / params.rate_hz),
      model_(params.needle, table_, dt_),
      input_guard_(params.guard, dt_),
      output_guard_(params.guard, params.device, dt_),
      passivity_(params.passivity, dt_) {
  ARTUS_REQUIRE(params.rate_hz >= 100 && params.rate_hz <= 20000,
                "the rate must be 100 to 20000 Hz");
}

void NeedleTickStep::run_laws(const Pose& X_JN) noexcept {
  rendered_.status = count_.truncated ? TickStatus::kTruncated : TickStatus::kOk;
  tip_ = X_JN.translation();
  if (faults_ != 0) {
    model_.reset();
    rendered_.forces = NeedleForces{};
    passivity_.pause();
  } else if (count_.truncated) {
    model_.hold();
  } else {
    const std::span<const TissueInterval> intervals(intervals_.data(), count_.size);
    ARTUS_ASSERT(is_contiguous(intervals));
    rendered_.forces = model_.step(X_JN, intervals);
  }
}

const RenderedNeedle& NeedleTickStep::command(const Vec3& more) noexcept {
  Wrench wanted = rendered_.forces.total;
  if (!more.isZero(0)) wanted.force += more;
  if (faults_ == 0) wanted.force = passivity_.step(tip_, wanted.force);
  rendered_.command = output_guard_.apply(wanted, faults_, rendered_.status);
  passivity_.observe(rendered_.command.force);
  rendered_.energy_to_hand = passivity_.energy_to_hand();
  const bool law_failed = faults_ == 0 && (rendered_.status & TickStatus::kFaults) != 0;
  if (law_failed || (count_.truncated && !output_guard_.engaged())) {
    model_.reset();
    if (count_.truncated) rendered_.forces = NeedleForces{};
  }
  return rendered_;
}

}  // namespace artus
