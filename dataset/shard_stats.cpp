// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/shard_stats.h"

#include <algorithm>
#include <array>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "artus/detail/core/plain_reason.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/dataset/tar_file.h"

namespace artus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kWidth = 420;   // pixels of a histogram's box
constexpr int kHeight = 220;  // pixels
constexpr int kMargin = 34;   // pixels inside the box
constexpr int kBins = 40;
constexpr int kStatColumns = 3;

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

void take_needle(const json& needle, SetStatistics& out) {
  ++out.with_needle;
  out.in_plane += needle.at("in_plane").get<bool>() ? 1 : 0;
  out.tip_shown += needle.at("tip_shown_px").is_array() ? 1 : 0;
  out.tip_in_picture += needle.at("tip_in_picture").get<bool>() ? 1 : 0;
  out.tip_visible += needle.at("tip_visible").get<bool>() ? 1 : 0;
  ++out.tip_in[needle.at("tip_tissue").get<std::string>()];
  out.values["tip x, px"].push_back(needle.at("tip_true_px").at(0).get<double>());
  out.values["tip y, px"].push_back(needle.at("tip_true_px").at(1).get<double>());
  for (const char* key : {"tip_offset_mm", "plane_angle_deg", "face_angle_deg"})
    out.values[key].push_back(needle.at(key).get<double>());
}

void take_frame(const json& truth, SetStatistics& out) {
  ++out.frames;
  out.values["contact share"].push_back(truth.at("contact").at("share").get<double>());
  const json& position = truth.at("probe").at("position_mm");
  for (std::size_t i = 0; i < 3; ++i)
    out.values[std::string("probe ") + "xyz"[i] + ", mm"].push_back(position.at(i).get<double>());
  for (const json& region : truth.at("regions"))
    ++out.regions[region.at("region").get<std::string>()];
  if (truth.contains("needle")) take_needle(truth.at("needle"), out);
}

Result<void> take_shard(const fs::path& file, SetStatistics& out) {
  const auto archive = read_bytes(file);
  ARTUS_TRY(archive);
  const auto members = list_members(*archive);
  if (!members) return fail(members.error().code, members.error().message, file.string());
  for (const TarMember& member : *members) {
    if (!ends_with(member.name, ".json")) continue;
    try {
      take_frame(json::parse(member.bytes), out);
    } catch (const json::exception& e) {
      return fail(ErrorCode::malformed, plain_reason(e.what()),
                  file.string() + ":" + std::string(member.name));
    }
  }
  return {};
}

std::array<double, 5> five_numbers(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::array<double, 5> out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = values[i * (values.size() - 1) / 4];
  return out;
}

void write_at(cv::Mat& page, const std::string& text, const cv::Point& where, double size = 0.42) {
  cv::putText(page, text, where, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar::all(30), 1,
              cv::LINE_AA);
}

std::string short_number(double value) {
  return printed("%.3g", value);
}

/// Bars of counts in a box at `corner`.
void draw_bars(cv::Mat& page, const cv::Point& corner, const std::vector<double>& counts) {
  const double most = std::max(1.0, *std::max_element(counts.begin(), counts.end()));
  const int width = kWidth - 2 * kMargin;
  const int height = kHeight - 2 * kMargin;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto at = [&](std::size_t k) {
      return corner.x + kMargin + static_cast<int>(k) * width / static_cast<int>(counts.size());
    };
    const int bottom = corner.y + kHeight - kMargin;
    const int top = bottom - static_cast<int>(counts[i] / most * height);
    cv::rectangle(page, {at(i), top}, {at(i + 1) - 1, bottom}, cv::Scalar(180, 120, 60), -1);
  }
}

void draw_histogram(cv::Mat& page, const cv::Point& corner, const std::string& name,
                    const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double span = std::max(*high - *low, 1e-9);
  std::vector<double> counts(kBins, 0);
  for (const double value : values)
    ++counts[static_cast<std::size_t>(std::min(kBins - 1.0, (value - *low) / span * kBins))];
  draw_bars(page, corner, counts);
  write_at(page, name + "  (" + std::to_string(values.size()) + ")",
           corner + cv::Point(kMargin, kMargin - 12));
  write_at(page, short_number(*low), corner + cv::Point(kMargin, kHeight - 14));
  write_at(page, short_number(*high), corner + cv::Point(kWidth - kMargin - 50, kHeight - 14));
}

void draw_regions(cv::Mat& page, int top, const SetStatistics& statistics) {
  constexpr int kRow = 18;  // pixels
  write_at(page, "frames that show a region", {kMargin, top + 14}, 0.5);
  int y = top + 40;
  for (const auto& [name, count] : statistics.regions) {
    const double share = static_cast<double>(count) / static_cast<double>(statistics.frames);
    const int length = static_cast<int>(share * 600);
    write_at(page, name, {kMargin, y});
    cv::rectangle(page, {300, y - 10}, {300 + length, y + 2}, cv::Scalar(180, 120, 60), -1);
    write_at(page, short_number(100 * share) + " %", {310 + length, y});
    y += kRow;
  }
}

}  // namespace

Result<SetStatistics> read_statistics(const std::vector<fs::path>& folders,
                                      const Progress& progress) {
  std::vector<fs::path> files;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.path().filename().string().rfind("shard-", 0) == 0 &&
          entry.path().extension() == ".tar")
        files.push_back(entry.path());
    if (error) return fail(ErrorCode::not_found, error.message(), folder.string());
  }
  if (files.empty()) return fail(ErrorCode::not_found, "no shard was found");
  std::sort(files.begin(), files.end());
  SetStatistics statistics;
  for (std::size_t i = 0; i < files.size(); ++i) {
    ARTUS_TRY(take_shard(files[i], statistics));
    if (progress)
      progress("statistics", static_cast<double>(i + 1) / static_cast<double>(files.size()));
  }
  return statistics;
}

json to_json(const SetStatistics& statistics) {
  json values;
  for (const auto& [name, list] : statistics.values) values[name] = five_numbers(list);
  return {{"frames", statistics.frames},       {"with_needle", statistics.with_needle},
          {"in_plane", statistics.in_plane},   {"tip_in_picture", statistics.tip_in_picture},
          {"tip_shown", statistics.tip_shown}, {"tip_visible", statistics.tip_visible},
          {"tip_in", statistics.tip_in},       {"regions", statistics.regions},
          {"min_quartiles_max", values}};
}

cv::Mat histogram_page(const SetStatistics& statistics) {
  const int boxes = static_cast<int>(statistics.values.size());
  const int rows = (boxes + kStatColumns - 1) / kStatColumns;
  const int regions_top = rows * kHeight + 50;
  const int height = regions_top + 60 + 18 * static_cast<int>(statistics.regions.size());
  cv::Mat page(height, kStatColumns * kWidth, CV_8UC3, cv::Scalar::all(255));
  const std::string head = printed(
      "%zu frames, %zu with a needle, of these %zu in plane, %zu tips in the picture, %zu "
      "visible",
      statistics.frames, statistics.with_needle, statistics.in_plane, statistics.tip_in_picture,
      statistics.tip_visible);
  write_at(page, head, {kMargin, 28}, 0.6);
  int box = 0;
  for (const auto& [name, list] : statistics.values) {
    draw_histogram(page, {box % kStatColumns * kWidth, 40 + box / kStatColumns * kHeight}, name,
                   list);
    ++box;
  }
  draw_regions(page, regions_top, statistics);
  return page;
}

}  // namespace artus
