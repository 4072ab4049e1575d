// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/tracked_list.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include <nlohmann/json.hpp>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

using nlohmann::json;

/// What one line says: "needle.tip" -> numbers in SI.
using Line = std::map<std::string, std::vector<double>>;

struct Key {
  const char* name;  // as in JSON, without its unit
  std::size_t size;
  bool length;         // takes _mm or _m
  const char* column;  // as in CSV, before the axis
};
constexpr std::array<Key, 8> kKeys{{{"probe.position", 3, true, "probe"},
                                    {"probe.direction", 3, false, "direction"},
                                    {"probe.lateral", 3, false, "lateral"},
                                    {"probe.quaternion_wxyz", 4, false, "probe_q"},
                                    {"needle.entry", 3, true, "entry"},
                                    {"needle.tip", 3, true, "tip"},
                                    {"needle.position", 3, true, "needle"},
                                    {"needle.quaternion_wxyz", 4, false, "needle_q"}}};

/// Where a JSON key or a CSV column belongs.
struct Place {
  const Key* key = nullptr;
  std::size_t axis = 0;
  double scale = 1;
};

Result<Place> json_place(const std::string& name, const std::string& where) {
  for (const Key& key : kKeys) {
    if (!key.length && name == key.name) return Place{&key, 0, 1};
    if (key.length && name == std::string(key.name) + "_mm") return Place{&key, 0, kMillimetre};
    if (key.length && name == std::string(key.name) + "_m") return Place{&key, 0, 1};
  }
  return fail(ErrorCode::invalid, "unknown key '" + name + "'", where);
}

Result<Place> csv_place(const std::string& column, const std::string& where) {
  for (const Key& key : kKeys) {
    const bool quaternion = key.size == 4;
    const std::string axes = quaternion ? "wxyz" : "xyz";
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const std::string stem = std::string(key.column) + (quaternion ? "" : "_") + axes[i];
      if (!key.length && column == stem) return Place{&key, i, 1};
      if (key.length && column == stem + "_mm") return Place{&key, i, kMillimetre};
      if (key.length && column == stem + "_m") return Place{&key, i, 1};
    }
  }
  return fail(ErrorCode::invalid, "unknown column '" + column + "'", where);
}

std::optional<Vec3> vector_of(const Line& line, const std::string& key) {
  const auto at = line.find(key);
  if (at == line.end()) return std::nullopt;
  return Vec3(at->second[0], at->second[1], at->second[2]);
}

/// position and quaternion of a hand; empty when it has none.
Result<std::optional<Pose>> posed(const Line& line, const std::string& hand,
                                  const std::string& where) {
  const auto position = vector_of(line, hand + ".position");
  const auto at = line.find(hand + ".quaternion_wxyz");
  if (at == line.end()) return std::optional<Pose>();
  if (!position)
    return fail(ErrorCode::invalid, "the " + hand + " has a quaternion and no position", where);
  Eigen::Quaterniond q(at->second[0], at->second[1], at->second[2], at->second[3]);
  const double norm = q.norm();
  if (!(norm >= 0.9 && norm <= 1.1))
    return fail(ErrorCode::invalid,
                "the " + hand + "'s quaternion has the norm " + std::to_string(norm) +
                    "; it must be 0.9 to 1.1",
                where);
  Pose pose = Pose::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = *position;
  return std::optional<Pose>(pose);
}

Result<std::optional<Pose>> probe_of(const Line& line, const std::string& where) {
  auto pose = posed(line, "probe", where);
  ARTUS_TRY(pose);
  const auto position = vector_of(line, "probe.position");
  const auto direction = vector_of(line, "probe.direction");
  if (*pose || (!position && !direction)) return pose;
  if (!position || !direction)
    return fail(ErrorCode::invalid, "a probe needs position and direction, or a quaternion", where);
  const Vec3 lateral = vector_of(line, "probe.lateral").value_or(Vec3::Zero());
  if (direction->norm() < 1e-12)
    return fail(ErrorCode::invalid, "the probe's direction is zero", where);
  if (!lateral.isZero(0) && direction->normalized().cross(lateral.normalized()).norm() < 1e-6)
    return fail(ErrorCode::invalid, "the probe's lateral direction is along the beam", where);
  return std::optional<Pose>(make_pose(*position, *direction, lateral));
}

