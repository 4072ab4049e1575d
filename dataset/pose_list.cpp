// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/dataset/pose_list.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

using nlohmann::json;

/// What stands in one line, before it is a pose.
struct Line {
  std::string name;
  std::optional<double> time;
  std::optional<Vec3> position;  // mm
  std::optional<Vec3> direction;
  std::optional<Vec3> lateral;
  std::optional<Vec3> entry;  // mm
  std::optional<Vec3> tip;    // mm
};

Result<ListedPose> to_pose(const Line& line, const std::string& where) {
  const auto refuse = [&](const char* why) {
    return fail(ErrorCode::invalid, why, where);
  };
  if (!line.position || !line.direction)
    return refuse("a pose needs the probe's position_mm and direction");
  if (line.direction->norm() < 1e-12) return refuse("the probe's direction is zero");
  if (line.lateral && line.direction->normalized().cross(line.lateral->normalized()).norm() < 1e-6)
    return refuse("the probe's lateral direction is zero or along the beam");
  if (line.entry.has_value() != line.tip.has_value())
    return refuse("a needle needs both entry_mm and tip_mm");
  if (line.entry && (*line.tip - *line.entry).norm() < 1e-6)
    return refuse("the needle's entry and tip are the same point");
  ListedPose pose;
  pose.name = line.name;
  pose.time = line.time;
  pose.X_JP =
      make_pose(*line.position * kMillimetre, *line.direction, line.lateral.value_or(Vec3::Zero()));
  if (line.entry)
    pose.X_JN = make_pose(*line.tip * kMillimetre, *line.tip - *line.entry, Vec3::Zero());
  return pose;
}

Result<void> append(std::vector<ListedPose>& poses, const Line& line, const std::string& where) {
  auto pose = to_pose(line, where);
  ARTUS_TRY(pose);
  if (pose->time && !poses.empty() && poses.back().time && *pose->time <= *poses.back().time)
    return fail(ErrorCode::invalid, "time_s must rise from pose to pose", where);
  poses.push_back(std::move(*pose));
  return {};
}

Result<std::vector<ListedPose>> not_empty(std::vector<ListedPose> poses, const std::string& name) {
  if (poses.empty()) return fail(ErrorCode::invalid, "there is no pose in it", name);
  return poses;
}

// ---- JSON lines

Result<Vec3> triple_of(const json& value, const std::string& key, const std::string& where) {
  if (value.is_array() && value.size() == 3 &&
      std::all_of(value.begin(), value.end(), [](const json& v) { return v.is_number(); })) {
    const Vec3 v(value[0].get<double>(), value[1].get<double>(), value[2].get<double>());
    if (v.allFinite()) return v;
  }
  return fail(ErrorCode::invalid, "'" + key + "' must be three numbers, [x, y, z]", where);
}

Result<void> read_triples(const json& object, const std::string& what,
                          const std::vector<std::pair<std::string, std::optional<Vec3>*>>& known,
                          const std::string& where) {
  if (!object.is_object())
    return fail(ErrorCode::invalid, "'" + what + "' must be an object", where);
  for (const auto& [key, value] : object.items()) {
    const auto place = std::find_if(known.begin(), known.end(),
                                    [&k = key](const auto& entry) { return entry.first == k; });
    if (place == known.end())
      return fail(
          ErrorCode::invalid,
          std::string("unknown key '").append(key).append("' in '").append(what).append("'"),
          where);
    const auto v = triple_of(value, key, where);
    ARTUS_TRY(v);
    *place->second = *v;
  }
  return {};
}

