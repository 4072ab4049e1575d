// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/record/recording_head.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "artus/detail/anatomy/body/joint_digest.h"
#include "artus/detail/core/byte_stream.h"
#include "artus/detail/core/plain_reason.h"
#include "artus/detail/core/printed.h"
#include "artus/detail/session/record/fields_json.h"
#include "artus/detail/session/record/needle_feel_json.h"
#include "artus/detail/simulation/session_fields.h"

namespace artus {
namespace {

// 13: the probe's contact is the tick's: packets of skin and curve in place of a tangent; the
// device's own limits of the probe's hand and its boxes, how long a device's pose is held,
// and `given` counts what left the needle forward, so that a replay of before would differ.
// 15: beams between beams, and every second plane's scatterers: pictures are others.
// 16: look, grey curve, compounding, persistence and Doppler are turned in a session.
// 18: a bursa's film parts around the tip first, and a roof that liquid lifts leaves the bevel.
constexpr int kVersion = 24;
constexpr const char* kName = "artus_recording";
constexpr const char* kDigest = "digest";

std::string digest_of(const nlohmann::json& json) {
  return in_hexadecimal(hash_bytes(json.dump()));
}

/// The first three rows of the pose's matrix: the same bits again when they are read.
nlohmann::json to_json(const Pose& pose) {
  auto json = nlohmann::json::array();
  for (Eigen::Index i = 0; i < 12; ++i) json.push_back(pose.matrix()(i / 4, i % 4));
  return json;
}

Pose to_pose(const nlohmann::json& json) {
  Pose pose = Pose::Identity();
  for (Eigen::Index i = 0; i < 12; ++i)
    pose.matrix()(i / 4, i % 4) = json.at(static_cast<std::size_t>(i)).get<double>();
  return pose;
}

Result<RecordingHead> to_head(const nlohmann::json& json) {
  RecordingHead head;
  json.at("joint").get_to(head.joint);
  json.at("joint_digest").get_to(head.joint_digest);
  json.at("device").get_to(head.params.device.name);  // one of the table, or somebody's own
  read_fields(json.at("params"), head.params);
  head.params.X_WJ = to_pose(json.at("X_WJ"));
  head.params.wait_for_cage = json.value("wait_for_cage", false);
  if (json.contains("X_JC")) head.params.X_JC = to_pose(json.at("X_JC"));
  const auto feel = to_needle_feel(json.at("feel"));
  ARTUS_TRY(feel);
  head.params.feel = *feel;
  ARTUS_TRY(validate(head.params));
  return head;
}

}  // namespace

RecordingHead make_head(const CompiledJoint& joint, const SessionParams& params) {
  return {joint.name, compute_joint_digest(joint), params};
}

std::string to_line(const RecordingHead& head) {
  nlohmann::json json{{kName, kVersion},
                      {"joint", head.joint},
                      {"joint_digest", head.joint_digest},
                      {"device", head.params.device.name},
                      {"X_WJ", to_json(head.params.X_WJ)},
                      {"feel", to_json(head.params.feel)},
                      {"params", fields_to_json(head.params)}};
  if (head.params.wait_for_cage) json["wait_for_cage"] = true;
  if (head.params.X_JC) json["X_JC"] = to_json(*head.params.X_JC);
  json[kDigest] = digest_of(json);
  return json.dump();
}

Result<RecordingHead> parse_head(const std::string& line) {
  auto json = nlohmann::json::parse(line, nullptr, false);
  if (json.is_discarded() || !json.is_object() || !json.contains(kName))
    return fail(ErrorCode::malformed, "this is not a recording of artus", {});
  if (json[kName] != kVersion)
    return fail(ErrorCode::unsupported,
                "the recording is of another format version; this artus reads version " +
                    std::to_string(kVersion),
                {});
  const nlohmann::json digest = json.value(kDigest, nlohmann::json());
  json.erase(kDigest);
  if (digest != digest_of(json))
    return fail(ErrorCode::corrupt, "its header (first line) was changed after it was written", {});
  try {
    return to_head(json);
  } catch (const nlohmann::json::exception& e) {
    return fail(ErrorCode::malformed,
                "its header (first line) is damaged: " + plain_reason(e.what()), {});
  }
}

}  // namespace artus
