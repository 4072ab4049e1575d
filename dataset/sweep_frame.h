// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include <nlohmann/json.hpp>

#include "artus/dataset/sweep.h"
#include "artus/detail/dataset/frame_order.h"
#include "artus/detail/echo/display/rf_lines.h"

namespace artus {

/// The keys of a frame's pictures in its line of truth: masks and region ids where the picture
/// shows things, and where they truly are.
inline constexpr std::array<std::string_view, 7> kPictureKeys{
    "image",       "labels_shown", "shadow_shown", "needle_shown",
    "labels_true", "shadow_true",  "needle_true"};

/// How a picture's file ends: ".png" of the image, "-labels_shown.png" and so on of the others.
[[nodiscard]] std::string ending_of(std::string_view key, char separator);
/// The key of a frame's lines before the envelope, which are no picture.
inline constexpr std::string_view kRfKey = "rf";

/// A frame of a sweep before it is a file: its line of truth and its pictures by kPictureKeys, the
/// image first.
struct SweepFrame {
  nlohmann::json truth;
  std::vector<std::pair<std::string, cv::Mat>> pictures;
  std::optional<RfLines> rf;  ///< where they are asked for
};

/// Draws frames one by one; a frame depends on its order alone. A pressed one is drawn from the
/// joint as it then lies, the needle where it stands: its probe has moved along the beam, and its
/// truth has "press" (depth_mm, force_n, settled), null where nothing could be pressed.
class SweepDrawer {
 public:
  SweepDrawer(std::shared_ptr<const Scene> scene, const SweepOptions& options);
  ~SweepDrawer();
  /// The pictures look into the drawer until the next call.
  [[nodiscard]] SweepFrame draw(std::size_t index, const FrameOrder& order);

 private:
  struct Scanner;
  [[nodiscard]] Scanner& scanner(const FrameOrder& order);
  [[nodiscard]] nlohmann::json press(const FrameOrder& order, Pose& X_JP);

  std::shared_ptr<const Scene> scene_;
  SweepOptions options_;
  std::map<std::pair<std::size_t, std::size_t>, std::unique_ptr<Scanner>> scanners_;
  std::unique_ptr<Scanner> pressed_;  // of the last frame, when it was pressed
};

/// Errors: invalid, what no sweep can have: persistence, and lines of compound pictures.
[[nodiscard]] Result<void> check_sweep(const SweepOptions& options, const std::string& where);

/// What was asked for, apart from the poses: joints, transducers, settings, needle.
[[nodiscard]] nlohmann::json describe_sweep(const CompiledJoint& joint,
                                            const SweepOptions& options);

}  // namespace artus