Result<Line> parse_json_line(std::string_view text, const std::string& where) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object())
    return fail(ErrorCode::malformed, "every line must be one JSON object", where);
  Line line;
  for (const auto& [key, value] : object.items()) {
    Result<void> ok;
    if (key == "probe") {
      ok = read_triples(value, key,
                        {{"position_mm", &line.position},
                         {"direction", &line.direction},
                         {"lateral", &line.lateral}},
                        where);
    } else if (key == "needle") {
      if (!value.is_null())
        ok = read_triples(value, key, {{"entry_mm", &line.entry}, {"tip_mm", &line.tip}}, where);
    } else if (key == "name" && value.is_string()) {
      line.name = value.get<std::string>();
    } else if (key == "time_s" && value.is_number() && std::isfinite(value.get<double>())) {
      line.time = value.get<double>();
    } else {
      ok = fail(ErrorCode::invalid, "'" + key + "' is unknown or has no proper value", where);
    }
    if (!ok) return tl::unexpected(ok.error());
  }
  return line;
}

// ---- CSV

struct Column {
  const char* name;
  std::optional<Vec3> Line::*member;
  int axis;
};
constexpr std::array<Column, 15> kColumns{{{"probe_x_mm", &Line::position, 0},
                                           {"probe_y_mm", &Line::position, 1},
                                           {"probe_z_mm", &Line::position, 2},
                                           {"direction_x", &Line::direction, 0},
                                           {"direction_y", &Line::direction, 1},
                                           {"direction_z", &Line::direction, 2},
                                           {"lateral_x", &Line::lateral, 0},
                                           {"lateral_y", &Line::lateral, 1},
                                           {"lateral_z", &Line::lateral, 2},
                                           {"entry_x_mm", &Line::entry, 0},
                                           {"entry_y_mm", &Line::entry, 1},
                                           {"entry_z_mm", &Line::entry, 2},
                                           {"tip_x_mm", &Line::tip, 0},
                                           {"tip_y_mm", &Line::tip, 1},
                                           {"tip_z_mm", &Line::tip, 2}}};

std::vector<std::string_view> split_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

Result<double> number_of(std::string_view cell, std::string_view column, const std::string& where) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
    return fail(
        ErrorCode::invalid,
        "'" + std::string(cell) + "' in column " + std::string(column) + " is not a finite number",
        where);
  return value;
}

Result<Line> parse_csv_line(const std::vector<std::string>& header, std::string_view text,
                            const std::string& where) {
  const auto cells = split_cells(text);
  if (cells.size() != header.size())
    return fail(ErrorCode::malformed,
                std::to_string(cells.size()) + " cells, but the header has " +
                    std::to_string(header.size()),
                where);
  Line line;
  std::array<int, kColumns.size()> seen{};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (header[i] == "name") {
      line.name = cells[i];
      continue;
    }
    if (cells[i].empty()) continue;  // no needle, no lateral direction or no time in this line
    const auto value = number_of(cells[i], header[i], where);
    ARTUS_TRY(value);
    if (header[i] == "time_s") {
      line.time = *value;
      continue;
    }
    for (std::size_t c = 0; c < kColumns.size(); ++c) {
      if (header[i] != kColumns[c].name) continue;
      auto& vector = line.*kColumns[c].member;
      if (!vector) vector = Vec3::Zero();
      (*vector)[kColumns[c].axis] = *value;
      ++seen[c];
    }
  }
  for (std::size_t c = 0; c < kColumns.size(); c += 3)
    if (seen[c] != seen[c + 1] || seen[c] != seen[c + 2])
      return fail(ErrorCode::invalid,
                  "of " + std::string(kColumns[c].name) + " and its two companions one is missing",
                  where);
  return line;
}

Result<std::vector<std::string>> parse_header(std::string_view text, const std::string& where) {
  std::vector<std::string> header;
  for (const std::string_view cell : split_cells(text)) {
    const bool known = cell == "name" || cell == "time_s" ||
                       std::any_of(kColumns.begin(), kColumns.end(),
                                   [&](const Column& c) { return cell == c.name; });
    if (!known)
      return fail(ErrorCode::invalid, "unknown column '" + std::string(cell) + "'", where);
    if (std::find(header.begin(), header.end(), cell) != header.end())
      return fail(ErrorCode::invalid, "column '" + std::string(cell) + "' is there twice", where);
    header.emplace_back(cell);
  }
  return header;
}

