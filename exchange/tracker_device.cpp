// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/tracker_device.h"

#include <algorithm>

#include "artus/detail/exchange/igtl/contents.h"

namespace artus {

namespace {
constexpr std::int64_t kNanosecondsOfAMillisecond = 1'000'000;
}  // namespace

TrackerInbox::TrackerInbox(const TrackerCalibration& calibration, const Names& names)
    : calibration_(calibration), reference_(calibration.X_JR), names_(names) {}

Result<void> TrackerInbox::take(const igtl::Message& message, std::int64_t now_ns) {
  if (message.type == "SENSOR" && message.device == names_.plunger)
    return take_plunger(message, now_ns);
  const bool probe = message.device == names_.probe;
  if (message.type != "TRANSFORM" || !(probe || message.device == names_.needle)) return {};
  const std::string_view status = message.meta_value("TransformStatus");
  if (!status.empty() && status != "OK") return {};
  const auto pose = [&]() -> Result<Pose> {
    const auto matrix = igtl::parse_transform(message.content);
    ARTUS_TRY(matrix);
    return reference_.from_reference(*matrix);
  }();
  if (!pose) {
    newest_.refused_ns = now_ns;
  } else if (probe) {
    newest_.X_WP = to_plain(*pose * calibration_.X_ProbeP);
    newest_.probe_ns = now_ns;
  } else {
    newest_.X_WN = to_plain(*pose * calibration_.X_NeedleN);
    newest_.needle_ns = now_ns;
  }
  if (pose) ++newest_.number;
  poses_.store(newest_);
  if (!pose) return fail(pose.error().code, message.device + ": " + pose.error().message);
  return {};
}

Result<void> TrackerInbox::take_plunger(const igtl::Message& message, std::int64_t now_ns) {
  const auto sensor = igtl::parse_sensor(message.content);
  DeviceSample said;
  if (sensor && sensor->values.size() == 1) {
    if (sensor->unit == igtl::kNewton) said.plunger = PlungerSign::force;
    if (sensor->unit == igtl::kMetre) said.plunger = PlungerSign::travel;
    said.plunger_force = said.plunger_travel = 0;
    (said.plunger == PlungerSign::force ? said.plunger_force : said.plunger_travel) =
        sensor->values[0];
  }
  const bool sound = said.plunger != PlungerSign::none && is_plunger(said);
  newest_.sign = sound ? said.plunger : PlungerSign::none;
  newest_.plunger = sound ? sensor->values[0] : 0;
  newest_.plunger_ns = now_ns;
  poses_.store(newest_);
  if (!sound)
    return fail(ErrorCode::invalid,
                message.device + ": the plunger must be one number, at most 1000 N or 1 m");
  return {};
}

DeviceSample TrackerDevice::read(std::int64_t now_ns) noexcept {
  TrackedPoses poses;
  if (inbox_->load(poses)) seen_ = poses;
  const auto fresh = [now_ns](std::int64_t heard_ns, std::int64_t hold_ns) {
    return heard_ns != 0 && now_ns - heard_ns < hold_ns;
  };
  DeviceSample sample;
  sample.X_WN = seen_.X_WN;
  sample.X_WP = seen_.X_WP;
  sample.number = seen_.number;
  sample.has_needle = fresh(seen_.needle_ns, holds_.needle_ns) ? 1 : 0;
  sample.has_probe = fresh(seen_.probe_ns, holds_.probe_ns) ? 1 : 0;
  if (fresh(seen_.plunger_ns, holds_.needle_ns)) {
    sample.plunger = seen_.sign;
    if (seen_.sign == PlungerSign::travel) sample.plunger_travel = seen_.plunger;
    if (seen_.sign == PlungerSign::force) sample.plunger_force = seen_.plunger;
  }
  sample.hold_ms = static_cast<std::uint32_t>(std::min<std::int64_t>(
      kLongestHold, std::max(kPeerTimeout, holds_.needle_ns) / kNanosecondsOfAMillisecond));
  sample.time_ns = sample.has_needle != 0 ? seen_.needle_ns : seen_.probe_ns;
  const std::int64_t heard = std::max(seen_.needle_ns, seen_.probe_ns);
  if (sample.has_needle != 0 || sample.has_probe != 0)
    sample.state = PeerState::alive;
  else if (seen_.refused_ns > heard)
    sample.state = PeerState::invalid;
  else
    sample.state = heard == 0 ? PeerState::absent : PeerState::lost;
  return sample;
}

}  // namespace artus
