// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>

#include "artus/detail/soft/solver/needle_compliance.h"
#include "artus/detail/soft/solver/soft_block.h"

namespace artus {

/// 2 mm of skin of 120 kPa, 6 mm of fat of 2.4 and 28 mm of muscle of 7.5 kPa over bone, and a
/// solver with its factor at rest: what a needle's gates and experiments give way by.
struct NeedledBlock {
  SoftBlock block;
  std::unique_ptr<SoftSolver> solver;

  /// Cost: some tenths of a second.
  NeedledBlock();
  /// A track straight in, of a needle of this radius, m.
  [[nodiscard]] static NeedleLine track(double radius);
  [[nodiscard]] NeedleCompliance compliance(double radius) const;
};

}  // namespace artus
