// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/tracker_file.h"

#include <fstream>
#include <utility>

#include "artus/detail/core/csv.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/text_lines.h"
#include "artus/detail/exchange/perk_recording.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/sequence_header.h"
#include "artus/detail/exchange/tracker_table.h"

namespace artus {
namespace {

bool begins_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

/// The file's first bytes: enough to know a sequence, whose pixels nobody needs.
std::string first_bytes(const std::filesystem::path& file) {
  std::string start(64, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(in.gcount()));
  return start;
}

/// The file as a track; nullopt: it is none, but a list of artus.
Result<std::optional<TrackerTrack>> read_track(const std::filesystem::path& file,
                                               const TrackNames& names) {
  const std::string extension = file.extension().string();
  const std::string first = first_bytes(file);
  const std::string_view start = trimmed(first);
  const auto some = [](Result<TrackerTrack> track) -> Result<std::optional<TrackerTrack>> {
    ARTUS_TRY(track);
    return std::optional(std::move(*track));
  };
  const bool named = extension == ".mha" || extension == ".mhd" || extension == ".nrrd";
  if (named || begins_with(start, "NRRD0") || begins_with(start, "ObjectType") ||
      begins_with(start, "NDims")) {
    const auto header = read_sequence_header(file);
    ARTUS_TRY(header);
    return some(track_of(*header, file.string(), names));
  }
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  if (begins_with(start, "<") || extension == ".xml")
    return some(parse_perk_recording(*text, file.string(), names));
  if (!is_pose_list(file, *text) && is_tracker_table(*text))
    return some(parse_tracker_table(*text, file.string()));
  return std::optional<TrackerTrack>();
}

/// Puts sensors in the tracker's reference into the joint.
class Registered {
 public:
  Registered(const PoseFileOptions& options, bool reference_is_ras) {
    if (options.calibration) {
      calibration_ = *options.calibration;
      if (!calibration_.registered && !reference_is_ras) calibration_.X_JR = Pose::Identity();
    } else if (!reference_is_ras) {
      calibration_.X_JR = Pose::Identity();
    }
  }
  [[nodiscard]] Pose probe(const Pose& X_RS) const {
    return calibration_.X_JR * calibration_.scaled(X_RS) * calibration_.X_ProbeP;
  }
  [[nodiscard]] Pose needle(const Pose& X_RS) const {
    return calibration_.X_JR * calibration_.scaled(X_RS) * calibration_.X_NeedleN;
  }
  /// The same of orientations.
  [[nodiscard]] Eigen::Matrix3d probe_turn(const Eigen::Matrix3d& given) const {
    return calibration_.X_JR.linear() * given * calibration_.X_ProbeP.linear();
  }
  [[nodiscard]] Eigen::Matrix3d needle_turn(const Eigen::Matrix3d& given) const {
    return calibration_.X_JR.linear() * given * calibration_.X_NeedleN.linear();
  }

 private:
  TrackerCalibration calibration_;
};

Result<PoseFile> poses_of_track(TrackerTrack track, const PoseFileOptions& options,
                                const std::string& name) {
  const Registered registered(options, track.reference_is_ras);
  PoseFile out;
  out.notices = std::move(track.notices);
  std::size_t without = 0;
  for (const TrackFrame& frame : track.frames) {
    const bool has = options.needed == PoseHand::either ||
                     (options.needed == PoseHand::probe ? frame.probe : frame.needle).has_value();
    if (!has) {
      ++without;
      continue;
    }
    ListedPose pose;
    pose.time = frame.time;
    pose.has_probe = frame.probe.has_value();
    if (frame.probe) pose.X_JP = registered.probe(*frame.probe);
    if (frame.needle) pose.X_JN = registered.needle(*frame.needle);
    if (frame.probe_given) pose.probe_given = registered.probe_turn(*frame.probe_given);
    if (frame.needle_given) pose.needle_given = registered.needle_turn(*frame.needle_given);
    out.poses.push_back(std::move(pose));
  }
  const char* hand = options.needed == PoseHand::probe ? "probe" : "needle";
  if (out.poses.empty())
    return fail(ErrorCode::invalid, std::string("no pose has the ") + hand + ", which is needed",
                name);
  if (without > 0)
    out.notices.push_back(std::to_string(without) +
                          " frames were left out: the tracker did not see the " + hand);
  return out;
}

Result<PoseFile> poses_of_list(const std::filesystem::path& file, const PoseFileOptions& options) {
  PoseFile out;
  std::size_t left_out = 0;
  auto poses = read_poses(file, options.needed, &left_out);
  ARTUS_TRY(poses);
  out.poses = std::move(*poses);
  if (left_out > 0)
    out.notices.push_back(std::to_string(left_out) +
                          " rows were left out: the tracker did not see what is needed");
  if (!options.calibration) return out;
  const Registered registered(options, false);
  for (ListedPose& pose : out.poses) {
    if (pose.has_probe) pose.X_JP = registered.probe(pose.X_JP);
    if (pose.X_JN) pose.X_JN = registered.needle(*pose.X_JN);
  }
  return out;
}

}  // namespace

bool is_pose_list(const std::filesystem::path& file, std::string_view text) {
  if (file.extension() == ".jsonl") return true;
  if (file.extension() != ".csv") return false;
  const std::string_view line = text.substr(0, text.find('\n'));
  for (const std::string& cell : csv_cells(line))
    for (const char* own : {"probe_x_", "needle_x_", "direction_x", "entry_x_", "tip_x_"})
      if (begins_with(cell, own)) return true;
  return false;
}

Result<PoseFile> read_pose_file(const std::filesystem::path& file, const PoseFileOptions& options) {
  auto track = read_track(file, options.names);
  ARTUS_TRY(track);
  if (*track) return poses_of_track(std::move(**track), options, file.string());
  return poses_of_list(file, options);
}

}  // namespace artus
