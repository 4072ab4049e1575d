// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/recording.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <istream>
#include <iterator>
#include <limits>
#include <type_traits>
#include <utility>

#include "artus/detail/core/text_file.h"
#include "artus/detail/session/record/needle_contrast.h"

namespace artus {
namespace {

constexpr std::size_t kLongestHead = std::size_t{64} * 1024;  // bytes
constexpr double kFar = 50;       // m from the joint's origin, of any pose that a device can make
constexpr double kSoftest = 1e3;  // m/N, of any tissue

static_assert(sizeof(TickRecord) == 352 && sizeof(FrameRecord) == 624 &&
                  sizeof(PacketRecord) == 3136,
              "as documented");

template <class T>
bool read(std::istream& in, T& value) {
  return static_cast<bool>(in.read(reinterpret_cast<char*>(&value), sizeof value));
}

/// False where a crash cut the record off.
template <class T>
Result<bool> read_into(std::istream& in, std::vector<T>& records, std::uint64_t& last,
                       const std::string& where) {
  T record;
  if (!read(in, record)) return false;
  const char* fault = find_fault(record, last);
  if (fault != nullptr)
    return fail(ErrorCode::corrupt,
                std::string(fault) + " in record " + std::to_string(records.size() + 1), where);
  if constexpr (std::is_same_v<T, TickRecord>)
    last = record.input.tick;
  else if constexpr (std::is_same_v<T, PacketRecord>)
    last = record.tick;
  else
    last = record.input.number;
  records.push_back(record);
  return true;
}

/// Numbers of the newest tick and image.
struct Newest {
  std::uint64_t tick = 0;
  std::uint64_t frame = 0;
  std::uint64_t packet = 0;
};

/// False at the end or at what a crash cut off.
Result<bool> read_record(std::istream& in, Recording& recording, Newest& newest,
                         const std::string& where) {
  RecordStart start;
  if (!read(in, start)) return false;
  if (start.kind == RecordStart::kTick && start.size == sizeof(TickRecord))
    return read_into(in, recording.ticks, newest.tick, where);
  if (start.kind == RecordStart::kFrame && start.size == sizeof(FrameRecord))
    return read_into(in, recording.frames, newest.frame, where);
  if (start.kind == RecordStart::kPacket && start.size == sizeof(PacketRecord))
    return read_into(in, recording.packets, newest.packet, where);
  if (start.kind == RecordStart::kEnd && start.size == sizeof recording.dropped) {
    recording.complete = read(in, recording.dropped);
    if (recording.complete && in.peek() != std::istream::traits_type::eof())
      return fail(ErrorCode::corrupt, "there is data after the end of the recording", where);
    return false;
  }
  return fail(ErrorCode::corrupt, "unknown kind or size of record", where);
}

bool is_flag(std::uint32_t value) noexcept {
  return value <= 1;
}

bool is_force(double value) noexcept {
  return std::abs(value) <= 1e3;  // N
}

template <std::size_t N>
bool all_finite(const double (&values)[N]) noexcept {
  return std::all_of(std::begin(values), std::end(values),
                     [](double value) { return std::isfinite(value); });
}

}  // namespace

FrameRecord to_record(const FrameInput& input, const Frame& frame, const Transducer& transducer) {
  FrameRecord record;
  record.input = input;
  record.digest = digest_of(frame);
  if (const auto contrast = needle_contrast(input, frame, transducer))
    record.tip_contrast = *contrast;
  return record;
}

TickRecord to_record(const HapticSnapshot& snapshot) noexcept {
  TickRecord record;
  record.input = snapshot.input;
  std::copy(std::begin(snapshot.feedback.force), std::end(snapshot.feedback.force), record.force);
  std::copy(std::begin(snapshot.feedback.torque), std::end(snapshot.feedback.torque),
            record.torque);
  const DeviceFeedback& f = snapshot.feedback;
  std::copy(std::begin(f.probe_force), std::end(f.probe_force), record.probe_force);
  std::copy(std::begin(f.probe_torque), std::end(f.probe_torque), record.probe_torque);
  record.plunger = f.plunger;
  record.status = snapshot.status;
  record.region = snapshot.feedback.region;
  return record;
}

const char* find_fault(const TickRecord& record, std::uint64_t last) noexcept {
  const DeviceSample& device = record.input.device;
  if (record.input.tick <= last) return "tick number that does not rise";
  if (!is_pose(device.X_WN) || !is_pose(device.X_WP)) return "invalid pose in tick";
  if (device.state > PeerState::invalid) return "unknown device state";
  if (!is_flag(device.has_needle) || !is_flag(device.has_probe))
    return "flag that is neither 0 nor 1";
  if ((record.input.command & ~SessionCommand::kAll) != 0 || record.input.reserved != 0)
    return "unknown command";
  if (!is_plunger(device)) return "invalid plunger input";
  if (!is_hold(device.hold_ms)) return "a pose that is held for too long";
  const PlungerFeedback& p = record.plunger;
  const double plunger[] = {p.thumb_force, p.pressure, p.tip_pressure, p.flow,
                            p.travel,      p.given,    p.drawn};
  if (!all_finite(plunger) || p.reserved != 0) return "invalid plunger feedback";
  if (!all_finite(record.force) || !all_finite(record.torque) || !all_finite(record.probe_force) ||
      !all_finite(record.probe_torque))
    return "force that is not finite";
  return record.region > std::numeric_limits<RegionId>::max() ? "region number out of range"
                                                              : nullptr;
}

bool is_place(const double (&p_J)[3]) noexcept {  // NOLINT(*-avoid-c-arrays)
  return std::all_of(std::begin(p_J), std::end(p_J), [](double x) { return std::abs(x) <= kFar; });
}

bool is_load(const NeedleLoad& load) noexcept {
  return std::all_of(load.shaft.begin(), load.shaft.end(), is_force) && is_force(load.tip) &&
         std::abs(load.tip_depth) <= kFar;
}

bool is_compliance(const NeedleCompliance& c) noexcept {
  if (c.points > NeedleCompliance::kMax || !(c.spacing > 0 && c.spacing < 1)) return false;
  const auto small = [](double v) {
    return std::abs(v) <= kSoftest;
  };
  const auto all_small = [&small](const auto& row) {
    return std::all_of(row.begin(), row.end(), small);
  };
  if (!all_small(c.near_field) || !std::all_of(c.by_load.begin(), c.by_load.end(), all_small))
    return false;
  for (std::size_t i = 0; i < c.points; ++i)
    if (!(c.by_load[i][i] > 0)) return false;
  return true;
}

const char* find_fault(const FrameRecord& record, std::uint64_t last) noexcept {
  const FrameInput& input = record.input;
  if (input.number <= last) return "image number that does not rise";
  if (!is_pose(input.X_JP, kFar) || !is_pose(input.X_JN, kFar)) return "invalid pose in image";
  if (!is_flag(input.has_needle) || !is_flag(input.has_probe))
    return "flag that is neither 0 nor 1";
  if (input.n_sites > kMaxSites || input.reserved != 0) return "too many injected sites";
  for (const InjectedSite& site : input.sites)
    if (!is_place(site.p_J) || !(site.volume >= 0 && site.volume < 1) || !is_flag(site.cavity) ||
        site.region > std::numeric_limits<RegionId>::max())
      return "invalid injected site";
  if (!is_load(input.load)) return "invalid needle load";
  const ImageControls& c = input.controls;
  const double knobs[] = {c.depth,     c.gain_db,         c.tgc_db_cm_mhz, c.dynamic_range_db,
                          c.frequency, c.elevation_focus, c.persistence};
  if (!all_finite(knobs) || !std::all_of(c.grey_curve.grey.begin(), c.grey_curve.grey.end(),
                                         [](double grey) { return std::isfinite(grey); }))
    return "image control that is not finite";
  if (c.look > Look::compound || c.motion > MotionShown::power || c.compound_angles > 99 ||
      c.more_reserved != 0)
    return "image control out of its range";
  return std::isinf(record.tip_contrast) ? "infinite tip contrast" : nullptr;
}

const char* find_fault(const PacketRecord& record, std::uint64_t last) noexcept {
  if (record.tick <= last) return "packet number that does not rise";
  const ProbePacket& p = record.packet.probe;
  const NeedlePacket& n = record.packet.needle;
  const auto finite = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  };
  if (!is_packet(p) || !finite(n.carried) || !is_compliance(n.compliance) ||
      !(n.compliance_scale >= 0 && n.compliance_scale <= 1))
    return "invalid packet";
  return nullptr;
}

