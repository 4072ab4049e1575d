// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/perk_recording.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <expat.h>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/exchange/faults.h"
#include "artus/detail/exchange/transform_graph.h"

namespace artus {
namespace {

struct Record {
  double time = 0;  // s
  std::string device;
  igtl::Matrix matrix;
};
struct Message {
  double time = 0;  // s
  std::string text;
};

/// What expat tells of a file is gathered here.
struct Gathered {
  XML_Parser parser = nullptr;
  std::vector<Record> records;
  std::vector<Message> messages;
  Faults faults;
};

using Attributes = std::map<std::string, std::string, std::less<>>;

std::optional<double> number_of(const Attributes& attributes, std::string_view key) {
  const auto found = attributes.find(key);
  const auto number = found == attributes.end() ? std::nullopt : parse_number(found->second);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::string text_at(const Attributes& attributes, std::string_view key) {
  const auto found = attributes.find(key);
  return found == attributes.end() ? std::string() : found->second;
}

void take_log(Gathered& into, const Attributes& attributes) {
  const std::string where = "line " + std::to_string(XML_GetCurrentLineNumber(into.parser));
  const std::string type = text_at(attributes, "type");
  if (type != "transform" && type != "message") return;
  const auto seconds = number_of(attributes, "TimeStampSec");
  const auto nanoseconds = number_of(attributes, "TimeStampNSec");
  if (!seconds || !nanoseconds)
    return into.faults.add(where, "it has no time (TimeStampSec, TimeStampNSec)");
  const double time = *seconds + 1e-9 * *nanoseconds;
  if (type == "message") {
    into.messages.push_back({time, text_at(attributes, "message")});
    return;
  }
  Record record{time, text_at(attributes, "DeviceName"), {}};
  const std::string numbers = text_at(attributes, "transform");
  TextCursor cursor(numbers, "");
  for (Eigen::Index i = 0; i < 16; ++i) {
    const auto number = cursor.next_number();
    if (!number) return into.faults.add(where, "a transform must have 16 numbers");
    if (i < 12) record.matrix(i / 4, i % 4) = *number;
  }
  into.records.push_back(std::move(record));
}

void on_element(void* user, const XML_Char* name, const XML_Char** given) {
  if (std::string_view(name) != "log") return;
  Attributes attributes;
  for (std::size_t i = 0; given[i] != nullptr; i += 2) attributes[given[i]] = given[i + 1];
  take_log(*static_cast<Gathered*>(user), attributes);
}

Result<void> gather(std::string_view text, const std::string& name, Gathered& into) {
  const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate(nullptr),
                                                                       XML_ParserFree);
  if (!parser) return fail(ErrorCode::failed, "the XML parser cannot be started", name);
  into.parser = parser.get();
  XML_SetUserData(parser.get(), &into);
  XML_SetStartElementHandler(parser.get(), on_element);
  constexpr std::size_t kPiece = 1U << 20U;
  bool more = true;
  while (more) {
    const std::string_view piece = text.substr(0, kPiece);
    text.remove_prefix(piece.size());
    more = !text.empty();
    if (XML_Parse(parser.get(), piece.data(), static_cast<int>(piece.size()), more ? 0 : 1) ==
        XML_STATUS_ERROR)
      return fail(
          ErrorCode::malformed,
          std::string("it is no sound XML: ") + XML_ErrorString(XML_GetErrorCode(parser.get())),
          name + ":" + std::to_string(XML_GetCurrentLineNumber(parser.get())));
  }
  return {};
}

/// The transforms of the moment: each as it last was, for as long as it is held.
class Moment {
 public:
  void take(const Record& record) { newest_[record.device] = &record; }
  [[nodiscard]] TransformGraph at(double time) const {
    constexpr double kHeld = 0.5;  // s
    TransformGraph graph;
    for (const auto& [device, record] : newest_)
      if (time - record->time <= kHeld) graph.set(device, record->matrix);
    return graph;
  }

 private:
  std::map<std::string, const Record*> newest_;
};

std::string tool_of(const std::string& device) {
  const auto frames = frames_of_transform(device);
  return frames ? frames->first : device;
}

/// The tool whose records make the frames.
std::string leading_tool(const Gathered& file, const TrackNames& names) {
  std::set<std::string> tools;
  for (const Record& record : file.records) tools.insert(tool_of(record.device));
  for (const std::string& tool :
       {tool_of(names.needle), std::string("NeedleTip"), std::string("StylusTip"),
        std::string("Stylus"), tool_of(names.probe)})
    if (tools.count(tool) > 0) return tool;
  return {};
}

/// Makes the frames of the leading tool's records.
class PerkTrack {
 public:
  PerkTrack(const TrackNames& names, double start) : names_(names), start_(start) {
    track_.reference_is_ras = true;
  }

  void add(const TransformGraph& graph, double time, Faults& faults) {
    const auto hands = find_hands(graph, names_.probe, names_.needle);
    if (!hands) return faults.add(hands.error().where, hands.error().message);
    if (!hands->probe && !hands->needle) return;
    if (!hands->probe_name.empty()) taken_.insert(hands->probe_name + " is taken for the probe");
    if (!hands->needle_name.empty()) taken_.insert(hands->needle_name + " is taken for the needle");
    track_.frames.push_back(
        {time - start_, hands->probe, hands->needle, hands->probe_given, hands->needle_given});
  }
  [[nodiscard]] bool empty() const noexcept { return track_.frames.empty(); }
  TrackerTrack finish(const std::vector<Message>& messages) {
    track_.notices.assign(taken_.begin(), taken_.end());
    for (const Message& message : messages)
      track_.notices.push_back(printed("message at %.2f s: ", message.time - start_) +
                               message.text);
    return std::move(track_);
  }

 private:
  TrackNames names_;
  double start_ = 0;  // s
  TrackerTrack track_;
  std::set<std::string> taken_;
};

Result<TrackerTrack> track_from(Gathered& file, const std::string& name, const TrackNames& names) {
  std::vector<Record>& records = file.records;
  std::stable_sort(records.begin(), records.end(),
                   [](const Record& a, const Record& b) { return a.time < b.time; });
  const std::string leading = leading_tool(file, names);
  PerkTrack track(names, records.empty() ? 0 : records.front().time);
  std::set<std::string> has;
  Moment moment;
  for (std::size_t i = 0; i < records.size();) {
    const double time = records[i].time;
    bool leads = false;
    for (; i < records.size() && records[i].time == time; ++i) {
      has.insert(records[i].device);
      moment.take(records[i]);
      leads = leads || tool_of(records[i].device) == leading;
    }
    if (leads) track.add(moment.at(time), time, file.faults);
  }
  if (file.faults.empty() && track.empty()) {
    std::string all;
    for (const std::string& device : has) all += (all.empty() ? "" : ", ") + device;
    file.faults.add("", "it has no " + names.probe + " or " + names.needle +
                            ", nor what they follow from; it has " +
                            (all.empty() ? "no transforms" : all));
  }
  if (!file.faults.empty()) return file.faults.refusal(ErrorCode::invalid, name);
  return track.finish(file.messages);
}

}  // namespace

Result<TrackerTrack> parse_perk_recording(std::string_view text, const std::string& name,
                                          const TrackNames& names) {
  Gathered file;
  ARTUS_TRY(gather(text, name, file));
  return track_from(file, name, names);
}

}  // namespace artus
