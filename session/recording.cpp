// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/recording.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

#include <nlohmann/json.hpp>

#include "artus/session/needle_feel_json.h"

namespace artus {
namespace {

constexpr int kVersion = 5;
constexpr std::uint32_t kTick = 1;
constexpr std::uint32_t kFrame = 2;
constexpr std::uint32_t kEnd = 3;

/// What stands before each record of the file.
struct RecordHead {
  std::uint32_t kind = 0;
  std::uint32_t size = 0;
};

template <class T>
void write_record(std::FILE* file, std::uint32_t kind, const T& record) {
  const RecordHead head{kind, sizeof(T)};
  std::fwrite(&head, sizeof head, 1, file);
  std::fwrite(&record, sizeof record, 1, file);
}

nlohmann::json to_json(const RecordingHead& head) {
  const GestureParams& g = head.gesture;
  return {{"artus_recording", kVersion},
          {"joint", head.joint},
          {"source_digest", head.source_digest},
          {"device", head.device},
          {"haptic_rate_hz", head.haptic_rate},
          {"image_rate_hz", head.image_rate},
          {"seed", head.seed},
          {"X_WJ_position", head.X_WJ.position},
          {"X_WJ_rotation", head.X_WJ.rotation},
          {"gesture_point", {g.p_W.x(), g.p_W.y(), g.p_W.z()}},
          {"gesture_axis", {g.axis_W.x(), g.axis_W.y(), g.axis_W.z()}},
          {"gesture_beside", g.beside_probe},
          {"gesture_steepness", g.steepness},
          {"feel", to_json(head.feel)}};
}

Vec3 to_vec3(const nlohmann::json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Result<RecordingHead> to_head(const nlohmann::json& json) {
  RecordingHead head;
  json.at("joint").get_to(head.joint);
  json.at("source_digest").get_to(head.source_digest);
  json.at("device").get_to(head.device);
  json.at("haptic_rate_hz").get_to(head.haptic_rate);
  json.at("image_rate_hz").get_to(head.image_rate);
  json.at("seed").get_to(head.seed);
  for (std::size_t i = 0; i < 3; ++i) head.X_WJ.position[i] = json.at("X_WJ_position").at(i);
  for (std::size_t i = 0; i < 4; ++i) head.X_WJ.rotation[i] = json.at("X_WJ_rotation").at(i);
  head.gesture.p_W = to_vec3(json.at("gesture_point"));
  head.gesture.axis_W = to_vec3(json.at("gesture_axis"));
  json.at("gesture_beside").get_to(head.gesture.beside_probe);
  json.at("gesture_steepness").get_to(head.gesture.steepness);
  const auto feel = to_needle_feel(json.at("feel"));
  ARTUS_TRY(feel);
  head.feel = *feel;
  return head;
}

struct OpenFile {
  std::FILE* file = nullptr;
  explicit OpenFile(const std::filesystem::path& path) : file(std::fopen(path.c_str(), "rb")) {}
  ~OpenFile() {
    if (file != nullptr) std::fclose(file);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
};

std::string read_line(std::FILE* file) {
  constexpr std::size_t kLongest = std::size_t{64} * 1024;
  std::string line;
  for (int c = std::fgetc(file); c != EOF && c != '\n' && line.size() < kLongest;
       c = std::fgetc(file))
    line.push_back(static_cast<char>(c));
  return line;
}

template <class T>
bool read_into(std::FILE* file, std::vector<T>& records) {
  T record;
  if (std::fread(&record, sizeof record, 1, file) != 1) return false;
  records.push_back(record);
  return true;
}

/// False at the end or at what a crash cut off.
Result<bool> read_record(std::FILE* file, Recording& recording, const std::string& where) {
  RecordHead head;
  if (std::fread(&head, sizeof head, 1, file) != 1) return false;
  if (head.kind == kTick && head.size == sizeof(TickRecord))
    return read_into(file, recording.ticks);
  if (head.kind == kFrame && head.size == sizeof(FrameRecord))
    return read_into(file, recording.frames);
  if (head.kind == kEnd && head.size == sizeof recording.dropped) {
    recording.complete = std::fread(&recording.dropped, sizeof recording.dropped, 1, file) == 1;
    return false;
  }
  return fail(ErrorCode::corrupt, "a record of an unknown kind or size", where);
}

}  // namespace

TickRecord to_record(const HapticSnapshot& snapshot) noexcept {
  TickRecord record;
  record.input = snapshot.input;
  std::copy(std::begin(snapshot.feedback.force), std::end(snapshot.feedback.force), record.force);
  std::copy(std::begin(snapshot.feedback.torque), std::end(snapshot.feedback.torque),
            record.torque);
  record.status = snapshot.status;
  record.region = snapshot.feedback.region;
  return record;
}

RecordingHead make_head(const CompiledJoint& joint, const SessionParams& params) {
  RecordingHead head;
  head.joint = joint.name;
  head.source_digest = joint.source_digest;
  head.device = std::string(params.device.name);
  head.haptic_rate = params.haptic_rate;
  head.image_rate = params.image_rate;
  head.seed = params.image.seed;
  head.X_WJ = to_plain(params.X_WJ);
  head.gesture = params.gesture;
  head.feel = params.feel;
  return head;
}

Result<Recording> read_recording(const std::filesystem::path& file) {
  const OpenFile in(file);
  if (in.file == nullptr) return fail(ErrorCode::not_found, "cannot open the recording", file);
  Recording recording;
  const auto json = nlohmann::json::parse(read_line(in.file), nullptr, false);
  if (json.is_discarded() || !json.is_object() || !json.contains("artus_recording"))
    return fail(ErrorCode::malformed, "this is not a recording of artus", file);
  if (json["artus_recording"] != kVersion)
    return fail(ErrorCode::unsupported, "a recording of another version", file);
  try {
    const auto head = to_head(json);
    ARTUS_TRY(head);
    recording.head = *head;
  } catch (const nlohmann::json::exception& e) {
    return fail(ErrorCode::malformed, std::string("its first line is damaged: ") + e.what(), file);
  }
  for (;;) {
    const Result<bool> more = read_record(in.file, recording, file);
    ARTUS_TRY(more);
    if (!*more) return recording;
  }
}

Recorder::Recorder(std::FILE* file) : file_(file), ticks_(16384), frames_(1024) {
  thread_ = std::thread([this] { run(); });
}

Result<std::unique_ptr<Recorder>> Recorder::start(const std::filesystem::path& file,
                                                  const RecordingHead& head) {
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (out == nullptr) return fail(ErrorCode::unreadable, "cannot write the recording", file);
  const std::string line = to_json(head).dump() + "\n";
  std::fwrite(line.data(), 1, line.size(), out);
  return std::unique_ptr<Recorder>(new Recorder(out));
}

Recorder::~Recorder() {
  stop_ = true;
  thread_.join();
  drain();
  write_record(file_.get(), kEnd, dropped());
}

void Recorder::drain() {
  TickRecord tick;
  while (ticks_.pop(tick)) write_record(file_.get(), kTick, tick);
  FrameRecord frame;
  while (frames_.pop(frame)) write_record(file_.get(), kFrame, frame);
}

void Recorder::run() {
  while (!stop_) {
    drain();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace artus
