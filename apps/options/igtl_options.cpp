// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/igtl_options.h"

#include <cstdio>
#include <utility>

#include "artus/detail/apps/options/command.h"

namespace artus {
namespace {

std::int64_t nanoseconds(double milliseconds) {
  return static_cast<std::int64_t>(milliseconds * 1e6);
}

}  // namespace

void add_igtl_options(Command* command, IgtlOptions& options) {
  const char* group = "OpenIGTLink";
  command
      ->add_option("--igtl", options.listen,
                   "[address:]port that 3D Slicer, PLUS and others connect to (18944 by "
                   "custom), this machine alone unless an address says otherwise; or "
                   "connect:HOST:PORT, a server (PlusServer, a tracker) to connect to")
      ->group(group);
  command
      ->add_option("--calibration", options.calibration,
                   "how the tracker's sensors sit on probe, needle and joint, and where a device "
                   "lets a needle in (.toml)")
      ->group(group);
  command->add_option("--tracker-probe", options.probe, "name of the probe's TRANSFORM")
      ->group(group)
      ->capture_default_str();
  command->add_option("--tracker-needle", options.needle, "name of the needle's TRANSFORM")
      ->group(group)
      ->capture_default_str();
  command
      ->add_option("--probe-hold-ms", options.probe_hold_ms,
                   "how long a probe stays where it was last seen")
      ->check(number_in(1, 60000))
      ->group(group)
      ->capture_default_str();
  command
      ->add_option("--needle-hold-ms", options.needle_hold_ms,
                   "the same of the needle; trackers below 67 Hz need more than 15, where no hand "
                   "feels the force")
      ->check(number_in(1, 1000))
      ->group(group)
      ->capture_default_str();
}

Result<TrackerInput> make_tracker_input(const IgtlOptions& options) {
  TrackerInput input;
  if (!options.calibration.empty()) {
    auto calibration = read_tracker_calibration(options.calibration);
    ARTUS_TRY(calibration);
    input.calibration = *calibration;
  }
  input.inbox = std::make_shared<TrackerInbox>(input.calibration,
                                               TrackerInbox::Names{options.probe, options.needle});
  return input;
}

Result<std::unique_ptr<InputDevice>> make_tracker_device(const IgtlOptions& options,
                                                         const TrackerInput& input) {
  if (options.listen.empty())
    return fail(ErrorCode::invalid, "poses come in by --igtl [address:]port", "--input igtl");
  return std::unique_ptr<InputDevice>(std::make_unique<TrackerDevice>(
      input.inbox, TrackerDevice::Holds{nanoseconds(options.probe_hold_ms),
                                        nanoseconds(options.needle_hold_ms)}));
}

Result<std::unique_ptr<SessionLink>> open_session_link(
    const IgtlOptions& options, const TrackerInput& input,
    std::function<void(double ImageControls::*, double)> turn,
    std::function<RemoteAnswer(const std::string&)> begin) {
  if (options.listen.empty()) return std::unique_ptr<SessionLink>();
  constexpr std::string_view kConnect = "connect:";
  const bool out = options.listen.compare(0, kConnect.size(), kConnect) == 0;
  const auto where =
      igtl::parse_address(out ? options.listen.substr(kConnect.size()) : options.listen, "--igtl");
  ARTUS_TRY(where);
  SessionLink::Options link_options;
  if (out)
    link_options.server.connect_to = *where;
  else
    link_options.server.where = *where;
  link_options.reference = ReferenceFrame(input.calibration.X_JR);
  link_options.inbox = input.inbox;
  link_options.version = ARTUS_VERSION;
  link_options.turn = std::move(turn);
  link_options.begin = std::move(begin);
  auto link = SessionLink::open(link_options);
  ARTUS_TRY(link);
  if (out) {
    std::fprintf(stderr, "OpenIGTLink: connecting to %s port %d\n", where->address.c_str(),
                 where->port);
    return link;
  }
  std::fprintf(stderr, "OpenIGTLink: listening on %s port %d\n", where->address.c_str(),
               (*link)->server().port());
  return link;
}

}  // namespace artus
