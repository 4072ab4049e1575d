// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>

/// How a DistanceField stores its samples.
namespace artus::field_blocks {

inline constexpr int kCells = 8;              ///< cells of a block along an axis
inline constexpr int kSide = kCells + 1;      ///< samples along an axis: blocks share their rims
inline constexpr int kRow = kSide;            ///< stride of y
inline constexpr int kPlane = kSide * kSide;  ///< stride of z
inline constexpr int kBlock = kSide * kSide * kSide;
inline constexpr std::int32_t kOut = -1;  ///< slot of a block wholly outside
inline constexpr std::int32_t kIn = -2;   ///< slot of a block wholly inside

}  // namespace artus::field_blocks
