// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "artus/core/result.h"
#include "artus/detail/evidence/validation/echo/echo_gates.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/labels.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Grey values of a patch of tissue: how bright, how varied, how coarse.
struct PatchStatistics {
  double mean = 0;       ///< grey, 0..255
  double deviation = 0;  ///< grey
  /// px, full width at half maximum of the autocorrelation along depth, without changes of
  /// brightness slower than a Gaussian of 12 px
  double axial_width = 0;
  double lateral_width = 0;  ///< px, across
};

/// Requires: an 8-bit grey image that holds the patch.
[[nodiscard]] PatchStatistics measure_patch(const cv::Mat& image, const cv::Rect& patch);

/// Patches of `size` px that lie in muscle alone, at most `count`, that do not overlap, best spread
/// from the top left; frames of a region's border are left out.
[[nodiscard]] std::vector<cv::Rect> find_muscle_patches(const LabelImage& labels,
                                                        const CompiledJoint& joint, int size,
                                                        std::size_t count);

/// Least and most of each value over published images of muscle.
struct PatchRange {
  PatchStatistics least;
  PatchStatistics most;
  std::size_t images = 0;
};

/// Reads a table of measured images of muscle: tab-separated, columns file, mean, std,
/// acf_fwhm_axial_px, acf_fwhm_lateral_px among others. `prefixes` choose the rows by how their
/// file names begin; none: all rows. Errors: not_found, unreadable, malformed (column or number
/// missing, no row).
[[nodiscard]] Result<PatchRange> read_patch_range(const std::filesystem::path& file,
                                                  std::span<const std::string> prefixes = {});

/// Renders the joint's default view, or the nearest along the skin in which muscle is as thick as
/// those patches and runs along the face as there (see MuscleFinder), the same turned by 90
/// degrees, and a block of muscle in its long axis, and compares their muscle with the range. The
/// probe and pixels are those of the reference images: 4-9 MHz, 0.0854 mm. Every claim is fitted,
/// by muscle's speckle and, where the probe was slid, by the view.
[[nodiscard]] Gate measure_muscle(const std::shared_ptr<const Scene>& scene,
                                  const PatchRange& range);

}  // namespace artus