/// `before`: the needle's last pose, from which it turns without spin.
Result<std::optional<Pose>> needle_of(const Line& line, const std::optional<Pose>& before,
                                      const std::string& where) {
  auto pose = posed(line, "needle", where);
  ARTUS_TRY(pose);
  if (*pose) return pose;
  const auto entry = vector_of(line, "needle.entry");
  const auto tip = vector_of(line, "needle.tip");
  if (line.count("needle.position") > 0)
    return fail(ErrorCode::invalid, "the needle has a position and no quaternion_wxyz", where);
  if (entry.has_value() != tip.has_value())
    return fail(ErrorCode::invalid, "a needle needs both entry and tip", where);
  if (!entry) return std::optional<Pose>();
  const Vec3 axis = *tip - *entry;
  if (axis.norm() < 1e-9)
    return fail(ErrorCode::invalid, "the needle's entry and tip are the same point", where);
  Pose now = make_pose(*tip, axis, Vec3::Zero());
  if (before) {
    const Vec3 last = before->linear().col(2);
    now.linear() = rotation_between(last, axis).toRotationMatrix() * before->linear();
  }
  return std::optional<Pose>(now);
}

/// Collects lines into poses.
class Builder {
 public:
  Builder(const TrackedListOptions& options, std::string name)
      : options_(options), name_(std::move(name)) {}

  Result<void> add(const Line& line, std::optional<double> time, const std::string& where) {
    if (!time) return fail(ErrorCode::invalid, "every pose needs its time_s", where);
    if (!options_.sort && !list_.poses.empty() && *time < list_.poses.back().time)
      return fail(ErrorCode::invalid,
                  "time_s falls from " + std::to_string(list_.poses.back().time) + " to " +
                      std::to_string(*time) + " s; --sort puts the poses by their times",
                  where);
    auto probe = probe_of(line, where);
    ARTUS_TRY(probe);
    auto needle = needle_of(line, last_needle_, where);
    ARTUS_TRY(needle);
    if (!*probe && !*needle)
      return fail(ErrorCode::invalid, "there is neither needle nor probe", where);
    if (*needle) last_needle_ = *needle;
    list_.poses.push_back({*time, *needle, *probe});
    return {};
  }

  Result<TrackedList> finish() {
    auto& poses = list_.poses;
    if (poses.empty()) return fail(ErrorCode::invalid, "there is no pose in it", name_);
    const auto earlier = [](const auto& a, const auto& b) {
      return a.time < b.time;
    };
    if (!std::is_sorted(poses.begin(), poses.end(), earlier)) {
      std::stable_sort(poses.begin(), poses.end(), earlier);
      list_.notices.push_back("the poses were put by their times");
    }
    if (poses.back().time - poses.front().time > options_.longest)
      return fail(ErrorCode::invalid,
                  "the times span " + std::to_string(poses.back().time - poses.front().time) +
                      " s; is time_s in seconds?",
                  name_);
    tell_gaps();
    return std::move(list_);
  }

 private:
  void tell_gaps() {
    int gaps = 0;
    int same = 0;
    double widest = 0;
    double widest_at = 0;
    for (std::size_t i = 1; i < list_.poses.size(); ++i) {
      const double dt = list_.poses[i].time - list_.poses[i - 1].time;
      if (dt == 0) ++same;
      if (dt > options_.gap) ++gaps;
      if (dt > widest) {
        widest = dt;
        widest_at = list_.poses[i - 1].time;
      }
    }
    if (same > 0)
      list_.notices.push_back(std::to_string(same) +
                              " poses have the time of the one before: they move without speed");
    if (gaps > 0) {
      const std::string text = printed(
          "%d gaps of more than %.3g s, the widest %.3g s from %.3f s: both hands are taken to go "
          "straight across",
          gaps, options_.gap, widest, widest_at);
      list_.notices.emplace_back(text);
    }
  }

  TrackedListOptions options_;
  std::string name_;
  TrackedList list_;
  std::optional<Pose> last_needle_;
};

// ---- JSON lines

Result<void> read_hand(const json& object, const std::string& hand, Line& line,
                       const std::string& where) {
  if (object.is_null()) return {};
  if (!object.is_object())
    return fail(ErrorCode::invalid, "'" + hand + "' must be an object", where);
  for (const auto& [name, value] : object.items()) {
    const auto place = json_place(hand + "." + name, where);
    ARTUS_TRY(place);
    std::vector<double> numbers;
    if (value.is_array())
      for (const json& v : value)
        if (v.is_number()) numbers.push_back(place->scale * v.get<double>());
    const bool good =
        value.is_array() && value.size() == place->key->size && numbers.size() == value.size() &&
        std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); });
    if (!good)
      return fail(ErrorCode::invalid,
                  "'" + name + "' must be " + std::to_string(place->key->size) + " numbers", where);
    if (!line.emplace(place->key->name, numbers).second)
      return fail(ErrorCode::invalid, "'" + name + "' is there in mm and in m", where);
  }
  return {};
}

