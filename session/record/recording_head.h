// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/result.h"
#include "artus/simulation/session_params.h"

namespace artus {

/// What a recording says about itself: everything that its results depend on besides its inputs. A
/// line of JSON at the file's start (docs/recording-format.md).
struct RecordingHead {
  std::string joint;         ///< name
  std::string joint_digest;  ///< compute_joint_digest
  SessionParams params;
};
[[nodiscard]] RecordingHead make_head(const CompiledJoint& joint, const SessionParams& params);

/// One line without its end.
[[nodiscard]] std::string to_line(const RecordingHead& head);
/// Errors: malformed, unsupported (another version), corrupt (changed since it was written),
/// not_found (device, law), invalid (values that no session can have).
[[nodiscard]] Result<RecordingHead> parse_head(const std::string& line);

}  // namespace artus
