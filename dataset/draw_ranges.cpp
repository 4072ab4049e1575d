// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/draw_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "artus/detail/core/byte_stream.h"
#include "artus/detail/core/text_cursor.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_table.h"
#include "artus/echo/needle_view.h"

namespace artus {
namespace {

constexpr double kAny = -std::numeric_limits<double>::max();

/// A range in the file's unit, none of it below `least`.
std::optional<DrawRange> range_at(TomlTable& table, std::string_view key, double unit,
                                  double least) {
  const toml::array* pair = table.array(key);
  if (pair == nullptr) return std::nullopt;
  const auto at = [&](std::size_t i) {
    return pair->size() == 2 ? (*pair)[i].value<double>() : std::nullopt;
  };
  const auto low = at(0);
  const auto high = at(1);
  if (low && high && std::isfinite(*low) && std::isfinite(*high) && *low <= *high && *low >= least)
    return DrawRange{*low * unit, *high * unit};
  std::string message = "must be two numbers, [low, high]";
  if (least > kAny) append_number(message += ", from ", least);
  table.problem_at(key, message);
  return std::nullopt;
}

void read_range(TomlTable& table, std::string_view key, double unit, DrawRange& range,
                double least = kAny) {
  if (const auto read = range_at(table, key, unit, least)) range = *read;
}

void read_share(TomlTable& table, std::string_view key, double& share) {
  if (const auto number = table.number(key, 0, 1)) share = *number;
}

std::vector<std::string> texts_at(TomlTable& table, std::string_view key) {
  return table.has(key) ? table.required_texts(key) : std::vector<std::string>();
}

void read_probe(TomlTable& table, DrawRanges& ranges) {
  read_range(table, "lateral_mm", kMillimetre, ranges.lateral);
  read_range(table, "elevation_mm", kMillimetre, ranges.elevation);
  read_range(table, "turn_deg", kDegree, ranges.turn);
  read_range(table, "tilt_deg", kDegree, ranges.tilt);
  read_range(table, "rock_deg", kDegree, ranges.rock);
}

void read_gauges(TomlTable& table, DrawRanges& ranges) {
  const toml::array* list = table.array("gauge");
  if (list == nullptr) return;
  bool good = !list->empty();
  for (const toml::node& node : *list) {
    const int gauge = static_cast<int>(node.value<std::int64_t>().value_or(0));
    good = good && needle_of_gauge(gauge);
    ranges.gauges.push_back(gauge);
  }
  if (!good) table.problem_at("gauge", "must be a list of 18, 20, 21, 22, 23 or 25");
}

void read_needle(TomlTable& table, DrawRanges& ranges) {
  constexpr double kShortest = 10;  // mm
  read_share(table, "share", ranges.needle_share);
  read_share(table, "in_plane", ranges.in_plane_share);
  read_range(table, "along_mm", kMillimetre, ranges.along);
  read_range(table, "aside_mm", kMillimetre, ranges.aside);
  read_range(table, "slant_deg", kDegree, ranges.slant);
  if (const auto tip = table.text("tip")) {
    const auto named = std::find(kTipPlaceNames.begin(), kTipPlaceNames.end(), *tip);
    if (named == kTipPlaceNames.end())
      table.problem_at("tip", "must be anywhere, in_picture or visible");
    else
      ranges.tip = static_cast<TipPlace>(named - kTipPlaceNames.begin());
  }
  read_share(table, "tip_share", ranges.tip_share);
  if (table.has("not_in")) ranges.not_in = table.required_texts("not_in");
  read_share(table, "not_in_share", ranges.not_in_share);
  read_gauges(table, ranges);
  ranges.length = range_at(table, "length_mm", kMillimetre, kShortest);
  ranges.echogenic_share = table.number("echogenic", 0, 1);
}

void read_press(TomlTable& table, DrawRanges& ranges) {
  constexpr double kDeepest = 20e-3;  // m
  read_share(table, "share", ranges.press_share);
  read_range(table, "depth_mm", kMillimetre, ranges.press_depth, 0);
  if (ranges.press_depth.high > kDeepest) table.problem_at("depth_mm", "must be at most 20 mm");
}

}  // namespace

Result<DrawRanges> parse_draw_ranges(std::string_view text, const std::string& name) {
  const auto parsed = parse_toml(text, name);
  ARTUS_TRY(parsed);
  DrawRanges ranges;
  Problems problems;
  TomlTable root(*parsed, "ranges", problems);
  const auto read = [&](const char* key, const auto& take) {
    const toml::table* found = root.table(key);
    if (found == nullptr) return;
    TomlTable table(*found, key, problems);
    take(table, ranges);
    table.finish();
  };
  read("probe", read_probe);
  read("needle", read_needle);
  read("press", read_press);
  read("transducer",
       [](TomlTable& table, DrawRanges& out) { out.transducers = texts_at(table, "names"); });
  read("patient", [&name](TomlTable& table, DrawRanges& out) {
    for (const std::string& file : texts_at(table, "joints"))
      out.joints.push_back(std::filesystem::path(name).parent_path() / file);
    out.drawn_patients = static_cast<std::size_t>(table.number("drawn", 1, 1000).value_or(0));
  });
  root.finish();
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, name);
  return ranges;
}

Result<DrawRanges> read_draw_ranges(const std::filesystem::path& file) {
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  return parse_draw_ranges(*text, file.string());
}

std::uint64_t hash_of(const DrawRanges& r) {
  ByteWriter out;
  for (const DrawRange& range : {r.lateral, r.elevation, r.turn, r.tilt, r.rock, r.along, r.aside,
                                 r.slant, r.length.value_or(DrawRange{}), r.press_depth}) {
    out.put(range.low);
    out.put(range.high);
  }
  for (const double share : {r.needle_share, r.in_plane_share, r.echogenic_share.value_or(-1),
                             r.press_share, r.tip_share, r.not_in_share})
    out.put(share);
  out.put(static_cast<std::uint64_t>(r.tip));
  for (const std::string& name : r.not_in) out.put(std::string_view(name));
  out.put_array(r.gauges);
  for (const std::string& transducer : r.transducers) out.put(std::string_view(transducer));
  // Their digests are in the sidecar.
  out.put(static_cast<std::uint64_t>(r.joints.size() + r.drawn_patients));
  return hash_bytes(out.bytes());
}

}  // namespace artus
