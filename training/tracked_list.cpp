// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/tracked_list.h"

#include <algorithm>
#include <utility>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/dataset/pose_lines.h"

namespace artus {
namespace {

/// Collects lines into poses.
class Builder {
 public:
  Builder(const TrackedListOptions& options, std::string name)
      : options_(options), name_(std::move(name)) {}

  Result<void> add(const PoseLine& line, const std::string& where) {
    if (!line.time) return fail(ErrorCode::invalid, "every pose needs its time_s", where);
    if (!options_.sort && !list_.poses.empty() && *line.time < list_.poses.back().time)
      return fail(ErrorCode::invalid,
                  "time_s falls from " + std::to_string(list_.poses.back().time) + " to " +
                      std::to_string(*line.time) + " s; --sort sorts the poses by time",
                  where);
    auto probe = probe_of(line, where);
    ARTUS_TRY(probe);
    auto needle = needle_of(line, where);
    ARTUS_TRY(needle);
    if (!*probe && !*needle && !line.unseen.empty()) {
      ++unseen_;
      return {};
    }
    if (!*probe && !*needle)
      return fail(ErrorCode::invalid, "the line has neither needle nor probe", where);
    if (*needle && last_needle_ && line.numbers.count("needle.tip") > 0)
      (*needle)->linear() = without_spin((*needle)->linear());
    if (*needle) last_needle_ = *needle;
    list_.poses.push_back({*line.time, *needle, *probe});
    return {};
  }

  Result<TrackedList> finish() {
    auto& poses = list_.poses;
    if (poses.empty()) return fail(ErrorCode::invalid, "the file has no pose", name_);
    const auto earlier = [](const auto& a, const auto& b) {
      return a.time < b.time;
    };
    if (!std::is_sorted(poses.begin(), poses.end(), earlier)) {
      std::stable_sort(poses.begin(), poses.end(), earlier);
      list_.notices.push_back("the poses were sorted by time");
    }
    if (poses.back().time - poses.front().time > options_.longest)
      return fail(ErrorCode::invalid,
                  "the times span " + std::to_string(poses.back().time - poses.front().time) +
                      " s; is time_s in seconds?",
                  name_);
    if (unseen_ > 0)
      list_.notices.push_back(std::to_string(unseen_) +
                              " rows were left out: the tracker saw neither needle nor probe");
    tell_gaps();
    return std::move(list_);
  }

 private:
  /// The turn of a needle of two points: as it last was, turned without spin.
  [[nodiscard]] Eigen::Matrix3d without_spin(const Eigen::Matrix3d& R) const {
    const Eigen::Matrix3d last = last_needle_->linear();
    return rotation_between(last.col(2), R.col(2)).toRotationMatrix() * last;
  }
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
      list_.notices.push_back(
          std::to_string(same) +
          " poses have the same time as the pose before; no speed is computed for them");
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
  std::size_t unseen_ = 0;
};

}  // namespace

Result<TrackedList> parse_tracked_list(std::string_view text, const std::string& name,
                                       const TrackedListOptions& options) {
  const auto format = pose_format_of(name);
  ARTUS_TRY(format);
  Builder builder(options, name);
  ARTUS_TRY(for_pose_lines(
      text, name, *format,
      [&](const PoseLine& line, const std::string& where) { return builder.add(line, where); }));
  return builder.finish();
}

Result<TrackedList> read_tracked_list(const std::filesystem::path& file,
                                      const TrackedListOptions& options) {
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  return parse_tracked_list(*bytes, file.string(), options);
}

}  // namespace artus
