// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>

namespace artus {

/// A well-mixed 64-bit hash of a counter (the finaliser of SplitMix64, [Steele2014]). Stateless,
/// so noise is a pure function of (seed, index) and the same at any thread count.
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

/// Uniform in [0, 1) from a seed and an index; 53 random bits.
[[nodiscard]] constexpr double uniform_noise(std::uint64_t seed, std::uint64_t index) noexcept {
  return static_cast<double>(mix_bits(mix_bits(seed) ^ index) >> 11U) * 0x1.0p-53;
}

/// Standard normal from a seed and an index (Box-Muller on two uniforms of the same counter).
[[nodiscard]] double normal_noise(std::uint64_t seed, std::uint64_t index) noexcept;

}  // namespace artus
