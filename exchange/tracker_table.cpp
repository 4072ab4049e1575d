// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/tracker_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/exchange/faults.h"
#include "artus/detail/exchange/table_columns.h"

namespace artus {
namespace {

using Cells = std::vector<std::string>;
constexpr double kNdiRate = 60;  // Hz, at which NDI's frame numbers count

Cells cells_of(std::string_view line) {
  std::string text(line);
  text.erase(std::remove(text.begin(), text.end(), '"'), text.end());
  if (text.find_first_of(",;\t") == std::string::npos) {
    Cells cells;
    TextCursor cursor(text, "");
    for (std::string_view token = cursor.next(); !token.empty(); token = cursor.next())
      cells.emplace_back(token);
    return cells;
  }
  if (text.find(',') == std::string::npos)
    for (char& c : text) c = c == ';' || c == '\t' ? ',' : c;
  return csv_cells(text);
}

/// The header of lines of eight numbers, which have none: time, x y z, qx qy qz qw.
TableColumns plain_columns() {
  TableColumns columns;
  columns.time = 0;
  columns.tools.push_back({"", {1, 2, 3, 7, 4, 5, 6}, 0, {}});
  return columns;
}

bool is_plain_row(const Cells& cells) {
  return cells.size() == 8 && std::all_of(cells.begin(), cells.end(), [](const std::string& cell) {
           return parse_number(cell).has_value();
         });
}

bool is_sofa(std::string_view line) {
  return trimmed(line).substr(0, 2) == "T=";
}

/// A line that says whose columns follow: of words, or lines of eight numbers.
std::optional<TableColumns> columns_in(std::string_view line) {
  if (trimmed(line).substr(0, 1) == "#") return std::nullopt;
  const Cells cells = cells_of(line);
  if (is_plain_row(cells)) return plain_columns();
  TableColumns columns = find_columns(cells);
  const bool timed = columns.time || columns.second || columns.millisecond || columns.frame;
  return columns.tools.empty() || !timed ? std::nullopt : std::optional(std::move(columns));
}

/// One tool of a row before its unit is known.
struct RawPose {
  Vec3 position = Vec3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};
struct RawRow {
  double time = 0;
  std::vector<std::optional<RawPose>> tools;
};

bool is_word_of_loss(std::string word) {
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const char* lost : {"missing", "disabled", "invalid", "out", "not", "lost", "unoccupied"})
    if (word.find(lost) != std::string::npos) return true;
  return false;
}

class TableReader {
 public:
  explicit TableReader(std::string name) : name_(std::move(name)) {}

  void take(std::string_view line, const std::string& where) {
    if (is_sofa(line) || sofa_) return take_sofa(line, where);
    if (!columns_) {
      columns_ = columns_in(line);
      if (!columns_ || !is_plain_row(cells_of(line))) return;
    }
    if (trimmed(line).substr(0, 1) != "#") take_row(cells_of(line), where);
  }

  Result<TrackerTrack> finish();

 private:
  void take_sofa(std::string_view line, const std::string& where);
  void take_row(const Cells& cells, const std::string& where);
  std::optional<double> clock_of(const Cells& cells, const std::string& where);
  std::optional<RawPose> pose_of(const ToolColumns& tool, const Cells& cells,
                                 const std::string& where);
  std::optional<RawPose> pose_of(const std::array<double, 7>& numbers, const std::string& where);
  void add(RawRow row, const std::string& where);
  double time_unit() const;
  double length_unit();
  std::vector<std::size_t> hands();

