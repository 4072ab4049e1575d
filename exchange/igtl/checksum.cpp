// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/igtl/checksum.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace artus::igtl {
namespace {

constexpr std::uint64_t kPolynomial = 0x42F0E1EBA9EA3693;
constexpr std::size_t kStride = 8;  // bytes taken at once

using Table = std::array<std::array<std::uint64_t, 256>, kStride>;

/// table[k][b]: what byte b contributes when k more bytes follow it.
constexpr Table make_table() {
  Table table{};
  for (std::size_t b = 0; b < 256; ++b) {
    std::uint64_t crc = static_cast<std::uint64_t>(b) << 56U;
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc >> 63U) != 0 ? (crc << 1U) ^ kPolynomial : crc << 1U;
    table[0][b] = crc;
  }
  for (std::size_t k = 1; k < kStride; ++k)
    for (std::size_t b = 0; b < 256; ++b) {
      const std::uint64_t crc = table[k - 1][b];
      table[k][b] = (crc << 8U) ^ table[0][crc >> 56U];
    }
  return table;
}

constexpr Table kTable = make_table();

std::uint64_t big_endian_word(const char* bytes) noexcept {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  return std::endian::native == std::endian::little ? __builtin_bswap64(word) : word;
}

}  // namespace

std::uint64_t checksum(std::string_view bytes, std::uint64_t before) noexcept {
  std::uint64_t crc = before;
  while (bytes.size() >= kStride) {
    const std::uint64_t word = crc ^ big_endian_word(bytes.data());
    crc = 0;
    for (std::size_t k = 0; k < kStride; ++k) crc ^= kTable[k][(word >> (8 * k)) & 0xFFU];
    bytes.remove_prefix(kStride);
  }
  for (const char c : bytes)
    crc = (crc << 8U) ^ kTable[0][((crc >> 56U) ^ static_cast<unsigned char>(c)) & 0xFFU];
  return crc;
}

}  // namespace artus::igtl
