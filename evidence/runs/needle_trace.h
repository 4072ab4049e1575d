// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/operators/simulated_hand.h"
#include "artus/haptics/needle_renderer.h"

namespace artus {

/// One haptic tick as it is recorded: pose, contact, every component apart. SI, frame J; axial
/// forces positive into the body.
struct NeedleRow {
  double time = 0;
  Pose X_JN = Pose::Identity();  ///< as measured
  ContactState state = ContactState::away;
  std::uint32_t events = 0;  ///< ContactEvent bits
  std::uint32_t status = 0;  ///< TickStatus bits
  RegionId region = kOutside;
  int pass = 0;       ///< which injection, from 1
  double depth = 0;   ///< m, of the tip as the hand has it
  double pushed = 0;  ///< m of it that the tissue at the tip is pushed in; not in the trace's file
  double velocity = 0;        ///< m/s, axial, estimated
  double wall = 0;            ///< m, the tracking wall's anchor
  double cone = 0;            ///< rad, alpha(depth)
  double deviation = 0;       ///< m, tip off the insertion line
  double in_bone = 0;         ///< m, how far the tip is pressed into bone; 0 off it
  double incoming_speed = 0;  ///< m/s, of the last bone contact
  NeedleForces forces;
  Wrench command;             ///< after the guard
  Vec3 hand = Vec3::Zero();   ///< N, force of the simulated hand
  NeedleMotion needle;        ///< of the simulated needle itself, without an encoder's steps
  double energy_to_hand = 0;  ///< J given to the hand by the device since the start (observer)
  Vec3 axis = Vec3::UnitZ();  ///< insertion axis
};

/// Fills a row from a tick. The energy is the caller's.
[[nodiscard]] NeedleRow make_needle_row(double time, const Pose& X_JN,
                                        const RenderedNeedle& rendered, const NeedleModel& model);

/// The header of a trace and one of its rows, comma separated, without an end of line; `layer` is
/// the name in `region_names`, by region. The same row gives the same bytes in any locale.
[[nodiscard]] std::string needle_csv_header();
[[nodiscard]] std::string needle_csv_line(const NeedleRow& row,
                                          std::span<const std::string> region_names);

/// Columns that a caller adds behind the needle's own.
struct MoreColumns {
  std::string_view header;  ///< ",name_unit,..."
  /// Adds the cells of row `i`, each with a comma before it.
  std::function<void(std::size_t i, std::string& line)> append;
};

/// Writes rows as CSV: a header line with units, then one line a row. Errors: unreadable.
[[nodiscard]] Result<void> write_needle_csv(const std::filesystem::path& file,
                                            std::span<const NeedleRow> rows,
                                            std::span<const std::string> region_names,
                                            const MoreColumns& more = {});

}  // namespace artus