  std::string name_;
  std::optional<TableColumns> columns_;
  bool sofa_ = false;
  std::optional<double> sofa_time_;
  double days_ = 0;  // s, of clocks that went over midnight
  std::vector<RawRow> rows_;
  std::size_t unseen_ = 0;
  std::size_t twice_ = 0;
  TrackerTrack track_;
  Faults faults_;
};

void TableReader::add(RawRow row, const std::string& where) {
  const bool seen =
      std::any_of(row.tools.begin(), row.tools.end(), [](const auto& t) { return t.has_value(); });
  if (!rows_.empty() && row.time < rows_.back().time)
    return faults_.add(where,
                       printed("the time falls from %.9g to %.9g", rows_.back().time, row.time));
  if (!seen) {
    ++unseen_;
    return;
  }
  if (!rows_.empty() && row.time == rows_.back().time) {
    ++twice_;
    return;
  }
  rows_.push_back(std::move(row));
}

std::optional<RawPose> TableReader::pose_of(const std::array<double, 7>& n,
                                            const std::string& where) {
  constexpr double kNoNumber = 1e20;  // NDI writes -3.697314e28
  const bool none = std::any_of(
      n.begin(), n.end(), [](double v) { return !std::isfinite(v) || std::abs(v) > kNoNumber; });
  const Eigen::Quaterniond q(n[3], n[4], n[5], n[6]);
  if (none || q.norm() == 0) return std::nullopt;
  if (!(q.norm() >= 0.9 && q.norm() <= 1.1)) {
    faults_.add(where,
                printed("the quaternion has the norm %.6g; it must be 0.9 to 1.1", q.norm()));
    return std::nullopt;
  }
  return RawPose{Vec3(n[0], n[1], n[2]), q.normalized()};
}

std::optional<RawPose> TableReader::pose_of(const ToolColumns& tool, const Cells& cells,
                                            const std::string& where) {
  for (const std::size_t i : tool.status)
    if (i < cells.size() && is_word_of_loss(cells[i])) return std::nullopt;
  std::array<double, 7> numbers{};
  std::size_t there = 0;
  for (std::size_t k = 0; k < 7; ++k) {
    const auto number = tool.at[k] < cells.size() ? parse_number(cells[tool.at[k]]) : std::nullopt;
    numbers[k] = number.value_or(0);
    there += number ? 1U : 0U;
  }
  if (there == 0) return std::nullopt;
  if (there == 7) return pose_of(numbers, where);
  faults_.add(where, "a pose is incomplete: some of its seven numbers are missing or are none");
  return std::nullopt;
}

std::optional<double> TableReader::clock_of(const Cells& cells, const std::string& where) {
  const auto number = [&](const std::optional<std::size_t>& at) -> std::optional<double> {
    if (!at) return 0.0;
    const auto value = *at < cells.size() ? parse_number(cells[*at]) : std::nullopt;
    return value && std::isfinite(*value) ? value : std::nullopt;
  };
  const auto time = number(columns_->time);
  const auto frame = number(columns_->frame);
  const auto hour = number(columns_->hour);
  const auto minute = number(columns_->minute);
  const auto second = number(columns_->second);
  const auto ms = number(columns_->millisecond);
  std::optional<double> value;
  if (columns_->time)
    value = time;
  else if (columns_->second || columns_->millisecond) {
    if (hour && minute && second && ms) value = 3600 * *hour + 60 * *minute + *second + 1e-3 * *ms;
  } else
    value = frame;
  if (!value) faults_.add(where, "the row has no time");
  if (value && columns_->hour && !columns_->time) {
    constexpr double kDay = 86400;
    if (!rows_.empty() && *value + days_ < rows_.back().time - 0.5 * kDay) days_ += kDay;
    value = *value + days_;
  }
  return value;
}

void TableReader::take_row(const Cells& cells, const std::string& where) {
  const auto time = clock_of(cells, where);
  if (!time) return;
  RawRow row{*time, {}};
  for (const ToolColumns& tool : columns_->tools) row.tools.push_back(pose_of(tool, cells, where));
  add(std::move(row), where);
}

void TableReader::take_sofa(std::string_view line, const std::string& where) {
  sofa_ = true;
  TextCursor cursor(line, "");
  const std::string key(cursor.next());
  if (key == "T=") {
    sofa_time_ = cursor.next_number();
    if (!sofa_time_) faults_.add(where, "T= must be followed by a time");
  }
  if (key != "X=" || !sofa_time_) return;
  std::vector<double> numbers;
  while (const auto number = cursor.next_number()) numbers.push_back(*number);
  if (numbers.empty() || numbers.size() % 7 != 0)
    return faults_.add(where, "X= must be followed by seven numbers for each rigid body");
  RawRow row{*sofa_time_, {}};
  for (std::size_t i = 0; i < numbers.size(); i += 7)
    row.tools.push_back(pose_of({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 6],
                                 numbers[i + 3], numbers[i + 4], numbers[i + 5]},
                                where));
  add(std::move(row), where);
}

double TableReader::time_unit() const {
  if (sofa_ || rows_.size() < 2) return 1;
  if (columns_->time) {
    if (columns_->time_unit > 0) return columns_->time_unit;
    const double step =
        (rows_.back().time - rows_.front().time) / static_cast<double>(rows_.size() - 1);
    return step >= 1e6 ? 1e-9 : step >= 1e3 ? 1e-6 : step >= 1 ? 1e-3 : 1;
  }
  return columns_->second || columns_->millisecond ? 1 : 1 / kNdiRate;
}

