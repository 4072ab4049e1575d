// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/dataset/pose_list.h"

#include <algorithm>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/dataset/pose_lines.h"

namespace artus {
namespace {

/// Refuses a place that no joint has: most often it is in another unit.
Result<void> check_place(const std::optional<Pose>& pose, const char* hand,
                         const std::string& where) {
  constexpr double kFarthest = 10;  // m
  if (!pose || pose->translation().norm() <= kFarthest) return {};
  return fail(ErrorCode::invalid,
              printed("the %s lies %.0f m from the joint's origin; is its place in another unit "
                      "(_mm, _m)?",
                      hand, pose->translation().norm()),
              where);
}

/// Whether a line without the hand that is needed says that a tracker did not see it.
bool was_not_seen(const PoseLine& line, PoseHand needed) {
  if (needed == PoseHand::either) return !line.unseen.empty();
  return line.unseen.count(needed == PoseHand::probe ? "probe" : "needle") > 0;
}

/// Whether the line was taken: one in which the needed hand was not seen is not.
Result<bool> append(std::vector<ListedPose>& poses, const PoseLine& line, PoseHand needed,
                    const std::string& where) {
  const auto probe = probe_of(line, where);
  ARTUS_TRY(probe);
  const auto needle = needle_of(line, where);
  ARTUS_TRY(needle);
  const bool lacks = needed == PoseHand::either ? !*probe && !*needle
                                                : !(needed == PoseHand::probe ? *probe : *needle);
  if (lacks && was_not_seen(line, needed)) return false;
  if (lacks && needed == PoseHand::probe)
    return fail(ErrorCode::invalid, "a pose needs the probe's position_mm and direction", where);
  if (lacks && needed == PoseHand::needle)
    return fail(ErrorCode::invalid, "a pose needs the needle's entry_mm and tip_mm", where);
  if (lacks) return fail(ErrorCode::invalid, "the line has neither needle nor probe", where);
  ARTUS_TRY(check_place(*probe, "probe", where));
  ARTUS_TRY(check_place(*needle, "needle", where));
  if (line.time && !poses.empty() && poses.back().time && *line.time <= *poses.back().time)
    return fail(ErrorCode::invalid, "time_s must rise from pose to pose", where);
  poses.push_back(
      {line.name, line.time, probe->value_or(Pose::Identity()), *needle, probe->has_value()});
  return true;
}

Result<std::vector<ListedPose>> parse(std::string_view text, const std::string& name,
                                      PoseFormat format, PoseHand needed, std::size_t* left_out) {
  std::vector<ListedPose> poses;
  std::size_t unseen = 0;
  const auto read = for_pose_lines(
      text, name, format, [&](const PoseLine& line, const std::string& where) -> Result<void> {
        const auto taken = append(poses, line, needed, where);
        ARTUS_TRY(taken);
        unseen += *taken ? 0U : 1U;
        return {};
      });
  ARTUS_TRY(read);
  if (left_out != nullptr) *left_out = unseen;
  if (poses.empty()) return fail(ErrorCode::invalid, "the file has no pose", name);
  return poses;
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

Result<std::vector<ListedPose>> parse_poses_jsonl(std::string_view text, const std::string& name,
                                                  PoseHand needed, std::size_t* left_out) {
  return parse(text, name, PoseFormat::json_lines, needed, left_out);
}

Result<std::vector<ListedPose>> parse_poses_csv(std::string_view text, const std::string& name,
                                                PoseHand needed, std::size_t* left_out) {
  return parse(text, name, PoseFormat::csv, needed, left_out);
}

Result<std::vector<ListedPose>> read_poses(const std::filesystem::path& file, PoseHand needed,
                                           std::size_t* left_out) {
  const auto format = pose_format_of(file);
  ARTUS_TRY(format);
  const auto bytes = read_bytes(file);
  ARTUS_TRY(bytes);
  return parse(*bytes, file.string(), *format, needed, left_out);
}

Result<std::vector<ListedPose>> sample_path(const std::vector<ListedPose>& poses, double rate,
                                            std::size_t max_samples) {
  const auto timed = std::count_if(poses.begin(), poses.end(),
                                   [](const ListedPose& p) { return p.time.has_value(); });
  if (timed == 0 || poses.size() < 2) return poses;
  if (timed != static_cast<std::ptrdiff_t>(poses.size()))
    return fail(ErrorCode::invalid, "either all poses have a time_s or none");
  const double start = *poses.front().time;
  const double seconds = *poses.back().time - start;
  if (!(seconds * rate < static_cast<double>(max_samples)))
    return fail(ErrorCode::invalid,
                printed("time_s runs over %.4g s, which at %.4g a second are more than %zu poses; "
                        "is it in seconds? Give less of it, or a lower rate",
                        seconds, rate, max_samples));
  std::vector<ListedPose> out;
  std::size_t next = 1;
  for (std::size_t i = 0;; ++i) {
    const double time = start + static_cast<double>(i) / rate;
    if (time > *poses.back().time + 1e-9) break;
    while (next + 1 < poses.size() && *poses[next].time < time) ++next;
    const ListedPose& a = poses[next - 1];
    const ListedPose& b = poses[next];
    const double t = std::clamp((time - *a.time) / (*b.time - *a.time), 0.0, 1.0);
    ListedPose pose{t < 1 ? a.name : b.name, time, between(a.X_JP, b.X_JP, t), std::nullopt,
                    a.has_probe && b.has_probe};
    if (a.X_JN && b.X_JN) pose.X_JN = between(*a.X_JN, *b.X_JN, t);
    out.push_back(std::move(pose));
  }
  return out;
}

std::string poses_csv(std::span<const ListedPose> poses) {
  constexpr double kShaft = 0.1;  // m
  std::string out =
      "name,time_s,probe_x_mm,probe_y_mm,probe_z_mm,direction_x,direction_y,direction_z,lateral_x,"
      "lateral_y,lateral_z,entry_x_mm,entry_y_mm,entry_z_mm,tip_x_mm,tip_y_mm,tip_z_mm\n";
  const auto append_vector = [&out](const Vec3& v) {
    for (const double value : v) (out += ',') += to_exact_csv(value);
  };
  for (const ListedPose& pose : poses) {
    ((out += pose.name) += ',') += pose.time ? to_exact_csv(*pose.time) : "";
    append_vector(pose.X_JP.translation() / kMillimetre);
    append_vector(pose.X_JP.linear().col(2));
    append_vector(pose.X_JP.linear().col(0));
    if (pose.X_JN) {
      const Vec3 tip = pose.X_JN->translation() / kMillimetre;
      append_vector(tip - pose.X_JN->linear().col(2) * (kShaft / kMillimetre));
      append_vector(tip);
    } else {
      out += ",,,,,,";
    }
    out += '\n';
  }
  return out;
}

}  // namespace artus