Result<Recording> read_recording(std::istream& in, const std::string& where) {
  std::string line;
  for (int c = in.get(); c != std::istream::traits_type::eof() && c != '\n'; c = in.get()) {
    if (line.size() == kLongestHead)
      return fail(ErrorCode::malformed, "this is not a recording of artus", where);
    line.push_back(static_cast<char>(c));
  }
  Recording recording;
  auto head = parse_head(line);
  if (!head) {
    Error error = head.error();
    error.where = error.where.empty() ? where : where + ": " + error.where;
    return tl::unexpected(error);
  }
  recording.head = std::move(*head);
  Newest newest;
  for (;;) {
    const Result<bool> more = read_record(in, recording, newest, where);
    ARTUS_TRY(more);
    if (!*more) return recording;
  }
}

Result<Recording> read_recording(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return fail(ErrorCode::not_found, "cannot open the recording", file);
  return read_recording(in, file.string());
}

namespace {

template <class T>
void put(std::string& out, std::uint32_t kind, const T& record) {
  const RecordStart start{kind, sizeof(T)};
  out.append(reinterpret_cast<const char*>(&start), sizeof start);
  out.append(reinterpret_cast<const char*>(&record), sizeof record);
}

}  // namespace

Result<void> write_recording(const Recording& recording, const std::filesystem::path& file) {
  std::string out = to_line(recording.head) + "\n";
  auto frame = recording.frames.begin();
  auto packet = recording.packets.begin();
  for (const TickRecord& tick : recording.ticks) {
    for (; packet != recording.packets.end() && packet->tick <= tick.input.tick; ++packet)
      put(out, RecordStart::kPacket, *packet);
    put(out, RecordStart::kTick, tick);
    for (; frame != recording.frames.end() &&
           frame->input.sample_time_ns <= tick.input.device.time_ns;
         ++frame)
      put(out, RecordStart::kFrame, *frame);
  }
  for (; packet != recording.packets.end(); ++packet) put(out, RecordStart::kPacket, *packet);
  put(out, RecordStart::kEnd, recording.dropped);
  return write_text(file, out);
}

}  // namespace artus
