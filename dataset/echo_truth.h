// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include <opencv2/core.hpp>

#include <nlohmann/json.hpp>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/echo/display/scan_converter.h"
#include "artus/detail/echo/display/shown_places.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/labels.h"
#include "artus/echo/transducer.h"

/// The ground truth of a frame as files and JSON hold it.
namespace artus {

/// Region ids, (height, width) CV_16UC1.
[[nodiscard]] cv::Mat id_image(const LabelImage& labels);

/// 255 where the needle's shaft is in the slice, (height, width) CV_8UC1.
[[nodiscard]] cv::Mat needle_mask(const LabelImage& labels);

/// 255 where no sound returns (behind bone or gas, or without contact), 128 where less than half of
/// it passes the needle, else 0; (height, width) CV_8UC1; as the picture shows it, or where it
/// truly is by the `places` that the frame shows. Requires: `converter` is of the frame's
/// transducer and settings.
[[nodiscard]] cv::Mat shadow_mask(const Frame& frame, const ScanConverter& converter,
                                  const ShownPlaces* places = nullptr);

/// The grey image (CV_8UC3) with what moves in colour: red toward the probe, blue away, the
/// brighter the faster; of powers dark red to yellow. Requires: a frame with velocities;
/// `converter` and `settings` are the frame's.
[[nodiscard]] cv::Mat doppler_image(const Frame& frame, const ScanConverter& converter,
                                    const ImageSettings& settings,
                                    MotionShown shown = MotionShown::velocity);

/// Tip in pixels, where it is (tip_true_px) and where it shows (Frame::tip_shown; null when it does
/// not), offset from the plane in mm, angles in degrees, in_plane; tip_visible: it shows and lies
/// in the slice.
[[nodiscard]] nlohmann::json to_json(const NeedleTruth& truth,
                                     const std::optional<PixelPoint>& tip_shown);

/// What is in the plane: id, name, tissue and area (mm2) of each region, by rising id.
[[nodiscard]] nlohmann::json region_list(const LabelImage& labels, const CompiledJoint& joint);

/// Position (mm), direction into the body and lateral direction.
[[nodiscard]] nlohmann::json probe_json(const Pose& X_JP);

/// Share of the face that couples to the body, and the stretches of scanlines (first, last) that
/// do not.
[[nodiscard]] nlohmann::json contact_json(const Frame& frame);

/// Every value, in mm, MHz and degrees.
[[nodiscard]] nlohmann::json to_json(const Transducer& transducer);
/// Its inverse. Errors: malformed, naming the value; those of validate.
[[nodiscard]] Result<Transducer> transducer_of(const nlohmann::json& values);

/// Every value that the image depends on (not the number of threads).
[[nodiscard]] nlohmann::json to_json(const ImageSettings& settings);

}  // namespace artus
