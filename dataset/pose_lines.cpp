// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/pose_lines.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

using nlohmann::json;

struct PoseKey {
  const char* name;  // as in JSON, without its unit
  std::size_t size;
  bool length;         // takes _mm or _m
  const char* column;  // as in CSV, before the axis
};
constexpr std::array<PoseKey, 8> kPoseKeys{{{"probe.position", 3, true, "probe"},
                                            {"probe.direction", 3, false, "direction"},
                                            {"probe.lateral", 3, false, "lateral"},
                                            {"probe.quaternion_wxyz", 4, false, "probe_q"},
                                            {"needle.entry", 3, true, "entry"},
                                            {"needle.tip", 3, true, "tip"},
                                            {"needle.position", 3, true, "needle"},
                                            {"needle.quaternion_wxyz", 4, false, "needle_q"}}};

/// Where a JSON key or a CSV column belongs.
struct KeyPlace {
  const PoseKey* key = nullptr;
  std::size_t axis = 0;
  double scale = 1;
};

/// Whether `text` is `stem` in the key's unit, and then its factor to SI.
std::optional<double> scale_of(const PoseKey& key, const std::string& stem,
                               const std::string& text) {
  if (!key.length) return text == stem ? std::optional(1.0) : std::nullopt;
  if (text == stem + "_mm") return kMillimetre;
  return text == stem + "_m" ? std::optional(1.0) : std::nullopt;
}

Result<KeyPlace> json_place(const std::string& name, const std::string& where) {
  for (const PoseKey& key : kPoseKeys)
    if (const auto scale = scale_of(key, key.name, name)) return KeyPlace{&key, 0, *scale};
  return fail(ErrorCode::invalid, "unknown key '" + name + "'", where);
}

Result<KeyPlace> csv_place(const std::string& column, const std::string& where) {
  for (const PoseKey& key : kPoseKeys) {
    const bool quaternion = key.size == 4;
    const std::string axes = quaternion ? "wxyz" : "xyz";
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const std::string stem = std::string(key.column) + (quaternion ? "" : "_") + axes[i];
      if (const auto scale = scale_of(key, stem, column)) return KeyPlace{&key, i, *scale};
    }
  }
  return fail(ErrorCode::invalid, "unknown column '" + column + "'", where);
}

Result<void> read_hand(const json& object, const std::string& hand, PoseLine& line,
                       const std::string& where) {
  if (object.is_null()) {
    line.unseen.insert(hand);
    return {};
  }
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
                  "'" + name + "' must be " + std::to_string(place->key->size) + " finite numbers",
                  where);
    if (!line.numbers.emplace(place->key->name, numbers).second)
      return fail(ErrorCode::invalid, "'" + name + "' is given both in mm and in m", where);
  }
  return {};
}

/// Takes a hand's numbers out when they are seven zeros: so trackers write what they do not see.
void forget_zeros(PoseLine& line) {
  for (const char* hand : {"probe", "needle"}) {
    const auto position = line.numbers.find(std::string(hand) + ".position");
    const auto rotation = line.numbers.find(std::string(hand) + ".quaternion_wxyz");
    if (position == line.numbers.end() || rotation == line.numbers.end()) continue;
    const auto zero = [](double v) {
      return v == 0;
    };
    if (!std::all_of(position->second.begin(), position->second.end(), zero) ||
        !std::all_of(rotation->second.begin(), rotation->second.end(), zero))
      continue;
    line.numbers.erase(position);
    line.numbers.erase(rotation);
    line.unseen.insert(hand);
  }
}

/// The hand that a column is of: directions are the probe's, entry and tip the needle's.
std::string hand_of(const PoseKey& key) {
  const std::string name = key.name;
  return name.substr(0, name.find('.'));
}

Result<PoseLine> parse_json(std::string_view text, const std::string& where) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object())
    return fail(ErrorCode::malformed, "every line must be one JSON object", where);
  PoseLine line;
  for (const auto& [key, value] : object.items()) {
    if (key == "needle" || key == "probe") {
      ARTUS_TRY(read_hand(value, key, line, where));
    } else if (key == "time_s" && value.is_number() && std::isfinite(value.get<double>())) {
      line.time = value.get<double>();
    } else if (key == "name" && value.is_string()) {
      line.name = value.get<std::string>();
    } else {
      return fail(ErrorCode::invalid, "'" + key + "' is an unknown key or has an invalid value",
                  where);
    }
  }
  forget_zeros(line);
  return line;
}

struct PoseHeader {
  std::vector<std::string> names;
  std::vector<KeyPlace> places;  // of columns that are numbers of a hand
};

Result<PoseHeader> parse_header(std::string_view text, const std::string& where) {
  PoseHeader header;
  header.names = csv_cells(text);
  for (const std::string& name : header.names) {
    if (std::count(header.names.begin(), header.names.end(), name) > 1)
      return fail(ErrorCode::invalid, "column '" + name + "' is given twice", where);
    KeyPlace place;
    if (name != "name" && name != "time_s") {
      const auto found = csv_place(name, where);
      ARTUS_TRY(found);
      place = *found;
    }
    header.places.push_back(place);
  }
  return header;
}

