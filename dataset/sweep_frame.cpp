// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/dataset/sweep_frame.h"

#include <bit>
#include <cstdint>
#include <cstdio>
#include <optional>

#include "artus/core/noise.h"
#include "artus/core/units.h"
#include "artus/dataset/echo_truth.h"
#include "artus/echo/image_io.h"

namespace artus {
namespace {

std::uint64_t mix_pose(std::uint64_t hash, const Pose& pose) {
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 4; ++j)
      hash = mix_bits(hash ^ std::bit_cast<std::uint64_t>(pose(i, j)));
  return hash;
}

}  // namespace

std::string digest_of(const std::vector<ListedPose>& poses) {
  std::uint64_t hash = poses.size();
  for (const ListedPose& pose : poses) {
    for (const char c : pose.name) hash = mix_bits(hash ^ static_cast<unsigned char>(c));
    hash = mix_bits(hash ^ std::bit_cast<std::uint64_t>(pose.time.value_or(-1)));
    hash = mix_pose(mix_bits(hash ^ (pose.X_JN ? 1U : 0U)), pose.X_JP);
    if (pose.X_JN) hash = mix_pose(hash, *pose.X_JN);
  }
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

nlohmann::json describe_sweep(const CompiledJoint& joint, const SweepOptions& options) {
  return {{"joint", {{"name", joint.name}, {"digest", joint.source_digest}}},
          {"transducer", to_json(options.transducer)},
          {"settings", to_json(options.settings)},
          {"needle",
           {{"outer_diameter_mm", options.needle.outer_diameter / kMillimetre},
            {"bore_mm", options.needle.bore / kMillimetre},
            {"length_mm", options.needle.length / kMillimetre},
            {"echogenic", options.needle.echogenic}}}};
}

SweepDrawer::SweepDrawer(std::shared_ptr<const Scene> scene, const SweepOptions& options)
    : scene_(std::move(scene)),
      needle_(options.needle),
      renderer_(scene_, options.transducer, options.settings),
      truth_(options.transducer, options.settings) {}

SweepFrame SweepDrawer::draw(std::size_t index, const ListedPose& pose) {
  std::optional<NeedleView> needle;
  if (pose.X_JN) needle = NeedleView{*pose.X_JN, needle_};
  const Frame& frame = renderer_.render(pose.X_JP, needle);
  const LabelImage labels = truth_.render(*scene_, pose.X_JP, needle);
  SweepFrame out;
  out.truth = {{"index", index},
               {"probe", probe_json(pose.X_JP)},
               {"pixel_mm", frame.pixel / kMillimetre},
               {"contact", contact_json(frame)},
               {"regions", region_list(labels, scene_->joint())}};
  if (!pose.name.empty()) out.truth["name"] = pose.name;
  if (pose.time) out.truth["time_s"] = *pose.time;
  if (needle) out.truth["needle"] = to_json(truth_.locate(*needle, pose.X_JP), frame.tip_shown);
  out.pictures = {{"image", grey_image(frame)},
                  {"labels", id_image(labels)},
                  {"shadow_mask", shadow_mask(frame, truth_.converter())}};
  if (needle) out.pictures.emplace_back("needle_mask", needle_mask(labels));
  return out;
}

}  // namespace artus
