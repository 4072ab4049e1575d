// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

#include "artus/core/result.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/labels.h"
#include "artus/echo/transducer.h"

namespace artus {

/// The frame's grey image as a matrix (CV_8UC1); shares the frame's memory.
[[nodiscard]] cv::Mat grey_image(const Frame& frame);

/// `picture` (of the frame's size, CV_8UC1 or CV_8UC3) in a dark border with a depth scale (a tick
/// every 5 mm, a number every 10), the lens focus as a triangle and the orientation mark at the
/// left (-x) side.
[[nodiscard]] cv::Mat annotated_image(const cv::Mat& picture, const Frame& frame,
                                      const Transducer& transducer);

/// The same around the frame's grey image (CV_8UC1).
[[nodiscard]] cv::Mat annotated_image(const Frame& frame, const Transducer& transducer);

/// The labels in the palette's colours, needle white (CV_8UC3, blue first as OpenCV has it).
[[nodiscard]] cv::Mat colour_labels(const LabelImage& labels, const CompiledJoint& joint);

/// Writes an image; the format is the extension's (.png and .jpg 8 bit, .tiff also float).
/// Errors: unsupported (extension), unreadable (cannot write).
[[nodiscard]] Result<void> write_image(const cv::Mat& image, const std::filesystem::path& file);

/// Writes the envelope, (n_samples rows, n_lines columns) 32-bit float, as .tiff.
[[nodiscard]] Result<void> write_envelope(const Frame& frame, const std::filesystem::path& file);

}  // namespace artus