Result<PoseLine> parse_row(const PoseHeader& header, std::string_view text,
                           const std::string& where) {
  const auto cells = csv_cells(text);
  if (cells.size() != header.names.size())
    return fail(ErrorCode::malformed,
                std::to_string(cells.size()) + " cells, but the header has " +
                    std::to_string(header.names.size()),
                where);
  PoseLine line;
  std::map<std::string, std::size_t> filled;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (header.names[i] == "name") line.name = cells[i];
    if (header.names[i] == "name" || cells[i].empty()) continue;
    const auto value = parse_number(cells[i]);
    if (!value || !std::isfinite(*value))
      return fail(ErrorCode::invalid,
                  "'" + cells[i] + "' in column " + header.names[i] + " is not a finite number",
                  where);
    const KeyPlace& place = header.places[i];
    if (place.key == nullptr) {
      line.time = *value;
      continue;
    }
    auto& numbers = line.numbers[place.key->name];
    numbers.resize(place.key->size);
    numbers[place.axis] = place.scale * *value;
    ++filled[place.key->name];
  }
  for (const auto& [key, count] : filled)
    if (count != line.numbers[key].size())
      return fail(ErrorCode::invalid,
                  key + " is incomplete: a companion of a filled column is empty or missing",
                  where);
  forget_zeros(line);
  for (const KeyPlace& place : header.places) {
    if (place.key == nullptr) continue;
    const std::string hand = hand_of(*place.key);
    const auto at = line.numbers.lower_bound(hand + ".");
    if (at == line.numbers.end() || at->first.compare(0, hand.size() + 1, hand + ".") != 0)
      line.unseen.insert(hand);
  }
  return line;
}

std::optional<Vec3> vector_of(const PoseLine& line, const std::string& key) {
  const auto at = line.numbers.find(key);
  if (at == line.numbers.end()) return std::nullopt;
  return Vec3(at->second[0], at->second[1], at->second[2]);
}

/// By position and quaternion; empty when the line has no quaternion of the hand.
Result<std::optional<Pose>> posed(const PoseLine& line, const std::string& hand,
                                  const std::string& where) {
  const auto position = vector_of(line, hand + ".position");
  const auto at = line.numbers.find(hand + ".quaternion_wxyz");
  if (at == line.numbers.end()) return std::optional<Pose>();
  if (!position)
    return fail(ErrorCode::invalid, "the " + hand + " has a quaternion and no position", where);
  const Eigen::Quaterniond q(at->second[0], at->second[1], at->second[2], at->second[3]);
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

}  // namespace

Result<PoseFormat> pose_format_of(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".jsonl") return PoseFormat::json_lines;
  if (extension == ".csv") return PoseFormat::csv;
  return fail(ErrorCode::unsupported, "poses are read from .jsonl or .csv", file.string());
}

Result<void> for_pose_lines(
    std::string_view text, const std::string& name, PoseFormat format,
    const std::function<Result<void>(const PoseLine& line, const std::string& where)>& each) {
  std::optional<PoseHeader> header;
  return for_lines(
      text, name, [&](std::string_view content, const std::string& where) -> Result<void> {
        if (format == PoseFormat::csv && !header) {
          auto first = parse_header(content, where);
          ARTUS_TRY(first);
          header = std::move(*first);
          return {};
        }
        const auto line = header ? parse_row(*header, content, where) : parse_json(content, where);
        ARTUS_TRY(line);
        return each(*line, where);
      });
}

Result<std::optional<Pose>> probe_of(const PoseLine& line, const std::string& where) {
  auto pose = posed(line, "probe", where);
  ARTUS_TRY(pose);
  const auto position = vector_of(line, "probe.position");
  const auto direction = vector_of(line, "probe.direction");
  if (*pose || (!position && !direction)) return pose;
  if (!position || !direction)
    return fail(ErrorCode::invalid, "a probe needs position and direction, or a quaternion", where);
  const auto lateral = vector_of(line, "probe.lateral");
  if (direction->norm() < 1e-12)
    return fail(ErrorCode::invalid, "the probe's direction is zero", where);
  if (lateral && direction->normalized().cross(lateral->normalized()).norm() < 1e-6)
    return fail(ErrorCode::invalid, "the probe's lateral direction is zero or along the beam",
                where);
  return std::optional<Pose>(
      make_pose(*position, *direction, lateral.value_or(Vec3(Vec3::Zero()))));
}

Result<std::optional<Pose>> needle_of(const PoseLine& line, const std::string& where) {
  auto pose = posed(line, "needle", where);
  ARTUS_TRY(pose);
  if (*pose) return pose;
  const auto entry = vector_of(line, "needle.entry");
  const auto tip = vector_of(line, "needle.tip");
  if (line.numbers.count("needle.position") > 0)
    return fail(ErrorCode::invalid, "the needle has a position and no quaternion_wxyz", where);
  if (entry.has_value() != tip.has_value())
    return fail(ErrorCode::invalid, "a needle needs both entry and tip", where);
  if (!entry) return pose;
  const Vec3 axis = *tip - *entry;
  if (axis.norm() < 1e-9)
    return fail(ErrorCode::invalid, "the needle's entry and tip are the same point", where);
  return std::optional<Pose>(make_pose(*tip, axis, Vec3::Zero()));
}

}  // namespace artus
