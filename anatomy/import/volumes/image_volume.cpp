// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/volumes/image_volume.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {

std::size_t bytes_of(SampleType type) noexcept {
  switch (type) {
    case SampleType::u8:
    case SampleType::i8:
      return 1;
    case SampleType::u16:
    case SampleType::i16:
      return 2;
    case SampleType::u32:
    case SampleType::i32:
    case SampleType::f32:
      return 4;
    default:
      return 8;
  }
}

Result<std::size_t> count_voxels(const std::array<std::size_t, 3>& size, const std::string& where) {
  constexpr std::size_t kMost = 2147483647;
  std::size_t n = 1;
  for (const std::size_t along : size) {
    if (along == 0)
      return fail(ErrorCode::invalid, "a size of the volume is 0: there are no voxels", where);
    if (along > kMost / n)
      return fail(ErrorCode::invalid,
                  printed("%zu x %zu x %zu voxels are more than any scan has (2^31); crop it, or "
                          "the header is damaged",
                          size[0], size[1], size[2]),
                  where);
    n *= along;
  }
  return n;
}

Result<void> check_frame(const IndexFrame& X_LI, const std::string& where) {
  constexpr double kSmallest = 1e-6;  // m
  constexpr double kLargest = 50 * kMillimetre;
  constexpr double kFlat = 1e-3;  // of the voxel's edges' product
  if (!X_LI.matrix().allFinite())
    return fail(ErrorCode::invalid, "the frame of the volume has numbers that are not finite",
                where);
  const Eigen::Matrix3d edges = X_LI.linear();
  const Vec3 lengths = edges.colwise().norm();
  if (!(std::abs(edges.determinant()) > kFlat * lengths.prod()))
    return fail(ErrorCode::invalid,
                "the axes of the volume lie in one plane (its matrix is singular); save it again "
                "from the program that made it",
                where);
  if (lengths.minCoeff() < kSmallest || lengths.maxCoeff() > kLargest)
    return fail(
        ErrorCode::invalid,
        printed("voxels of %.4g x %.4g x %.4g mm are not those of a body; the unit of the "
                "header is wrong",
                lengths.x() / kMillimetre, lengths.y() / kMillimetre, lengths.z() / kMillimetre),
        where);
  return {};
}

IndexFrame rounded_frame(const IndexFrame& X_LI) noexcept {
  constexpr double kEdge = 1e-9;    // m
  constexpr double kOrigin = 1e-6;  // m
  IndexFrame out = X_LI;
  out.linear() = (X_LI.linear() / kEdge).array().round() * kEdge;
  out.translation() = (X_LI.translation() / kOrigin).array().round() * kOrigin;
  return out;
}

void swap_bytes(std::string& samples, std::size_t width) noexcept {
  for (std::size_t i = 0; i + width <= samples.size(); i += width)
    std::reverse(samples.begin() + static_cast<std::ptrdiff_t>(i),
                 samples.begin() + static_cast<std::ptrdiff_t>(i + width));
}

}  // namespace artus