Result<void> add_json(Builder& builder, std::string_view text, const std::string& where) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object())
    return fail(ErrorCode::malformed, "every line must be one JSON object", where);
  Line line;
  std::optional<double> time;
  for (const auto& [key, value] : object.items()) {
    if (key == "needle" || key == "probe") {
      ARTUS_TRY(read_hand(value, key, line, where));
    } else if (key == "time_s" && value.is_number() && std::isfinite(value.get<double>())) {
      time = value.get<double>();
    } else if (key != "name" || !value.is_string()) {
      return fail(ErrorCode::invalid, "'" + key + "' is unknown or has no proper value", where);
    }
  }
  return builder.add(line, time, where);
}

// ---- CSV

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    while (!cell.empty() && cell.front() == ' ') cell.remove_prefix(1);
    while (!cell.empty() && cell.back() == ' ') cell.remove_suffix(1);
    cells.emplace_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

struct Header {
  std::vector<std::string> names;
  std::vector<Place> places;  // of columns that are numbers of a hand
};

Result<Header> read_header(std::string_view text, const std::string& where) {
  Header header;
  header.names = cells_of(text);
  for (const std::string& name : header.names) {
    if (std::count(header.names.begin(), header.names.end(), name) > 1)
      return fail(ErrorCode::invalid, "column '" + name + "' is there twice", where);
    Place place;
    if (name != "name" && name != "time_s") {
      const auto found = csv_place(name, where);
      ARTUS_TRY(found);
      place = *found;
    }
    header.places.push_back(place);
  }
  return header;
}

Result<double> number_of(const std::string& cell, const std::string& column,
                         const std::string& where) {
  double value = 0;
  const char* end = cell.data() + cell.size();
  const auto read = std::from_chars(cell.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || !std::isfinite(value))
    return fail(ErrorCode::invalid,
                "'" + cell + "' in column " + column + " is not a finite number", where);
  return value;
}

Result<void> add_csv(Builder& builder, const Header& header, std::string_view text,
                     const std::string& where) {
  const auto cells = cells_of(text);
  if (cells.size() != header.names.size())
    return fail(ErrorCode::malformed,
                std::to_string(cells.size()) + " cells, but the header has " +
                    std::to_string(header.names.size()),
                where);
  Line line;
  std::map<std::string, std::size_t> filled;
  std::optional<double> time;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (header.names[i] == "name" || cells[i].empty()) continue;
    const auto value = number_of(cells[i], header.names[i], where);
    ARTUS_TRY(value);
    const Place& place = header.places[i];
    if (place.key == nullptr) {
      time = *value;
      continue;
    }
    auto& numbers = line[place.key->name];
    numbers.resize(place.key->size);
    numbers[place.axis] = place.scale * *value;
    ++filled[place.key->name];
  }
  for (const auto& [key, count] : filled)
    if (count != line[key].size())
      return fail(ErrorCode::invalid, "of " + key + " a companion is missing", where);
  return builder.add(line, time, where);
}

}  // namespace

Result<TrackedList> parse_tracked_list(std::string_view text, const std::string& name,
                                       const TrackedListOptions& options) {
  const std::string extension = std::filesystem::path(name).extension().string();
  if (extension != ".jsonl" && extension != ".csv")
    return fail(ErrorCode::unsupported, "poses are read from .jsonl or .csv", name);
  Builder builder(options, name);
  std::optional<Header> header;
  const auto read =
      for_lines(text, name, [&](std::string_view line, const std::string& where) -> Result<void> {
        if (extension == ".jsonl") return add_json(builder, line, where);
        if (header) return add_csv(builder, *header, line, where);
        auto first = read_header(line, where);
        ARTUS_TRY(first);
        header = std::move(*first);
        return {};
      });
  ARTUS_TRY(read);
  return builder.finish();
}

Result<TrackedList> read_tracked_list(const std::filesystem::path& file,
                                      const TrackedListOptions& options) {
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  return parse_tracked_list(*bytes, file.string(), options);
}

}  // namespace artus
