// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "artus/core/result.h"
#include "artus/detail/apps/options/command_line.h"
#include "artus/detail/exchange/session_link.h"

namespace artus {

/// --igtl and what belongs to it: how other programs see a session, and track its hands.
struct IgtlOptions {
  std::string listen;  ///< empty: nobody listens
  std::filesystem::path calibration;
  std::string probe = "ProbeToReference";
  std::string needle = "NeedleToReference";
  double probe_hold_ms = 500;
  double needle_hold_ms = 15;
};
void add_igtl_options(Command* command, IgtlOptions& options);

/// The calibration that --calibration names, or the identity; then where poses arrive.
/// Errors: as read_tracker_calibration.
struct TrackerInput {
  TrackerCalibration calibration;
  std::shared_ptr<TrackerInbox> inbox;
};
[[nodiscard]] Result<TrackerInput> make_tracker_input(const IgtlOptions& options);

/// What reads it. Requires: an inbox. Errors: invalid (--input igtl without --igtl).
[[nodiscard]] Result<std::unique_ptr<InputDevice>> make_tracker_device(const IgtlOptions& options,
                                                                       const TrackerInput& input);

/// Listens as --igtl says, and says where on stderr; null without it. `turn`, `begin`: see
/// SessionLink::Options. Errors: as SessionLink::open, malformed (--igtl).
[[nodiscard]] Result<std::unique_ptr<SessionLink>> open_session_link(
    const IgtlOptions& options, const TrackerInput& input,
    std::function<void(double ImageControls::*, double)> turn = {},
    std::function<RemoteAnswer(const std::string&)> begin = {});

}  // namespace artus