Pose between(const Pose& a, const Pose& b, double t) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(a.linear())
                      .slerp(t, Eigen::Quaterniond(b.linear()))
                      .normalized()
                      .toRotationMatrix();
  pose.translation() = (1 - t) * a.translation() + t * b.translation();
  return pose;
}

}  // namespace

Result<std::vector<ListedPose>> parse_poses_jsonl(std::string_view text, const std::string& name) {
  std::vector<ListedPose> poses;
  const auto ok = for_lines(text, name, [&](std::string_view content, const std::string& where) {
    const auto line = parse_json_line(content, where);
    return line ? append(poses, *line, where) : Result<void>(tl::unexpected(line.error()));
  });
  ARTUS_TRY(ok);
  return not_empty(std::move(poses), name);
}

Result<std::vector<ListedPose>> parse_poses_csv(std::string_view text, const std::string& name) {
  std::vector<ListedPose> poses;
  std::vector<std::string> header;
  const auto ok = for_lines(
      text, name, [&](std::string_view content, const std::string& where) -> Result<void> {
        if (header.empty()) {
          auto columns = parse_header(content, where);
          ARTUS_TRY(columns);
          header = std::move(*columns);
          return {};
        }
        const auto line = parse_csv_line(header, content, where);
        return line ? append(poses, *line, where) : Result<void>(tl::unexpected(line.error()));
      });
  ARTUS_TRY(ok);
  return not_empty(std::move(poses), name);
}

Result<std::vector<ListedPose>> read_poses(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension != ".jsonl" && extension != ".csv")
    return fail(ErrorCode::unsupported, "poses are read from .jsonl or .csv", file.string());
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  return extension == ".csv" ? parse_poses_csv(*bytes, file.string())
                             : parse_poses_jsonl(*bytes, file.string());
}

Result<std::vector<ListedPose>> sample_path(const std::vector<ListedPose>& poses, double rate) {
  const auto timed = std::count_if(poses.begin(), poses.end(),
                                   [](const ListedPose& p) { return p.time.has_value(); });
  if (timed == 0 || poses.size() < 2) return poses;
  if (timed != static_cast<std::ptrdiff_t>(poses.size()))
    return fail(ErrorCode::invalid, "either all poses have a time_s or none");
  std::vector<ListedPose> out;
  const double start = *poses.front().time;
  std::size_t next = 1;
  for (int i = 0;; ++i) {
    const double time = start + i / rate;
    if (time > *poses.back().time + 1e-9) break;
    while (next + 1 < poses.size() && *poses[next].time < time) ++next;
    const ListedPose& a = poses[next - 1];
    const ListedPose& b = poses[next];
    const double t = std::clamp((time - *a.time) / (*b.time - *a.time), 0.0, 1.0);
    ListedPose pose{t < 1 ? a.name : b.name, time, between(a.X_JP, b.X_JP, t), std::nullopt};
    if (a.X_JN && b.X_JN) pose.X_JN = between(*a.X_JN, *b.X_JN, t);
    out.push_back(std::move(pose));
  }
  return out;
}

std::string poses_csv(std::span<const ListedPose> poses) {
  constexpr double kShaft = 0.1;  // m
  std::string out = "name,time_s";
  for (const Column& column : kColumns) (out += ',') += column.name;
  out += '\n';
  for (const ListedPose& pose : poses) {
    Line line;
    line.position = pose.X_JP.translation() / kMillimetre;
    line.direction = pose.X_JP.linear().col(2);
    line.lateral = pose.X_JP.linear().col(0);
    if (pose.X_JN) {
      line.tip = pose.X_JN->translation() / kMillimetre;
      line.entry = *line.tip - pose.X_JN->linear().col(2) * (kShaft / kMillimetre);
    }
    ((out += pose.name) += ',') += pose.time ? to_exact_csv(*pose.time) : "";
    for (const Column& column : kColumns) {
      const auto& vector = line.*column.member;
      (out += ',') += vector ? to_exact_csv((*vector)[column.axis]) : "";
    }
    out += '\n';
  }
  return out;
}

}  // namespace artus
