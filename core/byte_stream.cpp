// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/byte_stream.h"

#include "artus/detail/core/noise.h"

namespace artus {

std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t seed) noexcept {
  std::uint64_t hash = mix_bits(seed ^ bytes.size());
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t n = bytes.size() < sizeof word ? bytes.size() : sizeof word;
    std::memcpy(&word, bytes.data(), n);
    hash = mix_bits(hash ^ word);
    bytes.remove_prefix(n);
  }
  return hash;
}

}  // namespace artus
