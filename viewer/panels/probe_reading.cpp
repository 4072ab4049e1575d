// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/probe_reading.h"

#include "artus/detail/viewer/panels/panels.h"

namespace artus {

ProbeReading read_probe(const HapticSnapshot& now, const SessionParams& params) {
  ProbeReading probe;
  probe.felt = params.deform && now.input.device.has_probe != 0;
  if (!probe.felt) return probe;
  probe.force = press_of_probe(now);
  probe.share = now.feedback.probe_share;
  probe.tissue_age = now.feedback.tissue_age;
  probe.status = now.feedback.probe_status;
  return probe;
}

std::string describe_probe(Language language, const ProbeReading& probe) {
  if (!probe.felt) return {};
  std::string said =
      fill(translate(language, "probe {} N, {} % of its face in contact, tissue {} ms old"),
           {number(language, probe.force, 1), number(language, 100 * probe.share, 0),
            number(language, 1e3 * probe.tissue_age, 0)});
  if (probe.status != 0) said += ": " + describe_status(language, probe.status);
  return said;
}

}  // namespace artus
