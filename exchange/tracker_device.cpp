// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/tracker_device.h"

#include <algorithm>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/detail/exchange/igtl/contents.h"

namespace artus {

namespace {
constexpr std::int64_t kNanosecondsOfAMillisecond = 1'000'000;
constexpr std::size_t kToolName = 20;  // bytes of a tool's name in TDATA

bool is_power_of_two(std::uint64_t n) noexcept {
  return (n & (n - 1)) == 0;
}
}  // namespace

TrackerInbox::TrackerInbox(const TrackerCalibration& calibration, const Names& names)
    : calibration_(calibration), reference_(calibration.X_JR), names_(names) {}

void TrackerInbox::register_at(const Pose& X_JR) {
  const std::lock_guard lock(registering_);
  reference_ = ReferenceFrame(X_JR);
}

Result<void> TrackerInbox::take(const igtl::Message& message, std::int64_t now_ns) {
  if (message.type == "SENSOR" && message.device == names_.plunger)
    return take_plunger(message, now_ns);
  if (message.type == "TDATA" || message.type == "QTDATA") return take_tools(message, now_ns);
  const bool transform = message.type == "TRANSFORM";
  if (!transform && message.type != "POSITION") return {};
  if (message.device != names_.probe && message.device != names_.needle) {
    tell_unknown(message.type + " " + message.device);
    return {};
  }
  const std::string_view status = message.meta_value("TransformStatus");
  if (!status.empty() && status != "OK") return {};
  return take_pose(
      message.device,
      transform ? igtl::parse_transform(message.content) : igtl::parse_position(message.content),
      message, now_ns);
}

Result<void> TrackerInbox::take_tools(const igtl::Message& message, std::int64_t now_ns) {
  const auto tools = message.type == "TDATA" ? igtl::parse_tdata(message.content)
                                             : igtl::parse_qtdata(message.content);
  ARTUS_TRY(tools);
  const auto means = [](const std::string& tool, const std::string& name) {
    return tool == name.substr(0, kToolName) || tool == name.substr(0, name.rfind("To"));
  };
  Result<void> all;
  std::string others;
  for (const igtl::TrackedTool& tool : *tools) {
    const bool probe = means(tool.name, names_.probe);
    if (!probe && !means(tool.name, names_.needle)) {
      others += (others.empty() ? "" : ", ") + tool.name;
      continue;
    }
    const auto taken =
        take_pose(probe ? names_.probe : names_.needle, tool.matrix, message, now_ns);
    if (!taken) all = taken;
  }
  if (!others.empty()) tell_unknown(message.type + " " + others);
  return all;
}

void TrackerInbox::tell_unknown(const std::string& names) {
  constexpr std::size_t kMost = 32;
  if (told_.size() < kMost && told_.insert(names).second)
    notice_ = names + " is not taken: the hands are " + names_.probe + " and " + names_.needle +
              " (--tracker-probe, --tracker-needle)";
}

void TrackerInbox::watch(bool probe, const Pose& pose, const igtl::Message& message,
                         std::int64_t now_ns) {
  constexpr double kLongest = 0.25;   // s between two poses that are compared
  constexpr double kFastest = 2;      // m/s, as a session refuses of a device
  constexpr double kShortest = 5e-3;  // s; messages may come in one piece
  constexpr double kFar = 0.02;       // m; less is noise of the tracker
  Watched& last = watched_[probe ? 1 : 0];
  const double time =
      message.time != 0 ? igtl::seconds_of(message.time) : 1e-9 * static_cast<double>(now_ns);
  const double dt = std::max(time - last.time, kShortest);
  if (last.pose && time >= last.time && dt <= kLongest) {
    const double far = (pose.translation() - last.pose->translation()).norm();
    const bool flipped = pose.linear().col(2).dot(last.pose->linear().col(2)) < 0;
    const bool leapt = far > kFar && far / dt > kFastest;
    if ((flipped || leapt) && is_power_of_two(++last.odd))
      notice_ =
          (probe ? names_.probe : names_.needle) +
          printed(flipped ? " flipped: its axis turned round, its origin went %.0f mm in %.0f "
                            "ms (%llu such poses so far)"
                          : " leapt %.0f mm in %.0f ms (%llu such poses so far)",
                  far / kMillimetre, 1e3 * dt, static_cast<unsigned long long>(last.odd));
  }
  last.pose = pose;
  last.time = time;
}

Result<void> TrackerInbox::take_pose(const std::string& device, const Result<igtl::Matrix>& matrix,
                                     const igtl::Message& message, std::int64_t now_ns) {
  const bool probe = device == names_.probe;
  const std::lock_guard lock(registering_);
  const auto scaled = [this](igtl::Matrix X_RS) {
    X_RS.col(3) *= calibration_.scale;
    return X_RS;
  };
  const auto pose = matrix ? reference_.from_reference(scaled(*matrix))
                           : Result<Pose>(tl::unexpected<Error>(matrix.error()));
  if (!pose) {
    newest_.refused_ns = now_ns;
  } else if (probe) {
    const Pose X_WP = *pose * calibration_.X_ProbeP;
    watch(true, X_WP, message, now_ns);
    newest_.X_WP = to_plain(X_WP);
    newest_.probe_ns = now_ns;
  } else {
    const Pose X_WN = *pose * calibration_.X_NeedleN;
    watch(false, X_WN, message, now_ns);
    newest_.X_WN = to_plain(X_WN);
    newest_.needle_ns = now_ns;
  }
  if (pose) ++newest_.number;
  poses_.store(newest_);
  if (!pose) return fail(pose.error().code, device + ": " + pose.error().message);
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
