// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/body_outline.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/anatomy/import/voxel_masks.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kClose = 16 * kMillimetre;
constexpr double kErode = 8 * kMillimetre;
constexpr double kHullCell = 2 * kMillimetre;
constexpr double kAirToFat = -400;  // HU

/// Voxels whose segment is one of `which`.
VoxelMask mask_of(const LabelVolume& volume, const std::vector<bool>& which) {
  VoxelMask mask{volume.size, std::vector<std::uint8_t>(volume.labels.size(), 0)};
  for (std::size_t i = 0; i < mask.is_in.size(); ++i)
    mask.is_in[i] = volume.labels[i] != 0 && which[volume.labels[i] - 1U] ? 1 : 0;
  return mask;
}

/// The grey value that parts two classes best.
double otsu_threshold(const std::vector<double>& values, double least, double most) {
  constexpr std::size_t kBins = 256;
  std::vector<double> histogram(kBins, 0);
  const double scale = (kBins - 1) / std::max(most - least, 1e-12);
  for (const double v : values) ++histogram[static_cast<std::size_t>((v - least) * scale)];
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    sum += static_cast<double>(i) * histogram[i];
    n += histogram[i];
  }
  double below = 0, sum_below = 0, best = -1;
  std::size_t at = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    below += histogram[i];
    sum_below += static_cast<double>(i) * histogram[i];
    if (below == 0 || below == n) continue;
    const double apart = sum_below / below - (sum - sum_below) / (n - below);
    const double between = below * (n - below) * apart * apart;
    if (between > best) {
      best = between;
      at = i;
    }
  }
  return least + (static_cast<double>(at) + 0.5) / scale;
}

Result<VoxelMask> mask_of_image(const LabelVolume& volume, const ImageVolume& image,
                                const std::string& name) {
  constexpr double kApart = 0.1;  // voxel
  constexpr double kAir = -500;   // HU; only CT has such values
  const Vec3 end(static_cast<double>(volume.size[0]), static_cast<double>(volume.size[1]),
                 static_cast<double>(volume.size[2]));
  const double apart = std::max((image.X_LI * end - volume.X_LI * end).norm(),
                                (image.X_LI.translation() - volume.X_LI.translation()).norm()) /
                       volume.voxel_edge();
  if (image.size != volume.size || image.layers != 1 || !(apart < kApart))
    return fail(ErrorCode::invalid,
                "the image has another grid than the segmentation; resample it to that of the "
                "segmentation (3D Slicer: Resample Image), or leave --image out",
                name);
  std::vector<double> values(volume.labels.size());
  with_samples(image, [&](const auto* samples) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double v = image.slope * static_cast<double>(samples[i]) + image.intercept;
      values[i] = std::isfinite(v) ? v : 0;
    }
  });
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double threshold = *least < kAir ? kAirToFat : otsu_threshold(values, *least, *most);
  VoxelMask mask{volume.size, std::vector<std::uint8_t>(values.size(), 0)};
  for (std::size_t i = 0; i < values.size(); ++i)
    mask.is_in[i] = values[i] > threshold || volume.labels[i] != 0 ? 1 : 0;
  keep_largest(mask);
  fill_enclosed(mask);
  return mask;
}

bool any(const std::vector<bool>& flags) {
  return std::find(flags.begin(), flags.end(), true) != flags.end();
}

/// The body, and by what it is known.
Result<VoxelMask> find_body(const LabelVolume& volume, const SegmentRoles& roles,
                            const std::optional<ImageVolume>& image, BodyOutline& outline,
                            const std::string& name) {
  const std::vector<bool> all(volume.segments.size(), true);
  const auto named = [&](const std::vector<bool>& which) {
    const auto at = std::find(which.begin(), which.end(), true) - which.begin();
    return "label '" + volume.segments[static_cast<std::size_t>(at)].name + "'";
  };
  if (any(roles.is_outline) || any(roles.is_skin)) {
    outline.by = named(any(roles.is_outline) ? roles.is_outline : roles.is_skin);
    VoxelMask mask = mask_of(volume, all);
    fill_enclosed(mask);
    return mask;
  }
  if (image) {
    outline.by = "the image";
    return mask_of_image(volume, *image, name);
  }
  outline.by = "a hull around all labels";
  outline.assumed = true;
  const Vec3 spacing = volume.X_LI.linear().colwise().norm();
  return closed_hull(mask_of(volume, all), spacing, kClose, kErode, kHullCell);
}

}  // namespace

Result<BodyOutline> outline_body(LabelVolume& volume, const SegmentRoles& roles,
                                 const std::optional<ImageVolume>& image, const std::string& name) {
  BodyOutline outline;
  const auto mask = find_body(volume, roles, image, outline, name);
  ARTUS_TRY(mask);
  LabelSegment rest;
  rest.name = "rest";
  outline.rest = static_cast<std::uint16_t>(volume.segments.size() + 1);
  bool has_air = false;
  for (std::size_t i = 0; i < volume.labels.size(); ++i) {
    std::uint16_t& label = volume.labels[i];
    const bool is_other =
        label != 0 && (roles.is_outline[label - 1U] || roles.is_left_out[label - 1U]);
    has_air = has_air || (label == 0 && mask->is_in[i] == 0);
    if (mask->is_in[i] == 0 || (label != 0 && !is_other)) continue;
    label = outline.rest;
    ++rest.n_voxels;
  }
  if (!has_air)
    return fail(ErrorCode::invalid,
                "the labels fill all of the volume and are cut on all sides: the body has no skin "
                "in it; crop less, so that air is around the limb",
                name);
  volume.segments.push_back(std::move(rest));
  return outline;
}

}  // namespace artus
