// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/sequence_header.h"

#include <cmath>
#include <fstream>
#include <optional>
#include <set>

#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/exchange/faults.h"
#include "artus/detail/exchange/transform_graph.h"

namespace artus {
namespace {

constexpr std::string_view kFrame = "Seq_Frame";

/// Takes a header apart, line after line.
class HeaderReader {
 public:
  explicit HeaderReader(std::string name) : name_(std::move(name)) {}

  /// `line` without its end; true when it was the last one.
  Result<bool> take(std::string_view line) {
    ++number_;
    if (number_ == 1 && line.substr(0, 4) == "NRRD") {
      nrrd_ = true;
      return false;
    }
    if (nrrd_ && trimmed(line).empty()) return true;
    if (nrrd_ && line.front() == '#') return false;
    std::size_t at = line.find(nrrd_ ? ":" : "=");
    if (at == std::string_view::npos)
      return fail(ErrorCode::malformed, "a header line must be 'key = value'",
                  name_ + ":" + std::to_string(number_));
    const std::string_view key = trimmed(line.substr(0, at));
    if (nrrd_ && at + 1 < line.size() && line[at + 1] == '=') ++at;
    put(key, std::string(trimmed(line.substr(at + 1))));
    return key == "ElementDataFile";
  }
  [[nodiscard]] tl::unexpected<Error> cut() const {
    return fail(ErrorCode::malformed, "a header line must be 'key = value'; the header has no end",
                name_ + ":" + std::to_string(number_ + 1));
  }
  SequenceHeader header;

 private:
  void put(std::string_view key, std::string value) {
    const std::size_t end = key.find('_', kFrame.size());
    if (key.substr(0, kFrame.size()) == kFrame && end != std::string_view::npos)
      if (const auto i = parse_integer(key.substr(kFrame.size(), end - kFrame.size()));
          i && *i >= 0) {
        header.frames[static_cast<std::size_t>(*i)][std::string(key.substr(end + 1))] =
            std::move(value);
        return;
      }
    header.fields[std::string(key)] = std::move(value);
  }

  std::string name_;
  std::size_t number_ = 0;
  bool nrrd_ = false;
};

std::optional<igtl::Matrix> matrix_in(const std::string& text) {
  TextCursor cursor(text, "");
  igtl::Matrix matrix;
  for (Eigen::Index i = 0; i < 16; ++i) {
    const auto number = cursor.next_number();
    if (!number) return std::nullopt;
    if (i < 12) matrix(i / 4, i % 4) = *number;
  }
  return cursor.next().empty() ? std::optional(matrix) : std::nullopt;
}

/// The frames of a header, one after the other, into a track.
class TrackMaker {
 public:
  TrackMaker(const TrackNames& names, std::string name) : names_(names), name_(std::move(name)) {}

  void take(std::size_t number, const SequenceHeader::Fields& fields) {
    const std::string where = "frame " + std::to_string(number);
    const TransformGraph graph = graph_of(fields, where);
    const auto hands = find_hands(graph, names_.probe, names_.needle);
    if (!hands) {
      faults_.add(where + ", " + hands.error().where, hands.error().message);
      return;
    }
    if (!hands->probe && !hands->needle) {
      ++unseen_;
      return;
    }
    const std::optional<double> time = time_of(fields, where);
    if (!time) return;
    if (!hands->probe_name.empty()) taken_.insert(hands->probe_name + " is taken for the probe");
    if (!hands->needle_name.empty()) taken_.insert(hands->needle_name + " is taken for the needle");
    track_.frames.push_back(
        {*time, hands->probe, hands->needle, hands->probe_given, hands->needle_given});
  }

  Result<TrackerTrack> finish() {
    if (faults_.empty() && track_.frames.empty()) {
      std::string has;
      for (const std::string& known : known_) has += (has.empty() ? "" : ", ") + known;
      faults_.add("", "no frame has " + names_.probe + " or " + names_.needle +
                          " that is OK, nor what they follow from; the file has " +
                          (has.empty() ? "no transforms" : has));
    }
    if (!faults_.empty()) return faults_.refusal(ErrorCode::invalid, name_);
    track_.reference_is_ras = true;
    if (unseen_ > 0)
      track_.notices.push_back(std::to_string(unseen_) +
                               " frames were left out: the tracker saw neither probe nor needle");
    if (twice_ > 0)
      track_.notices.push_back(std::to_string(twice_) +
                               " frames were left out: they have the time of the one before");
    track_.notices.insert(track_.notices.end(), taken_.begin(), taken_.end());
    return std::move(track_);
  }

 private:
  TransformGraph graph_of(const SequenceHeader::Fields& fields, const std::string& where) {
    constexpr std::string_view kTransform = "Transform";
    TransformGraph graph;
    for (const auto& [key, value] : fields) {
      if (key.size() <= kTransform.size() ||
          std::string_view(key).substr(key.size() - kTransform.size()) != kTransform)
        continue;
      const std::string name = key.substr(0, key.size() - kTransform.size());
      known_.insert(name);
      const auto status = fields.find(key + "Status");
      if (status != fields.end() && !status->second.empty() && status->second != "OK") continue;
      if (const auto matrix = matrix_in(value))
        graph.set(name, *matrix);
      else
        faults_.add(where + ", " + key, "a matrix must have 16 numbers");
    }
    return graph;
  }

  /// nullopt: this frame is not taken.
  std::optional<double> time_of(const SequenceHeader::Fields& fields, const std::string& where) {
    const auto found = fields.find("Timestamp");
    const auto time = found == fields.end() ? std::nullopt : parse_number(found->second);
    if (!time || !std::isfinite(*time)) {
      faults_.add(where, "it has no Timestamp in seconds");
      return std::nullopt;
    }
    if (!track_.frames.empty() && *time == track_.frames.back().time) {
      ++twice_;
      return std::nullopt;
    }
    if (!track_.frames.empty() && !(*time > track_.frames.back().time)) {
      faults_.add(where, "the time must rise from frame to frame");
      return std::nullopt;
    }
    return time;
  }

  TrackNames names_;
  std::string name_;
  TrackerTrack track_;
  Faults faults_;
  std::set<std::string> known_;
  std::set<std::string> taken_;
  std::size_t unseen_ = 0;
  std::size_t twice_ = 0;
};

}  // namespace

Result<SequenceHeader> parse_sequence_header(std::string_view bytes, const std::string& name) {
  HeaderReader reader(name);
  std::size_t at = 0;
  while (at < bytes.size()) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos) break;
    const auto last = reader.take(bytes.substr(at, end - at));
    ARTUS_TRY(last);
    at = end + 1;
    if (!*last) continue;
    reader.header.bytes = at;
    return std::move(reader.header);
  }
  return reader.cut();
}

Result<SequenceHeader> read_sequence_header(const std::filesystem::path& file) {
  std::error_code code;
  if (!std::filesystem::exists(file, code))
    return fail(ErrorCode::not_found, "there is no such file", file.string());
  std::ifstream in(file, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(file, code))
    return fail(ErrorCode::unreadable, "the file cannot be read", file.string());
  HeaderReader reader(file.string());
  for (std::string line; std::getline(in, line);) {
    const auto last = reader.take(line);
    ARTUS_TRY(last);
    reader.header.bytes += line.size() + 1;
    if (*last) return std::move(reader.header);
  }
  return reader.cut();
}

Result<TrackerTrack> track_of(const SequenceHeader& header, const std::string& name,
                              const TrackNames& names) {
  TrackMaker maker(names, name);
  for (const auto& [number, fields] : header.frames) maker.take(number, fields);
  return maker.finish();
}

}  // namespace artus