double TableReader::length_unit() {
  double most = 0;
  for (const RawRow& row : rows_)
    for (const auto& tool : row.tools)
      if (tool) most = std::max(most, tool->position.cwiseAbs().maxCoeff());
  const bool ndi = columns_ && columns_->of_ndi;
  const bool millimetres = ndi || most >= 10;
  track_.notices.push_back(
      std::string("no unit is written beside the lengths: they are taken as ") +
      (millimetres ? "millimetres" : "metres"));
  return millimetres ? 1e-3 : 1;
}

/// Which tool is the needle, which the probe: their numbers, or the count of tools for none.
std::vector<std::size_t> TableReader::hands() {
  std::size_t count = 0;
  for (const RawRow& row : rows_) count = std::max(count, row.tools.size());
  std::vector<std::size_t> found{count, count};
  const auto has = [](const std::string& tool, std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* w) { return tool.find(w) != std::string::npos; });
  };
  for (std::size_t i = 0; columns_ && i < columns_->tools.size(); ++i) {
    const std::string& tool = columns_->tools[i].tool;
    if (has(tool, {"probe", "transducer"}) && found[1] == count) found[1] = i;
    if (has(tool, {"needle", "stylus", "syringe"}) && found[0] == count) found[0] = i;
  }
  if (found[0] == count && found[1] == count) {
    found[0] = 0;
    if (count > 1) found[1] = 1;
    track_.notices.push_back(
        count > 1 ? "the first tool is taken for the needle, the second for the probe"
                  : "the tool is taken for the needle");
  }
  return found;
}

Result<TrackerTrack> TableReader::finish() {
  if (!sofa_ && !columns_)
    return fail(ErrorCode::malformed, "there is no header of positions and quaternions", name_);
  if (faults_.empty() && rows_.empty()) faults_.add("", "the file has no pose");
  if (!faults_.empty()) return faults_.refusal(ErrorCode::invalid, name_);
  const double seconds = time_unit();
  if (columns_ && columns_->time && columns_->time_unit == 0 && seconds != 1)
    track_.notices.push_back(printed("the times are taken as steps of %g s", seconds));
  if (columns_ && !columns_->time && !columns_->second && !columns_->millisecond)
    track_.notices.push_back(
        "there is no time but frame numbers: they are taken to count at 60 Hz");
  const bool written = columns_ && columns_->tools.front().unit > 0;
  const double guessed = written ? 1 : length_unit();
  const auto hand = hands();
  const auto pose_in = [&](const RawRow& row, std::size_t i) -> std::optional<Pose> {
    if (i >= row.tools.size() || !row.tools[i]) return std::nullopt;
    const double unit = columns_ && columns_->tools[i].unit > 0 ? columns_->tools[i].unit : guessed;
    Pose pose = Pose::Identity();
    pose.linear() = row.tools[i]->rotation.toRotationMatrix();
    pose.translation() = unit * row.tools[i]->position;
    return pose;
  };
  for (const RawRow& row : rows_) {
    TrackFrame frame{seconds * (row.time - rows_.front().time), pose_in(row, hand[1]),
                     pose_in(row, hand[0])};
    if (frame.probe || frame.needle)
      track_.frames.push_back(std::move(frame));
    else
      ++unseen_;
  }
  if (unseen_ > 0)
    track_.notices.push_back(std::to_string(unseen_) +
                             " rows were left out: the tracker saw none of the tools");
  if (twice_ > 0)
    track_.notices.push_back(std::to_string(twice_) +
                             " rows were left out: they have the time of the one before");
  return std::move(track_);
}

}  // namespace

bool is_tracker_table(std::string_view text) {
  constexpr int kSearched = 50;  // lines
  int lines = 0;
  bool found = false;
  static_cast<void>(
      for_lines(text, "", [&](std::string_view line, const std::string&) -> Result<void> {
        found = is_sofa(line) || columns_in(line).has_value();
        if (found || ++lines == kSearched) return fail(ErrorCode::failed, "enough");
        return {};
      }));
  return found;
}

Result<TrackerTrack> parse_tracker_table(std::string_view text, const std::string& name) {
  TableReader reader(name);
  const auto read = for_lines(text, name, [&](std::string_view line, const std::string& where) {
    reader.take(line, "line " + where.substr(where.rfind(':') + 1));
    return Result<void>();
  });
  ARTUS_TRY(read);
  return reader.finish();
}

}  // namespace artus
